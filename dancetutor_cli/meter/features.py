"""What the feet have to do in how little time: numbers of a play that never fall when it is played faster."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.play.played import Play

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
    "jumps": ("jump",),
}
THINGS = ("steps", *_NAMED, "turns", "held")
_CROSSOVERS = THINGS.index("crossovers")
HOWS = ("mean", "peak", "count")  # the last two of steps alone
_PLACE = {thing: n for n, thing in enumerate(THINGS)}
_PEAK = 0.98  # the share of rows that are easier than a peak
_QUARTER = 90.0  # degrees


class Feature(NamedTuple):
    """One number of a chart: how often `thing` happens in a second.

    thing : one of `THINGS`. "turns": quarter turns of the body; "held": steps while the other foot holds; "crossovers"
        counts the step that crosses, not those that stay crossed
    seconds : how far back each row looks; how : "mean" of all rows with a step, and of steps alone "peak": what 98 in
        100 rows do not exceed, "count": of the whole chart, whatever its time
    """

    thing: str
    seconds: float
    how: str


def features(play: Play, wanted: Sequence[Feature], rate: float = 1.0) -> list[float]:
    """These numbers of a play, 0 or more; none of them is less at a higher rate: a window then holds no fewer rows.

    rate : how fast the music plays, above 0. The feet are those of rate 1
    """
    rows = np.flatnonzero(play.rows.steps.any(axis=1))  # taps of rolls, too: somebody has to tap them
    out = [0.0] * len(wanted)
    if not len(rows):
        return out
    second = np.maximum.accumulate(play.rows.second[rows])
    order = np.arange(len(rows))
    firsts = {seconds: second.searchsorted(second - seconds * rate) for seconds in _spans(tuple(wanted))}
    means: dict[float, list[float]] = {}
    for place, (thing, seconds, how) in enumerate(wanted):
        if how == "count":
            out[place] = float(len(rows))
        elif how == "peak":
            out[place] = _peak(order - firsts[seconds]) / seconds
        else:
            if seconds not in means:
                windows = np.cumsum(np.bincount(firsts[seconds], minlength=len(rows))) - order  # that each row is in
                means[seconds] = (_sums(play, rows, windows) / (len(rows) * seconds)).tolist()
            out[place] = means[seconds][_PLACE[thing]]
    return out


def _peak(before: NDArray[np.int64]) -> float:
    """What 98 in 100 windows have no more rows than. before : rows in each, but for its last one"""
    at = int(_PEAK * (len(before) - 1))
    before.partition(at)
    return float(before[at]) + 1.0


@cache
def _spans(wanted: tuple[Feature, ...]) -> tuple[float, ...]:
    """The different seconds of some features."""
    return tuple(dict.fromkeys(feature.seconds for feature in wanted if feature.seconds))


def _sums(play: Play, rows: NDArray[np.int64], windows: NDArray[np.int64]) -> NDArray[np.float64]:
    """(`THINGS`,): how often each happens in all windows together. rows : those with a step; windows : of each row"""
    kinds, codes = play.kinds()
    codes = codes[rows]
    marks = np.array([_marked(names) for names in kinds])
    out = np.empty(len(THINGS))
    out[0] = windows.sum()
    out[1:-2] = np.bincount(codes, windows, len(kinds)) @ marks
    crossed = marks[:, _CROSSOVERS - 1].astype(bool)[codes]
    stays = crossed[1:] & crossed[:-1]
    out[_CROSSOVERS] -= windows[1:][stays].sum()
    facing = play.facing[rows]
    turned = np.abs(facing[1:] - facing[:-1])
    out[-2] = np.minimum(turned, 360.0 - np.minimum(turned, 360.0)) @ windows[1:] / _QUARTER
    ends = play.rows.hold_end.T
    until = ends[0]
    for column in ends[1:]:  # there are few columns, and rows by the thousand
        until = np.maximum(until, column)
    held = np.maximum.accumulate(until)[rows[1:] - 1] > play.rows.tick[rows[1:]]
    out[-1] = windows[1:][held].sum()
    return out


@cache
def _marked(names: tuple[str, ...]) -> tuple[float, ...]:
    """Which of `_NAMED` a row with these moves is."""
    return tuple(float(any(name in names for name in of)) for of in _NAMED.values())
