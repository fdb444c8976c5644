"""The real page in a real browser."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from dance_requests import solved_one
from page_chromium import NOW, Browser, message, pad_script, text
from page_song import write_song
from PIL import Image

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.feet.limbs import Limb

pytestmark = pytest.mark.usefixtures("fresh")


def second(browser: Browser) -> float:
    """The second of the music that the page shows."""
    return float(browser.run(NOW))


def test_it_opens_alone_without_complaint(browser: Browser) -> None:
    assert browser.run("window.hacked") is None
    assert text(browser, "h1").startswith("</script><script>window.hacked=1")
    assert browser.problems == []
    asked = [url for url in browser.requests if not url.startswith(("file:", "data:", "blob:", "about:"))]
    assert asked == [] and sum(url.startswith("file:") for url in browser.requests) == 1


def test_it_draws_dancer_pad_and_notes(browser: Browser, tmp_path: Path) -> None:
    for _ in range(2):
        browser.key(".", "Period")
    pixels = np.asarray(Image.open(browser.picture(tmp_path / "a.png")).convert("RGB")).astype(int)
    x, y, w, h = (int(v) for v in browser.box(".view"))
    view = pixels[y : y + h, x : x + w]

    def share(part: np.ndarray, colour: tuple[int, int, int], away: int) -> float:
        return float((np.abs(part - np.array(colour)).max(axis=2) <= away).mean())

    # Her hair, her two shoes, the floor's violet and the pad's grey are all there, in their places.
    assert share(view[: h // 2], (196, 55, 110), 32) > 0.002
    assert share(view[h // 2 :], (255, 138, 31), 40) > 0.001
    assert share(view[h // 2 :], (22, 194, 207), 40) > 0.001
    assert share(view[h // 2 :], (52, 48, 92), 22) > 0.1
    x, y, w, h = (int(v) for v in browser.box(".lanes"))
    assert share(pixels[y : y + h, x : x + w], (238, 59, 79), 12) > 0.002  # notes on beats are red


def test_it_plays_by_the_real_clock(browser: Browser, page_file: Path) -> None:
    browser.open(page_file, live=True)
    browser.key(" ", "Space")
    start = second(browser)
    browser.wait(f"{NOW} > {start} + 0.5")
    assert browser.problems == []


def test_it_plays_loops_and_seeks(browser: Browser) -> None:
    browser.key("Home")
    start = second(browser)
    browser.key(" ", "Space")
    browser.turn(1.06)  # after the moment in which the sound is made ready
    assert second(browser) == pytest.approx(start + 1, abs=0.01)
    assert text(browser, ".play") == "❚❚"
    browser.key(" ", "Space")
    browser.turn(1)
    assert second(browser) == pytest.approx(start + 1, abs=0.01) and text(browser, ".play") == "▶"
    browser.key("Home")
    browser.key(".", "Period")
    assert text(browser, ".where").startswith("m1 · beat 4 ·") and second(browser) == pytest.approx(2.0, abs=0.01)
    browser.key(".", "Period")
    assert second(browser) == pytest.approx(2.25, abs=0.01)  # the next row is an eighth later
    browser.run("location.hash = '#m1-1.5@2'")
    browser.wait(
        "document.querySelector('.message').textContent.startsWith('loop measure 1, beat 4 to measure 1, beat 5')"
    )
    browser.key("i", "KeyI")  # no count-in: the loop is a second of music, half a second at this speed
    browser.key(" ", "Space")
    browser.turn(0.06 + 0.55)
    assert "1 done" in message(browser) and second(browser) == pytest.approx(2.1, abs=0.02)


def test_a_deep_link_names_whole_measures_and_begins_with_the_count_in(browser: Browser, page_file: Path) -> None:
    """Measures 1 to 2, both of them: seconds 2 to 6, after four beats that are counted down in numbers."""
    browser.open(page_file, "#m1-2")
    assert message(browser).startswith("loop measures 1 to 2,") and second(browser) == pytest.approx(2.0, abs=0.01)
    assert text(browser, ".count") == ""
    browser.key(" ", "Space")
    browser.turn(0.06)
    for beat, number in enumerate("4321"):
        assert text(browser, ".count") == number
        assert second(browser) == pytest.approx(0.5 * beat, abs=0.02)
        browser.turn(0.5)
    assert text(browser, ".count") == "" and second(browser) == pytest.approx(2.0, abs=0.02)
    browser.turn(3.9)
    assert second(browser) == pytest.approx(5.9, abs=0.02) and "0 done" in message(browser)
    browser.turn(0.15)
    assert "1 done" in message(browser) and text(browser, ".count") == "4"  # and before every pass
    assert browser.run("location.hash") == "#m1-2"


def test_the_end_of_the_ramp_brings_the_chosen_speed_back(browser: Browser, page_file: Path) -> None:
    browser.open(page_file, "#m1-1@0.8")
    browser.key("i", "KeyI")
    browser.key("r", "KeyR")
    browser.key(" ", "Space")
    browser.turn(0.06 + 2.6)  # a pass of two seconds at 80 %
    assert browser.run("document.querySelector('.rate').value") == "0.85"
    assert text(browser, ".rate-text") == "85 %" and "ramp: speed 80 % → 85 %" in message(browser)
    assert browser.run("location.hash") == "#m1-1@0.8"
    browser.key("r", "KeyR")
    assert text(browser, ".rate-text") == "80 %" and "ramp" not in message(browser)


def test_the_strip_seeks_and_makes_loops(browser: Browser) -> None:
    x, y, w, h = browser.box(".strip")
    for kind in ("mousePressed", "mouseReleased"):
        browser.mouse(kind, x + 0.5 * w, y + h / 2)
    browser.drawn()
    ends = browser.run("['min','max'].map(n=>Number(document.querySelector('.strip').getAttribute('aria-value'+n)))")
    assert second(browser) == pytest.approx(sum(ends) / 2, abs=0.2)
    browser.mouse("mousePressed", x + 0.4 * w, y + h / 2)
    for k in range(5, 8):
        browser.mouse("mouseMoved", x + 0.1 * k * w, y + h / 2)
    browser.mouse("mouseReleased", x + 0.7 * w, y + h / 2)
    browser.drawn()
    assert re.match(r"loop measures? \d+( to \d+)?, 0", message(browser))  # whole ones, as they are named
    assert re.fullmatch(r"#m\d+-\d+", browser.run("location.hash"))


def press_pad(browser: Browser, *buttons: int) -> None:
    """Press buttons together, long enough to be seen by a picture, and let go."""
    browser.run(f"for (const b of {list(buttons)}) window.pad.buttons[b].pressed = true")
    browser.drawn()
    browser.run(f"for (const b of {list(buttons)}) window.pad.buttons[b].pressed = false")
    browser.drawn()


def test_she_waits_until_each_row_is_pressed(browser: Browser) -> None:
    browser.run(pad_script())
    browser.key("Home")
    browser.key("w", "KeyW")
    browser.key(" ", "Space")
    browser.turn(9)
    assert message(browser).startswith("waiting") and second(browser) == pytest.approx(2.0, abs=0.01)
    press_pad(browser, 1)  # down: the row is left
    browser.turn(9)
    assert second(browser) == pytest.approx(2.0, abs=0.01) and "1 wrong" in text(browser, ".score")
    press_pad(browser, 0)
    browser.turn(9)
    assert message(browser).startswith("waiting") and second(browser) == pytest.approx(2.25, abs=0.01)
    browser.key("f", "KeyF")  # a key is as good: down
    browser.turn(9)
    assert second(browser) == pytest.approx(2.5, abs=0.01)
    assert "2 hit" in text(browser, ".score") and "1 wrong" in text(browser, ".score")


def test_a_mat_that_calls_its_arrows_axes_plays_along_and_lets_go_when_it_is_pulled_out(browser: Browser) -> None:
    browser.run(pad_script() + "window.pad.axes = [0, 0, 1]")  # a third one rests at its end
    browser.turn(0.1)
    browser.run("window.pad.axes[0] = -1")
    browser.turn(0.1)
    assert message(browser) == "Nothing you press or step on is judged yet: choose Play along (p)."
    browser.run("window.pad.axes[0] = 0")
    browser.key("Home")
    browser.key("w", "KeyW")
    browser.key(" ", "Space")
    browser.turn(9)
    assert message(browser).startswith("waiting") and second(browser) == pytest.approx(2.0, abs=0.01)
    browser.run("window.pad.axes[1] = 1")  # down: the row is left
    browser.turn(0.1)
    assert "1 wrong" in text(browser, ".score")
    browser.run("window.pad.axes[1] = 0; window.pad.axes[0] = -1")
    browser.turn(0.1)
    assert "1 hit" in text(browser, ".score") and "1 wrong" in text(browser, ".score")
    held = "document.querySelector('canvas[data-held]').dataset.held"
    assert browser.run(held) == "[0]"
    browser.run("navigator.getGamepads = () => [null]")
    browser.turn(0.1)
    assert browser.run(held) == "[]"


def test_she_waits_in_every_pass_of_a_loop(browser: Browser, page_file: Path) -> None:
    """Waiting is switched on at the loop's end: no row behind it is waited for; the next pass waits at its first."""
    browser.open(page_file, "#m1-1@2")
    browser.key("i", "KeyI")
    browser.key(" ", "Space")
    browser.turn(0.06 + 0.98)
    assert second(browser) == pytest.approx(3.96, abs=0.01)
    browser.key("w", "KeyW")
    browser.turn(9)  # to the next pass's beginning
    browser.turn(9)
    assert message(browser).startswith("waiting") and second(browser) == pytest.approx(2.0, abs=0.01)
    assert text(browser, ".score").strip() == "0 hit"


