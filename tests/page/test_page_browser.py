"""The real page in a real browser."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from conftest import write_song
from page_chromium import NOW, Browser, pad_script, text
from PIL import Image

from dancetutor_cli.jobs.bake import BakeTask, ask
from dancetutor_cli.library.selection import Selection
from dancetutor_cli.play.model import Limb


@pytest.fixture(autouse=True)
def fresh(browser: Browser, page_file: Path) -> None:
    """The page, opened anew, with nothing stored."""
    browser.size(1280, 720)
    browser.call("Storage.clearDataForOrigin", origin="file://", storageTypes="local_storage")
    browser.problems.clear()
    browser.open(page_file)
    assert browser.run("localStorage.length") == 0


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
        browser.key("ArrowRight")
    browser.wait("document.querySelector('.where').textContent.includes('beat')")
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


def test_it_plays_loops_and_seeks(browser: Browser) -> None:
    browser.key(" ", "Space")
    start = second(browser)
    browser.wait(f"{NOW} > {start} + 0.5")
    browser.key(" ", "Space")
    browser.wait("document.querySelector('.play').textContent === '▶'")
    browser.key("Home")
    browser.key("ArrowRight")
    browser.wait("document.querySelector('.where').textContent.startsWith('m1 · beat 1')")
    first = second(browser)
    browser.key("ArrowRight")
    browser.wait(f"{NOW} !== {first}")
    assert second(browser) - first == pytest.approx(0.25, abs=0.011)  # the next row is an eighth later
    browser.run("location.hash = '#m1-1.5@2'")
    browser.wait("document.querySelector('.said').textContent.includes('m1 to m1.5')")
    browser.key("i", "KeyI")  # no count-in: the loop is a second of music, half a second at this speed
    browser.key(" ", "Space")
    browser.wait("/[1-9] done/.test(document.querySelector('.said').textContent)")
    assert 2.0 - 0.1 <= second(browser) <= 3.0 + 0.1


def test_the_strip_seeks_and_makes_loops(browser: Browser) -> None:
    x, y, w, h = browser.box(".strip")
    for kind in ("mousePressed", "mouseReleased"):
        browser.mouse(kind, x + 0.5 * w, y + h / 2)
    ends = browser.run("['min','max'].map(n=>Number(document.querySelector('.strip').getAttribute('aria-value'+n)))")
    browser.wait(f"Math.abs({NOW} - {sum(ends) / 2}) < 0.2")
    browser.mouse("mousePressed", x + 0.4 * w, y + h / 2)
    for k in range(5, 8):
        browser.mouse("mouseMoved", x + 0.1 * k * w, y + h / 2)
    browser.mouse("mouseReleased", x + 0.7 * w, y + h / 2)
    browser.wait("document.querySelector('.said').textContent.startsWith('loop m')")
    assert browser.run("location.hash").startswith("#m")


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
    browser.wait("document.querySelector('.said').textContent.startsWith('waiting')")
    assert second(browser) == pytest.approx(2.0, abs=0.02)
    press_pad(browser, 1)  # down: the row is left
    assert second(browser) == pytest.approx(2.0, abs=0.02)
    press_pad(browser, 0)
    browser.wait(f"{NOW} > 2.24 && document.querySelector('.said').textContent.startsWith('waiting')")
    assert second(browser) == pytest.approx(2.25, abs=0.02)
    browser.key("f", "KeyF")  # a key is as good: down
    browser.wait(f"{NOW} > 2.49")
    assert "2 hit" in text(browser, ".score")


def test_she_waits_in_every_pass_of_a_loop(browser: Browser, page_file: Path) -> None:
    """Waiting is switched on at the loop's end: no row behind it is waited for; the next pass waits at its first."""
    browser.open(page_file, "#m1-2@2")
    while second(browser) < 3.9:  # from the lead-in, by measures
        browser.key("PageDown")
    assert second(browser) == pytest.approx(4.0, abs=0.02)
    browser.key("w", "KeyW")
    browser.key(" ", "Space")
    browser.wait(f"{NOW} < 3 && document.querySelector('.said').textContent.startsWith('waiting')")
    assert second(browser) == pytest.approx(2.0, abs=0.02)
    assert "0 hit" in text(browser, ".score") and "0 missed" in text(browser, ".score")


def test_panels_can_be_given_other_keys(browser: Browser) -> None:
    browser.click("#tab-along")
    browser.click("#assign")
    for key in "qwer":
        browser.key(key, f"Key{key.upper()}")
    browser.wait("[...document.querySelectorAll('.keys kbd')].map(k => k.textContent).join('') === 'QWER'")
    assert browser.run("JSON.parse(localStorage.getItem('dancetutor')).keys['4'].join()") == "KeyQ,KeyW,KeyE,KeyR"
    assert browser.run("Object.keys(localStorage).every(key => key.startsWith('dancetutor'))")


