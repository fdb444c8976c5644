"""`data.sme` as input: overrides, ignores, and what is not used and why."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from dancetutor_cli.chart.model import Song
from dancetutor_cli.chart.reader import load
from dancetutor_cli.feet.limbs import Limb, Part
from dancetutor_cli.feet.song_feet import SongFeet

LEFT, RIGHT = Limb.LEFT_FOOT, Limb.RIGHT_FOOT
CHART = "#NOTES:\n {}:\n :\n {}:\n 8:\n :{}\n1000\n0100\n0011\n0001\n;\n"


def song_in(folder: Path, pin: str = "") -> Song:
    path = folder / "song.sm"
    charts = [
        CHART.format(kind, level, pin)
        for kind, level in (("dance-single", "Easy"), ("pump-single", "Easy"), ("dance-single", "Hard"))
    ]
    path.write_text("#TITLE:x;\n#BPMS:0=120;\n" + "".join(charts))
    return load(path)


def sme(folder: Path, *charts: Any, **more: Any) -> None:
    (folder / "data.sme").write_text(json.dumps({"version": 1, "parity": {"dance-single": list(charts)}, **more}))


def test_overrides_go_to_the_chart_of_their_place(tmp_path: Path) -> None:
    song = song_in(tmp_path)
    sme(tmp_path, {"overrides": [], "ignores": {}}, {"overrides": [[0, 0, "Right"], [1, 1, "Left"]], "ignores": {}})
    assert [len(SongFeet(song).author_feet(chart)[0]) for chart in song.charts] == [0, 0, 2]
    assert SongFeet(song).author_feet(song.charts[2])[0].cells() == {
        (0, 0): (RIGHT, Part.WHOLE),
        (48, 1): (LEFT, Part.WHOLE),
    }


def test_numbers_are_parts_of_feet(tmp_path: Path) -> None:
    song = song_in(tmp_path)
    sme(tmp_path, {"overrides": [[0, 0, 3], [1, 1, 2], [2, 2, 4], [2, 3, 3]], "ignores": {}})
    assert SongFeet(song).author_feet(song.charts[0])[0].cells() == {
        (0, 0): (RIGHT, Part.WHOLE),  # a heel without a toe is the foot
        (48, 1): (LEFT, Part.WHOLE),
        (96, 2): (RIGHT, Part.TOE),
        (96, 3): (RIGHT, Part.HEEL),
    }


def test_ignores_are_codes_at_beats(tmp_path: Path) -> None:
    song = song_in(tmp_path)
    sme(tmp_path, {"overrides": [], "ignores": {"1": ["DS", "FS"], "2.333": ["AM", "XX"], "x": ["DS"], "3": "DS"}})
    _, ignores, problems = SongFeet(song).author_feet(song.charts[0])
    assert problems == ()
    assert ignores.codes == {48: {"DS", "FS"}, 112: {"AM"}}
    assert ignores.is_silenced(48, "FS")
    assert not ignores.is_silenced(48, "AM")
    assert not ignores.is_silenced(49, "FS")


def test_a_pin_counts_more(tmp_path: Path) -> None:
    song = song_in(tmp_path, pin="//{dt1! LL(LR)L}")
    sme(tmp_path, {"overrides": [[0, 0, "Right"], [3, 3, "Right"]], "ignores": {}})
    overrides, _, problems = SongFeet(song).author_feet(song.charts[0])
    assert problems == ()
    assert overrides.cells()[0, 0] == (LEFT, Part.WHOLE)
    assert overrides.cells()[144, 3] == (LEFT, Part.WHOLE)


def test_unused_parts_are_reported(tmp_path: Path) -> None:
    song = song_in(tmp_path)
    sme(tmp_path, {"overrides": [[0, 1, "Left"], [2, 2, "Left"], [2, 3, "Left"]], "ignores": {}})
    overrides, _, problems = SongFeet(song).author_feet(song.charts[0])
    assert len(overrides) == 0
    assert [(p.code, p.line, p.column) for p in problems] == [("sme-no-note", None, None), ("feet-twice", 11, 1)]
    assert "beat 0, column 1, where no note is" in problems[0].message


ODD = [
    "", "{", "[]", "5", "\x00", '{"version": 1}', '{"parity": 3}', '{"parity": {"dance-single": {"0": 1}}}',
    '{"parity": {"dance-single": [5]}}',
    '{"parity": {"dance-single": [{"overrides": [[1], "x", [1, 2, 3], [0, 0, true]]}]}}',
]  # fmt: skip


@pytest.mark.parametrize("text", ODD)
def test_odd_files_never_raise(tmp_path: Path, text: str) -> None:
    song = song_in(tmp_path)
    (tmp_path / "data.sme").write_text(text)
    overrides, ignores, problems = SongFeet(song).author_feet(song.charts[0])
    assert len(overrides) == 0
    assert not ignores.codes
    assert all("data.sme" in p.message for p in problems)


def test_what_we_wrote_ourselves_is_no_override(tmp_path: Path) -> None:
    song = song_in(tmp_path)
    ours = {"parity": {"dance-single": [{"overrides": [[0, 0, "Right"]]}]}}
    sme(tmp_path, {"overrides": [[0, 0, "Right"], [1, 1, "Left"]], "ignores": {}}, dancetutor=ours)
    assert SongFeet(song).author_feet(song.charts[0])[0].cells() == {(48, 1): (LEFT, Part.WHOLE)}
    sme(tmp_path, {"overrides": [[0, 0, "Left"]], "ignores": {}}, dancetutor=ours)  # changed by a person since
    assert SongFeet(song).author_feet(song.charts[0])[0].cells() == {(0, 0): (LEFT, Part.WHOLE)}


def test_a_folder_of_several_songs_has_no_data_of_one(tmp_path: Path) -> None:
    song = song_in(tmp_path)
    sme(tmp_path, {"overrides": [[0, 0, "Right"]], "ignores": {}})
    (tmp_path / "song.ssc").write_text("")
    assert len(SongFeet(song).author_feet(song.charts[0])[0]) == 1
    (tmp_path / "other.sm").write_text("")
    overrides, _, (problem,) = SongFeet(song).author_feet(song.charts[0])
    assert len(overrides) == 0
    assert "several songs" in problem.message
