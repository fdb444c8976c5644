"""The style `theme`: what the cues say, that JSON and Lua say the same, and whose files they are."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from dancetutor_cli.chart import parse
from dancetutor_cli.errors import FileError
from dancetutor_cli.markers import theme
from dancetutor_cli.markers.changes import Lack
from dancetutor_cli.markers.cues import LEAST_TURN, ThemeCue, cues_of
from dancetutor_cli.markers.planning import solve_charts
from dancetutor_cli.play import load_preset, solve_chart

HEAD = '#TITLE:A \\"quoted\\" title;\n#OFFSET:-0.250;\n#BPMS:0=120;\n#NOTES:dance-single::Hard:9::\n'
CROSSOVER = "1000\n0001\n0010\n1000\n0010\n0001\n0010\n1000"  # R L: the left foot steps on the right panel


def cues(rows: str) -> list[ThemeCue]:
    chart = parse(f"{HEAD}{rows}\n;\n".encode(), Path("x.sm")).charts[0]
    play = solve_chart(chart, load_preset("itg"))
    assert play is not None
    return list(cues_of(play))


def test_a_crossover_lasts_until_the_feet_are_uncrossed_or_the_chart_ends() -> None:
    found = [cue for cue in cues("1000\n0010\n0001\n0010\n1000\n0100\n0001\n0000") if cue.kind == "crossover"]
    assert [(cue.tick / 48, cue.ticks / 48, cue.count, cue.foot, cue.way) for cue in found] == [
        (1.0, 1.0, 2, "left", "front"),
        (3.0, 0.0, 1, "left", "front"),
    ]
    for cue in found:
        assert cue.seconds == pytest.approx(cue.ticks / 96)  # 120 BPM: 96 ticks a second
        assert cue.second == pytest.approx(0.25 + cue.tick / 96)  # beat 0 is at 0.25 s


def test_a_chart_that_alternates_has_none() -> None:
    assert cues("1000\n0001\n0100\n0001\n1000\n0010\n1000\n0001") == []


def test_brackets_of_a_passage_are_one() -> None:
    found = [
        cue
        for cue in cues(
            "1000\n0011\n1000\n0011\n1000\n0000\n0000\n0000\n,\n0000\n0000\n1000\n0011\n1000\n0011\n0000\n0000"
        )
        if cue.kind == "bracket"
    ]
    assert [(cue.count, cue.foot, cue.tick / 48, cue.ticks / 48) for cue in found] == [
        (2, "right", 0.5, 1.0),
        (2, "right", 5.5, 1.0),
    ]


def test_turns_say_to_which_side() -> None:
    from dancetutor_cli.chart import load
    from dancetutor_cli.resources import charts_path

    song = load(charts_path() / "two_left_feet" / "two_left_feet.ssc")
    play = solve_chart(song.charts[3], load_preset("itg"))
    assert play is not None
    turns = [cue for cue in cues_of(play) if cue.kind == "turn"]
    assert [(cue.tick / 48, cue.way) for cue in turns] == [(45.5, "right")]
    for cue in turns:
        row = play.rows.tick.tolist().index(cue.tick)
        assert "spin" in play.moves[row] or abs(play.facing[row] - play.facing[row - 1]) >= LEAST_TURN - 1e-6


def said(path: Path) -> dict[str, Any]:
    song = parse(f"{HEAD}{CROSSOVER}\n;\n".encode(), path)
    problems: list[Lack] = []
    feet = list(solve_charts(song, song.charts, lambda chart: load_preset("itg"), [], problems))
    return theme.write(path, None, song, feet)


def lua_value(text: str) -> Any:
    """What a Lua table of this style means: its signs are near enough to JSON's."""
    assert text.startswith("-- dancetutor cues")
    body = re.sub(r"\\(\d{3})", lambda match: f"\\u{int(match[1]):04x}", text.split("\nreturn ", 1)[1])
    strings: list[str] = []

    def keep(match: re.Match[str]) -> str:
        strings.append(match[0])
        return f"@{len(strings) - 1}@"

    body = re.sub(r'"(?:\\.|[^"\\])*"', keep, body)
    body = re.sub(r",(\s*})", r"\1", re.sub(r"(\w+) = ", r'"\1": ', body))
    return _filled(json.loads(_lists(body)), strings)


def _lists(body: str) -> str:
    """Braces that hold no key at once become brackets."""
    out, stack = [], []
    for at, letter in enumerate(body):
        if letter == "{":
            is_list = not body[at + 1 :].lstrip().startswith('"')
            stack.append(is_list)
            out.append("[" if is_list else "{")
        elif letter == "}":
            out.append("]" if stack.pop() else "}")
        else:
            out.append(letter)
    return re.sub(r"@(\d+)@", r'"@\1@"', "".join(out))


def _filled(value: Any, strings: list[str]) -> Any:
    if isinstance(value, dict):
        return {key: _filled(one, strings) for key, one in value.items()}
    if isinstance(value, list):
        return [_filled(one, strings) for one in value]
    if isinstance(value, str):
        return json.loads(strings[int(value.strip("@"))])
    return value


def test_json_and_lua_say_the_same() -> None:
    table = said(Path("x.sm"))
    assert json.loads(theme.as_json(table)) == table
    assert lua_value(theme.as_lua(table).decode()) == table
    assert table["title"] == 'A "quoted" title'


def test_what_other_charts_have_stays_and_strangers_are_left_alone() -> None:
    table = said(Path("x.sm"))
    old = theme.as_json(table)
    song = parse(f"{HEAD}{CROSSOVER}\n;\n".encode(), Path("x.sm"))
    assert theme.write(Path("x.cues.json"), old, song, ())["charts"] == table["charts"]
    for stranger in (b"{}", b"[1]", b'{"program": "dancetutor", "charts": [{}]}', b"\xff"):
        with pytest.raises(FileError, match="no table of dancetutor's cues"):
            theme.charts_in(Path("x.cues.json"), stranger)
    with pytest.raises(FileError, match="no table of dancetutor's cues"):
        theme.check_lua(Path("x.cues.lua"), b"return {}")
