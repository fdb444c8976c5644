"""What the page keeps of playing along: errors by foot and row, days, loops, a file of it; one foot; coach; delays."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from page_chromium import NOW, Browser, message, pad_script, text

RECORD = (
    "JSON.parse(Object.entries(localStorage).find(([k]) => k.startsWith('dancetutor:practice:song'))?.[1] ?? 'null')"
)
HOSTILE = "<img src=x onerror=window.hacked=1>"
# What a link of a file to download held, without a download.
CATCH = "URL.createObjectURL = blob => { window.caught = blob; return 'data:,'; }; 1"


def loop(browser: Browser, link: str = "#m1-1") -> None:
    """Loop some measures without a count-in, and play along from its start."""
    browser.run(f"location.hash = '{link}'")
    browser.wait("document.querySelector('.message').textContent.includes('loop')")
    browser.key("i", "KeyI")
    browser.run(pad_script())
    browser.key("p", "KeyP")
    browser.key(" ", "Space")
    browser.turn(0.06)


def press(browser: Browser, column: int) -> None:
    """Press and let go a panel of a mat, which says when that was by the test's clock."""
    for down in ("true", "false"):
        browser.run(f"window.pad.buttons[{column}].pressed = {down}; window.pad.timestamp = performance.now()")
        browser.drawn()


def play(browser: Browser, keys: str, late: float = 0.0) -> None:
    """A measure of rows a quarter of a second apart; a key for each, a space for none."""
    at = 0.0
    for number, key in enumerate(keys):
        browser.turn(0.25 * number + late - at)
        at = 0.25 * number + late
        if key != " ":
            press(browser, "dfjk".index(key))
    browser.turn(2.0 - at + 0.01)


def results(browser: Browser) -> str:
    browser.click("#tab-results")
    return text(browser, "#panel-results")


def load_file(browser: Browser, content: str, name: str = "x.json") -> str:
    """Give the page a file of results; what it says then."""
    browser.run(
        "(async () => { const data = new DataTransfer();"
        f"data.items.add(new File([{content}], {json.dumps(name)}));"
        "const input = document.querySelector('#record-file');"
        "document.querySelector('#record-message').textContent = '';"
        "input.files = data.files; input.dispatchEvent(new Event('change')); })()"
    )
    browser.wait("document.querySelector('#record-message').textContent !== ''")
    return text(browser, "#record-message")


STEPS = "dfkfdkjk"  # of measure 1: 1000 0100 0001 0100 1000 0001 0010 0001


def test_a_pass_is_kept_by_foot_row_and_day_and_stays(opened: Browser, page_file: Path) -> None:
    loop(opened)
    play(opened, "dfk     ", late=0.06)
    opened.key(" ", "Space")
    record: dict[str, Any] = opened.run(RECORD)
    (day,) = record["days"]
    assert (day["hit"], day["late"], day["miss"], day["wrong"]) == (0, 3, 5, 0)
    left, right = day["feet"]
    assert sum(left) + sum(right) == 3 and left[9 + 4] + right[9 + 4] == 3  # 60 ms are the fourth bar of 15 ms
    assert [one["missed"] for one in record["rows"].values()] == [False] * 3 + [True] * 5
    shown = results(opened)
    assert "Today: 8 notes19 %scoreof the notes: 38 % pressed, 0 % on time" in shown and "Days in a row: 1" in shown
    assert (
        "measure 1start at 70 % speed5 rows missed · not passed yet" in shown
    )  # and the speed to begin at: what was hit at 100 % does not make it passed
    assert opened.run("[...document.querySelectorAll('.rows tbody td:nth-child(3)')].map(e => e.textContent)") == (
        ["1 of 1"] * 5
    )
    about = opened.run("document.querySelector('.bars').getAttribute('aria-label')")
    assert "left foot: " in about and "on average 60 ms late" in about
    tall = opened.run("[...document.querySelectorAll('.bars')[0].children].map(e => Math.max(...[...e.children]"
                      ".map(b => b.getBoundingClientRect().height)) > 5)")  # fmt: skip
    assert tall == [k == 13 for k in range(19)]
    opened.open(page_file)
    assert "Today: 8 notes19 %scoreof the notes: 38 % pressed, 0 % on time" in results(opened)
    opened.click(".missed")
    assert message(opened).startswith("coach: not passed yet, begins at 70 % speed · loop measure 1,")
    assert opened.problems == []


