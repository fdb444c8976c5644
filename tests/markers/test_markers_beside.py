"""What is written beside a chart file: the sidecar and SMEditor's data.sme."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from types import ModuleType
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from markers_songs import sm, song_of

from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.feet.annotations import step_rows
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_chart
from dancetutor_cli.markers import sidecar, smeditor
from dancetutor_cli.markers.model import ChartFeet, row_letters
from dancetutor_cli.run.errors import FileError

MEASURES = b"\n1000\n0001\n0110\n0M00\n,\n2002\n0000\n0010\n3003\n;\n"


def two_charts() -> Song:
    data = sm(MEASURES)
    return song_of(data + data[data.index(b"#NOTES") :].replace(b"Hard", b"Easy"))


def feet_of(song: Song) -> list[ChartFeet]:
    out = []
    for chart in song.charts:
        play = solve_chart(chart, load_preset("thesis"))
        assert play is not None
        rows = step_rows(song.data, chart)
        out.append(ChartFeet(chart, rows, tuple(row_letters(chart, rows, play)), play))
    return out


NAMES = {sidecar: "song.dancetutor.json", smeditor: "data.sme"}


def write(style: ModuleType, old: bytes | None, song: Song, feet: Sequence[ChartFeet]) -> bytes | None:
    """The new content of a style's file in a folder where it has the old content."""
    with placed(style, old, song) as beside:
        (change,) = style.write(beside, beside.path.parent, feet)
    assert change.old == old
    return change.new


def strip(style: ModuleType, old: bytes | None, song: Song, charts: Sequence[Chart]) -> bytes | None:
    with placed(style, old, song) as beside:
        (change,) = style.strip(beside, charts)
    assert change.old == old
    return change.new


@contextmanager
def placed(style: ModuleType, old: bytes | None, song: Song) -> Iterator[Song]:
    """The song in a folder of its own, with the style's file beside it."""
    with TemporaryDirectory() as folder:
        if old is not None:
            Path(folder, NAMES[style]).write_bytes(old)
        yield replace(song, path=Path(folder, song.path.name))


def test_the_sidecar_says_beat_column_and_limb() -> None:
    song = two_charts()
    feet = feet_of(song)
    data = json.loads(write(sidecar, None, song, feet) or b"")
    charts = data["files"]["song.sm"]["charts"]
    assert [(c["index"], c["steps_type"], c["difficulty"], c["meter"]) for c in charts] == [
        (0, "dance-single", "Hard", 8), (1, "dance-single", "Easy", 8),
    ]  # fmt: skip
    hand = feet[0].letters[-1]
    assert charts[0]["steps"] == [
        [0.0, 0, "left_foot"], [1.0, 3, "right_foot"], [2.0, 1, "right_foot"], [2.0, 2, "left_foot"],
        [4.0, 0, "left_foot"], [4.0, 3, "right_foot"], [6.0, 2, "left_hand" if hand == "<" else "right_hand"],
    ]  # fmt: skip
    lines = "0,0,1,-1\n48,3,1,-1\n96,1,1,-1\n96,2,1,-1\n144,1,4,-1\n192,0,2,336\n192,3,2,336\n288,2,1,-1\n"
    assert charts[0]["notes_sha256"] == hashlib.sha256(lines.encode()).hexdigest()


def test_the_sidecar_is_for_both_files_of_a_song_and_keeps_other_charts() -> None:
    song = two_charts()
    feet = feet_of(song)
    first = write(sidecar, None, song, feet)
    assert write(sidecar, first, song, feet) == first
    assert write(sidecar, first, song, feet[1:]) == first
    twin = song_of(sm(MEASURES), "song.SM")
    both = write(sidecar, first, twin, feet_of(twin))
    assert set(json.loads(both or b"")["files"]) == {"song.sm", "song.SM"}
    assert strip(sidecar, both, twin, twin.charts) == first
    half = strip(sidecar, first, song, song.charts[:1])
    assert half is not None
    assert [c["index"] for c in json.loads(half)["files"]["song.sm"]["charts"]] == [1]
    assert strip(sidecar, half, song, song.charts) is None


def test_the_sidecar_notices_that_notes_have_changed() -> None:
    path, song = Path("song.dancetutor.json"), song_of(sm(MEASURES))
    old = write(sidecar, None, song, feet_of(song))
    edited = song_of(sm(MEASURES.replace(b"0001", b"0010")))
    new = write(sidecar, old, edited, feet_of(edited))
    assert "its notes have changed" in str(sidecar.check_entry(path, old, edited, edited.charts[0], new))
    assert sidecar.check_entry(path, new, edited, edited.charts[0], new) is None
    # a comment, which an editor may drop, changes nothing
    commented = song_of(sm(MEASURES.replace(b",\n", b", // x\n")))
    assert sidecar.check_entry(path, old, commented, commented.charts[0], old) is None


ODD_CHARTS = b'{"schema": 1, "program": "dancetutor", "files": {"song.sm": {"charts": [1]}}}'


@pytest.mark.parametrize(
    "text", [b"", b"{}", b"[1]", b'{"program": "other", "files": {}}', b"\xff", b'{"files": 3}', ODD_CHARTS]
)
def test_a_file_that_is_no_sidecar_is_left_alone(text: bytes) -> None:
    song = two_charts()
    with pytest.raises(FileError, match="not a sidecar"):
        write(sidecar, text, song, feet_of(song))


