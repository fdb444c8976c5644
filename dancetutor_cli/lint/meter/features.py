"""What the feet have to do in how little time: numbers of a play that never fall when it is played faster."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from itertools import accumulate, pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.feet.play import Play
from dancetutor_cli.feet.solver.vocabulary import EVENTS

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
_COUNTED = (*_NAMED, "held")  # what a row is or is not
_BITS = np.array([sum(1 << EVENTS.index(name) for name in _NAMED.get(thing, ())) for thing in _COUNTED])
_PLACES, _TURNS = [THINGS.index(thing) for thing in _COUNTED], THINGS.index("turns")
HOWS = ("mean", "peak", "count")  # the last two of steps alone
_PLACE = {thing: n for n, thing in enumerate(THINGS)}
_PEAK = 0.98  # the share of rows that are easier than a peak
_QUARTER = 90.0  # degrees
_PLAY = 40  # bits of a tick: everything in a later play comes after every tick of the one before


class Feature(NamedTuple):
    """One number of a chart: how often `thing` happens in a second.

    thing : one of `THINGS`. "turns": quarter turns of the body; "held": steps while the other foot holds; "crossovers"
        counts the step that crosses, not those that stay crossed
    seconds : how far back each row looks; kind : "mean" of all rows with a step, and of steps alone "peak": what 98 in
        100 rows do not exceed, "count": of the whole chart, whatever its time
    """

    thing: str
    seconds: float
    kind: str


def features(play: Play, wanted: Sequence[Feature], rate: float = 1.0) -> list[float]:
    """These numbers of a play, see `features_of`."""
    return features_of([play], wanted, rate)[0]


def features_of(plays: Sequence[Play], wanted: Sequence[Feature], rate: float = 1.0) -> list[list[float]]:
    """These numbers of each play, 0 or more; none of them is less at a higher rate: a window then holds no fewer rows.

    plays : all of one pad; rate : how fast the music plays, above 0. The feet are those of rate 1
    """
    steps = _steps_of(plays)
    return [_of_one(steps, first, after, wanted, rate) for first, after in pairwise(steps.first)]


def _of_one(steps: _Steps, first: int, after: int, wanted: Sequence[Feature], rate: float) -> list[float]:
    """The numbers of the play that has these steps."""
    out, count = [0.0] * len(wanted), after - first
    if not count:
        return out
    second, order = steps.second[first:after], steps.order[:count]
    firsts = {seconds: second.searchsorted(second - seconds * rate) for seconds in _spans(tuple(wanted))}
    means: dict[float, list[float]] = {}
    for place, (thing, seconds, how) in enumerate(wanted):
        if how == "count":
            out[place] = float(count)
        elif how == "peak":
            out[place] = _peak(order - firsts[seconds]) / seconds
        else:
            if seconds not in means:
                windows = np.bincount(firsts[seconds], minlength=count).cumsum() - order  # that each row is in
                means[seconds] = (_sums(steps, first, after, windows.astype(float)) / (count * seconds)).tolist()
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


class _Steps(NamedTuple):
    """The rows with a step of some plays, n, one play after the other; taps of rolls, too: somebody has to tap them.

    first : where the rows of each play begin; and n; order : 0 to n - 1
    second : never less than in the row before; turned : degrees from the row before, of no meaning in a first one
    happens : (t, n) 1.0 where one of `_COUNTED` happens, else 0.0
    """

    first: list[int]
    order: NDArray[np.int64]
    second: NDArray[np.float64]
    turned: NDArray[np.float64]
    happens: NDArray[np.float64]


def _steps_of(plays: Sequence[Play]) -> _Steps:
    bounds = np.array([0, *accumulate(len(play.rows) for play in plays)])
    columns = np.concatenate([play.rows.steps for play in plays]).T
    rows = np.flatnonzero(np.logical_or.reduce(list(columns)))  # few columns, and rows by the thousand
    first = rows.searchsorted(bounds).tolist()
    later = np.ones(len(rows), dtype=bool)
    later[[one for one in first if one < len(rows)]] = False  # the first row of a play has none before it
    second = np.concatenate([play.rows.second for play in plays])[rows]
    if (later[1:] & (second[1:] < second[:-1])).any():
        for a, b in pairwise(first):
            second[a:b] = np.maximum.accumulate(second[a:b])
    happens = np.concatenate([_marks(play) for play in plays], axis=1)[:, rows]
    crossed = happens[_COUNTED.index("crossovers")]
    crossed[1:][(crossed[1:] > 0) & (crossed[:-1] > 0) & later[1:]] = 0.0
    # the last of all holds so far; those of later plays end after everything in those before
    play_of = np.arange(len(plays)).repeat(np.diff(bounds)) << _PLAY
    until = np.maximum.reduce([*np.concatenate([play.rows.hold_end for play in plays]).T]) + play_of
    ticks = (np.concatenate([play.rows.tick for play in plays]) + play_of)[rows]
    happens[_COUNTED.index("held")] = later & (np.maximum.accumulate(until)[rows - 1] > ticks)
    facing = np.concatenate([play.facing for play in plays])[rows]
    turned = np.zeros(len(rows))
    turned[1:] = np.abs(facing[1:] - facing[:-1])
    turned = np.minimum(turned, 360.0 - np.minimum(turned, 360.0))
    return _Steps(first, np.arange(len(rows)), second, turned, happens)


def _marks(play: Play) -> NDArray[np.float64]:
    """(`_COUNTED`, n) which of them each row of a play is, as far as the names of its moves say."""
    if play.events is None:
        marks = np.array([_marked(names) for names in play.moves], dtype=float).reshape(-1, len(_COUNTED)).T
    else:
        marks = ((play.events & _BITS[:, None]) != 0).astype(float)
    return marks


def _sums(steps: _Steps, first: int, after: int, windows: NDArray[np.float64]) -> NDArray[np.float64]:
    """(`THINGS`,): how often each happens in all windows of a play together. windows : that each of its rows is in"""
    out = np.empty(len(THINGS))
    out[0] = windows.sum()
    out[_PLACES] = steps.happens[:, first:after] @ windows
    out[_TURNS] = steps.turned[first + 1 : after] @ windows[1:] / _QUARTER
    return out


@cache
def _marked(names: tuple[str, ...]) -> tuple[float, ...]:
    """Which of `_COUNTED` a row with these moves is."""
    return tuple(float(any(name in names for name in _NAMED.get(thing, ()))) for thing in _COUNTED)
