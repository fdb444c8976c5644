"""A play read from the JSON of `analyze --format json`: any program can drive the dancer.

The rows come from the chart; the file says which limb takes each step, where the feet stand after each row, and which
way they face. Steps that the file does not name, and rows that the chart does not have, are errors.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from dancetutor_cli.bounded import read_json, shown_key
from dancetutor_cli.chart.model import TICKS_PER_BEAT, Chart
from dancetutor_cli.errors import FileError
from dancetutor_cli.pads import Pad
from dancetutor_cli.play.played import Limb, Part, Play, Rows

SCHEMA = 1
_LIMBS = {limb.name.lower(): int(limb) for limb in Limb if limb >= 0}
_PARTS = {"heel": int(Part.HEEL), "toe": int(Part.TOE)}


def read_play(path: Path, chart: Chart, rows: Rows, pad: Pad) -> Play:
    """The play of `chart` in a JSON file.

    Parameters
    ----------
    path : the file; chart : whose play it is, found by index and steps type
    rows : its rows, as `play.prepare` gives them; pad : c panels

    Raises FileError for a file that is not such JSON, or that does not fit the chart.
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
    data = read_json(path)
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
            raise FileError(path, "a row is no object")
        out[round(_number(path, row, "beat") * TICKS_PER_BEAT)] = row
    return out


def _steps(path: Path, row: dict[str, Any], tick: int, steps: Any, limb: Any, part: Any) -> None:
    """Fill one row of limb and part."""
    where = f"beat {tick / TICKS_PER_BEAT:g}"
    for step in _listed(path, row, "steps"):
        if not isinstance(step, dict):
            raise FileError(path, f"{where}: a step is no object")
        column, name = step.get("column"), step.get("limb")
        if not isinstance(column, int) or isinstance(column, bool) or not 0 <= column < len(steps) or not steps[column]:
            raise FileError(path, f"{where}: the chart has no step in column {column}")
        if name is not None and (not isinstance(name, str) or name not in _LIMBS):
            raise FileError(
                path, f"{where}: no limb is called '{shown_key(name)}'; there are {', '.join(_LIMBS)}, null"
            )
        limb[column] = Limb.UNPLAYED if name is None else _LIMBS[name]
        part[column] = _PARTS.get(str(step.get("part")), int(Part.WHOLE))
    if (missing := np.flatnonzero((steps > 0) & (limb == Limb.NONE))).size:
        raise FileError(path, f"{where}: the step in column {missing[0]} has no limb")


def _leave_mines(feet: Any, mines: Any, held: Any) -> None:
    """A row of mines only: feet (2,) that stand on one go home, unless they hold their panel (docs/cost-model.md)."""
    for side in (0, 1):
        if feet[side] >= 0 and mines[feet[side]] and not held[side]:
            feet[side] = -1


def _listed(path: Path, row: dict[str, Any], name: str) -> list[Any]:
    value = row.get(name, [])
    if not isinstance(value, list):
        raise FileError(path, f"a row's {name} is no list")
    return value


def _panel(path: Path, row: dict[str, Any], side: str, columns: int) -> int:
    feet = row.get("feet", {})
    value = feet.get(side) if isinstance(feet, dict) else feet
    if value is None:
        return -1
    if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value < columns:
        raise FileError(path, f"beat {row['beat']:g}: the {side} foot stands on {shown_key(value)}, which is no panel")
    return value


def _number(path: Path, row: dict[str, Any], name: str) -> float:
    value = row.get(name)
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < 1e15:
        raise FileError(path, f"a row's {name} is {shown_key(repr(value))}, which is no number")
    return float(value)