def test_days_make_a_streak_and_a_clean_pass_is_remembered(opened: Browser, page_file: Path) -> None:
    loop(opened, "#m1-4@0.5")
    feet = [[0] * 19, [0] * 19]
    days = (
        "[3, 2, 1].map(n => new Date(Date.now() - 864e5 * n)).map(d => [d.getFullYear(), d.getMonth() + 1, d.getDate()]"
    )
    days += ".map(n => String(n).padStart(2, '0')).join('-'))"
    assert opened.run(RECORD) is None  # nothing was pressed yet
    press(opened, 0)
    opened.key(" ", "Space")
    name = opened.run("Object.keys(localStorage).find(k => k.startsWith('dancetutor:practice:'))")
    stored = f"""{days}.map(day => ({{day, hit: 3, early: 0, late: 1, miss: 0, wrong: 0, feet: {feet}}}))"""
    opened.run(
        f"localStorage.setItem({json.dumps(name)}, JSON.stringify({{days: {stored}, rows: {{}}, loops: [],"
        " best: {'4-20': 85}}))"
    )
    opened.call("Page.navigate", url="about:blank")
    opened.open(page_file)
    shown = results(opened)
    assert "Nothing played today. Days in a row: 3 (record: 3)." in shown and "How early or late, all days" in shown
    assert opened.run("document.querySelectorAll('.bars:not(.timing):not(.through) > *').length") == 3
    assert "88 %" in opened.run("document.querySelector('.bars:not(.timing):not(.through)').getAttribute('aria-label')")


def test_a_card_keeps_the_best_pass_and_a_tick(opened: Browser, page_file: Path) -> None:
    """Below full speed too, over days: what was played of a passage, in a loop or in the song."""
    loop(opened, "#m1-4@0.5")
    assert text(opened, ".card .kept-best") == ""
    for key in STEPS[:4]:
        press(opened, "dfjk".index(key))
        opened.turn(0.5)
    opened.turn(16)
    plays = opened.run(f"{RECORD}.plays")
    (where,) = plays
    score = plays[where][0]
    assert plays[where][1] == 50 and 0 < score < 100
    assert text(opened, ".card .kept-best") == f"best score {score} % at 50 % speed"
    opened.open(page_file)  # the next day
    assert text(opened, ".card .kept-best") == f"best score {score} % at 50 % speed"
    assert not opened.run("document.querySelector('.card').classList.contains('passed-full')")
    name = opened.run("Object.keys(localStorage).find(k => k.startsWith('dancetutor:practice:'))")
    stored = json.dumps({"scores": {where: 96}})
    opened.run(f"localStorage.setItem({json.dumps(name)}, {json.dumps(stored)})")
    opened.call("Page.navigate", url="about:blank")
    opened.open(page_file)
    assert text(opened, ".card .kept-best") == "✓ passed at full speed · best score 96 % at 100 % speed"
    assert opened.run("document.querySelector('.card').classList.contains('passed-full')") and opened.problems == []


