"""The page where WebGL is missing, which draws quickly whatever else the machine does."""

from __future__ import annotations

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
        flat.key("ArrowRight")
    flat.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))")
    x, y, w, h = (int(v) for v in flat.box(".view"))
    pixels = np.asarray(Image.open(flat.picture(tmp_path / "a.png")).convert("RGB")).astype(int)
    view = pixels[y : y + h, x : x + w]
    for colour in ((255, 138, 31), (22, 194, 207)):
        assert (np.abs(view - np.array(colour)).max(axis=2) <= 30).mean() > 0.002


def test_presses_are_timed_and_misses_counted(flat: Browser, page_file: Path) -> None:
    flat.open(page_file)
    flat.run(pad_script())
    flat.run("location.hash = '#m0.5-1.5@0.25'")
    flat.wait("document.querySelector('.said').textContent.includes('m0.5')")
    flat.key("i", "KeyI")
    flat.key("p", "KeyP")
    flat.key(" ", "Space")
    flat.run(  # the mat says when it was pressed, however slowly pictures come
        "new Promise(done => { const press = () => { window.pad.buttons[0].pressed = true;"
        " window.pad.timestamp = performance.now(); done(1); };"
        "const look = () => " + NOW + " < 1.8 ? requestAnimationFrame(look)"
        " : setTimeout(press, (2 - " + NOW + ") / 0.25 * 1000); requestAnimationFrame(look); })"
    )
    flat.wait("/ [1-9]\\d* missed/.test(document.querySelector('.score').textContent)")
    counts = [int(word) for word in text(flat, ".score").split() if word.isdigit()]
    assert sum(counts[:3]) == 1 and counts[3] >= 1, text(flat, ".score")


def test_lanes_are_panels_for_a_finger(flat: Browser, page_file: Path) -> None:
    flat.open(page_file)
    flat.key("Home")
    flat.key("w", "KeyW")
    flat.key(" ", "Space")
    flat.wait("document.querySelector('.said').textContent.startsWith('waiting')")
    x, y, w, h = flat.box(".lanes")
    lane = min(72, (w - 2 * min(46, 0.14 * w)) / 4)
    left = x + 0.28 * (w - 4 * lane)
    for column in (3, 0):  # right does nothing, left is the row
        before = float(flat.run(NOW))
        for kind in ("mousePressed", "mouseReleased"):
            flat.mouse(kind, left + (column + 0.5) * lane, y + h / 2)
    flat.wait(f"{NOW} > {before} + 0.2")
    assert "1 hit" in text(flat, ".score")
    assert flat.problems == []


def test_the_other_dancer_is_named_with_the_rows_that_differ(flat: Browser, page_file: Path) -> None:
    flat.open(page_file)
    flat.key("2", "Digit2")
    flat.wait("/next best feet \\(other feet in [1-9]/.test(document.querySelector('.said').textContent)")
    flat.key("2", "Digit2")
    flat.wait("!document.querySelector('.said').textContent.includes('next best')")