def test_panels_can_be_given_other_keys(browser: Browser) -> None:
    browser.click("#tab-along")
    browser.click("#assign")
    for key in "qwer":
        browser.key(key, f"Key{key.upper()}")
    assert (
        browser.run("[...document.querySelectorAll('.keys kbd:first-of-type')].map(k => k.textContent).join('')")
        == "QWER"
    )
    assert browser.run("JSON.parse(localStorage.getItem('dancetutor')).keys['4'].join()") == "KeyQ,KeyW,KeyE,KeyR"
    assert browser.run("Object.keys(localStorage).every(key => key.startsWith('dancetutor'))")


def test_music_can_be_dropped_and_plays(browser: Browser, page_file: Path) -> None:
    """A second of sound as a WAV file: decoded, and what is no music is said; played by the real clock."""
    browser.open(page_file, live=True)
    browser.run(
        "window.wav = (() => { const n = 8000, d = new DataView(new ArrayBuffer(44 + 2 * n));"
        "const s = (at, t) => [...t].forEach((c, k) => d.setUint8(at + k, c.charCodeAt(0)));"
        "s(0, 'RIFF'); d.setUint32(4, 36 + 2 * n, true); s(8, 'WAVEfmt '); d.setUint32(16, 16, true);"
        "d.setUint16(20, 1, true); d.setUint16(22, 1, true); d.setUint32(24, 8000, true);"
        "d.setUint32(28, 16000, true); d.setUint16(32, 2, true); d.setUint16(34, 16, true); s(36, 'data');"
        "d.setUint32(40, 2 * n, true);"
        "for (let k = 0; k < n; ++k) d.setInt16(44 + 2 * k, 9000 * Math.sin(k / 3), true);"
        "return d.buffer; })();"
        "window.drop = (data, name) => { const t = new DataTransfer(); t.items.add(new File([data], name));"
        "document.dispatchEvent(new DragEvent('drop', {dataTransfer: t, bubbles: true, cancelable: true})); }"
    )
    assert "No music yet" in text(browser, "#music-state")
    browser.run("window.drop(new Uint8Array(100), 'a.ogg')")
    browser.wait(
        "document.querySelector('.message').textContent ==="
        " 'a.ogg cannot be played as music here. No music yet: the page claps instead.'"
    )
    assert text(browser, "#music-state") == text(browser, ".message")
    browser.run("window.drop(window.wav, 'a.wav')")
    browser.wait("document.querySelector('#music-state').textContent === 'The music is loaded: a.wav.'")
    browser.wait("document.querySelector('.pick').offsetParent === null")
    browser.run("window.drop(new Uint8Array(100), 'b.ogg')")  # no music: the one before stays, and both places say so
    browser.wait("document.querySelector('.message').textContent.startsWith('b.ogg cannot')")
    assert text(browser, "#music-state") == text(browser, ".message")
    assert text(browser, "#music-state").endswith("The music is loaded: a.wav.")
    browser.key(" ", "Space")
    start = second(browser)
    browser.wait(f"{NOW} > {start} + 0.3")
    assert browser.problems == []


