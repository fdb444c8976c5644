"""Subtitles: every named move, in time to be read, one after the other, and read back by a parser and by ffmpeg."""

from __future__ import annotations

import re
import subprocess
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from dancetutor_cli.film.clock import Clock, Pass
from dancetutor_cli.film.media import subtitles as module
from dancetutor_cli.film.media.subtitles import SubtitleStyle, subtitle_style, subtitles
from dancetutor_cli.film.notes import Cue
from dancetutor_cli.run import ffmpeg
from dancetutor_cli.run.errors import FileError

STYLE = SubtitleStyle(1.0, 0.25, 0.7, 2, ("spin", "jump", "jack"))
_BLOCK = re.compile(r"(\d+)\n(\d\d:\d\d:\d\d,\d{3}) --> (\d\d:\d\d:\d\d,\d{3})\n((?:.+\n)+)(?:\n|\Z)")


def parsed(text: str) -> list[tuple[float, float, str]]:
    """What an .srt file says: start, end, words. Fails on anything that is no subtitle."""
    out, at = [], 0
    for match in _BLOCK.finditer(text):
        assert match.start() == at, text[at:]
        at = match.end()
        assert int(match[1]) == len(out) + 1
        out.append((seconds(match[2]), seconds(match[3]), match[4].rstrip("\n")))
    assert at == len(text), text[at:]
    return out


def seconds(stamp: str) -> float:
    hours, minutes, rest = stamp.replace(",", ".").split(":")
    return int(hours) * 3600 + int(minutes) * 60 + float(rest)


def cue(second: float, text: str = "spin", end: float | None = None, who: tuple[str, ...] = ()) -> Cue:
    return Cue(second, second if end is None else end, text, who, text)


def test_words_stand_before_their_move_until_it_is_over_in_each_run() -> None:
    clock = Clock((Pass(0.0, 4.0, 0.5), Pass(0.0, 4.0)), 30)
    text = subtitles((cue(2.0, end=2.5, who=("left foot",)),), clock, STYLE)
    assert parsed(text) == [
        (3.0, pytest.approx(5.25), "spin, left foot"),  # half speed: the move comes at second 4 and lasts one
        (9.0, pytest.approx(10.75), "spin, left foot"),
    ]


def test_moves_that_come_fast_are_named_together_and_the_most_important_are_kept() -> None:
    clock = Clock((Pass(0.0, 10.0),), 30)
    fast = (cue(5.0, "jack", who=("left foot",)), cue(5.1, "jack", who=("right foot",)), cue(5.2, "spin"))
    assert parsed(subtitles(fast, clock, STYLE)) == [(4.0, 5.7 - 0.25, "jack, left foot, right foot\nspin")]
    assert parsed(subtitles((*fast, cue(5.3, "jump")), clock, STYLE))[0][2] == "spin\njump"


def test_the_same_words_again_are_left_standing() -> None:
    clock = Clock((Pass(0.0, 10.0),), 30)
    assert parsed(subtitles([cue(2.0 + k) for k in range(5)], clock, STYLE)) == [(1.0, 6.25, "spin")]


def test_count_in_and_parts_outside_are_not_reported() -> None:
    clock = Clock((Pass(2.0, 6.0, 1.0, sound_from=4.0, count=4),), 30)
    assert subtitles((cue(1.0), cue(3.0), cue(6.0)), clock, STYLE) == ""
    assert parsed(subtitles((cue(4.0),), clock, STYLE)) == [(1.0, 2.25, "spin")]


@given(
    times=st.lists(st.floats(0, 20), min_size=1, max_size=40),
    words=st.lists(st.sampled_from(["spin", "jump", "jack"]), min_size=40, max_size=40),
    length=st.floats(0, 3),
    rates=st.lists(st.floats(0.25, 2.0), min_size=1, max_size=3),
)
def test_any_moves_can_be_read(times: list[float], words: list[str], length: float, rates: list[float]) -> None:
    cues = [cue(t, w, t + length) for t, w in zip(sorted(times), words, strict=False)]
    clock = Clock(tuple(Pass(0.0, 20.5, rate) for rate in rates), 30)
    told = parsed(subtitles(cues, clock, STYLE))
    for start, end, _ in told:
        assert end - start >= STYLE.shortest - 0.002
        assert start >= 0 and end <= clock.seconds + 0.002
    for (_, end, _), (start, _, _) in pairwise(told):
        assert end <= start + 1e-9
    passed = 0.0
    for rate in rates:  # words of each move stand when it comes, or, in a hurry, until just before; none come too late
        for one in cues:
            at = passed + one.second / rate
            near = [text for start, end, text in told if start <= at + 0.002 and end >= at - STYLE.shortest]
            assert any(one.text in text or text.count("\n") == STYLE.most - 1 for text in near), (at, told)
        passed += 20.5 / rate


def test_ffmpeg_reads_what_is_written(tmp_path: Path) -> None:
    clock = Clock((Pass(0.0, 4000.0),), 30)
    file = tmp_path / "film.srt"
    file.write_text(subtitles([cue(t, w) for t, w in ((2, "spin"), (5, "jump"), (3700, "jack"))], clock, STYLE))
    command = [ffmpeg.executable(), "-v", "error", "-i", str(file), "-f", "webvtt", "-"]
    read = subprocess.run(command, capture_output=True, text=True, check=True)
    assert read.stderr == ""
    assert "00:01.000 --> 00:02.250\nspin" in read.stdout
    assert "01:01:39.000 --> 01:01:40.250\njack" in read.stdout
    assert read.stdout.count("-->") == 3


def test_the_configuration_names_moves_that_exist(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert {"jump", "candle", "hold", "spin", "bracket"} <= set(subtitle_style().moves)
    path = tmp_path / "subtitles.yaml"
    monkeypatch.setattr(module, "config_path", lambda name: path)
    for text, said in (
        ("before: 1\nstays: 0.2\nshortest: 0.7\nmost: 2\nmoves: [crossofer]\n", "no move 'crossofer'"),
        ("before: 0.1\nstays: 0.2\nshortest: 0.7\nmost: 2\nmoves: []\n", "shortest <= before"),
    ):
        path.write_text(text)
        module.subtitle_style.cache_clear()
        with pytest.raises(FileError, match=re.escape(said)):
            module.subtitle_style()
    module.subtitle_style.cache_clear()
