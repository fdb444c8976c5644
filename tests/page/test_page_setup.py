"""Setting up to play along: what a press says that nothing judges, lists of keys and buttons, one foot only."""

from __future__ import annotations

from pathlib import Path

import pytest
from page_chromium import NOW, Browser, message, pad_script, text

KEYS = "[...document.querySelectorAll('.keys > span')].map(e => [...e.querySelectorAll('kbd')].map(k => k.textContent))"
STORED = "JSON.parse(localStorage.dancetutor ?? '{}')"


def shown(browser: Browser, selector: str) -> bool:
    """Whether an element is to be seen."""
    return bool(browser.run(f"document.querySelector('{selector}').checkVisibility()"))


def test_a_panels_key_that_nothing_judges_is_reported(opened: Browser) -> None:
    for before in ("", " "):  # while the song is paused, and while it plays
        if before:
            opened.key(before, "Space")
        opened.key("d", "KeyD")
        assert message(opened) == "Nothing you press or step on is judged yet: choose Play along (p)."
        opened.turn(6)
        assert not message(opened).startswith("Nothing") and not shown(opened, "#chip-along")
    opened.key("k", "KeyK")
    opened.click("#chip-along")
    assert not message(opened).startswith("Nothing") and not shown(opened, "#chip-along")
    assert shown(opened, ".standing") and opened.problems == []


def test_arrow_keys_that_are_panels_do_nothing_else(opened: Browser) -> None:
    """While one watches they say what they are, playing or paused: no seek, no pause, no other speed."""
    for before in ("", " "):
        if before:
            opened.key(before, "Space")
        state = [text(opened, ".play"), text(opened, ".rate-text"), opened.run(NOW)]
        for arrow in ("ArrowLeft", "ArrowUp", "ArrowRight", "ArrowDown"):
            opened.key(arrow)
            assert message(opened).startswith("Nothing") and shown(opened, "#chip-along")
            assert [text(opened, ".play"), text(opened, ".rate-text"), opened.run(NOW)] == state
        opened.turn(6)
    opened.key("-", "Minus")
    assert text(opened, ".rate-text") == "95 %"
    x, y, w, h = opened.box(".strip")
    for kind in ("mousePressed", "mouseReleased"):
        opened.mouse(kind, x + w / 2, y + h / 2)
    opened.drawn()
    at = opened.run(NOW)
    opened.key("ArrowUp")  # a click on the strip leaves the keys as they are
    opened.key("ArrowLeft")
    assert text(opened, ".play") == "❚❚" and opened.run(NOW) == at and message(opened).startswith("Nothing")
    opened.run("document.querySelector('.strip').focus()")  # who comes with Tab has a slider
    opened.key("ArrowLeft")
    assert text(opened, ".play") == "▶" and opened.problems == []


def test_the_speed_is_the_same_after_a_reload(opened: Browser) -> None:
    for _ in range(3):
        opened.key("-", "Minus")
    opened.call("Page.reload")
    opened.wait("document.documentElement?.dataset.ready")
    opened.wait("document.querySelector('.rate-text')?.textContent === '85 %'")
    assert opened.problems == []


def test_a_finger_on_the_lanes_of_a_song_that_plays_does_not_stop_it(opened: Browser, page_file: Path) -> None:
    opened.size(380, 740, touch=True)
    opened.open(page_file)
    opened.click(".play")
    x, y, w, h = opened.box(".lanes")
    for kind, points in (("touchStart", [{"x": x + w / 2, "y": y + h / 2}]), ("touchEnd", [])):
        opened.call("Input.dispatchTouchEvent", type=kind, touchPoints=points)
    opened.drawn()
    assert message(opened) == "Nothing you press or step on is judged yet: choose Play along."  # there is no key p
    assert text(opened, ".play") == "❚❚" and shown(opened, "#chip-along") and opened.problems == []


def test_keys_and_the_buttons_of_a_mat_are_listed_side_by_side(opened: Browser) -> None:
    opened.click("#tab-along")
    assert opened.run(KEYS) == [["D", "←"], ["F", "↓"], ["J", "↑"], ["K", "→"]]
    opened.run(pad_script() + "window.dispatchEvent(new Event('gamepadconnected'))")
    opened.run("window.pad.buttons[2].pressed = true")
    opened.drawn()
    both = [["D", "←", "B0", "A0−"], ["F", "↓", "B1", "A1+"], ["J", "↑", "B2", "A1−"], ["K", "→", "B3", "A0+"]]
    assert opened.run(KEYS) == both
    opened.key("p", "KeyP")
    opened.key("q", "KeyQ")
    assert message(opened) == "That key is not a panel. The panels are D F J K, or ← ↓ ↑ →."
    assert opened.problems == []


def test_the_dialog_of_keys_can_be_cancelled_and_has_defaults(opened: Browser, page_file: Path) -> None:
    opened.run(pad_script() + "window.dispatchEvent(new Event('gamepadconnected'))")
    opened.click("#tab-along")
    before = opened.run(KEYS)
    for way in ("#assign-cancel", "Escape"):
        opened.click("#assign")
        opened.key("q", "KeyQ")
        opened.run("window.pad.buttons[7].pressed = true")
        opened.drawn()
        opened.run("window.pad.buttons[7].pressed = false")
        opened.drawn()
        if way == "Escape":
            opened.key(way)
        else:
            opened.click(way)
        assert opened.run("document.querySelector('dialog.assign')") is None
        assert opened.run(KEYS) == before
        assert opened.run(f"{STORED}.keys") == {} and opened.run(f"{STORED}.pads") == {}
    opened.click("#assign")
    for key in "qwer":
        opened.key(key, f"Key{key.upper()}")
    assert [names[0] for names in opened.run(KEYS)] == list("QWER")
    opened.open(page_file)
    opened.click("#tab-along")
    assert [names[0] for names in opened.run(KEYS)] == list("QWER")
    opened.click("#assign")
    opened.click("#assign-defaults")
    assert [names[0] for names in opened.run(KEYS)] == list("DFJK")
    assert opened.run(f"{STORED}.keys") == {} and opened.problems == []


