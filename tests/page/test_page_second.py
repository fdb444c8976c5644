"""What a second look at the page found: keys reach every note, a failed start says why, fingers are told apart, ..."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from page_chromium import NOW, STILL, Browser, message, text
from page_song import SONG
from test_page_document import unpacked

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.page.facts import without_repeats
from dancetutor_cli.page.work import PageRequest, make_page


@pytest.fixture(scope="module")
def wide_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A double whose title is a megabyte."""
    folder = tmp_path_factory.mktemp("wide")
    rows = ["10000000", "01000000", "00010000", "00001000", "00000100", "00000001", "00000010", "00001000"]
    song = folder / "song.sm"
    song.write_text(f"#TITLE:{'long title ' * 95000};\n#OFFSET:0;\n#BPMS:0=120;\n"
                    f"#NOTES:dance-double::Hard:9::\n{chr(10).join(rows)}\n;\n")  # fmt: skip
    path = folder / "wide.html"
    path.write_bytes(make_page(PageRequest(DanceRequest(song, Selection(), fps=30.0))).html)
    return path


def load(browser: Browser, path: Path, before: str, until: str) -> None:
    """Open a page that need not become ready, after a script of the test's."""
    browser.call("Page.navigate", url="about:blank")
    number = browser.call("Page.addScriptToEvaluateOnNewDocument", source=before)["identifier"]
    browser.call("Page.navigate", url=path.resolve().as_uri())
    try:
        browser.wait(f"location.protocol === 'file:' && document.readyState === 'complete' && {until}", 15)
    finally:
        browser.call("Page.removeScriptToEvaluateOnNewDocument", identifier=number)


# Keys


def test_other_feet_go_to_the_row_that_stands(opened: Browser) -> None:
    opened.key("Home")
    opened.key(".", "Period")
    opened.key("o", "KeyO")
    opened.key(".", "Period")
    opened.key("o", "KeyO")
    rows = opened.run("[...document.querySelectorAll('.changes li button')].map(e => e.textContent)")
    assert [row.partition(":")[0] for row in rows] == ["measure 1, beat 4", "measure 1, beat 4.5"]


def test_keys_reach_every_note(opened: Browser) -> None:
    """The notes are a stop of the Tab key; arrows go from note to note there, and each is told."""
    opened.run("document.querySelector('.lanes').focus()")
    assert opened.run("document.activeElement.className") == "lanes"
    opened.key("Home")
    assert text(opened, ".notes [role=status]").startswith("measure 1, beat 4: left L")
    told = []
    for _ in range(9):
        opened.key("ArrowRight")
        told.append(text(opened, ".notes [role=status]"))
    assert len(set(told)) == 9 and told[0].startswith("measure 1, beat 4.5: down")
    assert told[7].startswith("measure 2, beat 8: left") and told[8].startswith("measure 2, beat 8: right")  # a jump
    opened.key("ArrowLeft")
    assert text(opened, ".notes [role=status]") == told[7]
    opened.key("o", "KeyO")
    assert opened.run("document.querySelectorAll('.changes li').length") == 1
    outline = "(e => [getComputedStyle(e).outlineStyle, e.matches(':focus-visible')])(document.querySelector('.lanes'))"
    assert opened.run(outline) == ["solid", True]
    assert opened.problems == []


# A start that fails

BAD = {
    "keys": {"4": [1, 2, 3, 4], "8": "x", "__proto__": 1}, "pads": {"mat/4": [0, "1", None, 2], "x": 3},
    "claps": "loud", "camera": "moon", "help": {}, "language": 7,
    "speed": "fast", "volume": None, "latency": True,
    "leadBeats": 2.5, "ramp": 1, "yaw": [], "metronome": True,
}  # fmt: skip


def test_settings_of_a_wrong_shape_fall_back_each_alone(opened: Browser, page_file: Path) -> None:
    opened.run(f"localStorage.setItem('dancetutor', {json.dumps(json.dumps(BAD))})")
    load(opened, page_file, STILL, "document.documentElement?.dataset.ready")
    opened.key("p", "KeyP")
    assert opened.run("document.querySelector('.standing').checkVisibility()")
    pressed = "[...document.querySelectorAll('.bar [aria-pressed=true]')].map(e => e.textContent)"
    assert "Metronome" in opened.run(pressed) and "Ramp" not in opened.run(pressed)
    assert text(opened, ".camera[aria-pressed=true]") == "Behind"
    assert opened.run("document.querySelector('#feet-help').value") == "all"
    keys = "[...document.querySelectorAll('.keys kbd:first-of-type')].map(k => k.textContent).join('')"
    assert opened.run(keys) == "DFJK" and opened.problems == []
    opened.run("localStorage.clear()")


def test_a_browser_that_cannot_unpack_is_told(opened: Browser, page_file: Path) -> None:
    load(opened, page_file, "delete window.DecompressionStream", "document.querySelector('h1') !== null")
    assert "too old" in text(opened, "#app") and text(opened, "#app") != "…"


