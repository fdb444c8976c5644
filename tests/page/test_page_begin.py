"""How a page begins and how a song ends on it: three ways to begin, the score over the picture, the result."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from page_chromium import NOW, Browser, pad_script, said, text

FLAGS = ("--disable-gpu", "--disable-3d-apis")  # without WebGL: it draws quickly whatever else the machine does


@pytest.fixture(scope="module")
def flat() -> Iterator[Browser]:
    """A browser without WebGL."""
    one = Browser(flags=FLAGS)
    yield one
    one.close()


@pytest.fixture
def opened(flat: Browser, page_file: Path) -> Browser:
    flat.size(1280, 720)
    flat.call("Storage.clearDataForOrigin", origin="file://", storageTypes="local_storage")
    flat.problems.clear()
    flat.open(page_file)
    return flat


def shown(browser: Browser, selector: str) -> bool:
    """Whether an element is to be seen."""
    return bool(browser.run(f"document.querySelector('{selector}').checkVisibility()"))


def step(browser: Browser, button: int) -> None:
    """Press a button of the pad for a picture."""
    browser.run(f"window.pad.buttons[{button}].pressed = true")
    browser.drawn()
    browser.run(f"window.pad.buttons[{button}].pressed = false")
    browser.drawn()


def test_the_first_notes_are_in_sight_and_playing_leaves_time_to_get_ready(opened: Browser) -> None:
    """The first step is at second 2: one second before it the page opens, two before it the clock begins."""
    assert float(opened.run(NOW)) == pytest.approx(1.0, abs=0.01)
    opened.key(" ", "Space")
    opened.turn(0.06 + 0.5)
    assert float(opened.run(NOW)) == pytest.approx(0.5, abs=0.02)
    opened.key(" ", "Space")
    opened.key(" ", "Space")  # only the first time
    opened.turn(0.06 + 0.25)
    assert float(opened.run(NOW)) == pytest.approx(0.75, abs=0.05)


def test_three_ways_to_begin(opened: Browser) -> None:
    opened.key("End")
    opened.click(".way.watch")
    opened.turn(0.06 + 0.5)
    assert float(opened.run(NOW)) == pytest.approx(0.5, abs=0.02) and not shown(opened, ".standing")
    opened.click(".way.step")
    assert said(opened).startswith("0 hit") and shown(opened, ".standing")
    opened.turn(0.06 + 0.5)
    assert float(opened.run(NOW)) == pytest.approx(0.5, abs=0.02)
    opened.click(".way.coached")
    assert "coach: begins at 70 %" in said(opened)
    opened.click(".way.watch")  # no loop and no coach is left of it
    assert "coach" not in said(opened) and "loop" not in said(opened) and text(opened, ".rate-text") == "100 %"
    assert opened.problems == []


def test_a_song_that_is_over_shows_its_result_and_what_to_practise(opened: Browser) -> None:
    opened.run(pad_script())
    opened.click(".way.step")
    opened.turn(0.06 + 2.02)
    step(opened, 0)  # 20 ms late: a hit
    opened.turn(0.32)
    step(opened, 1)  # the second row, 90 ms late
    opened.turn(0.3)
    step(opened, 2)  # no note there
    standing = text(opened, ".standing")
    assert "1 hit" in standing and "1 late" in standing and "1 wrong" in standing
    assert not shown(opened, ".result")
    for _ in range(4):
        opened.turn(30)
    assert shown(opened, ".result") and not shown(opened, ".standing")
    result = text(opened, ".result")
    assert "1 hit" in result and "1 late" in result and "longest run: 2" in result
    assert "a new best" in result
    share = opened.run("Number(/(\\d+) %/.exec(document.querySelector('.result strong').textContent)[1])")
    notes = opened.run(
        "[...document.querySelectorAll('.result .counts b')].slice(0, 4).reduce((n, e) => n + +e.textContent, 0)"
    )
    assert share == round(100 / notes)
    opened.click(".result .group button:last-child")  # what was missed
    assert not shown(opened, ".result") and said(opened).partition(" · ")[2].startswith("loop measure")
    opened.click(".way.step")
    for _ in range(4):
        opened.turn(30)
    assert f"your best: {share} %" in text(opened, ".result")
    opened.click(".result .main")
    assert not shown(opened, ".result") and said(opened).startswith("0 hit") and text(opened, ".play") == "❚❚"
    for _ in range(4):
        opened.turn(30)
    opened.click(".result .shut")
    assert not shown(opened, ".result") and opened.problems == []


def test_the_result_lies_in_the_window_of_a_phone(opened: Browser, page_file: Path) -> None:
    opened.size(380, 740, touch=True)
    opened.open(page_file)
    opened.run(pad_script())
    opened.click(".way.step")
    opened.turn(1)
    step(opened, 0)
    for _ in range(4):
        opened.turn(30)
    x, y, w, h = opened.box(".result")
    assert x >= 0 and y >= 0 and x + w <= 380 and y + h <= 740
    assert opened.run("(e => e.scrollWidth <= e.clientWidth)(document.querySelector('.result'))")
    small = "[...document.querySelectorAll('.result button')].filter(b => b.getBoundingClientRect().height < 44)"
    assert opened.run(f"{small}.length") == 0
