"""One small page for all tests of this room, and one browser."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from page_chromium import Browser

from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.jobs.page import Page, PageRequest, make_page
from dancetutor_cli.library.selection import Selection

# Hostile on purpose: all that people write is text. A measure of rest, then steps, a crossover, a jump and a hold, and
# a quiet end: the beginning is the hardest passage, and the linter finds a note that never counts.
TITLE = "</script><script>window.hacked=1</script>\"'><img src=x onerror=window.hacked=1>{{data}}&amp;"
SONG = (
    "#VERSION:0.83;\n#TITLE:{title};\n#ARTIST:<b>{title}</b>;\n#MUSIC:x.wav;\n#OFFSET:0;\n#BPMS:0=120;\n#FAKES:36=2;\n"
    "#NOTEDATA:;\n#STEPSTYPE:dance-single;\n#DIFFICULTY:Hard;\n#METER:9;\n#CREDIT:<script>window.hacked=1</script>;\n"
    "#NOTES:\n0000\n0000\n0000\n0000\n,\n1000\n0100\n0001\n0100\n1000\n0001\n0010\n0001\n"
    ",\n1001\n0000\n0200\n0000\n0000\n0300\n1000\n000M\n"
    + 3 * ",\n1000\n0000\n0000\n0000\n,\n0001\n0000\n0000\n0000\n"
    + ",\n1000\n0000\n0000\n0000\n;\n"
)


def write_song(folder: Path, title: str = TITLE) -> Path:
    """A song's file with that title."""
    path = folder / "song.ssc"
    path.write_text(SONG.replace("{title}", title.replace(";", "\\;").replace(":", "\\:")), "utf-8")
    return path


@pytest.fixture(scope="session")
def page(tmp_path_factory: pytest.TempPathFactory) -> Page:
    """The page of the hostile song, with the next best play beside."""
    path = write_song(tmp_path_factory.mktemp("song"))
    return make_page(PageRequest(DanceRequest(path, Selection(), "thesis", fps=30.0), beside="next"))


@pytest.fixture(scope="session")
def page_file(page: Page, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same on the disk."""
    path = tmp_path_factory.mktemp("page") / "page.html"
    path.write_bytes(page.html)
    return path


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """A headless Chromium; skips where there is none."""
    one = Browser()
    yield one
    one.close()


@pytest.fixture
def fresh(browser: Browser, page_file: Path) -> None:
    """The page, opened anew, with nothing stored."""
    browser.size(1280, 720)
    browser.call("Storage.clearDataForOrigin", origin="file://", storageTypes="local_storage")
    browser.problems.clear()
    browser.open(page_file)
    assert browser.run("localStorage.length") == 0
