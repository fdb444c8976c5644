"""The style `theme`: what the cues say, that JSON and Lua say the same, and whose files they are."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from dancetutor_cli.chart.reader import parse
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_chart
from dancetutor_cli.markers import theme
from dancetutor_cli.markers.plan import solve_charts
from dancetutor_cli.markers.theme import LEAST_TURN, ThemeCue, cues_of
from dancetutor_cli.run.errors import FileError

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
    from dancetutor_cli.chart.reader import load
    from dancetutor_cli.run.reading import charts_path

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
    feet = solve_charts(song, song.charts, lambda chart: load_preset("itg")).charts
    return theme.cue_table(path, None, song, feet)


def lua_value(value: Any) -> Any:
    """A Lua table as plain data: with keys from 1 on it is a list; an empty one is a list, too."""
    if not hasattr(value, "items"):
        return value
    items = dict(value.items())
    if all(isinstance(key, int) for key in items):
        return [lua_value(items[key]) for key in range(1, len(items) + 1)]
    return {key: lua_value(one) for key, one in items.items()}


def lua_of(version: str) -> Any:
    """A real Lua, from the package lupa of the development tools."""
    return pytest.importorskip(f"lupa.{version}", reason="no lupa here: pip install -e '.[dev]'").LuaRuntime()


@pytest.mark.parametrize("version", ["lua51", "lua52", "lua53", "lua54", "luajit21"])
def test_every_lua_reads_the_table(version: str) -> None:
    table = said(Path("x.sm"))
    lua = lua_of(version)
    assert lua_value(lua.execute(theme.as_lua(table).decode())) == table


ANY_TEXT = 'a"\\\n\r\t\0\x1b]]--é日\u2028'


def test_any_text_comes_back_from_lua() -> None:
    table = {**said(Path("x.sm")), "title": ANY_TEXT}
    read = lua_of("lua51").execute(theme.as_lua(table).decode())
    assert read["title"] == ANY_TEXT


GAME = """
shown, update, listing = {}, nil, ...
PLAYER_1, SCREEN_CENTER_X = "PlayerNumber_P1", 427
beat = 0
local steps = {GetStepsType = function() return "StepsType_Dance_Single" end,
  GetDifficulty = function() return "Difficulty_Hard" end}
GAMESTATE = {GetCurrentSong = function() return {GetSongDir = function() return "/Songs/P/x/" end} end,
  GetCurrentSteps = function() return steps end,
  GetSongPosition = function() return {GetSongBeat = function() return beat end} end}
FILEMAN = {GetDirListing = function(_, pattern, only_dirs, with_path)
  assert(pattern == "/Songs/P/x/*.cues.lua" and only_dirs == false and with_path == true)
  return {"/Songs/P/x/x.cues.lua"} end}
function loadfile(name) assert(name == "/Songs/P/x/x.cues.lua") return loadstring(listing) end
Def = {ActorFrame = function(t) return t end, BitmapText = function(t) return t end}
"""
PLAY = """
local actor = example()
local word = {settext = function(_, text) shown[#shown + 1] = text end}
local frame = {GetChild = function(_, name) assert(name == "Word") return word end}
actor.InitCommand({SetUpdateFunction = function(_, f) update = f end})
for _, at in ipairs({...}) do beat = at update(frame) end
return shown
"""


def test_the_example_of_the_docs_runs_in_the_games_lua() -> None:
    """Lua 5.1 with as much of the game as it asks for: two beats ahead a cue is told, and gone when it is over."""
    text = (Path(__file__).parents[2] / "docs" / "theme.md").read_text(encoding="utf-8")
    (example,) = re.findall(r"```lua\n(.*?)```", text, re.DOTALL)
    table = said(Path("x.sm"))
    (chart,) = table["charts"]
    first = chart["cues"][0]
    lua = lua_of("lua51")
    lua.execute("example, game, play = ...", lua.compile(example), lua.compile(GAME), lua.compile(PLAY))
    lua.globals().game(theme.as_lua(table).decode())
    beats = [first["beat"] - 2.5, first["beat"] - 1.5, chart["cues"][-1]["beat"] + 60]
    shown = list(lua.globals().play(*beats).values())
    assert shown == ["", f"{first['kind']} {first['foot']}", ""]


def test_json_says_the_table() -> None:
    table = said(Path("x.sm"))
    assert json.loads(theme.as_json(table)) == table
    assert table["title"] == 'A "quoted" title'


def test_what_other_charts_have_stays_and_strangers_are_left_alone() -> None:
    table = said(Path("x.sm"))
    old = theme.as_json(table)
    song = parse(f"{HEAD}{CROSSOVER}\n;\n".encode(), Path("x.sm"))
    assert theme.cue_table(Path("x.cues.json"), old, song, ())["charts"] == table["charts"]
    for stranger in (b"{}", b"[1]", b'{"program": "dancetutor", "charts": [{}]}', b"\xff"):
        with pytest.raises(FileError, match="not a table of cues by dancetutor"):
            theme.charts_in(Path("x.cues.json"), stranger)
    with pytest.raises(FileError, match="not a table of cues by dancetutor"):
        theme.check_lua(Path("x.cues.lua"), b"return {}")
