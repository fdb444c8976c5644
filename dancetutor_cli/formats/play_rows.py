"""The rows of a play in the JSON of `analyze` (docs/formats.md): as text at once, for there are so many.

Most rows look like others: what a row says besides its time, its line and its margin is written once for all rows of a
run that share it.
"""

from __future__ import annotations

import json
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import TICKS_PER_BEAT, TICKS_PER_MEASURE
from dancetutor_cli.play.played import Limb, Part, Play, StepKind

_LIMBS = {int(limb): limb.name.lower() for limb in Limb if limb >= 0}
_KINDS = {int(kind): kind.name.lower() for kind in StepKind}
_PARTS = {int(Part.HEEL): "heel", int(Part.TOE): "toe"}
_SMALL, _LARGE = 0.001, 1e9  # numbers beyond are written with an exponent, or with more digits than a float has
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
    beats = map(_beat, play.rows.tick[shown].tolist())
    seconds, lines = map(_second, play.rows.second[shown].tolist()), file_lines[shown].tolist()
    said = _said(play, shown)
    margins = ["null"] * len(shown) if play.margin is None else [*map(_margin, play.margin[shown].tolist())]
    if play.confidence is not None:
        sure = ["null" if one != one else _percent(one) for one in play.confidence[shown].tolist()]
        margins = [f'{margin}, "confidence": {one}' for margin, one in zip(margins, sure, strict=True)]
    rows = zip(beats, seconds, lines, said, margins, strict=True)
    texts = [f'{beat}{second}, "line": {line}, {what}{margin}}}' for beat, second, line, what, margin in rows]
    return f"[{', '.join(texts)}]"


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
def _margin(margin: int) -> str:
    return "null" if margin < 0 else str(margin)


@lru_cache(maxsize=_MOST_KNOWN)
def _percent(confidence: float) -> str:
    return repr(round(100 * confidence, 1))


def _said(play: Play, shown: NDArray[np.intp]) -> list[str]:
    """What each of some rows says between its line and its margin."""
    poses, costs = _poses(play.limb.shape[1]), _costs(play.terms)
    moves, said = play.moves, []
    looks = _bytes(shown, play.rows.steps, play.limb, play.part, play.feet, play.facing[:, None])
    for row, look, cost in zip(shown.tolist(), looks, _bytes(shown, play.cost), strict=True):
        if (pose := poses.get(look)) is None:
            pose = poses[look] = _pose(play, row)
        if (terms := costs.get(cost)) is None:
            terms = costs[cost] = _terms(play, row)
        said.append(f"{pose}{_moves(moves[row])}{terms}")
    for known in (poses, costs):
        if len(known) > _MOST_KNOWN:
            known.clear()
    return said


@lru_cache(maxsize=32)
def _poses(columns: int) -> dict[bytes, str]:
    """What is known of rows of so many columns: the text of steps, feet and facing by their bytes."""
    return {}


@lru_cache(maxsize=32)
def _costs(terms: tuple[str, ...]) -> dict[bytes, str]:
    """The text of costs by their bytes."""
    return {}


@lru_cache(maxsize=_MOST_KNOWN)
def _moves(names: tuple[str, ...]) -> str:
    return f"{json.dumps(names)}, "


def _bytes(shown: NDArray[np.intp], *arrays: NDArray[Any]) -> list[bytes]:
    """For each of some rows all that arrays have there."""
    table = np.concatenate([np.ascontiguousarray(array[shown]).view(np.uint8) for array in arrays], axis=1)
    data, width = table.tobytes(), table.shape[1]
    return [data[at : at + width] for at in range(0, len(data), width)]


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
    return f'{json.dumps(said)[1:-1]}, "moves": '


def _terms(play: Play, row: int) -> str:
    costs = {term: cost for term, cost in zip(play.terms, play.cost[row].tolist(), strict=True) if cost}
    return f'"cost": {json.dumps(costs)}, "margin": '
