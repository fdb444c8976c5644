"""What lies where: the score, buttons and messages cover neither the dancer nor the pad; nothing is there twice."""

from __future__ import annotations

from pathlib import Path

import pytest
from page_chromium import Browser, message, text


def box(browser: Browser, selector: str) -> list[float]:
    """Left, top, right and bottom as they lie in the window."""
    found: list[float] = browser.run(
        f"(b => [b.left, b.top, b.right, b.bottom])(document.querySelector('{selector}').getBoundingClientRect())"
    )
    return found


def visible(browser: Browser, selector: str) -> bool:
    """Whether there is anything of an element to look at."""
    return bool(
        browser.run(f"(b => b.width > 2 && b.height > 2)(document.querySelector('{selector}').getBoundingClientRect())")
    )


@pytest.mark.parametrize("width", [380, 768])
def test_a_narrow_window_has_the_score_in_a_line_above_the_lanes(opened: Browser, page_file: Path, width: int) -> None:
    opened.size(width, 800, touch=True)
    opened.open(page_file)
    assert not visible(opened, ".slim")
    opened.click(".way.step")
    opened.turn(0.06 + 3.95)
    assert text(opened, ".slim") == "0 %· 8 miss" and visible(opened, ".slim")
    line, lanes, picture = (box(opened, one) for one in (".slim", ".lanes", ".picture"))
    assert line[3] <= lanes[1] and line[0] >= picture[2] and not visible(opened, ".scores")
    assert lanes[3] <= box(opened, ".notes")[3] + 1
    opened.open(page_file, "#m1-1")
    opened.key("p", "KeyP")
    opened.key(" ", "Space")
    for _ in range(6):
        opened.turn(0.5)
    opened.key("d", "KeyD")  # somebody plays
    while not text(opened, ".passed"):
        opened.turn(0.3)
    assert text(opened, ".slim") == text(opened, ".passed") and opened.problems == []


def test_the_score_of_a_loop_is_drawn_above_the_receptors(opened: Browser, page_file: Path) -> None:
    opened.open(page_file, "#m1-1")
    opened.key("p", "KeyP")
    opened.key(" ", "Space")
    for _ in range(6):
        opened.turn(0.5)
    opened.key("d", "KeyD")
    opened.run(
        "window.words = []; const fill = CanvasRenderingContext2D.prototype.fillText;"
        "CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {"
        " window.words.push([text, y]); fill.call(this, text, x, y); };"
    )
    while not text(opened, ".passed"):
        opened.turn(0.3)
    assert text(opened, ".passed").startswith("score ")
    drawn = opened.run(f"window.words.filter(([text]) => text === '{text(opened, '.passed')}')")
    assert drawn and all(0 < y < 80 for _, y in drawn) and not visible(opened, ".passed")
    assert not visible(opened, ".slim") and opened.problems == []


def test_a_phones_messages_take_no_room_when_there_are_none(opened: Browser, page_file: Path) -> None:
    opened.size(380, 800, touch=True)
    opened.open(page_file)
    opened.click(".way.step")
    top = box(opened, ".picture")[1]
    assert message(opened) == "" and top <= box(opened, "header")[3] + 1
    opened.click(".play")
    opened.key("d", "KeyD")
    assert message(opened).startswith("Paused") and box(opened, ".message")[1] >= box(opened, "header")[3]
    assert box(opened, ".picture")[1] == top  # it lies on the picture for a moment
    opened.open(page_file, "#m1-2")
    assert message(opened).startswith("loop") and box(opened, ".message")[3] <= box(opened, ".picture")[1]
    assert opened.problems == []


def test_one_foot_only_is_said_below_the_picture_of_a_phone(opened: Browser, page_file: Path) -> None:
    opened.size(380, 800, touch=True)
    opened.open(page_file)
    opened.key("t", "KeyT")
    for play in (False, True):
        if play:
            opened.click(".play")
        chip, picture = box(opened, "#chip-foot"), box(opened, ".picture")
        assert chip[1] >= picture[3] and chip[3] - chip[1] < 46  # in one line
    assert opened.problems == []


def test_nothing_is_there_twice(opened: Browser) -> None:
    buttons = opened.run(
        "[...document.querySelectorAll('.side button')]"
        ".map(b => b.querySelector('strong')?.textContent ?? b.textContent)"
    )
    assert [buttons.count(name) for name in ("Watch", "Play along", "Wait for me", "Coach")] == [1] * 4
    marked = opened.run(
        "[...document.querySelectorAll('.card .tags')].map(e => e.querySelectorAll('span:not(.rest)').length)"
    )
    assert marked and max(marked) == 2 and opened.problems == []


def test_findings_say_what_they_mean_before_the_names_of_rules(opened: Browser) -> None:
    opened.click("#tab-findings")
    one = ".finding button"
    assert text(opened, f"{one} strong").lower().endswith("a note that never counts.")
    assert text(opened, f"{one} .figure").endswith("hidden note\u00a0·\u00a0DT402")  # no line of the rule alone
    assert opened.run(f"document.querySelector('{one}').title").startswith("DT402 hidden note: ")
    assert opened.problems == []
