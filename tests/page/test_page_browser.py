"""The real page in a real browser."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from page_chromium import Browser
from PIL import Image


@pytest.fixture(autouse=True)
def fresh(browser: Browser, page_file: Path) -> None:
    """The page, opened anew, with nothing stored."""
    browser.size(1280, 720)
    browser.open(page_file)
    browser.run("localStorage.clear()")
    browser.problems.clear()
    browser.open(page_file)


def second(browser: Browser) -> float:
    """The second of the music that the page shows."""
    return float(browser.run(NOW))


NOW = "Number(document.querySelector('.strip').getAttribute('aria-valuenow'))"


def text(browser: Browser, selector: str) -> str:
    """What an element says."""
    return str(browser.run(f"document.querySelector('{selector}').textContent"))


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
