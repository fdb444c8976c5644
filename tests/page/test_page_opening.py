"""What it shows first: last time's result, tags of passages, tabs with something in them, what is missing or loads."""

from __future__ import annotations

from pathlib import Path

import pytest
from page_chromium import STILL, Browser, message, pad_script, text
from page_song import write_song
from test_page_results import loop, play
from test_page_second import load
from test_page_setup import shown

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.page.work import PageRequest, make_page

PLAIN = (
    "#TITLE:x;\n#ARTIST:y;\n#CREDIT:z;\n#MUSIC:x.wav;\n#OFFSET:0;\n#BPMS:0=120;\n#NOTES:dance-single::Beginner:1::\n"
    + ",\n".join(["1000\n0000\n0001\n0000\n"] * 8)
    + ";\n"
)


@pytest.fixture(scope="module")
def music_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A page with something in it that stands for music."""
    folder = tmp_path_factory.mktemp("music")
    song = write_song(folder)
    (folder / "x.wav").write_bytes(b"RIFF" * 30)
    path = folder / "page.html"
    path.write_bytes(make_page(PageRequest(DanceRequest(song, Selection(), fps=30.0), music=True)).html)
    return path


def test_the_result_of_the_last_time_leads_to_what_was_missed(opened: Browser, page_file: Path) -> None:
    assert not shown(opened, ".resume")  # nobody has played yet
    loop(opened)
    play(opened, "dfk     ", late=0.06)
    opened.key(" ", "Space")
    opened.open(page_file)
    told = text(opened, ".resume")
    assert told.startswith("Last time, ") and "score 19 %" in told and "most missed: measure 1" in told
    assert not shown(opened, ".standing")
    opened.click("#go-on")
    assert message(opened).startswith("coach: not passed yet, begins at 70 % speed · loop measure 1,")
    assert shown(opened, ".standing") and text(opened, ".play") == "❚❚" and not shown(opened, ".resume")
    opened.size(380, 740, touch=True)
    opened.open(page_file)
    assert opened.box("#go-on")[3] >= 44 and opened.problems == []


def test_passages_are_told_by_tags_in_every_language(opened: Browser) -> None:
    tags = "[...document.querySelector('.card .tags').children].map(e => e.textContent)"
    found = opened.run(tags)
    assert found[0].endswith(" steps") and "1 crossover" in [tag.replace("crossovers", "crossover") for tag in found]
    assert all(len(tag) < 24 for tag in found)
    for language in ("de", "es", "ja", "ko"):
        opened.run(f"(s => {{ s.value = '{language}'; s.dispatchEvent(new Event('change')); }})"
                   "(document.querySelector('#language'))")  # fmt: skip
        opened.drawn()
        other = opened.run(tags)
        assert (
            len(other) == len(found) and other != found and not any("{" in tag or "undefined" in tag for tag in other)
        )
    assert opened.problems == []


def test_tabs_of_authors_are_there_when_there_is_something_in_them(opened: Browser, tmp_path: Path) -> None:
    assert shown(opened, "#tab-findings") and not shown(opened, "#tab-author")
    opened.key(".", "Period")
    opened.key("o", "KeyO")
    assert shown(opened, "#tab-author") and shown(opened, "#panel-author .column button")
    opened.key("o", "KeyO")  # given back: there is nothing to save
    assert shown(opened, "#tab-author") and not shown(opened, "#panel-author .column button")
    song = tmp_path / "song.sm"
    song.write_text(PLAIN)
    path = tmp_path / "plain.html"
    path.write_bytes(make_page(PageRequest(DanceRequest(song, Selection(), fps=30.0))).html)
    opened.open(path)
    names = "[...document.querySelectorAll('[role=tab]')].filter(e => e.checkVisibility()).map(e => e.id.slice(4))"
    assert opened.run(names) == ["passages", "along", "results", "settings"]
    opened.run("document.querySelector('#tab-results').click(); document.querySelector('#tab-results').focus()")
    opened.key("ArrowRight")  # past what is not there
    assert opened.run("document.activeElement.id") == "tab-settings"
    assert shown(opened, "#record-save") and opened.problems == []


def test_music_in_the_page_that_loads_is_said_and_nothing_claps(flat: Browser, music_file: Path) -> None:
    waits = "OfflineAudioContext.prototype.decodeAudioData = () => new Promise((_, no) => { window.fail = no; });"
    load(flat, music_file, STILL + waits, "document.documentElement?.dataset.ready && Boolean(window.fail)")
    flat.drawn()
    claps = "[...document.querySelectorAll('.bar [aria-pressed=true]')].some(e => e.textContent === 'Claps')"
    assert message(flat) == "Loading the music …" and not shown(flat, ".pick") and not flat.run(claps)
    flat.key(" ", "Space")
    assert message(flat) == "Loading the music …"  # also while it plays
    flat.run("window.fail(new Error('no music')); 1")
    flat.wait("document.querySelector('.message').textContent.includes('cannot be played')")
    assert shown(flat, ".pick") and flat.run(claps)


def test_without_webgl_the_picture_says_why(opened: Browser, browser: Browser, page_file: Path) -> None:
    assert text(opened, ".flat").startswith("No WebGL 2 in this browser") and shown(opened, ".flat")
    browser.open(page_file)
    browser.drawn()
    assert not shown(browser, ".flat")


def test_plots_and_errors_say_what_they_show(opened: Browser) -> None:
    loop(opened)
    play(opened, "dfk     ", late=-0.03)
    play(opened, "dfk     ", late=0.06)
    opened.key(" ", "Space")
    opened.click("#tab-results")
    told = text(opened, "#panel-results")
    assert "Score by day" not in told  # of one day there is nothing to compare
    assert "ms on average" not in told and " ms late" in told
    assert opened.box(".bars.through")[3] >= 80
    opened.click("#tab-along")
    opened.click("#calibrate")
    colours = "['#by-ear', '#by-eye'].map(s => getComputedStyle(document.querySelector(s)).backgroundColor)"
    assert len(set(opened.run(colours))) == 1 and opened.problems == []


SPY = (
    "window.bars = []; const fill = CanvasRenderingContext2D.prototype.fillRect;"
    "CanvasRenderingContext2D.prototype.fillRect = function (x, y, w, h) {"
    " if (this.canvas.className === 'lanes' && this.fillStyle === '#6fe38a') window.bars.push([x, y, w, h]);"
    " fill.call(this, x, y, w, h); };"
)


@pytest.mark.parametrize(("width", "height"), [(1280, 720), (768, 1024), (380, 740)])
def test_the_scale_of_errors_lies_above_the_receptors(flat: Browser, page_file: Path, width: int, height: int) -> None:
    flat.size(width, height, touch=width < 800)
    load(flat, page_file, STILL + SPY, "document.documentElement?.dataset.ready")
    flat.run(pad_script())
    flat.click(".way.step")
    flat.turn(0.06 + 2.02)
    flat.run("window.bars = []; window.pad.buttons[0].pressed = true")
    flat.drawn()
    bars = flat.run("window.bars")
    lanes = flat.box(".lanes")
    lane = min(72, (lanes[2] - 2 * 22) / 4)
    receptor = max(0.11 * lanes[3], 0.62 * lane + min(68, 0.15 * lanes[3]))
    assert bars and all(y > 0 and y + h < receptor - 0.5 * lane for _, y, _, h in bars)


def test_the_menu_of_a_phone_keeps_the_time_and_lists_no_keys(opened: Browser, page_file: Path) -> None:
    opened.size(380, 740, touch=True)
    opened.open(page_file)
    opened.click(".more")
    middles = "['.play', '.where', '.more'].map(s => document.querySelector(s).getBoundingClientRect())"
    places = opened.run(f"{middles}.map(b => b.top + b.height / 2)")
    assert max(places) - min(places) < 12  # in one row
    assert opened.run("document.documentElement.scrollWidth") == 380
    opened.run("document.querySelector('[aria-label=\"Keys and help\"]').click()")
    assert not shown(opened, "dialog.sheet kbd") and "press [" not in text(opened, "#panel-passages")
    opened.click("dialog.sheet summary")
    assert shown(opened, "dialog.sheet kbd") and opened.problems == []


def test_the_dancer_of_a_phone_is_not_tiny_for_whoever_plays(opened: Browser, page_file: Path) -> None:
    opened.size(380, 740, touch=True)
    opened.open(page_file)
    opened.click(".way.step")
    assert opened.box(".picture")[2] >= 150 and (opened.box(".lanes")[2] - 22) / 4 >= 44