def test_one_foot_only_is_said_on_the_picture_and_can_be_ended_there(opened: Browser, page_file: Path) -> None:
    assert not shown(opened, "#chip-foot")
    opened.key("t", "KeyT")
    assert text(opened, "#chip-foot") == "left only ✕"
    opened.open(page_file)  # the same song, the next day
    assert shown(opened, "#chip-foot")
    assert not opened.run(f"'foot' in {STORED}")  # what holds in every song
    opened.click("#chip-foot")
    assert not shown(opened, "#chip-foot") and opened.run("document.querySelector('#foot').value") == "both"
    opened.open(page_file)
    assert not shown(opened, "#chip-foot") and opened.problems == []


@pytest.mark.parametrize(("width", "height"), [(380, 740), (768, 1024)])
def test_a_phone_offers_ways_to_begin_below_the_picture(
    opened: Browser, page_file: Path, width: int, height: int
) -> None:
    """In one row, where the panel with the tiles is folded away: of a loop from its start."""
    opened.size(width, height, touch=True)
    opened.open(page_file)
    assert not shown(opened, "#chip-along")  # the tiles are there
    opened.click(".card")
    opened.turn(3)
    rows = "[...document.querySelectorAll('.chip')].filter(e => e.checkVisibility()).map(e => [e.id, e.offsetTop])"
    found = opened.run(rows)
    assert [name for name, _ in found] == ["chip-along", "chip-wait", "chip-loop"]
    assert len({top for _, top in found}) == 1
    chip, picture = opened.box("#chip-along"), opened.box(".picture")
    assert chip[1] >= picture[1] + picture[3] and opened.box(".lanes")[2] >= 0.5 * width
    opened.click("#chip-along")
    opened.turn(0.06)
    assert text(opened, ".play") == "❚❚" and float(opened.run(NOW)) < 1
    assert opened.run("document.querySelector('.along') !== null")
    opened.click("#chip-wait")
    opened.turn(9)
    assert message(opened).startswith("waiting for you")
    opened.click("#chip-along")  # and on
    assert not message(opened).startswith("waiting for you") and opened.problems == []


def test_a_phone_ends_a_loop_on_the_picture(opened: Browser, page_file: Path) -> None:
    opened.open(page_file, "#m1-2")
    assert not shown(opened, "#chip-loop") and shown(opened, ".bar [title^=No]")  # the bar has it
    opened.size(380, 740, touch=True)
    opened.open(page_file, "#m1-2")
    assert shown(opened, "#chip-loop") and not shown(opened, ".bar [title^=No]")
    opened.click("#chip-loop")
    assert not shown(opened, "#chip-loop") and "loop" not in message(opened) and opened.problems == []


def test_the_rules_of_judging_are_folded(opened: Browser) -> None:
    opened.click("#tab-along")
    assert text(opened, "#tab-along") == "Setup" and text(opened, "#panel-along summary") == "How it is judged"
    assert not shown(opened, "#panel-along details p")
    opened.click("#panel-along summary")
    assert shown(opened, "#panel-along details p") and "within ±45 ms" in text(opened, "#panel-along details p")


def test_a_thumb_that_scrolls_the_settings_changes_none(opened: Browser, page_file: Path) -> None:
    opened.size(380, 740, touch=True)
    opened.open(page_file)
    opened.click("#tab-settings")
    x, y, w, h = opened.box("#leadBeats")
    before = opened.run("document.querySelector('#leadBeats').value")
    points = [[{"x": x + 0.8 * w, "y": y + h / 2 - 12 * k}] for k in range(8)]
    for kind, where in [("touchStart", points[0]), *(("touchMove", one) for one in points[1:]), ("touchEnd", [])]:
        opened.call("Input.dispatchTouchEvent", type=kind, touchPoints=where)
    opened.drawn()
    assert opened.run("document.querySelector('#leadBeats').value") == before and opened.problems == []


def test_a_phone_shows_another_speed(opened: Browser, page_file: Path) -> None:
    opened.size(740, 380, touch=True)
    opened.open(page_file)
    assert text(opened, ".more") == "⋯"
    opened.key("-", "Minus")
    assert text(opened, ".more") == "95 % ⋯" and opened.problems == []


@pytest.mark.parametrize("language", ["", "de"])
def test_a_phone_that_lies_across_shows_feet_tabs_and_pills(opened: Browser, page_file: Path, language: str) -> None:
    """Pills stand in the bar, clear of the dancer and of the clock; each tab can be tapped, the settings too."""
    opened.size(740, 380, touch=True)
    opened.open(page_file)
    if language:
        opened.run(f"document.querySelector('#language').value = '{language}'")
        opened.run("document.querySelector('#language').dispatchEvent(new Event('change'))")
    tabs = "[...document.querySelectorAll('[role=tab]')].filter(e => e.checkVisibility())"
    inside = "b.left >= 0 && b.right <= innerWidth && b.width >= 44 && b.height >= 44"
    assert opened.run(f"{tabs}.map(e => e.getBoundingClientRect()).every(b => {inside})")
    opened.click(".card")
    opened.drawn()
    picture, clock = opened.box(".picture"), opened.box(".where span:last-child")
    for pill in ("#chip-along", "#chip-wait", "#chip-loop"):
        x, y, w, h = opened.box(pill)
        assert y >= picture[1] + picture[3] and x >= clock[0] + clock[2] and x + w <= 740 and h >= 44
    assert opened.problems == []
