"""What the feet have to do in how little time: numbers of a play that never fall when it is played faster."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.play.model import Play, StepKind

_SWITCHES = ("footswitch-up", "footswitch-down", "footswitch", "sideswitch-left", "sideswitch-right", "jump-footswitch")
# What is counted -> the moves of a row that it is.
_NAMED = {
    "crossovers": ("crossover-half", "crossover-full"),
    "footswitches": _SWITCHES,
    "brackets": ("bracket",),
    "doublesteps": ("doublestep", "forced-doublestep"),
    "jacks": ("jack",),
    "hands": ("hand",),
    "spins": ("spin",),
    "stream rows": ("stream",),
}
THINGS = ("steps", *_NAMED, "jumps", "turns", "held")
_CROSSOVERS, _BRACKETS = THINGS.index("crossovers"), THINGS.index("brackets")
HOWS = ("mean", "peak", "count")
_PEAK = 0.98  # the share of rows that are easier than a peak
_QUARTER = 90.0  # degrees


class Feature(NamedTuple):
    """One number of a chart: how often `thing` happens in a second.

    thing : one of `THINGS`. "turns": quarter turns of the body; "held": steps while the other foot holds; "crossovers"
        counts the step that crosses, not those that stay crossed
    seconds : how far back each row looks; how : "mean" of all rows with a step, "peak": what 98 in 100 rows stay
        below, "count": of the whole chart, whatever its time
    """

    thing: str
    seconds: float
    how: str


def features(play: Play, wanted: Sequence[Feature], rate: float = 1.0) -> list[float]:
    """These numbers of a play, 0 or more; none of them is less at a higher rate: a window then holds no fewer rows.

    rate : how fast the music plays, above 0. The feet are those of rate 1
    """
    kinds = play.rows.steps
    seen = (kinds != StepKind.NONE) & (kinds != StepKind.ROLL_TAP)
    pressed = seen.sum(axis=1)
    rows = np.flatnonzero(pressed)
    out = [0.0] * len(wanted)
    if not len(rows):
        return out
    things = _things(play, rows, pressed[rows])
    total = things.sum(axis=1)
    second = np.maximum.accumulate(play.rows.second[rows])
    for seconds, of_seconds in _plan(tuple(wanted)):
        first = second.searchsorted(second - seconds * rate) if seconds else rows[:0]
        for how, places, numbers in of_seconds:
            if how == "count":
                values = total[numbers]
            elif how == "mean":
                values = things[numbers] @ _windows_of(first) / (len(rows) * seconds)
            else:
                values = np.array([_peak(things[n], first) if total[n] else 0.0 for n in numbers]) / seconds
            for place, value in zip(places, values.tolist(), strict=True):
                out[place] = value
    return out


def _windows_of(first: NDArray[np.int64]) -> NDArray[np.float64]:
    """(rows,): the windows that each row is in. first : the row that the window of each row begins with"""
    begun = np.cumsum(np.bincount(first, minlength=len(first)))
    return np.asarray(begun - np.arange(len(first)), dtype=np.float64)


def _peak(happens: NDArray[np.float64], first: NDArray[np.int64]) -> float:
    """What 98 in 100 windows have no more of than."""
    sums = np.zeros(len(happens) + 1)
    np.cumsum(happens, out=sums[1:])
    within = sums[1:] - sums[first]
    at = int(_PEAK * (len(within) - 1))
    within.partition(at)
    return float(within[at])


@cache
def _plan(wanted: tuple[Feature, ...]) -> tuple[tuple[float, list[tuple[str, list[int], list[int]]]], ...]:
    """What is worked out together: by seconds and how, places in the answer and numbers of things."""
    found: dict[float, dict[str, tuple[list[int], list[int]]]] = {}
    for place, feature in enumerate(wanted):
        places, numbers = found.setdefault(feature.seconds, {}).setdefault(feature.how, ([], []))
        places.append(place)
        numbers.append(THINGS.index(feature.thing))
    return tuple((seconds, [(how, *of) for how, of in hows.items()]) for seconds, hows in found.items())


def _things(play: Play, rows: NDArray[np.int64], pressed: NDArray[np.int64]) -> NDArray[np.float64]:
    """(`THINGS`, rows): how often each happens in each of some rows with a step. pressed : panels in each"""
    number = {names: n for n, names in enumerate(dict.fromkeys(play.moves))}
    codes = np.fromiter(map(number.__getitem__, play.moves), np.intp, len(play.moves))[rows]
    out = np.empty((len(THINGS), len(rows)))
    out[0] = 1.0
    out[1:-3] = np.array([_marked(names) for names in number]).T.take(codes, axis=1)
    crossed = out[_CROSSOVERS]
    out[_CROSSOVERS, 1:] = crossed[1:] * (crossed[:-1] == 0)
    out[-3] = (pressed > 1) & (out[_BRACKETS] == 0)
    turned = np.abs(np.diff(play.facing[rows], prepend=play.facing[rows[0]]))
    out[-2] = np.minimum(turned, 360.0 - np.minimum(turned, 360.0)) / _QUARTER
    until = np.maximum.accumulate(play.rows.hold_end.max(axis=1, initial=-1))
    out[-1] = until[rows - 1] > play.rows.tick[rows]
    out[-1, 0] = 0.0
    return out


@cache
def _marked(names: tuple[str, ...]) -> tuple[float, ...]:
    """Which of `_NAMED` a row with these moves is."""
    return tuple(float(any(name in names for name in of)) for of in _NAMED.values())