def test_loops_are_kept_by_name_and_forgotten(opened: Browser, page_file: Path) -> None:
    assert opened.run("document.querySelector('#loop-keep').disabled") is True
    opened.run("location.hash = '#m2-3@0.75'")
    opened.wait("!document.querySelector('#loop-keep').disabled")
    opened.run("document.querySelector('#loop-name').focus()")
    opened.call("Input.insertText", text=f"k {HOSTILE}")  # a letter that is a key elsewhere
    opened.click("#loop-keep")
    assert opened.run("document.querySelectorAll('.kept').length") == 1
    opened.open(page_file)
    assert text(opened, ".kept strong") == f"k {HOSTILE}" and opened.run("window.hacked") is None
    assert opened.run("document.querySelector('.kept img')") is None
    opened.click(".kept .card")
    assert message(opened).startswith("loop measures 2 to 3") and text(opened, ".rate-text") == "75 %"
    opened.click(".kept .sign")
    assert opened.run("document.querySelector('.kept')") is None
    opened.open(page_file)
    assert opened.run("document.querySelector('.kept')") is None and opened.problems == []


def test_a_file_takes_results_to_another_browser(opened: Browser, page_file: Path) -> None:
    loop(opened)
    play(opened, STEPS)
    opened.key(" ", "Space")
    before = opened.run(RECORD)
    assert before["days"][0]["hit"] == 8 and before["best"] == {"4-8": 100}
    opened.run(CATCH)
    opened.click("#tab-settings")
    opened.click("#record-save")
    content = opened.run("window.caught.text()")
    opened.call("Storage.clearDataForOrigin", origin="file://", storageTypes="local_storage")
    opened.open(page_file)
    assert "Nothing played yet" in results(opened)
    for _ in range(2):  # twice is once
        assert load_file(opened, json.dumps(content)) == "Loaded 1 chart, this one among them."
        assert opened.run(RECORD) == before
    assert "Today: 8 notes100 %scoreof the notes: 100 % pressed, 100 % on time" in text(opened, "#panel-results")
    assert opened.requests[1:] == [] and opened.problems == []


def test_a_file_that_is_none_is_refused_and_nothing_is_lost(opened: Browser) -> None:
    loop(opened)
    play(opened, STEPS)
    opened.key(" ", "Space")
    before = opened.run(RECORD)
    opened.click("#tab-results")
    assert (
        load_file(opened, "'not json'", f"{HOSTILE}.json") == f"{HOSTILE}.json is not a file of results from this page."
    )
    assert "larger than 4 MB" in load_file(opened, "'x'.repeat(4000001)")
    hostile = {
        "format": "dancetutor-practice",
        "version": 1,
        "charts": {"other": {"days": [7], "loops": [{"name": 1}]}},
    }
    assert load_file(opened, f"JSON.stringify({json.dumps(hostile)})") == "Loaded 1 chart, but not this one."
    assert opened.run(RECORD) == before and opened.run("window.hacked") is None
    assert opened.problems == []


def test_a_record_of_a_wrong_shape_does_not_stop_the_page(opened: Browser, page_file: Path) -> None:
    loop(opened)
    play(opened, STEPS)
    opened.key(" ", "Space")
    name = opened.run("Object.keys(localStorage).find(k => k.startsWith('dancetutor:practice:'))")
    for value in ("3", "[]", '{"days": [{"day": 1}], "rows": 3, "best": [1]}', "{", '{"days": {"length": 5}}'):
        opened.run(f"localStorage.setItem({json.dumps(name)}, {json.dumps(value)})")
        opened.open(page_file)
        assert "Nothing played yet" in results(opened) and opened.problems == []


def test_of_one_foot_the_other_is_played(opened: Browser) -> None:
    opened.click("#tab-along")
    opened.run("(s => { s.value = 'left'; s.dispatchEvent(new Event('change')); })(document.querySelector('#foot'))")
    opened.run("location.hash = '#m1-1'")
    opened.key("i", "KeyI")
    opened.key(" ", "Space")
    opened.turn(0.06)
    play(opened, " " * 8)
    opened.key(" ", "Space")
    assert opened.run(RECORD) is None  # who presses nothing has not played
    opened.run(pad_script())
    opened.run("location.hash = '#m1-2'")  # anew, from the start
    opened.run("location.hash = '#m1-1'")
    opened.key(" ", "Space")
    opened.turn(0.06)
    play(opened, "d       ")
    opened.key(" ", "Space")
    (day,) = opened.run(RECORD)["days"]
    assert day["hit"] == 1 and 0 < day["miss"] < 7
    opened.key("t", "KeyT")
    assert opened.run("document.querySelector('#foot').value") == "right"
    opened.run("location.hash = '#m1-2'")  # anew, from the start
    opened.run("location.hash = '#m1-1'")
    opened.key(" ", "Space")
    opened.turn(0.06)
    play(opened, " f      ")
    opened.key(" ", "Space")
    (day,) = opened.run(RECORD)["days"]
    assert (day["hit"], day["miss"]) == (2, 6)  # each row has one foot
    assert opened.problems == []


