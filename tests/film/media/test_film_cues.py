"""The moves that subtitles name, of charts whose moves are known by heart."""

from __future__ import annotations

import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from dancetutor_cli.__main__ import main
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.film.media.subtitles import cues_of, subtitle_words
from dancetutor_cli.film.notes import Cue
from dancetutor_cli.film.overlay.sprites import callout_words
from dancetutor_cli.film.words import PanelNames
from dancetutor_cli.lint.subject import solved_chart
from dancetutor_cli.run.languages import load_language

ENGLISH = load_language()
HEAD = "#TITLE:T;\n#MUSIC:;\n#OFFSET:0;\n#BPMS:0=120;\n#NOTES:\n dance-single:\n x:\n Hard:\n 9:\n 0,0,0,0,0:\n"
LEFT, RIGHT = ("left foot",), ("right foot",)


def cues(rows: str) -> list[Cue]:
    song = parse((HEAD + rows.replace(" ", "\n") + "\n;\n").encode(), Path("song.sm"))
    play = solved_chart(song, song.charts[0], load_preset("itg")).play
    pad = load_pad("dance-single")
    assert play is not None and pad is not None
    return list(cues_of(play, song.charts[0].timing, subtitle_words(ENGLISH), PanelNames(pad, False, ENGLISH)))


def test_a_crossover_lasts_until_the_feet_are_back() -> None:
    # left, up, right with the left foot in front or behind, up, left: quarter notes at 120 BPM
    found = [one for one in cues("1000 0010 0001 0010 , 1000 0001 1000 0001") if "crossover" in one.text]
    assert len(found) == 1
    assert found[0].who == LEFT and found[0].second == 1.0
    assert found[0].text in ("crossover behind", "crossover in front")
    assert 1.5 <= found[0].end <= 2.0


def test_candles_jumps_and_jacks_have_their_feet() -> None:
    found = cues("0100 0001 0010 0001 , 1001 0000 1000 1000")
    assert Cue(1.0, 1.0, "long step", LEFT, "candle") in found
    assert Cue(2.0, 2.0, "jump", (), "jump") in found
    assert any(one.text == "same panel again" and one.second == 3.5 and len(one.who) == 1 for one in found)


def test_words_are_a_dancers_and_the_same_that_are_called_out() -> None:
    """No candles, doublesteps or jacks: who steps again, on which panels, how far."""
    told, called = subtitle_words(ENGLISH), callout_words(ENGLISH)
    assert {*told, *called} >= {"candle", "jack", "doublestep", "drill", "unplayable"}
    for name, words in (*told.items(), *called.items()):
        assert not re.search("candle|double ?step|jack|bracket|drill|gallop|stream", words), name
    assert all(told[name] == called[name] for name in set(told) & set(called))


class ThreeRows:
    """Of a play, without holds."""

    second, hold_end = np.array([1.0, 2.0, 3.0]), np.full((3, 4), -1)

    def __len__(self) -> int:
        return 3


def test_subtitles_name_doublesteps_and_brackets_as_the_notes_do() -> None:
    pad = load_pad("dance-single")
    assert pad is not None
    rows = ThreeRows()
    limb = np.array([[-1, -1, -1, 1], [0, 0, 1, 1], [0, 1, 2, 3]], dtype=np.int8)
    feet = np.array([[0, 3], [0, 3], [0, 1]])
    moves = (("doublestep",), ("bracket", "doublestep"), ("hand",))
    play: Any = SimpleNamespace(rows=rows, limb=limb, feet=feet, moves=moves, facing=np.zeros(3))
    words, timing = (
        subtitle_words(ENGLISH),
        parse((HEAD + "0000\n;\n").encode(), Path("song.sm")).charts[0].timing,
    )
    found = [(one.text, one.who, one.move) for one in cues_of(play, timing, words, PanelNames(pad, False, ENGLISH))]
    assert found == [
        ("right foot: twice in a row", (), "doublestep"),
        ("left foot: heel on left, toe on down", (), "bracket"),
        ("right foot: heel on right, toe on up", (), "bracket"),
        ("left hand down", (), "hand"),
        ("right hand down", (), "hand"),
    ]
    turned = [one.text for one in cues_of(play, timing, words, PanelNames(pad, True, ENGLISH))]
    assert turned[1] == "left foot: heel on right, toe on up"


def test_a_hold_lasts_as_long_as_it_is_held() -> None:
    found = cues("2000 0000 0000 3000 , 0001 0000 0000 0000")
    assert [(one.second, one.end) for one in found if one.text == "hold"] == [(0.0, 1.5)]


def test_a_film_without_moves_says_so_and_leaves_no_old_subtitles(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    song, film, old = tmp_path / "song.sm", tmp_path / "film.mp4", tmp_path / "film.srt"
    song.write_text(HEAD + "1000\n0001\n1000\n0001\n,\n0110\n0000\n0000\n0000\n;\n")
    options = (
        "-o",
        str(film),
        "--srt",
        "--size",
        "64x64",
        "--layout",
        "highway",
        "--fps",
        "10",
        "--jobs",
        "1",
        "--mute",
    )
    for section, told in ((("--section", "1:3"), True), (("--section", "0:1"), False)):
        with pytest.raises(SystemExit) as stop:
            main(["render", str(song), *options, *section])
        assert stop.value.code == 0
        assert old.exists() == told
        assert ("there is no film.srt" in capsys.readouterr().err) != told
