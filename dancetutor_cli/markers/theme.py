"""Cues for themes: coming moves with their start and length, in `SONG.cues.json` and `SONG.cues.lua`."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.play import Play, crossover_spans
from dancetutor_cli.markers.model import (
    ChartFeet,
    FileChange,
    change_of,
    check_is_ours,
    json_lines,
    old_content,
    own_json,
    removal_of,
)
from dancetutor_cli.markers.sidecar import notes_hash
from dancetutor_cli.run.files import encode_json

# The moves that a theme can announce to a player: crossovers, brackets and turns.

CROSSOVER, BRACKET, TURN = "crossover", "bracket", "turn"
KINDS = (CROSSOVER, BRACKET, TURN)
LEAST_TURN = 135.0  # degrees between two rows with steps; a smaller change is not a turn
_NEAR = TICKS_PER_BEAT  # brackets at most a beat apart are one passage
_EPSILON = 1e-6
_FEET = {Limb.LEFT_FOOT: "left", Limb.RIGHT_FOOT: "right"}


@dataclass(frozen=True, slots=True)
class ThemeCue:
    """One passage.

    kind : of `KINDS`; tick, second : of its first row; ticks, seconds : to its end, 0 for a single row
    foot : "left", "right" or "both"; count : rows that do it; way : "front", "back", "full" of a crossover, "left" or
    "right" of a turn, "" of a bracket
    """

    kind: str
    tick: int
    second: float
    ticks: int
    seconds: float
    foot: str
    count: int
    way: str = ""


def cues_of(play: Play) -> tuple[ThemeCue, ...]:
    """Return all cues of a play, by time. A crossover ends with the row that uncrosses the feet."""
    return tuple(sorted((*_crossovers(play), *_brackets(play), *_turns(play)), key=lambda cue: (cue.tick, cue.kind)))


def _crossovers(play: Play) -> Iterator[ThemeCue]:
    for span in crossover_spans(play):
        rows = range(span.first, span.last + 1)
        moves = {name.removeprefix("crossover-") for row in rows for name in play.moves[row]}
        way = next((name for name in ("full", "front", "back") if name in moves), "")
        yield _cue(play, CROSSOVER, (span.first, span.end), rows, way=way, who=_limb_names(play, span.first))


def _brackets(play: Play) -> Iterator[ThemeCue]:
    rows = [row for row, moves in enumerate(play.moves) if "bracket" in moves]
    for passage in _near(rows, play.rows.tick.tolist()):
        feet = {foot for row in passage for foot in _limb_names(play, row, bracketing=True)}
        yield _cue(play, BRACKET, (passage[0], passage[-1]), passage, who=feet)


def _turns(play: Play) -> Iterator[ThemeCue]:
    """Yield the rows to which the body turns by at least `LEAST_TURN`, or past 180 degrees; the first row is never a
    turn.
    """
    if len(play.rows) < 2:
        return
    steps = np.diff(play.facing)
    around = np.array(["spin" in moves for moves in play.moves])[1:]
    turn = np.where(around, steps, (steps + 180.0) % 360.0 - 180.0)
    for row in (np.flatnonzero(around | (np.abs(turn) >= LEAST_TURN - _EPSILON)) + 1).tolist():
        way = "left" if turn[row - 1] > 0 else "right"
        yield _cue(play, TURN, (row, row), (row,), way=way, who=_limb_names(play, row))


def _cue(
    play: Play, kind: str, span: tuple[int, int], rows: Sequence[int], *, way: str = "", who: set[str]
) -> ThemeCue:
    first, end = span
    ticks, seconds = play.rows.tick, play.rows.second
    foot = who.pop() if len(who) == 1 else "both"
    return ThemeCue(
        kind,
        int(ticks[first]),
        float(seconds[first]),
        int(ticks[end] - ticks[first]),
        float(seconds[end] - seconds[first]),
        foot,
        len(rows),
        way,
    )


def _limb_names(play: Play, row: int, bracketing: bool = False) -> set[str]:
    limbs = [Limb(one) for one in play.limb[row].tolist() if one in _FEET]
    wanted: Callable[[Limb], bool] = (lambda one: limbs.count(one) > 1) if bracketing else (lambda one: True)
    return {_FEET[one] for one in limbs if wanted(one)}


def _near(rows: Sequence[int], ticks: Sequence[int]) -> Iterator[list[int]]:
    passage: list[int] = []
    for row in rows:
        if passage and ticks[row] - ticks[passage[-1]] > _NEAR:
            yield passage
            passage = []
        passage.append(row)
    if passage:
        yield passage


# The style `theme`: the cues in two files beside the chart file, as JSON and as Lua.

JSON, LUA = ".cues.json", ".cues.lua"
_SCHEMA = 1
_HEAD = b"-- dancetutor cues"  # first words of this program's Lua tables
_OURS = "a table of cues by dancetutor"


def write(song: Song, folder: Path, feet: Sequence[ChartFeet]) -> Iterator[FileChange]:
    """Yield the two files of a song; the .sm and the .ssc share them."""
    table, lua = (folder / (song.path.stem + suffix) for suffix in (JSON, LUA))
    old, script = old_content(table, song), old_content(lua, song)
    check_lua(lua, script)
    content = cue_table(table, old, song, feet)
    yield change_of(table, old, as_json(content))
    yield change_of(lua, script, as_lua(content))


def strip(song: Song, charts: Sequence[Chart]) -> Iterator[FileChange]:
    """Yield the two files without some charts of a song."""
    table, lua = (song.path.with_name(song.path.stem + suffix) for suffix in (JSON, LUA))
    old, script = old_content(table, song), old_content(lua, song)
    check_lua(lua, script)
    gone = {chart.index for chart in charts}
    kept = [entry for entry in charts_in(table, old) if entry["index"] not in gone]
    content = {**cue_table(table, None, song, ()), "charts": kept}
    yield removal_of(table, old, as_json(content) if kept and old else None)
    yield removal_of(lua, script, as_lua(content) if kept and script else None)


def cue_table(path: Path, old: bytes | None, song: Song, feet: Sequence[ChartFeet]) -> dict[str, Any]:
    """Return the content of the files, from the old JSON at `path` and new charts; charts that are not in `feet` stay.

    Raises FileError if this program did not write the old file.
    """
    new = {one.chart.index: _entry(one) for one in feet}
    kept = [entry for entry in charts_in(path, old) if entry["index"] not in new and entry["index"] < len(song.charts)]
    charts = sorted([*kept, *new.values()], key=lambda entry: int(entry["index"]))
    return {"schema": _SCHEMA, "program": "dancetutor", "title": song.title, "charts": charts}


def charts_in(path: Path, old: bytes | None) -> list[Any]:
    """Return the charts of an old JSON file. Raises FileError if this program did not write it."""
    if old is None:
        return []
    return list(own_json(path, old, _OURS, _holds_charts)["charts"])


def _holds_charts(data: Any) -> bool:
    return all(isinstance(entry["index"], int) for entry in data["charts"])


def check_lua(path: Path, old: bytes | None) -> None:
    """Raise FileError if this program did not write the old Lua file."""
    check_is_ours(path, old is None or old.startswith(_HEAD), _OURS)


def as_json(table: dict[str, Any]) -> bytes:
    """Return the JSON file, with a line for each cue."""
    head = {key: value for key, value in table.items() if key != "charts"}
    blocks = []
    for chart in table["charts"]:
        about = json.dumps({key: value for key, value in chart.items() if key != "cues"}, ensure_ascii=False)
        cues = json_lines(chart["cues"])
        blocks.append(f'  {about[:-1]}, "cues": [\n{cues}]}}' if cues else f'  {about[:-1]}, "cues": []}}')
    text = json.dumps(head, ensure_ascii=False)[:-1] + ', "charts": [\n' + ",\n".join(blocks) + "]}\n"
    return encode_json(text)


def as_lua(table: dict[str, Any]) -> bytes:
    """Return the Lua file: a chunk that returns the same table and calls no function."""
    body = "\n".join(_lua_lines(table, 0))
    return _HEAD + b"; docs/theme.md explains the fields\nreturn " + encode_json(body) + b"\n"


def _lua_lines(value: Any, depth: int) -> Iterator[str]:
    inner, outer = "\t" * (depth + 1), "\t" * depth
    if isinstance(value, dict) and not any(isinstance(one, dict | list) for one in value.values()):
        yield "{" + ", ".join(f"{key} = {_lua(one)}" for key, one in value.items()) + "}"
    elif isinstance(value, dict | list):
        yield "{"
        pairs = value.items() if isinstance(value, dict) else ((None, one) for one in value)
        for key, one in pairs:
            lines = list(_lua_lines(one, depth + 1))
            lines[0] = f"{inner}{lines[0]}" if key is None else f"{inner}{key} = {lines[0]}"
            yield from (*lines[:-1], lines[-1] + ",")
        yield outer + "}"
    else:
        yield _lua(value)


def _lua(value: Any) -> str:
    """Return a number, or a text in a form that every version of Lua reads."""
    if isinstance(value, int | float):
        return repr(value) if math.isfinite(value) else "0"
    letters = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\r": "\\r"}
    return '"' + "".join(letters.get(c) or (c if c >= " " else f"\\{ord(c):03d}") for c in str(value)) + '"'


def _entry(one: ChartFeet) -> dict[str, Any]:
    chart = one.chart
    kind = "_".join(part.capitalize() for part in chart.steps_type.split("-"))
    return {
        "index": chart.index,
        "steps_type": f"StepsType_{kind}",
        "difficulty": f"Difficulty_{chart.difficulty}",
        "meter": chart.meter,
        "description": chart.description,
        "notes_sha256": notes_hash(chart),
        "cues": [_cue_entry(cue) for cue in cues_of(one.play)],
    }


def _cue_entry(cue: ThemeCue) -> dict[str, Any]:
    assert cue.kind in KINDS
    return {
        "kind": cue.kind,
        "beat": round(cue.tick / TICKS_PER_BEAT, 3),
        "second": round(cue.second, 3),
        "beats": round(cue.ticks / TICKS_PER_BEAT, 3),
        "seconds": round(cue.seconds, 3),
        "foot": cue.foot,
        "count": cue.count,
        "way": cue.way,
    }
