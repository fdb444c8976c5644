"""The real page on screens of all sizes: nothing is cut off or jumps about, and it can be used by keys and readers."""

from __future__ import annotations

from pathlib import Path

import pytest
from page_chromium import Browser, message, text

pytestmark = pytest.mark.usefixtures("fresh")


def test_the_first_tab_is_marked(browser: Browser) -> None:
    marked = "[...document.querySelectorAll('[role=tab]')].map(e => [e.id, getComputedStyle(e).borderBottomColor])"
    found = dict(browser.run(marked))
    assert found.pop("tab-passages") not in found.values() and len(set(found.values())) == 1


def boxes(browser: Browser, *selectors: str) -> list[tuple[float, float, float, float]]:
    """Left, top, right and bottom of elements as they lie in the window."""
    found = browser.run(
        f"{list(selectors)}.map(s => (b => [b.left, b.top, b.right, b.bottom])"
        "(document.querySelector(s).getBoundingClientRect()))"
    )
    return [(a, b, c, d) for a, b, c, d in found]


def test_a_phone_shows_all_of_it_without_scrolling(browser: Browser, page_file: Path) -> None:
    """Picture, notes, score and controls at once; nothing lies over another, all that is tapped is large enough."""
    browser.size(380, 740, touch=True)
    browser.open(page_file)
    root = "document.documentElement"
    assert browser.run(f"[{root}.scrollWidth <= 380, {root}.scrollHeight <= 740]") == [True, True]
    stage, strip, where, play = boxes(browser, ".picture", ".strip", ".where", ".play")
    assert stage[3] - stage[1] > 300
    assert where[1] >= strip[3] and where[0] >= play[2]  # the clock is beside the button, below the strip
    for _ in range(2):
        browser.key(".", "Period")  # between two beats, the longest text of it
    where, more = boxes(browser, ".where", ".more")
    assert text(browser, ".where").startswith("m1 · beat 4.5") and where[2] <= more[0]
    assert browser.run("(e => e.scrollWidth <= e.clientWidth)(document.querySelector('.place'))")
    buttons = "[...document.querySelectorAll('button, select')].filter(b => b.offsetParent)"
    assert browser.run(f"{buttons}.filter(b => b.getBoundingClientRect().height < 44).map(b => b.textContent)") == []
    browser.click(".card")  # loops a passage, where the picture is in sight
    higher = boxes(browser, ".picture")[0]  # the panel is folded away: who plays looks at the picture
    assert higher[3] > stage[3] + 150 and message(browser).startswith("loop measure")
    browser.key("p", "KeyP")
    ((left, top, right, bottom),) = boxes(browser, ".message")  # above the picture, whole, and clear of her
    lane = browser.run("document.querySelector('.lanes').clientWidth") - 22  # the numbers of measures are left of them
    assert lane / 4 >= 44  # wide enough for fingers
    assert (
        message(browser).startswith("loop measure") and left >= 0 and top >= 0 and bottom <= stage[1] and right <= 380
    )
    assert browser.run("(e => e.scrollHeight <= e.clientHeight + 1)(document.querySelector('.message'))")
    browser.click(".more")  # all controls, and still a picture
    assert boxes(browser, ".picture")[0][3] - stage[1] > 200
    browser.click("#tab-findings")  # a tab that is tapped closes them and opens
    assert (
        browser.run("!document.querySelector('.bar.open') && document.querySelector('.more').ariaExpanded") == "false"
    )
    assert browser.run("document.querySelector('#panel-findings').offsetParent !== null")
    browser.click(".more")
    assert browser.run(f"{root}.scrollHeight <= 740 && document.querySelector('.rate').offsetParent !== null")
    browser.click(".more")
    browser.click("#tab-findings")  # the open tab folds its panel away, and the lanes become wider for fingers
    folded, lanes = boxes(browser, ".picture", ".lanes")
    assert folded[3] > stage[3] + 150 and (lanes[2] - lanes[0] - 22) / 4 >= 44
    browser.key("?", "Slash", 8)
    assert text(browser, "dialog.sheet h3 + p").startswith("Tap ▶")
    assert browser.problems == []


def test_while_one_plays_the_ways_are_one_row(browser: Browser, page_file: Path) -> None:
    browser.size(1280, 800)
    browser.open(page_file)
    browser.click(".way.step")
    browser.drawn()
    assert browser.run("new Set([...document.querySelectorAll('.way')].map(e => e.offsetTop)).size") == 1
    assert browser.run(
        "[...document.querySelectorAll('.way strong')].every(e => e.scrollWidth <= e.parentElement.clientWidth)"
    )


def test_a_phone_that_lies_across_gives_the_lanes_the_panels_width(browser: Browser, page_file: Path) -> None:
    browser.size(740, 380, touch=True)
    browser.open(page_file)
    before, panel = boxes(browser, ".lanes", ".side")
    assert panel[2] - panel[0] >= 200
    browser.key("p", "KeyP")
    browser.click(".way.step")
    browser.drawn()
    lanes, tab = boxes(browser, ".lanes", ".side.folded [role=tab][aria-selected=true]")
    assert (lanes[2] - lanes[0] - 22) / 8 >= 40 > (before[2] - before[0] - 22) / 8
    assert tab[2] - tab[0] >= 44 and tab[3] - tab[1] >= 44 and tab[2] <= 740
    browser.click(".side.folded [aria-selected=true]")
    assert browser.run("document.querySelector('.side.folded') === null")
    browser.click(".tabs [aria-selected=true]")  # the open tab folds it away again
    assert browser.run("document.querySelector('.side.folded') !== null")
    assert browser.run("document.documentElement.scrollWidth <= 740") and browser.problems == []


def test_nothing_moves_while_it_plays(browser: Browser) -> None:
    browser.run(
        "window.shift = 0;"
        "new PerformanceObserver(list => { for (const e of list.getEntries()) window.shift += e.value; })"
        ".observe({type: 'layout-shift', buffered: true})"
    )
    browser.key("]", "BracketRight")
    browser.key(" ", "Space")
    for _ in range(5):
        browser.turn(0.2)
    for key in ("+", "m", "v", "v", "g"):
        browser.key(key)
    assert browser.run("window.shift") < 0.02
    assert browser.problems == []


def test_axe_finds_nothing_serious(browser: Browser) -> None:
    source = Path(__file__).parent / "node_modules" / "axe-core" / "axe.min.js"
    if not source.exists():
        pytest.skip("no axe here; `make page-tools` puts it into tests/page/node_modules")
    browser.run(source.read_text("utf-8") + "; 1")
    states = [("", tab) for tab in ("passages", "along", "results", "findings", "author", "settings")]
    browser.key(".", "Period")
    browser.key("o", "KeyO")  # the tab of feet is there once a note is chosen
    for key, tab in [*states, ("p", "passages"), (" ", "results")]:  # while somebody plays along, and with the result
        browser.click(f"#tab-{tab}")
        if key:
            browser.key(key)
        if key == " ":
            for _ in range(4):
                browser.turn(30)
            assert browser.run("!document.querySelector('.result').hidden")
        found = browser.run(
            "axe.run(document, {resultTypes: ['violations']}).then(r => r.violations"
            ".filter(v => ['serious', 'critical'].includes(v.impact)).map(v => v.id + ' ' + v.nodes[0].html))"
        )
        assert found == [], tab
