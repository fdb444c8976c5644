"""The real files: all load or say why not, and agree with index.csv and with the rows of thesis_costs.csv."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from dancetutor_cli.chart.model import Kind, Song
from dancetutor_cli.chart.reader import load
from dancetutor_cli.run.errors import ChartError

STEPS = (Kind.TAP, Kind.HOLD, Kind.ROLL, Kind.LIFT, Kind.MINE)


@pytest.fixture(scope="module")
def index(shared_data: Path) -> list[dict[str, str]]:
    with (shared_data / "charts" / "index.csv").open(encoding="utf-8", newline="") as table:
        return list(csv.DictReader(table))


@pytest.fixture(scope="module")
def songs(corpus: Path, index: list[dict[str, str]]) -> dict[str, Song]:
    found = {}
    for row in index:
        try:
            found[row["path"]] = load(corpus / row["path"])
        except ChartError as error:
            assert row["n_charts"] == "0", error
            assert "no charts" in str(error)
    return found


def test_all_charts_are_there(songs: dict[str, Song], index: list[dict[str, str]]) -> None:
    charts = [c for song in songs.values() for c in song.charts]
    assert len(index) == 435
    assert len(charts) == 1976
    assert sum(c.steps_type in ("dance-single", "dance-double") for c in charts) == 1595


def test_steps_types_difficulties_meters_encodings(songs: dict[str, Song], index: list[dict[str, str]]) -> None:
    names = {"utf-8-bom": "utf-8-sig"}
    for row in index:
        if row["path"] in songs:
            song = songs[row["path"]]
            mine = [f"{c.steps_type}:{c.difficulty}:{c.meter}".lower() for c in song.charts]
            assert sorted(mine) == sorted(row["steps_types_meters"].lower().split(";")), row["path"]
            assert song.encoding == names.get(row["encoding"], row["encoding"])


def test_rows_with_a_step_or_a_mine(songs: dict[str, Song], shared_data: Path) -> None:
    """1,538 charts have the number of judged rows that two other readers found; taps of rolls add rows there."""
    with (shared_data / "charts" / "thesis_costs.csv").open(encoding="utf-8", newline="") as table:
        rows = list(csv.DictReader(table))
    assert len(rows) > 1500
    for row in rows:
        matching = [
            c
            for c in songs[row["path"]].charts
            if (c.steps_type, c.difficulty.lower(), c.meter)
            == (row["steps_type"], row["difficulty"], int(row["meter"]))
        ]
        fits = []
        for c in matching:
            counted = c.notes.judged & np.isin(c.notes.kind, STEPS)
            found, wanted = len(np.unique(c.notes.tick[counted])), int(row["rows"])
            has_rolls = bool((c.notes.kind[c.notes.judged] == Kind.ROLL).any())
            fits.append(found == wanted or (has_rolls and found < wanted))
        assert any(fits), row


def test_positions_lines_and_order(songs: dict[str, Song]) -> None:
    for path, song in songs.items():
        lines = song.data.split(b"\n")
        for c in song.charts[:2]:
            rows, notes = c.rows, c.notes
            for start, end, line in zip(
                rows.start[::7].tolist(), rows.end[::7].tolist(), rows.line[::7].tolist(), strict=True
            ):
                text = song.data[start:end]
                assert text.strip() == text != b"", path
                assert text in lines[line - 1], path
            assert (np.diff(rows.tick) >= 0).all()
            assert (np.diff(rows.start) > 0).all()
            assert (np.diff(notes.tick * 100 + notes.column) > 0).all()
            assert (notes.end[np.isin(notes.kind, (Kind.HOLD, Kind.ROLL))] > 0).all()
            assert {song.data[a - 1] for a in c.measures.anchor.tolist()} <= set(b":,")
            start, end = c.notes_span
            assert song.data[start - 1 : start] == b":"
            assert song.data[end : end + 1] in (b";", b"#", b"")
