"""The rows of a play in the JSON of `analyze` (docs/formats.md): as text at once, for there are so many.

Most rows look like others: what a row says besides its time, its line and its margin is written once for all rows of a
run that share it.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import lru_cache
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import TICKS_PER_BEAT, TICKS_PER_MEASURE
from dancetutor_cli.play.played import Limb, Part, Play, StepKind

_LIMBS = {int(limb): limb.name.lower() for limb in Limb if limb >= 0}
_KINDS = {int(kind): kind.name.lower() for kind in StepKind}
_PARTS = {int(Part.HEEL): "heel", int(Part.TOE): "toe"}
_SMALL, _LARGE = 0.001, 1e9  # numbers beyond are written with an exponent, or with more digits than a float has
_UNASKED, _UNKNOWN = -1.0, -2.0  # for confidence that nobody has measured, and in rows without a step
_BETWEEN = ", "
_MOST_KNOWN = 100_000  # texts kept, so that a long run does not fill the memory


def json_rows(play: Play, file_lines: NDArray[np.int32]) -> str:
    """The JSON of a list, one object for each row with a step, keys in the documented order.

    A row of mines alone is there too if it costs something, so that the rows add up to the chart's cost.
    file_lines : (rows,), the line in the file of each row
    """
    is_shown = np.asarray(play.rows.steps.any(axis=1))
    others = np.flatnonzero(~is_shown)
    is_shown[others] = (play.cost[others] != 0).any(axis=1)
    shown = np.flatnonzero(is_shown)
    looks, costs = _looks(play, shown), _costs(play, shown)
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
    decimals = f"{second:.6f}".rstrip("0")  # what `repr` of the rounded number is, in a third of the time
    return f"{decimals}0" if decimals[-1] == "." else decimals


@lru_cache(maxsize=_MOST_KNOWN)
def _beat(tick: int) -> str:
    """The start of a row, up to its second."""
    return f'{{"beat": {round(tick / TICKS_PER_BEAT, 6)!r}, "measure": {tick // TICKS_PER_MEASURE}, "second": '


@lru_cache(maxsize=_MOST_KNOWN)
def _line(line: int) -> str:
    return f', "line": {line}, '


@lru_cache(maxsize=_MOST_KNOWN)
def _end(margin: int, sure: float) -> str:
    """The end of a row, and what stands between it and the next. sure : `Play.confidence`, `_UNASKED` or `_UNKNOWN`"""
    text = "null" if margin < 0 else str(margin)
    if sure != _UNASKED:
        text += f', "confidence": {"null" if sure == _UNKNOWN else repr(round(100 * sure, 1))}'
    return f"{text}}}{_BETWEEN}"


def _looks(play: Play, shown: NDArray[np.intp]) -> list[str]:
    """What each of some rows says of its steps, feet and moves."""
    moves = np.fromiter(map(id, play.moves), np.int64, len(play.moves)) if play.events is None else play.events
    known: dict[bytes, str] = {} if play.events is None else _looks_known(play.limb.shape[1])
    rows = play.rows
    keys = _bytes(shown, rows.steps, play.limb, play.part, play.feet, play.facing[:, None], moves[:, None])
    return _said(keys, known, lambda at: _pose(play, int(shown[at])))


def _costs(play: Play, shown: NDArray[np.intp]) -> list[str]:
    """What each of some rows says of its cost."""
    return _said(_bytes(shown, play.cost), _costs_known(play.terms), lambda at: _terms(play, int(shown[at])))


def _said(keys: list[bytes], known: dict[bytes, str], say: Callable[[int], str]) -> list[str]:
    """What is known of each key; of a new one what `say` tells of its place."""
    if len(known) > _MOST_KNOWN:
        known.clear()
    said = [*map(known.get, keys)]
    for place, (key, text) in enumerate(zip(keys, said, strict=True)):
        if text is None:
            said[place] = known[key] = known.get(key) or say(place)
    return cast("list[str]", said)


@lru_cache(maxsize=32)
def _looks_known(columns: int) -> dict[bytes, str]:
    """What is known of rows of so many columns: the text of steps, feet, facing and moves by their bytes."""
    return {}


@lru_cache(maxsize=32)
def _costs_known(terms: tuple[str, ...]) -> dict[bytes, str]:
    """The text of costs by their bytes."""
    return {}


def _bytes(shown: NDArray[np.intp], *arrays: NDArray[Any]) -> list[bytes]:
    """For each of some rows all that arrays have there."""
    table = np.concatenate([np.ascontiguousarray(array[shown]).view(np.uint8) for array in arrays], axis=1)
    keys: list[bytes] = table.view(f"V{table.shape[1]}").ravel().tolist() if table.size else [b""] * len(table)
    return keys


def _pose(play: Play, row: int) -> str:
    left, right = (None if panel < 0 else panel for panel in play.feet[row].tolist())
    limbs, parts = play.limb[row].tolist(), play.part[row].tolist()
    said: dict[str, Any] = {
        "steps": [
            {"column": column, "limb": _LIMBS.get(limbs[column]), "kind": _KINDS[kind],
             "part": _PARTS.get(parts[column])}
            for column, kind in enumerate(play.rows.steps[row].tolist())
            if kind
        ],
        "feet": {"left": left, "right": right},
        "facing": round(float(play.facing[row]), 6),
    }  # fmt: skip
    return f'{json.dumps(said)[1:-1]}, "moves": {json.dumps(play.moves[row])}, '


def _terms(play: Play, row: int) -> str:
    costs = {term: cost for term, cost in zip(play.terms, play.cost[row].tolist(), strict=True) if cost}
    return f'"cost": {json.dumps(costs)}, "margin": '
