"""The Python library `simfile` as an oracle for timing and notes of the real files, and where it knowingly differs."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

from dancetutor_cli.chart.model import Chart, Kind, Song
from dancetutor_cli.chart.reader import load
from dancetutor_cli.run.errors import ChartError

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # it uses pkg_resources, which setuptools is about to drop
    simfile = pytest.importorskip("simfile")
    from simfile.notes import NoteData, NoteType
    from simfile.timing import Beat, TimingData
    from simfile.timing.engine import TimingEngine

KINDS = {
    NoteType.TAP: Kind.TAP, NoteType.HOLD_HEAD: Kind.HOLD, NoteType.ROLL_HEAD: Kind.ROLL, NoteType.MINE: Kind.MINE,
    NoteType.LIFT: Kind.LIFT, NoteType.FAKE: Kind.FAKE, NoteType.KEYSOUND: Kind.KEYSOUND,
}  # fmt: skip

NOTES_DIFFER = {
    "long-row": "simfile raises for rows longer than the first row; the games ignore the rest of the row",
    "unknown-note": "simfile raises for a letter that is no note; the games read an empty column",
    "compound-note": "simfile raises for {...}; the games read letter by letter",
    "stepf2-note": "simfile raises for {...} of StepF2; here it is one note",
    "unmatched-head": "simfile keeps heads without a tail; the games delete them",
    "row-collision": "simfile keeps two notes on one 192nd; in the games the last counts",
}
TIME_DIFFERS = {
    "negative": "simfile lets time run backwards; the games make warps of negative BPMs and stops",
    "offset": "simfile gives a chart's own timing offset 0; the games give it the song's",
    "junk": "simfile raises for a BPM with trailing junk, as '352.0\\x0800'; the games read the number at the start",
    "empty": "simfile raises if a chart's own timing has no BPMs; the games take 60",
}


def pairs(corpus: Path) -> list[tuple[Song, object]]:
    found = []
    for path in sorted(corpus.rglob("*.s*"))[::3]:  # a third of the files
        try:
            song = load(path)
        except ChartError:
            continue
        found.append((song, simfile.open(str(path), strict=False)))
    return found


@pytest.fixture(scope="module")
def both(corpus: Path) -> list[tuple[Song, object]]:
    return pairs(corpus)


def test_notes(both: list[tuple[Song, object]]) -> None:
    same = 0
    for song, theirs in both:
        assert len(song.charts) == len(theirs.charts)  # type: ignore[attr-defined]
        for c, other in zip(song.charts, theirs.charts, strict=True):  # type: ignore[attr-defined]
            if {w.code for w in c.warnings} & NOTES_DIFFER.keys():
                continue
            found = list(zip(c.notes.tick.tolist(), c.notes.column.tolist(), c.notes.kind.tolist(), strict=True))
            expected = {
                (round(n.beat * 48), n.column, int(KINDS[n.note_type])) for n in NoteData(other) if n.note_type in KINDS
            }
            assert set(found) == expected, (song.path, c.label)
            same += 1
    assert same > 500


def test_seconds(both: list[tuple[Song, object]]) -> None:
    same = 0
    for song, theirs in both:
        for c, other in zip(song.charts, theirs.charts, strict=True):  # type: ignore[attr-defined]
            ticks = np.unique(c.notes.tick)[::23][:25]
            reason = why_times_differ(song, c)
            if reason or not len(ticks):
                assert reason is None or reason in TIME_DIFFERS
                continue
            engine = TimingEngine(TimingData(theirs, other))
            expected = [engine.time_at(Beat(int(tick), 48)) for tick in ticks]
            assert c.timing.seconds(ticks) == pytest.approx(expected, abs=1e-3), (song.path, c.label)
            same += 1
    assert same > 500


def why_times_differ(song: Song, c: Chart) -> str | None:
    if any(w.code == "negative-timing" for w in (*song.warnings, *c.warnings)):
        return "negative"
    if any(w.code == "odd-timing" and "not a pair of numbers" in w.message for w in song.warnings):
        return "junk"
    if c.timing is not song.timing and "OFFSET" not in c.tags and song.timing.offset != 0:
        return "offset"
    if any(w.code in ("no-bpm", "split-timing-without-bpms") for w in c.warnings):
        return "empty"
    return None
