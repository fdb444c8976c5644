"""The page where WebGL is missing, which draws quickly whatever else the machine does."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from page_chromium import NOW, Browser, pad_script, text
from PIL import Image


@pytest.fixture(scope="module")
def flat(page_file: Path) -> Iterator[Browser]:
    """A browser without WebGL."""
    one = Browser(flags=("--disable-gpu", "--disable-3d-apis"))
    one.size(1280, 720)
    yield one
    one.close()


def test_without_webgl_feet_from_above_are_shown(flat: Browser, page_file: Path, tmp_path: Path) -> None:
    flat.open(page_file)
    for _ in range(2):
        flat.key(".", "Period")
    flat.drawn()
    x, y, w, h = (int(v) for v in flat.box(".view"))
    pixels = np.asarray(Image.open(flat.picture(tmp_path / "a.png")).convert("RGB")).astype(int)
    view = pixels[y : y + h, x : x + w]
    for colour in ((255, 138, 31), (22, 194, 207)):
        assert (np.abs(view - np.array(colour)).max(axis=2) <= 30).mean() > 0.002


def test_presses_are_timed_and_misses_counted(flat: Browser, page_file: Path) -> None:
    flat.open(page_file)
    flat.run(pad_script())
    flat.run("location.hash = '#m0.5-1.5@0.25'")
    flat.wait("document.querySelector('.message').textContent.includes('measure 0, beat 2 to measure 1, beat 5')")
    flat.key("i", "KeyI")
    flat.key("p", "KeyP")
    flat.key(" ", "Space")
    flat.turn(0.06 + 1.0 / 0.25 + 0.08)  # the first row is a second into the loop, at second 2: 80 ms ago
    assert float(flat.run(NOW)) == pytest.approx(2.02, abs=0.01)
    flat.run("window.pad.buttons[0].pressed = true; window.pad.timestamp = performance.now() - 30")
    flat.drawn()
    assert text(flat, ".score").startswith("1 late (")  # counts of nothing are not said
    assert "50 ms late" in text(flat, ".score")  # the mat says when it was pressed, however slowly pictures come
    flat.turn(0.5 / 0.25)
    assert "1 late, 1 miss (" in text(flat, ".score")


def test_arrows_are_panels_while_somebody_plays_along(flat: Browser, page_file: Path) -> None:
    """They neither go to other rows nor change the speed; the first key that is no panel has the keys said."""
    flat.open(page_file)
    flat.key("Home")
    flat.key(".", "Period")  # nobody plays along: to the first row, and to one between two beats
    flat.key(".", "Period")
    assert text(flat, ".where").startswith("m1 · beat 4.5 ·")
    flat.key("Home")
    flat.key("p", "KeyP")
    flat.key(" ", "Space")
    flat.turn(0.06 + 2.0)
    flat.key("ArrowLeft")
    assert float(flat.run(NOW)) == pytest.approx(2.0, abs=0.01) and "1 hit" in text(flat, ".score")
    flat.key("ArrowUp")
    assert text(flat, ".rate-text") == "100 %" and "1 hit" in text(flat, ".score") and "1 wrong" in text(flat, ".score")
    flat.key("q", "KeyQ")
    assert text(flat, ".message") == "That key is not a panel. The panels are D F J K, or ← ↓ ↑ →."
    flat.key("ArrowRight")
    assert text(flat, ".score").startswith("1 hit")
    flat.turn(60)  # and at the end how it went
    assert text(flat, ".message").startswith("The song is over, ") and text(flat, ".play") == "▶"
    flat.key(" ", "Space")  # once more from the start, all notes anew
    flat.turn(0.06)
    assert text(flat, ".score").strip() == "0 hit" and text(flat, ".message") == ""
    assert flat.problems == []


def test_a_link_that_cannot_be_followed_says_so(flat: Browser, page_file: Path) -> None:
    flat.open(page_file, "#m900-1000")
    assert text(flat, ".message").startswith("The link begins in measure 900, but the last one is measure ")
    start = float(flat.run(NOW))
    for link, said in (("#m2-1", "The link ends before it begins"), ("#nonsense", "This link is not understood"),
                       ("#m1-99", "The link goes beyond the last measure")):  # fmt: skip
        flat.run(f"location.hash = '{link}'")
        flat.wait(f"document.querySelector('.message').textContent.startsWith('{said}')")
    assert start < 2 and float(flat.run(NOW)) == pytest.approx(2.0, abs=0.01)
    flat.key(".", "Period")  # whatever is done next takes the place of it
    assert text(flat, ".message").startswith("loop measures 1 to ")
    assert flat.problems == []


def test_the_free_camera_begins_anew(flat: Browser, page_file: Path) -> None:
    """What is stored is within bounds; chosen again, the free camera stands as at first."""
    flat.open(page_file)
    flat.run("localStorage.setItem('dancetutor', JSON.stringify({camera: 'free', zoom: 99, pitch: -50, yaw: 1e9}))")
    flat.open(page_file)
    stored = "(s => [s.yaw, s.pitch, s.zoom])(JSON.parse(localStorage.dancetutor))"
    flat.run("document.querySelector('.view').dispatchEvent(new WheelEvent('wheel', {deltaY: 8, cancelable: true}))")
    yaw, pitch, zoom = flat.run(stored)
    assert (yaw, pitch) == (360, 2) and 0.5 <= zoom <= 3
    flat.click(".camera[aria-pressed=true]")
    assert flat.run(stored) == [30, 20, 0.9]
    flat.key("D", "KeyD", 8)
    assert flat.run(stored) != [30, 20, 0.9]
    flat.key("0", "Digit0")
    assert flat.run(stored) == [30, 20, 0.9]
    flat.run("localStorage.clear()")
    assert flat.problems == []


def test_the_buttons_for_music_ask_for_a_file(flat: Browser, page_file: Path) -> None:
    flat.open(page_file)
    flat.run("window.asked = 0; document.querySelector('#music-file')"
             ".addEventListener('click', e => { ++window.asked; e.preventDefault(); })")  # fmt: skip
    assert text(flat, ".pick") == "♪ Choose x.wav"
    flat.click(".pick")
    flat.click("#tab-settings")
    flat.click("#choose-music")
    assert flat.run("window.asked") == 2


def test_lanes_are_panels_for_a_finger(flat: Browser, page_file: Path) -> None:
    flat.open(page_file)
    flat.key("Home")
    flat.key("w", "KeyW")
    flat.key(" ", "Space")
    flat.turn(9)
    assert text(flat, ".message").startswith("waiting")
    x, y, w, h = flat.box(".lanes")
    numbers = 8 + 7 * 2  # room left of the lanes, and a little right of them: as `Highway.measure`
    lane = min(96, (w - numbers - 8) / 4)
    left = x + max(numbers, 0.5 * (w - 4 * lane))
    for column in (3, 0):  # right does nothing, left is the row
        for kind in ("mousePressed", "mouseReleased"):
            flat.mouse(kind, left + (column + 0.5) * lane, y + h / 2)
    flat.turn(9)
    assert float(flat.run(NOW)) == pytest.approx(2.25, abs=0.01)
    assert "1 hit" in text(flat, ".score") and "1 wrong" in text(flat, ".score")
    assert flat.problems == []


def test_the_other_dancer_is_named_with_the_rows_that_differ(flat: Browser, page_file: Path) -> None:
    flat.open(page_file)
    flat.key("2", "Digit2")
    shown = "[...document.querySelectorAll('.caption')].map(e => e.offsetParent !== null)"
    assert text(flat, ".caption.left") == "these feet" and flat.run(shown) == [True, True]
    assert re.search(r"next best feet \(other feet in [1-9]", text(flat, ".caption.right"))
    flat.key("2", "Digit2")
    assert flat.run(shown) == [False, False] and "next best" not in text(flat, ".message")