def test_the_author_gives_the_other_foot_and_takes_files_home(browser: Browser, tmp_path: Path) -> None:
    browser.run(
        "window.saved = {}; URL.createObjectURL = blob => { window.last = blob; return 'blob:none'; };"
        "HTMLAnchorElement.prototype.click = function () { const name = this.download;"
        " window.last.text().then(text => { window.saved[name] = text; }); }"
    )
    browser.key("Home")
    browser.key(".", "Period")
    browser.key("o", "KeyO")
    about = text(browser, "#panel-author .about")
    assert "left R" in about and re.search(r"You gave it the other foot: [a-z ]*awkward \(\+\d+ cost units\)", about)
    assert "Kept in this browser" in text(browser, "#panel-author .saved")
    browser.key("o", "KeyO")  # and back
    about = text(browser, "#panel-author .about")
    assert "left L" in about and "The other foot is " in about and text(browser, "#panel-author .saved") == ""
    browser.key("o", "KeyO")
    assert "measure 1, beat 4: R" in text(browser, ".changes")
    browser.run("for (const b of document.querySelectorAll('#panel-author .column button')) b.click()")
    assert "play.json is in your downloads" in text(browser, "#panel-author .saved")
    browser.wait("Object.keys(window.saved).length === 3")
    assert '      4: "R"' in browser.run("window.saved['dancetutor.yaml']")
    assert browser.run("window.saved['measure-comments.txt']").startswith("// measure 1 {dt1! R")
    assert browser.problems == []
    saved = browser.run("window.saved")
    for name, content in saved.items():
        (tmp_path / name).write_text(content, "utf-8")
    check_files_are_taken(tmp_path, saved["measure-comments.txt"])