def test_data_sme_has_the_form_of_the_specification() -> None:
    song = two_charts()
    new = write(smeditor, None, song, feet_of(song))
    assert new is not None
    assert new.startswith(
        b'{"version":1,"parity":{"dance-single":[{"overrides":[[0,0,"Left"],[1,3,"Right"],[2,1,"Right"],[2,2,"Left"],'
        b'[4,0,"Left"],[4,3,"Right"]],"ignores":{}},{"overrides":[[0,0,"Left"]'
    )
    assert write(smeditor, new, song, feet_of(song)) == new
    assert strip(smeditor, new, song, song.charts) is None
    one = strip(smeditor, new, song, song.charts[:1])
    assert one is not None
    assert write(smeditor, one, song, feet_of(song)[:1]) == new


def test_beats_have_three_digits() -> None:
    song = song_of(sm(b"\n" + b"".join(b"1000\n" if i == 1 else b"0000\n" for i in range(12)) + b";\n"))
    assert smeditor.overrides(feet_of(song)[0]) == [[0.333, 0, "Left"]]


def test_what_a_person_set_is_never_touched() -> None:
    song = two_charts()
    theirs: dict[str, Any] = {
        "future": {"b": 1, "a": [2]},
        "parity": {
            "pump-single": [{"overrides": [[0, 1, "Left"]], "ignores": {}}],
            "dance-single": [{"overrides": [[2, 1, "Right"], [1.0, 3, 2]], "ignores": {"1": ["DS"]}, "note": "x"}],
        },
        "version": 1,
    }
    old = json.dumps(theirs, indent=3).encode()
    new = write(smeditor, old, song, feet_of(song))
    assert new is not None
    data = json.loads(new)
    assert list(data) == ["future", "parity", "version", "dancetutor"]
    assert list(data["parity"]) == ["pump-single", "dance-single"]
    assert data["parity"]["pump-single"] == theirs["parity"]["pump-single"]
    entry = data["parity"]["dance-single"][0]
    assert entry["overrides"][:2] == [[2, 1, "Right"], [1.0, 3, 2]]
    assert [item[:2] for item in entry["overrides"][2:]] == [[0, 0], [2, 2], [4, 0], [4, 3]]
    assert (entry["ignores"], entry["note"]) == ({"1": ["DS"]}, "x")
    assert write(smeditor, new, song, feet_of(song)) == new
    assert strip(smeditor, new, song, song.charts) == old


def test_a_change_by_a_person_after_us_is_theirs() -> None:
    song = song_of(sm(MEASURES))
    data = json.loads(write(smeditor, None, song, feet_of(song)) or b"")
    overrides = data["parity"]["dance-single"][0]["overrides"]
    overrides[0] = [0, 0, "Right"]
    data["parity"]["dance-single"][0]["ignores"] = {"2": ["AM"]}
    left = strip(smeditor, json.dumps(data).encode(), song, song.charts)
    assert json.loads(left or b"") == {
        "version": 1, "parity": {"dance-single": [{"overrides": [[0, 0, "Right"]], "ignores": {"2": ["AM"]}}]},
    }  # fmt: skip


def test_after_smeditor_has_saved_all_feet_are_a_persons() -> None:
    song = song_of(sm(MEASURES))
    data = json.loads(write(smeditor, None, song, feet_of(song)) or b"")
    del data["dancetutor"]
    saved = json.dumps(data, separators=(",", ":")).encode()
    assert strip(smeditor, saved, song, song.charts) == saved
    assert write(smeditor, saved, song, feet_of(song)) == saved


@pytest.mark.parametrize(
    "text", [b"", b"{", b"[]", b"\xff\xfe", b'{"parity":[]}', b'{"parity":{"dance-single":{}}}',
             b'{"parity":{"dance-single":[7]}}', b'{"parity":{"dance-single":[{"overrides":7}]}}']
)  # fmt: skip
def test_an_odd_file_is_left_alone(text: bytes) -> None:
    song = song_of(sm(MEASURES))
    with pytest.raises(FileError, match=r"left alone|did not write"):
        write(smeditor, text, song, feet_of(song))


_OVERRIDE = st.tuples(st.integers(0, 8), st.integers(0, 3), st.sampled_from(["Left", "Right", 1, 2, 3, 4])).map(list)
_CHART = st.fixed_dictionaries({"overrides": st.lists(_OVERRIDE, max_size=5), "ignores": st.just({"1": ["DS"]})})
_PARITY = st.dictionaries(
    st.sampled_from(["dance-single", "dance-double", "pump-single"]), st.lists(_CHART, max_size=3)
)
_EXTRA = st.dictionaries(st.sampled_from(["a", "b"]), st.integers())
_SME = st.builds(
    lambda parity, extra, indent: json.dumps({**extra, "version": 1, "parity": parity}, indent=indent).encode(),
    _PARITY, _EXTRA, st.sampled_from([None, 0, 2]),
)  # fmt: skip
_SONG = two_charts()
_FEET = feet_of(_SONG)


@given(_SME)
def test_any_data_sme_round_trips(old: bytes) -> None:
    new = write(smeditor, old, _SONG, _FEET)
    assert new is not None
    assert write(smeditor, new, _SONG, _FEET) == new
    assert strip(smeditor, new, _SONG, _SONG.charts) == old
