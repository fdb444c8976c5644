"""Plays in the JSON of `analyze` (docs/formats.md): the writer of rows, and the reader of plays from any program."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Chart
from dancetutor_cli.chart.names import TICKS_PER_BEAT, TICKS_PER_MEASURE
from dancetutor_cli.feet.limbs import Limb, Part
from dancetutor_cli.feet.play import Play, Rows, StepKind
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import read_json, shown_key

# Most rows repeat others: apart from the time, the line, the margin and the confidence, the text of equal rows is made
# once and cached.

_LIMBS = {int(limb): limb.name.lower() for limb in Limb if limb >= 0}
_KINDS = {int(kind): kind.name.lower() for kind in StepKind}
_PARTS = {int(Part.HEEL): "heel", int(Part.TOE): "toe"}
_SMALL, _LARGE = 0.001, 1e9  # beyond these limits, fixed-point text differs from the `repr` of a float
_UNASKED, _UNKNOWN = -1.0, -2.0  # confidence that the preset does not have, and confidence of rows without a step
_BETWEEN = ", "
_MAX_CACHED = 100_000  # limit of cached texts, so that a long run does not fill the memory


def json_rows(play: Play, file_lines: NDArray[np.int32]) -> str:
    """Return a JSON list with one object for each row with a step, keys in the documented order.

    A row of mines only is included if it costs something, so that the costs of the rows add up to the chart's cost.
    file_lines : (rows,), the line in the file of each row
    """
    is_shown = np.asarray(play.rows.steps.any(axis=1))
    others = np.flatnonzero(~is_shown)
    is_shown[others] = (play.cost[others] != 0).any(axis=1)
    shown = np.flatnonzero(is_shown)
    looks = _looks(play, shown)
    costs = _cached_texts(_bytes(shown, play.cost), _text_cache(play.terms), lambda at: _terms(play, int(shown[at])))
    margins = [-1] * len(shown) if play.margin is None else play.margin[shown].tolist()
    sure = [_UNASKED] * len(shown)
    if play.confidence is not None:
        sure = np.nan_to_num(play.confidence[shown], nan=_UNKNOWN).tolist()
    parts = (
        map(_beat, play.rows.tick[shown].tolist()),
        map(_second, play.rows.second[shown].tolist()),
        map(_line, file_lines[shown].tolist()),
        looks,
        costs,
        map(_end, margins, sure),
    )
    pieces = [""] * (len(parts) * len(shown))
    for place, part in enumerate(parts):
        pieces[place :: len(parts)] = part
    if pieces:
        pieces[-1] = pieces[-1][: -len(_BETWEEN)]
    return "".join(("[", *pieces, "]"))


def _second(second: float) -> str:
    if abs(second) < _SMALL or second > _LARGE:
        return repr(round(second, 6))
    decimals = f"{second:.6f}".rstrip("0")  # the same text as `repr` of the rounded number, in a third of the time
    return f"{decimals}0" if decimals[-1] == "." else decimals


@lru_cache(maxsize=_MAX_CACHED)
def _beat(tick: int) -> str:
    """Return the text at the start of a row, up to its second."""
    return f'{{"beat": {round(tick / TICKS_PER_BEAT, 6)!r}, "measure": {tick // TICKS_PER_MEASURE}, "second": '


@lru_cache(maxsize=_MAX_CACHED)
def _line(line: int) -> str:
    return f', "line": {line}, '


@lru_cache(maxsize=_MAX_CACHED)
def _end(margin: int, sure: float) -> str:
    """Return the end of a row, with the separator after it. sure : `Play.confidence`, `_UNASKED` or `_UNKNOWN`"""
    text = "null" if margin < 0 else str(margin)
    if sure != _UNASKED:
        text += f', "confidence": {"null" if sure == _UNKNOWN else repr(round(100 * sure, 1))}'
    return f"{text}}}{_BETWEEN}"


def _looks(play: Play, shown: NDArray[np.intp]) -> list[str]:
    """Return the text of the steps, feet, facing and moves of some rows."""
    moves = np.fromiter(map(id, play.moves), np.int64, len(play.moves)) if play.events is None else play.events
    known: dict[bytes, str] = {} if play.events is None else _text_cache(play.limb.shape[1])
    rows = play.rows
    keys = _bytes(shown, rows.steps, play.limb, play.part, play.feet, play.facing[:, None], moves[:, None])
    return _cached_texts(keys, known, lambda at: _pose(play, int(shown[at])))


def _cached_texts(keys: list[bytes], known: dict[bytes, str], say: Callable[[int], str]) -> list[str]:
    """Return the cached text of each key; the text of a new key is made by `say` from its index."""
    if len(known) > _MAX_CACHED:
        known.clear()
    texts = [*map(known.get, keys)]
    for place, (key, text) in enumerate(zip(keys, texts, strict=True)):
        if text is None:
            texts[place] = known[key] = known.get(key) or say(place)
    return cast("list[str]", texts)


@lru_cache(maxsize=64)
def _text_cache(kind: int | tuple[str, ...]) -> dict[bytes, str]:
    """Return the cache of texts by the bytes they are made from.

    kind : the number of columns, for the text of steps, feet, facing and moves; the cost terms, for the text of costs
    """
    return {}


def _bytes(shown: NDArray[np.intp], *arrays: NDArray[Any]) -> list[bytes]:
    """Return the bytes of all arrays in each of some rows, as keys of a cache."""
    table = np.concatenate([np.ascontiguousarray(array[shown]).view(np.uint8) for array in arrays], axis=1)
    keys: list[bytes] = table.view(f"V{table.shape[1]}").ravel().tolist() if table.size else [b""] * len(table)
    return keys


def _pose(play: Play, row: int) -> str:
    left, right = (None if panel < 0 else panel for panel in play.feet[row].tolist())
    limbs, parts = play.limb[row].tolist(), play.part[row].tolist()
    texts: dict[str, Any] = {
        "steps": [
            {"column": column, "limb": _LIMBS.get(limbs[column]), "kind": _KINDS[kind],
             "part": _PARTS.get(parts[column])}
            for column, kind in enumerate(play.rows.steps[row].tolist())
            if kind
        ],
        "feet": {"left": left, "right": right},
        "facing": round(float(play.facing[row]), 6),
    }  # fmt: skip
    return f'{json.dumps(texts)[1:-1]}, "moves": {json.dumps(play.moves[row])}, '


def _terms(play: Play, row: int) -> str:
    costs = {term: cost for term, cost in zip(play.terms, play.cost[row].tolist(), strict=True) if cost}
    return f'"cost": {json.dumps(costs)}, "margin": '


# Plays from the JSON of `analyze --format json`, so that any program can drive the dancer.
#
# The rows come from the chart; the file has the limb of each step, and the places of the feet and the facing after each
# row. It is an error if a step has no limb, or if the chart does not have a row of the file.

SCHEMA = 1
_LIMB_NUMBERS = {limb.name.lower(): int(limb) for limb in Limb if limb >= 0}
_PART_NUMBERS = {"heel": int(Part.HEEL), "toe": int(Part.TOE)}


def read_play(path: Path, chart: Chart, rows: Rows) -> Play:
    """Read the play of `chart` from a JSON file.

    Parameters
    ----------
    path : the file; chart : the chart of the play, identified by index, steps type and player
    rows : the rows of the chart, from `play.prepare_rows`, with c panels

    Raises FileError if the file does not have this format, or does not fit the chart.
    """
    table = _rows_by_tick(path, _chart_data(path, chart))
    n, c = rows.steps.shape
    limb, part = np.full((n, c), Limb.NONE, dtype=np.int8), np.zeros((n, c), dtype=np.uint8)
    feet, facing = np.full((n, 2), -1, dtype=np.int16), np.zeros(n)
    moves: list[tuple[str, ...]] = []
    reserved = np.full(2, -1, dtype=np.int64)  # tick until which a foot holds its panel
    for i, tick in enumerate(rows.tick.tolist()):
        row = table.pop(tick, None)
        if row is None and rows.steps[i].any():
            raise FileError(path, f"{chart.label}: beat {tick / TICKS_PER_BEAT:g} is missing")
        if row is None:
            feet[i], facing[i] = (feet[i - 1], facing[i - 1]) if i else (-1, 0.0)
            _leave_mines(feet[i], rows.mines[i], tick < reserved)
            moves.append(())
            continue
        _steps(path, row, tick, rows.steps[i], limb[i], part[i])
        feet[i] = [_panel(path, row, side, c) for side in ("left", "right")]
        facing[i] = _number(path, row, "facing")
        for side in (0, 1):
            reserved[side] = max(reserved[side], rows.hold_end[i][limb[i] == side].max(initial=-1))
        moves.append(tuple(str(m) for m in _listed(path, row, "moves")))
    if table:
        raise FileError(path, f"{chart.label}: the chart has no row at beat {min(table) / TICKS_PER_BEAT:g}")
    return Play(rows, limb, part, feet, facing, (), np.zeros((n, 0), dtype=np.int64), None, tuple(moves), path.name)


def _chart_data(path: Path, chart: Chart) -> list[Any]:
    data = read_json(path, writer="analyze --format json")
    try:
        if data["schema"] != SCHEMA:
            raise FileError(path, f"written in schema {data['schema']}; this program reads {SCHEMA}")
        charts = [c for file in data["files"] for c in file["charts"]]
        here = (chart.index, chart.written_type, chart.player)
        fitting = [c for c in charts if (c["index"], c["steps_type"], c.get("player", 0)) == here]
    except (KeyError, TypeError):
        raise FileError(path, "not the JSON of `dancetutor analyze --format json`") from None
    if not fitting:
        raise FileError(path, f"holds no chart {chart.index} ({chart.label})")
    rows = fitting[0].get("rows")
    if not isinstance(rows, list):
        raise FileError(path, f"{chart.label}: holds no rows")
    return rows


def _rows_by_tick(path: Path, rows: list[Any]) -> dict[int, dict[str, Any]]:
    out = {}
    for row in rows:
        if not isinstance(row, dict):
            raise FileError(path, "a row is not an object")
        out[round(_number(path, row, "beat") * TICKS_PER_BEAT)] = row
    return out


def _steps(path: Path, row: dict[str, Any], tick: int, steps: Any, limb: Any, part: Any) -> None:
    """Read the steps of one row into `limb` and `part`."""
    where = f"beat {tick / TICKS_PER_BEAT:g}"
    for step in _listed(path, row, "steps"):
        if not isinstance(step, dict):
            raise FileError(path, f"{where}: a step is not an object")
        column, name = step.get("column"), step.get("limb")
        if not isinstance(column, int) or isinstance(column, bool) or not 0 <= column < len(steps) or not steps[column]:
            raise FileError(path, f"{where}: the chart has no step in column {column}")
        if name is not None and (not isinstance(name, str) or name not in _LIMB_NUMBERS):
            raise FileError(
                path, f"{where}: there is no limb '{shown_key(name)}'; choose {', '.join(_LIMB_NUMBERS)}, null"
            )
        limb[column] = Limb.UNPLAYED if name is None else _LIMB_NUMBERS[name]
        part[column] = _PART_NUMBERS.get(str(step.get("part")), int(Part.WHOLE))
    if (missing := np.flatnonzero((steps > 0) & (limb == Limb.NONE))).size:
        raise FileError(path, f"{where}: the step in column {missing[0]} has no limb")


def _leave_mines(feet: Any, mines: Any, held: Any) -> None:
    """Move the feet (2,) that stand on a mine home, unless they hold their panel (docs/cost-model.md); in place."""
    for side in (0, 1):
        if feet[side] >= 0 and mines[feet[side]] and not held[side]:
            feet[side] = -1


def _listed(path: Path, row: dict[str, Any], name: str) -> list[Any]:
    value = row.get(name, [])
    if not isinstance(value, list):
        raise FileError(path, f"a row's {name} is not a list")
    return value


def _panel(path: Path, row: dict[str, Any], side: str, columns: int) -> int:
    feet = row.get("feet", {})
    value = feet.get(side) if isinstance(feet, dict) else feet
    if value is None:
        return -1
    if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value < columns:
        raise FileError(
            path, f"beat {row['beat']:g}: the {side} foot stands on {shown_key(value)}, which is not a panel"
        )
    return value


def _number(path: Path, row: dict[str, Any], name: str) -> float:
    value = row.get(name)
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < 1e15:
        raise FileError(path, f"a row's {name} is {shown_key(repr(value))}, which is not a number")
    return float(value)
