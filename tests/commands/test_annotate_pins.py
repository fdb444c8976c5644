"""`dancetutor annotate`: feet that people have laid down are kept."""

from __future__ import annotations

import json
from pathlib import Path

from annotating import SONG, Said


def test_pinned_feet_stay_and_guide_the_solver(ssc: Path) -> None:
    Said([ssc, "--preset", "thesis", "--index", 0])
    marked = ssc.read_bytes()
    pinned = marked.replace(b"measure 1 {dt1 LR}", b"measure 1 {dt1! RL}", 1)
    assert pinned != marked
    ssc.write_bytes(pinned)
    said = Said([ssc, "--preset", "thesis", "--index", 0])
    assert said.status == 0
    assert "1 pinned, left alone" in said.out
    after = ssc.read_bytes()
    assert b"{dt1! RL}" in after
    assert after != pinned, "the feet around a pinned measure must follow it"
    assert Said([ssc, "--preset", "thesis", "--index", 0, "--check"]).status == 0
    assert "would be stripped:" in (said := Said([ssc, "--strip", "--dry-run"])).out
    assert "1 file: 1 would change" in said.out
    kept = "two_left_feet.ssc: 1 pinned measure left alone; --force removes it"
    assert f"stripped {ssc}".removesuffix(ssc.name) + kept in Said([ssc, "--strip"]).out
    assert ssc.read_bytes().count(b"{dt1") == 1
    assert kept in Said([ssc, "--strip"]).out, "the second time nothing changes, and the pin is still there"
    assert "left alone" not in Said([ssc, "--strip", "--force"]).out
    assert ssc.read_bytes() == (SONG / ssc.name).read_bytes()


def test_a_pin_that_does_not_fit_is_reported_with_line_and_column(ssc: Path) -> None:
    Said([ssc, "--index", 0])
    text = ssc.read_bytes().replace(b"measure 1 {dt1 LR}", b"measure 1 {dt1! LRR}", 1)
    ssc.write_bytes(text)
    line = text[: text.index(b"{dt1!")].count(b"\n") + 1
    column = len(b",  // measure 1 {dt1! LR") + 1
    said = Said([ssc, "--index", 0])
    assert said.status == 0
    assert f"two_left_feet.ssc:{line}:{column}: pinned measure 1: 3 tokens for 2 rows with steps" in said.err
    said = Said([ssc, "--index", 0, "--check"])
    assert said.status == 1
    assert f":{line}:{column}: pinned measure 1" in said.out


def test_data_sme_is_input_and_keeps_what_a_person_said(ssc: Path) -> None:
    """Overrides of SMEditor force feet; those that we wrote ourselves do not."""
    data = ssc.parent / "data.sme"
    theirs = {
        "version": 1,
        "mine": [1],
        "parity": {"dance-single": [{"overrides": [[4, 0, "Right"]], "ignores": {"6": ["DS"]}}]},
    }
    data.write_text(json.dumps(theirs, indent=2))
    before = data.read_bytes()
    Said([ssc, "--index", 0, "--markers", "measure,smeditor"])
    assert b"measure 1 {dt1 R" in ssc.read_bytes()
    merged = json.loads(data.read_bytes())
    assert list(merged)[:3] == ["version", "mine", "parity"]
    assert merged["parity"]["dance-single"][0]["overrides"][0] == [4, 0, "Right"]
    assert len(merged["parity"]["dance-single"][0]["overrides"]) > 20
    assert merged["parity"]["dance-single"][0]["ignores"] == {"6": ["DS"]}
    once = data.read_bytes()
    Said([ssc, "--index", 0, "--markers", "measure,smeditor"])
    assert data.read_bytes() == once
    Said([ssc, "--markers", "smeditor", "--strip"])
    assert data.read_bytes() == before