def first_limb(song_file: Path, **more: Path) -> int:
    """Whose the first row is as `animate` finds it."""
    play = solved_one(song_file, Selection(), "itg", **more).play
    assert play is not None
    return int(play.limb[0, 0])


def check_files_are_taken(folder: Path, comment: str) -> None:
    """What the page saved does what it says: the first row is the right foot's, by each of the three."""
    song_file = write_song(folder)
    assert first_limb(song_file) == Limb.RIGHT_FOOT  # dancetutor.yaml beside the song
    (folder / "dancetutor.yaml").unlink()
    assert first_limb(song_file) == Limb.LEFT_FOOT
    assert first_limb(song_file, play=folder / "play.json") == Limb.RIGHT_FOOT
    lines = song_file.read_text("utf-8").split("\n,\n", 1)
    pinned = f"{lines[0]}\n,  {comment.strip()}\n{lines[1]}"
    song_file.write_text(pinned, "utf-8")
    assert first_limb(song_file) == Limb.RIGHT_FOOT


def test_help_lists_every_key_and_closes(browser: Browser) -> None:
    browser.key("?", "Slash", 8)
    assert browser.run("document.querySelector('dialog.sheet').open")
    assert browser.run("document.querySelectorAll('dialog.sheet tr').length") >= 28
    browser.key("Escape")
    assert not browser.run("document.querySelector('dialog.sheet').open")


def test_it_speaks_german(browser: Browser, page_file: Path) -> None:
    browser.run("localStorage.setItem('dancetutor', JSON.stringify({language: 'de'}))")
    browser.open(page_file)
    assert text(browser, "#tab-findings") == "Befunde"
    assert browser.run("document.documentElement.lang") == "de"
    words = browser.run("document.body.innerText")
    assert "undefined" not in words and "{" not in words.replace("{{data}}", "")


def test_another_language_is_spoken_at_once(browser: Browser) -> None:
    """Nothing is loaded anew: the place, the open tab and what was pressed stay; findings are told in it too."""
    browser.key(".", "Period")
    at = second(browser)
    browser.click("#tab-settings")
    browser.run("window.kept = 1; (s => { s.value = 'de'; s.dispatchEvent(new Event('change')); })"
                "(document.querySelector('#language'))")  # fmt: skip
    browser.drawn()
    assert text(browser, "#tab-findings") == "Befunde" and browser.run("document.documentElement.lang") == "de"
    assert browser.run("window.kept") == 1 and second(browser) == at
    assert browser.run("document.querySelector('#tab-settings').getAttribute('aria-selected')") == "true"
    assert browser.run("document.activeElement.id") == "language"
    told = browser.run("[...document.querySelectorAll('.finding .says:not([lang])')].map(e => e.textContent)")
    assert told and all(line.endswith((".", ")")) for line in told)
    assert browser.run("document.querySelectorAll('.finding [lang=en]').length") == 0  # and not in English besides
    keys = browser.run("[...document.querySelectorAll('.sheet kbd')].map(e => e.textContent)")
    assert {"Bild↑", "Bild↓", "Pos1", "Ende"} <= set(keys) and "PageUp" not in keys
    assert re.search(r"\d,\d Schritte/s", text(browser, "#panel-passages .figure"))
    assert "versteckte Note" in text(browser, "#panel-findings") and "DT402" in text(browser, "#panel-findings")
    browser.click(".play")
    browser.turn(1.06)
    assert second(browser) == pytest.approx(at + 1, abs=0.01)
    assert browser.problems == []
