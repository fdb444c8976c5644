"""The page of a chart for two: both dancers in one picture, every note in the colour of whose it is."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from page_chromium import Browser
from PIL import Image
from test_page_document import unpacked

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.film.overlay.sprites import highway_style
from dancetutor_cli.page.work import Page, PageRequest, make_page
from dancetutor_cli.run.errors import UsageError

ROOT = Path(__file__).resolve().parents[2]
ROWS = ["10000001", "01000010", "00010100", "00101000", "10010001", "01000010", "00010100", "00101001"]
SONG = "#TITLE:Two;\n#OFFSET:0;\n#BPMS:0=120;\n#NOTES:dance-couple::Hard:9::\n" + "\n".join(ROWS) + "\n;\n"


def request_for(folder: Path, **more: Any) -> PageRequest:
    path = folder / "two.sm"
    path.write_text(SONG)
    return PageRequest(DanceRequest(path, Selection(**more), fps=30.0))


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> Page:
    return make_page(request_for(tmp_path_factory.mktemp("two")))


def test_it_holds_both_dancers_and_whose_each_note_is(pair: Page) -> None:
    doc = unpacked(pair.html)
    assert doc["pair"] and pair.label == "dance-couple Hard 9" and len(doc["pad"]["panels"]) == 8
    assert len(doc["motions"]) == 2 and pair.sizes["motion1"] > 1000
    assert [len(part["skin"]) for part in doc["body"]["parts"]] == [2] * len(doc["body"]["parts"])
    assert any(part["skin"][0] != part["skin"][1] for part in doc["body"]["parts"])
    jsonschema = pytest.importorskip("jsonschema", reason="jsonschema is not installed; it is in the extra dev")
    jsonschema.validate(doc, json.loads((ROOT / "docs" / "page.schema.json").read_text("utf-8")))
    assert doc["flips"] == [] and all(one["message"][:4] in ("P1: ", "P2: ") for one in doc["findings"])


def test_of_one_player_there_is_one_dancer(tmp_path: Path) -> None:
    doc = unpacked(make_page(request_for(tmp_path, player=2)).html)
    assert not doc["pair"] and len(doc["motions"]) == 1 and len(doc["pad"]["panels"]) == 4


def test_what_is_for_one_dancer_says_so(tmp_path: Path) -> None:
    request = request_for(tmp_path)
    with pytest.raises(UsageError, match="--player"):
        make_page(PageRequest(request.dance, second="next"))


def test_both_are_drawn_and_notes_have_their_colours(pair: Page, browser: Browser, tmp_path: Path) -> None:
    file = tmp_path / "two.html"
    file.write_bytes(pair.html)
    browser.size(1280, 720)
    browser.problems.clear()
    browser.open(file)
    for _ in range(2):
        browser.key(".", "Period")
    pixels = np.asarray(Image.open(browser.picture(tmp_path / "a.png")).convert("RGB")).astype(int)
    assert browser.problems == [] and browser.run("document.querySelector('.players').textContent") == "● P1 ● P2 "

    def parts(place: str) -> np.ndarray:
        x, y, w, h = (int(v) for v in browser.box(place))
        return pixels[y : y + h, x : x + w]

    view, lanes = parts(".view"), parts(".lanes")
    red, green, blue = (view[..., k] for k in range(3))
    across = np.nonzero((green > red + 40) & (green > blue + 40))[1]  # the second one's clothes
    assert len(across) > 1000 and across.mean() > 0.5 * view.shape[1]
    for n, colour in enumerate(highway_style().players):
        at = np.nonzero(np.abs(lanes - np.array(colour)).max(axis=2) <= 12)[1]
        assert len(at) > 100 and (at.mean() > 0.5 * lanes.shape[1]) == (n == 1)
