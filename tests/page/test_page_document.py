"""The file that `page` writes: whole, small, safe."""

from __future__ import annotations

import base64
import hashlib
import json
import re
import struct
import zlib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from page_song import write_song

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.performance import perform, solve
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.feet.solver.techniques import HALF_TURNS
from dancetutor_cli.feet.solver.vocabulary import EVENTS
from dancetutor_cli.formats.npz import write_npz
from dancetutor_cli.page.document import Blob, languages
from dancetutor_cli.page.work import Page, PageRequest, make_page
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.languages import load_language


def unpacked(html: bytes) -> dict[str, Any]:
    """The JSON in a page."""
    found = re.search(rb'id="data">([^<]*)<', html)
    assert found
    raw = zlib.decompress(base64.b64decode(found[1]))
    (length,) = struct.unpack("<I", raw[:4])
    doc: dict[str, Any] = json.loads(raw[4 : 4 + length])
    return doc


def test_people_s_words_are_never_markup(page: Page) -> None:
    text = page.html.decode("utf-8")
    assert text.count("<script") == 3 and text.count("</script>") == 3  # data, music, and the one script
    assert "onerror=window" not in re.sub(r"<title>.*?</title>", "", text)
    assert "<title>&lt;/script&gt;&lt;script&gt;" in text
    words = unpacked(page.html)["words"]
    assert "</script><script>window.hacked=1</script>" in words["title"]


def test_the_policy_names_this_script_and_this_style_and_no_place(page: Page) -> None:
    text = page.html.decode("utf-8")
    found = re.search(r'Content-Security-Policy" content="([^"]*)"', text)
    assert found
    policy = dict(part.strip().split(" ", 1) for part in found[1].split(";"))
    assert policy["default-src"] == "'none'"
    for name, element in (("script-src", r"<script>(.*?)</script>"), ("style-src", r"<style>(.*?)</style>")):
        content = re.search(element, text, re.DOTALL)
        assert content
        digest = base64.b64encode(hashlib.sha256(content[1].encode()).digest()).decode()
        assert policy[name] == f"'sha256-{digest}'"
    assert "http" not in found[1]
    assert not re.findall(r"https?://", text)


def test_a_page_is_small(page: Page) -> None:
    # The dancer and the page itself are what a short page holds; two minutes of motion are less than a megabyte more.
    assert len(page.html) < 1_200_000
    assert page.sizes["mesh"] + page.sizes["skin"] < 500_000


@pytest.mark.parametrize("differences", [0, 1, 2])
def test_arrays_come_back_from_their_planes(differences: int) -> None:
    blob = Blob()
    values = np.random.default_rng(1).integers(-30000, 30000, (3, 40))
    blob.add("x", values, "i2", differences)
    kind, count, row, rounds, offset = blob.index["x"]
    assert (kind, count, row, rounds, offset) == ("i2", 120, 40, differences, 0)
    planes = np.frombuffer(blob.to_bytes(), dtype=np.uint8).reshape(2, 120).astype(np.int64)
    raw = planes[0] + 256 * planes[1]
    if differences:
        raw = (raw >> 1) ^ -(raw & 1)  # the sign is the lowest bit
    back = raw.astype(np.uint16).astype(np.int16).reshape(3, 40)
    for _ in range(differences):
        back = np.cumsum(back, axis=1, dtype=np.int16)
    assert (back == values).all()


def test_moves_are_called_what_films_call_them() -> None:
    """One table per language. Who and where stand beside the list of a row's moves, so not in it.

    A list has commas, so what explains a move is in brackets: "footswitch (swap feet)".
    """
    every = (*EVENTS, *HALF_TURNS)
    english = languages()["en"]
    for name, said in load_language().moves.items():
        if "{" not in said and name in every:
            assert english[f"move-{name}"] in (re.sub(": (.+)", r" (\1)", said), f"{name} ({said})"), name
    for labels in languages().values():
        named = [labels[f"move-{name}"] for name in every]
        assert not [said for said in named if re.search("[,、]|candle|gallop|stream|drill", said)]


@pytest.mark.parametrize("language", languages())
@pytest.mark.parametrize(("move", "rule"), [("bracket", "DT210"), ("doublestep", "DT201"), ("jack", "DT214")])
def test_a_move_has_one_name_on_cards_in_rows_and_in_findings(language: str, move: str, rule: str) -> None:
    """Its row explains it in brackets; beside the notes the move and its rule have one short name."""
    labels = languages()[language]
    called, _, means = labels[f"move-{move}"].partition(" (")
    assert means.endswith(")")
    for place in (labels[f"tag-{move}"], labels[f"finding-{rule}"].partition(":")[0]):
        assert called.lower() in place.lower()
    assert labels.get(f"short-{move}", labels[f"short-{rule}"]) == labels[f"short-{rule}"]


def test_every_label_that_the_modules_use_exists() -> None:
    folder = Path(__file__).resolve().parents[2] / "dancetutor_cli" / "page" / "js"
    known = set(languages()["en"])
    for path in folder.glob("*.js"):
        for key in re.findall(r'\bt\(\s*"([\w-]+)"', path.read_text("utf-8")):
            assert key in known, f"{path.name}: {key}"
        for key in re.findall(r'\bname: "(\w+)", keys:|slider\("(\w+)"', path.read_text("utf-8")):
            key = key[0] or f"setting-{key[1]}"
            assert key in known, f"{path.name}: {key}"


def test_a_second_dancer_has_the_motion_of_a_file(page: Page, tmp_path: Path) -> None:
    request = DanceRequest(write_song(tmp_path), Selection(), "thesis", fps=30.0)
    [own] = perform(solve(request), request).bake()
    other = replace(own.motion.contacts[0], limb=1 - own.motion.contacts[0].limb)
    later = replace(own.motion, times=own.motion.times + 1.0, contacts=(other, *own.motion.contacts[1:]))
    write_npz(tmp_path / "captured.npz", later)
    made = unpacked(make_page(PageRequest(request, second=str(tmp_path / "captured.npz"))).html)
    assert [round(one["start"] - own.motion.times[0], 3) for one in made["motions"]] == [0.0, 1.0]
    assert made["second"] == {"name": "captured", "rows": [other.row]}
    skeleton = replace(own.motion.skeleton, names=tuple(f"other_{name}" for name in own.motion.skeleton.names))
    write_npz(tmp_path / "foreign.npz", replace(own.motion, skeleton=skeleton))
    with pytest.raises(FileError, match=r"foreign\.npz: its skeleton has no .*; `dancetutor retarget`"):
        make_page(PageRequest(request, second=str(tmp_path / "foreign.npz")))


def test_a_second_dancer_plays_other_feet(page: Page) -> None:
    doc = unpacked(page.html)
    assert len(doc["motions"]) == 2 and doc["second"]["name"] == "next"
    assert doc["second"]["rows"], "the next best play steps some row otherwise"
    assert page.sizes["motion1"] > 1000
