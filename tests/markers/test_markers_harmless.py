"""What other programs read in an annotated file: the same as before. On all real and all hostile files."""

from __future__ import annotations

import warnings
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from markers_readers import READERS
from markers_songs import annotated, chart_files, readable, sm, song_of, stripped

from dancetutor_cli.chart.edits import HarmError, check_edit
from dancetutor_cli.chart.hash import hash_input
from dancetutor_cli.chart.model import Song
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.feet.annotations import step_rows

DATA = sm(b"\r\n1000\r\n0100\r\n,  // measure 1\r\n0010\r\n0001\r\n;\r\n")


def assert_same_song(before: Song, after: Song) -> None:
    """Rows, timing and tags as the project's own reader sees them."""
    assert (before.title, before.artist, before.tags, before.timing) == (
        after.title, after.artist, after.tags, after.timing,
    )  # fmt: skip
    assert len(before.charts) == len(after.charts)
    for a, b in zip(before.charts, after.charts, strict=True):
        assert (a.label, a.tags, a.timing, len(a.warnings)) == (b.label, b.tags, b.timing, len(b.warnings))
        for name in ("tick", "column", "kind", "end", "judged"):
            assert np.array_equal(getattr(a.notes, name), getattr(b.notes, name)), name
        assert np.array_equal(a.rows.tick, b.rows.tick)
        assert hash_input(before, a) == hash_input(after, b)


def check_files(paths: list[Path]) -> Counter[str]:
    """Annotate each file; every reader must see the same, stripping must give it back, twice must equal once."""
    counts: Counter[str] = Counter()
    for path in paths:
        song = readable(path)
        if song is None:
            continue
        data = annotated(song)
        again = check_edit(song, data)
        assert_same_song(song, again)
        assert stripped(again) == song.data, path
        assert annotated(again) == data, path
        if counts["files"] % 3 == 0:  # as if another preset had found other feet
            assert annotated(again, seed=2) == annotated(song, seed=2), path
        for name, reader in READERS.items():
            assert reader(song.data) == reader(data), f"{name}: {path}"
        counts["files"] += 1
        counts["changed"] += data != song.data
    return counts


def test_the_real_files(corpus: Path) -> None:
    counts = check_files(chart_files(corpus))
    assert counts["files"] > 400
    assert counts["changed"] > 390


def test_the_hostile_files(hostile: Path) -> None:
    counts = check_files(chart_files(hostile))
    assert counts["files"] > 50
    assert counts["changed"] > 40


@pytest.mark.parametrize("which", ["corpus", "hostile"])
def test_rows_round_trip_too(which: str, request: pytest.FixtureRequest) -> None:
    changed = 0
    for path in chart_files(request.getfixturevalue(which))[:: 5 if which == "corpus" else 1]:
        song = readable(path)
        if song is None:
            continue
        data = annotated(song, styles=("measure", "rows"))
        again = parse(data, path)
        assert_same_song(song, again)
        assert stripped(again, styles=("measure", "rows")) == song.data, path
        assert stripped(again, styles=("rows",)) == annotated(song), path
        assert annotated(again, styles=("measure", "rows")) == data, path
        for name, reader in READERS.items():
            if name not in ("Etterna",):
                assert reader(song.data) == reader(data), f"{name}: {path}"
        changed += data != song.data
    assert changed > 40


def views(data: bytes) -> set[str]:
    """The readers that see something else in `data` than in the plain file."""
    return {name for name, reader in READERS.items() if reader(data) != reader(DATA)}


def test_the_models_find_harmful_comments() -> None:
    """Each row of the table, so that a model that sees nothing would fail here."""
    assert views(annotated(song_of(DATA))) == set()
    assert views(DATA.replace(b"0100\r\n", b"//x\r\n0100\r\n")) == {"OpenITG, 3.9", "SMEditor"}
    assert views(DATA.replace(b"0100\r\n", b"  //x\r\n0100\r\n")) == {"OpenITG, 3.9", "SMEditor", "GrooveAuthor"}
    assert views(DATA.replace(b"1000\r\n", b"1000//dtL\r\n")) == {"Etterna"}
    assert views(DATA.replace(b"1000\r\n", b"1000 //dtL\r\n")) == {"Etterna", "ArrowVortex"}
    assert views(DATA.replace(b"measure 1", b"measure 1 {dt1 L:R}")) >= {"Etterna", "Simply Love score hash"}
    assert views(DATA.replace(b"measure 1", b"measure 1 {dt1 L;R}")) >= {"Etterna", "Simply Love score hash"}
    assert views(DATA.replace(b"0100", b"0110")) == set(READERS)


def test_a_change_that_harms_is_refused() -> None:
    song = song_of(DATA)
    for bad in (
        DATA.replace(b"0100", b"0110"),
        DATA.replace(b"0100\r\n", b"0100\r\n0000\r\n"),
        DATA.replace(b"#TITLE:Song", b"#TITLE:Sonk"),
        DATA.replace(b"0=120", b"0=121"),
        DATA.replace(b"// measure 1", b"// measure: 1"),
        DATA.replace(b"#NOTES", b"#NOTE"),
        DATA.replace(b"     8:", b"     9:"),
        DATA + DATA[DATA.index(b"#NOTES") :],
    ):
        with pytest.raises(HarmError, match="nothing was written"):
            check_edit(song, bad)
    assert check_edit(song, annotated(song)).title == "Song"


def seen_by_simfile(data: bytes, suffix: str) -> Any:
    """What the Python simfile library reads; None where it cannot."""
    simfile = pytest.importorskip("simfile")
    from simfile.notes import NoteData
    from simfile.timing import TimingData

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            file = simfile.loads(data.decode("utf-8", "surrogateescape"), strict=False)
            charts = []
            for chart in file.charts:
                timing = TimingData(file, chart if suffix == ".ssc" else None)
                notes = list(NoteData(chart))
                when = (timing.bpms, timing.stops, timing.delays, timing.warps, timing.offset)
                charts.append((str(chart.stepstype), str(chart.difficulty), notes, [str(value) for value in when]))
            tags = {k: v for k, v in file.items() if k != "NOTES"}
        except Exception:
            return None
    return tags, charts


def test_the_simfile_library_reads_the_same(corpus: Path, hostile: Path) -> None:
    read = 0
    for path in [*chart_files(corpus)[::9], *chart_files(hostile)]:
        song = readable(path)
        if song is None or len(song.data) > 300_000:
            continue
        before = seen_by_simfile(song.data, path.suffix.lower())
        if before is None:
            continue
        assert seen_by_simfile(annotated(song), path.suffix.lower()) == before, path
        read += 1
    assert read > 40


def test_steps_are_found_by_an_independent_count(corpus: Path) -> None:
    """As many letters as there are 1, 2, 4 and L, or players' letters, in the rows that StepMania's model sees."""
    for path in chart_files(corpus)[::10]:
        song = readable(path)
        if song is None or b"[" in song.data or b"\\" in song.data or b"&" in song.data:
            continue
        for chart in song.charts:
            text = b"#NOTES:" + song.data[slice(*chart.notes_span)] + b";"
            ((_, measures),) = READERS["StepMania 5, ITGmania"](text)
            steps = b"124LXYZxyz" if chart.marked else b"124L"
            expected = [
                [i for i, cell in enumerate(row[: chart.columns]) if cell in steps] for rows in measures for row in rows
            ]
            found = step_rows(song.data, chart).steps
            assert [row.nonzero()[0].tolist() for row in found] == [row for row in expected if row], path
