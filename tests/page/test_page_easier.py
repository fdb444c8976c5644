"""What the page offers to whoever plays along and fails: a word while it stands, an easier way, the coach anywhere."""

from __future__ import annotations

from pathlib import Path

from page_chromium import NOW, Browser, message, text


def shown(browser: Browser, selector: str) -> bool:
    """Whether an element is to be seen."""
    return bool(browser.run(f"document.querySelector('{selector}').checkVisibility()"))


def test_a_panel_that_is_pressed_while_nothing_plays_says_what_begins(opened: Browser, page_file: Path) -> None:
    for way in (".way.step", ".way.waits"):
        opened.click(way)
        opened.key(" ", "Space")
        assert text(opened, ".play") == "▶" and not message(opened).startswith("Paused")
        opened.key("d", "KeyD")
        assert message(opened) == "Paused: press ▶ (space)." and not shown(opened, "#chip-along")
        opened.turn(6)
        assert message(opened) == ""
        opened.key("d", "KeyD")
        opened.key(" ", "Space")
        assert not message(opened).startswith("Paused") and text(opened, ".play") == "❚❚"
    opened.size(380, 740, touch=True)
    opened.open(page_file)
    opened.click(".way.step")
    opened.click(".play")
    x, y, w, h = opened.box(".lanes")
    for kind, points in (("touchStart", [{"x": x + w / 2, "y": y + h / 2}]), ("touchEnd", [])):
        opened.call("Input.dispatchTouchEvent", type=kind, touchPoints=points)
    opened.drawn()
    assert message(opened) == "Paused: press ▶." and opened.problems == []


def test_ten_misses_in_a_row_offer_an_easier_way(opened: Browser) -> None:
    opened.click(".way.step")
    opened.turn(0.06 + 3.95)  # eight rows of the first measure
    assert not shown(opened, "#chip-slow") and not shown(opened, "#chip-wait")
    opened.turn(0.4)  # and a jump: two notes more
    assert text(opened, "#chip-slow") == "Slower: 70 %" and text(opened, "#chip-wait") == "Wait for me"
    opened.click("#chip-slow")
    assert text(opened, ".rate-text") == "70 %" and text(opened, ".play") == "❚❚"
    assert not shown(opened, "#chip-slow") and not shown(opened, "#chip-wait")
    opened.click(".way.step")
    opened.turn(0.06 + 7.0 / 0.7)
    assert not shown(opened, "#chip-slow") and shown(opened, "#chip-wait")  # no slower than that is offered
    opened.click("#chip-wait")
    opened.turn(60)
    assert message(opened).startswith("waiting for you") and not shown(opened, "#chip-wait") and opened.problems == []


def test_the_coach_takes_the_loop_that_there_is(opened: Browser, page_file: Path) -> None:
    opened.open(page_file, "#m2-3")
    opened.key("w", "KeyW")
    opened.key("c", "KeyC")
    assert message(opened) == "coach: not passed yet, begins at 70 % speed · loop measures 2 to 3, 0 done"
    assert text(opened, ".rate-text") == "70 %" and shown(opened, ".standing")
    opened.turn(0.06 + 20)  # and nothing waits
    assert not message(opened).startswith("waiting") and opened.problems == []


def test_one_foot_that_is_waited_for_in_a_loop(opened: Browser, page_file: Path) -> None:
    opened.open(page_file, "#m1-2")
    opened.key("t", "KeyT")  # the left foot only
    opened.click(".way.waits")
    for key, second in (("d", 2.0), ("k", 3.0), ("d", 4.0)):
        opened.turn(0.06 + 20)
        assert float(opened.run(NOW)) >= 2.0 and message(opened).startswith("waiting for you"), (key, second)
        for each in "dfjk":
            opened.key(each, f"Key{each.upper()}")
    for _ in range(20):  # from pass to pass
        opened.turn(0.5)
        for each in "dfjk":
            opened.key(each, f"Key{each.upper()}")
    assert "loop measures 1 to 2" in message(opened) or message(opened).startswith("waiting")
    opened.click("#chip-foot")
    assert text(opened, ".play") == "❚❚" and opened.problems == []
