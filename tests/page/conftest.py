"""One small page for all tests of this room, and one browser."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from page_chromium import Browser
from page_song import write_song

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.page.work import Page, PageRequest, make_page


@pytest.fixture(scope="session")
def page(tmp_path_factory: pytest.TempPathFactory) -> Page:
    """The page of the hostile song, with the next best play beside."""
    path = write_song(tmp_path_factory.mktemp("song"))
    return make_page(PageRequest(DanceRequest(path, Selection(), "thesis", fps=30.0), second="next"))


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


@pytest.fixture(scope="module")
def flat() -> Iterator[Browser]:
    """A browser without WebGL: it draws quickly whatever else the machine does."""
    one = Browser(flags=("--disable-gpu", "--disable-3d-apis"))
    yield one
    one.close()


@pytest.fixture
def opened(flat: Browser, page_file: Path) -> Browser:
    """The page without WebGL, opened with nothing stored."""
    flat.size(1280, 720)
    flat.call("Storage.clearDataForOrigin", origin="file://", storageTypes="local_storage")
    flat.problems.clear()
    flat.open(page_file)
    return flat


@pytest.fixture
def fresh(browser: Browser, page_file: Path) -> None:
    """The page, opened anew, with nothing stored."""
    browser.size(1280, 720)
    browser.call("Storage.clearDataForOrigin", origin="file://", storageTypes="local_storage")
    browser.problems.clear()
    browser.open(page_file)
    assert browser.run("localStorage.length") == 0