def test_the_coach_loops_what_was_missed_and_raises_the_speed(opened: Browser) -> None:
    loop(opened)
    play(opened, "dfk     ")
    opened.key(" ", "Space")
    opened.key("x", "KeyX")
    opened.key("-", "Minus")
    opened.key("c", "KeyC")
    assert "coach: not passed yet, begins at 70 %" in message(opened) and "loop measure 1" in message(opened)
    opened.turn(0.06)
    opened.turn(0.9)  # at 70 % a pass is 2.86 s: nobody presses anything in the first
    opened.turn(2.0)
    assert "begins at 70 %" in message(opened) and text(opened, ".rate-text") == "70 %"
    for number, column in enumerate((0, 1, 3, 1)):
        opened.turn(0.25 / 0.7 if number else 0.0)
        press(opened, column)
    opened.turn(1.9)
    assert "coach: score 50 %, 95 % passes; speed now 65 %" in message(opened) and text(opened, ".rate-text") == "65 %"
    assert opened.run("document.querySelector('.way.coached').ariaPressed") == "true"
    opened.key("c", "KeyC")
    assert text(opened, ".rate-text") == "95 %"  # that was chosen before
    opened.key("p", "KeyP")
    assert opened.problems == []


def test_the_coach_has_passages_where_nothing_was_missed(opened: Browser) -> None:
    opened.key("c", "KeyC")
    assert "coach: not passed yet, begins at 70 %" in message(opened)
    assert opened.run("document.querySelector('.strip').getAttribute('aria-valuenow')") is not None


@pytest.mark.parametrize(("button", "late", "setting"), [("#by-ear", 0.05, "latency"), ("#by-eye", 0.12, "sight")])
def test_delays_are_measured_and_shown(opened: Browser, button: str, late: float, setting: str) -> None:
    opened.click("#tab-along")
    opened.run("document.querySelector('#calibrate').click()")
    assert text(opened, ".calibrate .hint") == "In use now: 0 ms by ear, 0 ms visual delay."
    opened.click(button)
    opened.turn(1.2)
    for number in range(12):
        opened.turn(late)
        if number % 2:
            opened.key("j", "KeyJ")
        else:  # a finger does as well
            x, y, w, h = opened.box(".tap")
            opened.mouse("mousePressed", x + w / 2, y + h / 2)
            opened.mouse("mouseReleased", x + w / 2, y + h / 2)
        opened.turn(0.6 - late)
    opened.turn(0.4)
    ms = round(1000 * late)
    assert f"Your presses come {ms} ms after" in text(opened, ".calibrated") and "half of 12 within" in text(
        opened, ".calibrated"
    )
    assert opened.run("document.querySelectorAll('.scale .dot').length") == 12
    assert opened.run(f"JSON.parse(localStorage.dancetutor ?? '{{}}').{setting} ?? 0") == 0  # not before it is taken
    opened.click("#calibrate-apply")
    assert f"{ms} ms" in text(opened, ".calibrate .hint")
    assert opened.run(f"JSON.parse(localStorage.dancetutor).{setting}") == pytest.approx(late, abs=2e-3)
    opened.key("Escape")
    assert opened.run("document.querySelector('dialog.calibrate')") is None and opened.problems == []


