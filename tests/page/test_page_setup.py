"""Setting up to play along: what a press says that nothing judges, lists of keys and buttons, one foot only."""

from __future__ import annotations

from pathlib import Path

from page_chromium import Browser, pad_script, said, text

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
        assert said(opened) == "Nothing you press or step on is judged yet: choose Play along (p)."
        opened.turn(6)
        assert not said(opened).startswith("Nothing") and not shown(opened, "#chip-along")
    opened.key("k", "KeyK")
    opened.click("#chip-along")
    assert not said(opened).startswith("Nothing") and not shown(opened, "#chip-along")
    assert shown(opened, ".standing") and opened.problems == []


def test_an_arrow_key_that_may_be_meant_as_a_panel_is_told_once(opened: Browser) -> None:
    opened.key("ArrowLeft")
    assert not said(opened).startswith("Nothing")
    opened.key(" ", "Space")
    opened.key("ArrowUp")
    assert said(opened).startswith("Nothing") and text(opened, ".rate-text") == "105 %"
    opened.turn(6)
    opened.key("ArrowLeft")
    assert not said(opened).startswith("Nothing") and text(opened, ".play") == "▶" and opened.problems == []


def test_a_finger_on_the_lanes_of_a_song_that_plays_does_not_stop_it(opened: Browser, page_file: Path) -> None:
    opened.size(380, 740, touch=True)
    opened.open(page_file)
    opened.click(".play")
    x, y, w, h = opened.box(".lanes")
    for kind, points in (("touchStart", [{"x": x + w / 2, "y": y + h / 2}]), ("touchEnd", [])):
        opened.call("Input.dispatchTouchEvent", type=kind, touchPoints=points)
    opened.drawn()
    assert said(opened) == "Nothing you press or step on is judged yet: choose Play along."  # there is no key p
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
    assert said(opened) == "That key is not a panel. The panels are D F J K, or ← ↓ ↑ →."
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
    opened.open(page_file)  # the next song, the next day
    assert shown(opened, "#chip-foot")
    opened.click("#chip-foot")
    assert not shown(opened, "#chip-foot") and opened.run("document.querySelector('#foot').value") == "both"
    assert opened.run(f"{STORED}.foot") == "both" and opened.problems == []


def test_a_phone_ends_a_loop_on_the_picture(opened: Browser, page_file: Path) -> None:
    opened.open(page_file, "#m1-2")
    assert not shown(opened, "#chip-loop") and shown(opened, ".bar [title^=No]")  # the bar has it
    opened.size(380, 740, touch=True)
    opened.open(page_file, "#m1-2")
    assert shown(opened, "#chip-loop") and not shown(opened, ".bar [title^=No]")
    opened.click("#chip-loop")
    assert not shown(opened, "#chip-loop") and "loop" not in said(opened) and opened.problems == []


def test_the_rules_of_judging_are_folded(opened: Browser) -> None:
    opened.click("#tab-along")
    assert text(opened, "#tab-along") == "Setup" and text(opened, "#panel-along summary") == "How it is judged"
    assert not shown(opened, "#panel-along details p")
    opened.click("#panel-along summary")
    assert shown(opened, "#panel-along details p") and "at most 45 ms" in text(opened, "#panel-along details p")