def test_music_can_be_dropped_and_plays(browser: Browser) -> None:
    """A second of sound as a WAV file: decoded, and what is no music is said."""
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
    browser.wait("document.querySelector('.said').textContent.includes('cannot play')")
    browser.run("window.drop(window.wav, 'a.wav')")
    browser.wait("document.querySelector('#music-state').textContent === 'The music is loaded.'")
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
    browser.key("ArrowRight")
    browser.key("o", "KeyO")
    assert "other foot costs" in text(browser, "#panel-author .about")
    assert "measure 1, beat 1: R" in text(browser, ".changes")
    browser.run("for (const b of document.querySelectorAll('#panel-author .column button')) b.click()")
    browser.wait("Object.keys(window.saved).length === 3")
    assert '      4: "R"' in browser.run("window.saved['dancetutor.yaml']")
    assert browser.run("window.saved['measure-comments.txt']").startswith("// measure 1 {dt1! R")
    assert browser.problems == []
    saved = browser.run("window.saved")
    for name, content in saved.items():
        (tmp_path / name).write_text(content, "utf-8")
    check_files_are_taken(tmp_path, saved["measure-comments.txt"])


def check_files_are_taken(folder: Path, comment: str) -> None:
    """What the page saved does what it says: the first row is the right foot's, by each of the three."""
    song_file = write_song(folder)
    asked = ask(BakeTask(song_file, Selection(), "itg"))
    assert asked.play.limb[0, 0] == Limb.RIGHT_FOOT  # dancetutor.yaml beside the song
    (folder / "dancetutor.yaml").unlink()
    assert ask(BakeTask(song_file, Selection(), "itg")).play.limb[0, 0] == Limb.LEFT_FOOT
    play = ask(BakeTask(song_file, Selection(), "itg", play_file=folder / "play.json")).play
    assert play.limb[0, 0] == Limb.RIGHT_FOOT
    lines = song_file.read_text("utf-8").split("\n,\n", 1)
    pinned = f"{lines[0]}\n,  {comment.strip()}\n{lines[1]}"
    song_file.write_text(pinned, "utf-8")
    assert ask(BakeTask(song_file, Selection(), "itg")).play.limb[0, 0] == Limb.RIGHT_FOOT


def test_help_lists_every_key_and_closes(browser: Browser) -> None:
    browser.key("?", "Slash", 8)
    browser.wait("document.querySelector('dialog.sheet').open")
    assert browser.run("document.querySelectorAll('dialog.sheet tr').length") >= 28
    browser.key("Escape")
    browser.wait("!document.querySelector('dialog.sheet').open")


def test_it_speaks_german(browser: Browser, page_file: Path) -> None:
    browser.run("localStorage.setItem('dancetutor', JSON.stringify({language: 'de'}))")
    browser.open(page_file)
    assert text(browser, "#tab-findings") == "Befunde"
    assert browser.run("document.documentElement.lang") == "de"
    words = browser.run("document.body.innerText")
    assert "undefined" not in words and "{" not in words.replace("{{data}}", "")


def test_a_phone_shows_all_of_it_without_scrolling_sideways(browser: Browser, page_file: Path) -> None:
    browser.size(380, 800, touch=True)
    browser.open(page_file)
    assert browser.run("document.documentElement.scrollWidth") <= 380
    small = browser.run(
        "[...document.querySelectorAll('button, select')].filter(b => b.offsetParent)"
        ".filter(b => b.getBoundingClientRect().height < 24).map(b => b.textContent)"
    )
    assert small == []


def test_nothing_moves_while_it_plays(browser: Browser) -> None:
    browser.run(
        "window.shift = 0;"
        "new PerformanceObserver(list => { for (const e of list.getEntries()) window.shift += e.value; })"
        ".observe({type: 'layout-shift', buffered: true})"
    )
    browser.key("]", "BracketRight")
    browser.key(" ", "Space")
    start = second(browser)
    browser.wait(f"Math.abs({NOW} - {start}) > 0.3")
    for key in ("ArrowUp", "m", "v", "v", "g"):
        browser.key(key)
    assert browser.run("window.shift") < 0.02
    assert browser.problems == []


def test_axe_finds_nothing_serious(browser: Browser) -> None:
    source = Path(__file__).parent / "node_modules" / "axe-core" / "axe.min.js"
    if not source.exists():
        pytest.skip("no axe here; `make page-tools` puts it into tests/page/node_modules")
    browser.run(source.read_text("utf-8") + "; 1")
    for tab in ("passages", "along", "findings", "author", "settings"):
        browser.click(f"#tab-{tab}")
        found = browser.run(
            "axe.run(document, {resultTypes: ['violations']}).then(r => r.violations"
            ".filter(v => ['serious', 'critical'].includes(v.impact)).map(v => v.id + ' ' + v.nodes[0].html))"
        )
        assert found == [], tab