def test_a_start_that_fails_says_so_and_forgets_the_settings(opened: Browser, page_file: Path) -> None:
    opened.run("localStorage.setItem('dancetutor', '{\"volume\": 0.5}'); localStorage.setItem('other', 'stays')")
    broken = "window.structuredClone = () => { throw new Error('<b>broken</b>'); };"
    load(opened, page_file, broken, "document.querySelector('.failed h1') !== null")
    assert "<b>broken</b>" in text(opened, ".failed") and opened.run("document.querySelector('.failed b')") is None
    opened.run("document.querySelector('.failed button').click()")
    opened.wait("document.documentElement?.dataset.ready")
    assert opened.run("localStorage.getItem('dancetutor')") is None and opened.run("localStorage.other") == "stays"
    opened.run("localStorage.clear()")


def test_without_script_a_sentence_stands(opened: Browser, page_file: Path) -> None:
    opened.call("Emulation.setScriptExecutionDisabled", value=True)
    try:
        opened.call("Page.navigate", url=page_file.resolve().as_uri())
        opened.wait("document.readyState === 'complete' && location.protocol === 'file:'")
        assert "JavaScript" in opened.run("document.querySelector('#app').innerText")
        assert "…" not in opened.run("document.querySelector('#app').innerText")
    finally:
        opened.call("Emulation.setScriptExecutionDisabled", value=False)


# Fingers


def lanes_at(browser: Browser) -> tuple[list[float], float]:
    """The middles of the lanes and their height."""
    x, y, w, h = browser.box(".lanes")
    numbers, words = 15, 98  # left of the lanes those of measures, right of them words
    lane = min(96, (w - numbers - words) / 4)
    left = x + max(numbers, (w - words - 4 * lane) / 2)
    return [left + (k + 0.5) * lane for k in range(4)], y + h / 2


def test_a_finger_lifts_only_its_own_lane(opened: Browser, page_file: Path, tmp_path: Path) -> None:
    opened.size(800, 900, touch=True)
    opened.open(page_file)
    opened.key("p", "KeyP")
    xs, y = lanes_at(opened)

    def touch(kind: str, *points: tuple[int, float]) -> None:
        marks = [{"x": x, "y": y, "id": number} for number, x in points]
        opened.call("Input.dispatchTouchEvent", type=kind, touchPoints=marks)
        opened.drawn()

    def held() -> list[int]:
        """Lanes with the thick white ring of a receptor that is held."""
        return opened.run("JSON.parse(document.querySelector('.lanes').dataset.held ?? '[]')")  # type: ignore[no-any-return]

    touch("touchStart", (1, xs[0]))
    touch("touchStart", (1, xs[0]), (2, xs[3]))
    assert held() == [0, 3]
    touch("touchEnd", (1, xs[0]))
    assert held() == [3]
    touch("touchMove", (2, 20))  # lifted elsewhere
    touch("touchEnd")
    assert held() == []
    touch("touchStart", (1, xs[1]))
    touch("touchCancel")
    assert held() == []
    touch("touchStart", (1, xs[0] - 40), (2, xs[3] + 60))  # beside the lanes: the nearest one
    assert held() == [0, 3]
    touch("touchEnd")
    assert held() == []


def test_a_finger_on_the_lanes_is_told_that_nothing_is_judged_yet(opened: Browser, page_file: Path) -> None:
    opened.size(800, 900, touch=True)
    opened.open(page_file)
    opened.run("document.querySelector('#tab-along').click()")
    xs, y = lanes_at(opened)
    for kind, points in (("touchStart", [{"x": xs[0], "y": y}]), ("touchEnd", [])):
        opened.call("Input.dispatchTouchEvent", type=kind, touchPoints=points)
    opened.drawn()
    assert message(opened).startswith("Nothing you press or step on is judged yet")
    assert opened.run("document.querySelector('[aria-selected=true]').id") == "tab-along"
    opened.key("p", "KeyP")
    assert not message(opened).startswith("Nothing")


def test_on_a_phone_lanes_are_called_by_their_arrows(opened: Browser, page_file: Path) -> None:
    opened.size(380, 740, touch=True)
    opened.open(page_file)
    assert text(opened, ".keys").split() == ["left", "←", "down", "↓", "up", "↑", "right", "→"]
    opened.size(1280, 720)
    opened.open(page_file)
    assert "D" in text(opened, ".keys").split()


# Clock, links, words


def test_going_out_of_a_loop_ends_it(opened: Browser, page_file: Path) -> None:
    opened.open(page_file, "#m1-1")
    opened.key("End")
    assert message(opened) == "You left the loop of measure 1: it is over." and opened.run("location.hash") == ""
    at = float(opened.run(NOW))
    opened.key(" ", "Space")
    opened.turn(1.06)
    assert float(opened.run(NOW)) == pytest.approx(at + 1, abs=0.02)


