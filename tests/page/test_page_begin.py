"""How a page begins and how a song ends on it: three ways to begin, the score over the picture, the result."""

from __future__ import annotations

import io
import wave
from pathlib import Path

import pytest
from page_chromium import NOW, Browser, message, pad_script, text


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
    """The first step is at second 2: half a second before it the page opens, two before it the clock begins."""
    assert float(opened.run(NOW)) == pytest.approx(1.5, abs=0.01)
    opened.key(" ", "Space")
    opened.turn(0.06 + 0.5)
    assert float(opened.run(NOW)) == pytest.approx(0.5, abs=0.02)
    opened.key(" ", "Space")
    opened.key(" ", "Space")  # only the first time
    opened.turn(0.06 + 0.25)
    assert float(opened.run(NOW)) == pytest.approx(0.75, abs=0.05)


def test_four_ways_to_begin(opened: Browser) -> None:
    opened.key("End")
    opened.click(".way.watch")
    opened.turn(0.06 + 0.5)
    assert float(opened.run(NOW)) == pytest.approx(0.5, abs=0.02) and not shown(opened, ".standing")
    opened.click(".way.step")
    assert shown(opened, ".standing")
    opened.turn(0.06 + 0.5)
    assert float(opened.run(NOW)) == pytest.approx(0.5, abs=0.02)
    opened.click(".way.waits")
    opened.turn(0.06 + 30)  # the first row waits for whoever plays
    assert float(opened.run(NOW)) == pytest.approx(2.0, abs=0.02) and message(opened).startswith("waiting for you")
    assert pressed(opened) == "waits" and shown(opened, ".standing")
    opened.click(".way.step")
    opened.turn(0.06 + 2.5)
    assert pressed(opened) == "step" and float(opened.run(NOW)) == pytest.approx(2.5, abs=0.02)  # nothing waits
    opened.click(".way.coached")
    assert "coach: not passed yet, begins at 70 %" in message(opened)
    opened.click(".way.watch")  # no loop and no coach is left of it
    assert "coach" not in message(opened) and "loop" not in message(opened) and text(opened, ".rate-text") == "100 %"
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
    assert "your best score" in result and "a new best score" not in result  # below 50 %, and none before it
    share = opened.run("Number(/(\\d+) %/.exec(document.querySelector('.result strong').textContent)[1])")
    notes = counted(opened)
    assert share == round(150 / (notes + 1))  # a hit, and half for the late one; the wrong press counts as a note
    assert f"of the notes: {round(200 / notes)} % pressed, {round(100 / notes)} % on time" in result
    parts = opened.run("[...document.querySelectorAll('.result .parts span')].map(e => +e.style.flexGrow)")
    assert parts == [1, 0, 1, notes - 2, 1]  # what the score is a share of: the wrong press too
    assert opened.run("document.querySelectorAll('.result .timing > *').length") == 19
    assert (
        "left foot: 1 press, on average 20 ms late" in result and "right foot: 1 press, on average 90 ms late" in result
    )
    assert opened.run("document.querySelector('.result .main').id") == "again-missed"  # so many were missed
    opened.click("#again-missed")
    assert not shown(opened, ".result") and message(opened).startswith("coach: ") and "loop measure" in message(opened)
    opened.key("x", "KeyX")  # no loop: it would be kept
    opened.click(".way.step")
    for _ in range(4):
        opened.turn(30)
    assert f"your best score: {share} %" in text(opened, ".result")
    opened.click("#again-play")
    assert not shown(opened, ".result") and shown(opened, ".standing") and text(opened, ".play") == "❚❚"
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


def pressed(browser: Browser) -> str:
    """The tile of the mode that is on."""
    return str(browser.run("document.querySelector('.way[aria-pressed=true]').className")).removeprefix("way ")


def test_playing_along_stays_in_the_loop_and_its_tile_is_marked(opened: Browser) -> None:
    assert pressed(opened) == "watch"
    opened.run("location.hash = '#m2-3'")
    opened.wait("document.querySelector('.message').textContent.includes('loop')")
    opened.click(".way.step")
    opened.turn(0.06 + 0.5)  # in the count-in of the loop, four beats before second 4
    assert pressed(opened) == "step" and message(opened).startswith("loop measures 2 to 3")
    assert float(opened.run(NOW)) == pytest.approx(2.5, abs=0.02)
    opened.click(".way.coached")
    assert pressed(opened) == "coached"
    opened.click(".way.watch")
    assert pressed(opened) == "watch" and "loop" not in message(opened) and opened.problems == []


def test_a_mat_plays_pauses_goes_back_and_plays_again(opened: Browser) -> None:
    opened.run(pad_script())
    opened.drawn()
    step(opened, 9)  # who stands on a mat means to play along
    opened.turn(0.06 + 0.5)
    assert pressed(opened) == "step" and float(opened.run(NOW)) == pytest.approx(0.5, abs=0.02)
    step(opened, 9)
    opened.turn(1)
    assert text(opened, ".play") == "▶" and float(opened.run(NOW)) == pytest.approx(0.5, abs=0.02)
    opened.run("location.hash = '#m2-3'")
    opened.wait("document.querySelector('.message').textContent.includes('loop')")
    step(opened, 9)
    opened.turn(0.06 + 3)
    assert float(opened.run(NOW)) == pytest.approx(5, abs=0.05)
    step(opened, 8)
    opened.turn(0.06 + 0.5)
    assert float(opened.run(NOW)) == pytest.approx(2.5, abs=0.05) and text(opened, ".play") == "❚❚"
    opened.key("x", "KeyX")
    for _ in range(4):
        opened.turn(30)
    assert shown(opened, ".result")
    step(opened, 9)
    assert not shown(opened, ".result") and text(opened, ".play") == "❚❚" and opened.problems == []