@pytest.mark.parametrize(("spread", "told"), [(0.1, "presses vary too much"), (0.0, "2 ms before the sound")])
def test_taps_that_spread_are_refused_and_early_ones_are_before(opened: Browser, spread: float, told: str) -> None:
    opened.click("#tab-along")
    opened.run("document.querySelector('#calibrate').click()")
    opened.click("#by-ear")
    opened.turn(1.0)
    at = -0.2  # of the first tick
    for number in range(12):
        due = 0.6 * number - 0.002 + spread * (number % 3 - 1)
        opened.turn(due - at)
        at = due
        opened.key("j", "KeyJ")
    opened.turn(1.2)
    assert told in text(opened, ".calibrated")
    shown = opened.run("document.querySelector('#calibrate-apply').checkVisibility()")
    assert shown == (spread == 0)
    if shown:
        opened.click("#calibrate-keep")
        assert text(opened, ".calibrated") == "Nothing was changed."
    assert opened.run("JSON.parse(localStorage.dancetutor ?? '{}').latency ?? 0") == 0 and opened.problems == []


def test_rows_that_go_well_are_not_listed(opened: Browser) -> None:
    loop(opened)
    play(opened, STEPS[:7] + " ", late=0.02)
    opened.key(" ", "Space")
    results(opened)
    rows = opened.run("[...document.querySelectorAll('.rows tbody th')].map(e => e.textContent)")
    assert rows == ["measure 1, beat 4.5"]  # the one that was missed, by the beats of its measure
    assert "1 row missed ·" in text(opened, "#panel-results") and opened.problems == []


def test_the_strip_shows_a_part_and_goes_on_with_the_music(opened: Browser) -> None:
    x, y, w, h = opened.box(".strip")
    for _ in range(4):
        opened.key("z", "KeyZ")
    before = float(opened.run(NOW))
    opened.mouse("mousePressed", x + w - 1, y + h / 2)
    opened.mouse("mouseReleased", x + w - 1, y + h / 2)
    opened.drawn()
    at = float(opened.run(NOW))
    assert 4 < at - before <= 9  # the strip's right end is no longer the song's
    opened.key(" ", "Space")
    opened.turn(1.5)
    opened.mouse("mousePressed", x + 2, y + h / 2)
    opened.mouse("mouseReleased", x + 2, y + h / 2)
    opened.drawn()
    assert float(opened.run(NOW)) == pytest.approx(at, abs=1.2)  # it went on to the next part
    opened.click(".zoom button:last-child")
    for _ in range(4):
        opened.key("Z", "KeyZ", 8)
    opened.mouse("mousePressed", x + 1, y + h / 2)
    opened.mouse("mouseReleased", x + 1, y + h / 2)
    opened.drawn()
    assert float(opened.run(NOW)) < 0.2 and opened.problems == []


@pytest.mark.parametrize("language", ["en", "de"])
@pytest.mark.parametrize(("width", "height"), [(1280, 720), (768, 1024), (380, 740)])
def test_results_have_room_in_every_window(
    opened: Browser, page_file: Path, language: str, width: int, height: int
) -> None:
    loop(opened)
    play(opened, "dfk     ", late=0.06)
    opened.key(" ", "Space")
    opened.run(f"localStorage.setItem('dancetutor', JSON.stringify({{language: '{language}'}}))")
    opened.size(width, height, touch=width < 800)
    opened.open(page_file)
    for tab in ("passages", "along", "results"):
        opened.click(f"#tab-{tab}")
        wide = f"(e => e.scrollWidth <= e.clientWidth)(document.querySelector('#panel-{tab}'))"
        assert opened.run(wide), tab
    small = "[...document.querySelectorAll('#panel-results button')].filter(b => b.getBoundingClientRect().height < 44)"
    if width < 800:
        assert opened.run(f"{small}.length") == 0
    assert opened.run("document.documentElement.scrollWidth") == width