def test_the_ramp_says_why_it_does_nothing(opened: Browser, page_file: Path) -> None:
    opened.key("r", "KeyR")
    assert message(opened) == "The ramp raises the speed of a loop: make one first."
    opened.open(page_file, "#m1-1")
    assert "ramp: 100 % speed, the highest" in message(opened)
    opened.key("-", "Minus")
    assert "the highest" not in message(opened)


def test_the_keys_are_said_for_a_while(opened: Browser) -> None:
    opened.key("p", "KeyP")
    opened.key("q", "KeyQ")
    assert message(opened).startswith("That key is not a panel.")
    opened.turn(6)
    assert not message(opened).startswith("That key")


def test_links_of_nothing_and_of_endless_numbers_are_refused(opened: Browser, page_file: Path) -> None:
    opened.open(page_file, "#m0.001-0.002")
    assert message(opened).startswith("The loop in this link is too short")
    for link in (f"#m{'9' * 400}", f"#m1-{'9' * 400}", f"#m1@{'9' * 400}", f"#m0.{'1' * 400}"):
        opened.open(page_file, link)
        assert message(opened).startswith("This link is not understood") and len(message(opened)) < 200
        assert text(opened, ".rate-text") == "100 %"
    assert opened.problems == []


def test_beats_are_counted_as_everywhere_else(opened: Browser) -> None:
    """From 0 on through the song, as measures are: `analyze` says "measure 1 beat 4.5" of the same row."""
    opened.key("Home")
    opened.key(".", "Period")
    opened.key(".", "Period")
    assert text(opened, ".where").startswith("m1 · beat 4.5 ·")


def test_no_word_is_smaller_than_twelve_pixels(flat: Browser, page_file: Path) -> None:
    spy = (
        "window.least = 99; const fill = CanvasRenderingContext2D.prototype.fillText;"
        "CanvasRenderingContext2D.prototype.fillText = function (text, ...rest) { if (text.length > 1)"
        " window.least = Math.min(window.least, Number(/([\\d.]+)px/.exec(this.font)[1]));"
        " fill.call(this, text, ...rest); };"
    )
    for width, height in ((1280, 720), (768, 1024), (380, 740)):
        flat.size(width, height)
        load(flat, page_file, STILL + spy, "document.documentElement?.dataset.ready")
        for _ in range(9):
            flat.key(".", "Period")
        assert flat.run("window.least") >= 12


# Sizes of the window


@pytest.mark.parametrize(("width", "height"), [(1280, 720), (1024, 768), (740, 900), (740, 400)])
def test_tabs_stand_in_one_row_and_the_title_is_clamped(
    flat: Browser, wide_file: Path, width: int, height: int
) -> None:
    flat.size(width, height)
    flat.open(wide_file)
    for key in (".", "o"):  # all of the tabs
        flat.key(key)
    assert flat.run("[...document.querySelectorAll('[role=tab]')].every(e => e.checkVisibility())")
    assert len(flat.run("[...new Set([...document.querySelectorAll('[role=tab]')].map(e => e.offsetTop))]")) == 1
    if width >= 1024:  # none is cut off; on narrower ones the row scrolls
        assert flat.run("(e => e.scrollWidth <= e.clientWidth)(document.querySelector('.tabs'))")
    assert flat.box("header")[3] < 100 and flat.box(".view")[2] > 200


def test_at_four_hundred_percent_there_is_a_dancer(flat: Browser, page_file: Path) -> None:
    flat.size(320, 180)
    flat.open(page_file)
    assert flat.box(".view")[2] >= 280 and flat.box(".view")[3] >= 120 and flat.box(".lanes")[3] >= 120
    assert flat.run("document.documentElement.scrollWidth") == 320


def test_on_a_phone_the_dancer_of_a_double_has_the_width(flat: Browser, wide_file: Path) -> None:
    flat.size(380, 740, touch=True)
    flat.open(wide_file)
    assert flat.box(".view")[2] > 360 and flat.box(".view")[3] > 170
    assert flat.run("document.documentElement.scrollHeight") == 740


def test_passages_that_are_told_alike_are_one(tmp_path: Path) -> None:
    stream = "\n".join(["1000", "0100", "0010", "0001"] * 4) + "\n"
    rest = "1000\n0000\n0000\n0000\n"
    head = SONG.partition("#NOTES:")[0].replace("{title}", "x")
    song = tmp_path / "song.ssc"
    song.write_text(head + "#NOTES:\n" + ",\n".join([stream] * 16 + [rest] * 16) + ";\n")
    doc = unpacked(make_page(PageRequest(DanceRequest(song, Selection(), fps=30.0))).html)
    told = [str(one["tags"]) for one in doc["passages"]]
    assert told and len(set(told)) == len(told)
    assert doc["passages"][0]["again"] and doc["passages"][0]["number"] == 1


def test_a_few_slow_steps_are_no_hard_passage() -> None:
    told = {"from": 0, "to": 4, "plain": False, "player": 0}
    one, two = {**told, "tags": [["fast", 20], ["jump", 1]]}, {**told, "plain": True, "tags": [["fast", 10]]}
    assert [found["number"] for found in without_repeats([two, one])] == [2]