def test_a_part_that_was_played_says_so(opened: Browser) -> None:
    opened.run(pad_script())
    opened.key("p", "KeyP")
    opened.key("End")
    opened.key(" ", "Space")
    for _ in range(4):
        opened.turn(30)
    assert "1 note, from measure 8" in text(opened, ".result .part") and opened.problems == []


def test_a_pause_is_no_new_beginning(opened: Browser) -> None:
    """Two notes, a pause, a note: the result is of all of it, and of nothing before a seek."""
    opened.run(pad_script())
    opened.click(".way.step")
    opened.turn(0.06 + 2.0)
    step(opened, 0)
    opened.turn(0.25)
    step(opened, 1)
    opened.key(" ", "Space")
    opened.turn(5)
    opened.key(" ", "Space")
    opened.turn(0.06 + 0.25)
    step(opened, 3)
    for _ in range(4):
        opened.turn(30)
    result = text(opened, ".result")
    assert "3 hit" in result and "longest run: 3" in result and "your best score: 17 %" in result
    assert text(opened, ".result .part") == ""
    whole = counted(opened)
    opened.key("Home")
    opened.click(".way.step")
    opened.turn(0.06 + 2.0)
    step(opened, 0)
    opened.key("End")  # to the last row
    for _ in range(4):
        opened.turn(30)
    assert counted(opened) == 1 < whole and "1 note, from measure 8" in text(opened, ".result .part")
    assert opened.problems == []


def test_a_second_play_that_is_better_is_a_new_best_score(opened: Browser) -> None:
    opened.run(pad_script())
    for hits, words in ((1, "your best score"), (3, "a new best score")):
        opened.key("Home")
        opened.click(".way.step")
        opened.turn(0.06 + 2.0)
        for column in (0, 1, 3)[:hits]:
            step(opened, column)
            opened.turn(0.25)
        for _ in range(4):
            opened.turn(30)
        assert words in text(opened, ".result")
    assert opened.problems == []


def test_music_that_comes_while_somebody_plays_is_no_new_beginning(opened: Browser) -> None:
    opened.run(pad_script())
    opened.click(".way.step")
    opened.turn(0.06 + 2.0)
    step(opened, 0)
    silence = io.BytesIO()
    with wave.open(silence, "wb") as file:
        file.setparams((1, 2, 8000, 0, "NONE", ""))
        file.writeframes(bytes(2000))
    opened.run(
        "(() => { const data = new DataTransfer();"
        f"data.items.add(new File([new Uint8Array({list(silence.getvalue())})], 'a.wav'));"
        "document.dispatchEvent(new DragEvent('drop', {dataTransfer: data})); })()"
    )
    opened.wait("document.querySelector('#music-state').textContent.includes('a.wav')", 20)
    assert "1 hit" in text(opened, ".standing")
    opened.turn(0.06 + 0.25)
    step(opened, 1)
    assert "2 hit" in text(opened, ".standing") and opened.problems == []


def counted(browser: Browser) -> int:
    """Notes in the counts of the result."""
    counts = "[...document.querySelectorAll('.result .counts b')].slice(0, 4).reduce((n, e) => n + +e.textContent, 0)"
    return int(browser.run(counts))


def test_lanes_are_the_mats_own_whatever_the_camera_sees(opened: Browser, page_file: Path) -> None:
    """From the front the lanes are mirrored, but not for somebody who plays along: the left lane is the left panel."""
    opened.click(".camera:nth-child(2)")
    x, y, w, h = opened.box(".lanes")
    opened.key("p", "KeyP")
    opened.mouse("mousePressed", x + 0.15 * w, y + h / 2)
    opened.drawn()
    assert opened.run("document.querySelector('.lanes').dataset.held") == "[0]"
    opened.mouse("mouseReleased", x + 0.15 * w, y + h / 2)
    assert opened.problems == []


def test_the_pass_before_stands_in_the_count_in(opened: Browser) -> None:
    opened.run(pad_script())
    opened.run("location.hash = '#m1-1'")
    opened.wait("document.querySelector('.message').textContent.includes('loop')")
    opened.key("p", "KeyP")
    opened.key(" ", "Space")
    for before, scores in (("", "score 50 %"), ("score 50 %", "score 50 % → 50 %")):  # four of the eight notes are hit
        assert text(opened, ".passed") == before
        opened.turn(1.9 if before else 0.06 + 2.0)
        for number, column in enumerate((0, 1, 3, 1)):
            opened.turn(0.0 if number == 0 else 0.25)
            opened.run(f"window.pad.buttons[{column}].pressed = true; window.pad.timestamp = performance.now()")
            opened.drawn()
            opened.run(f"window.pad.buttons[{column}].pressed = false")
            opened.drawn()
        assert text(opened, ".passed") == ""  # while it plays
        opened.turn(1.35)
        assert text(opened, ".passed") == scores
    assert opened.problems == []
