"""What makes a chart hard to score on beside how fast it is: its rhythm, its bursts, its feet, and its timing."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import TICKS_PER_BEAT
from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.lint.plays import Plays

# Of the notes and the feet: numbers of many plays at once, which know of the timing only the seconds of the rows.

PLAYED = (
    "odd waits", "triplets", "fine rows", "quick", "half-quick", "crossed jumps", "forced doublesteps", "ways", "speed",
    "length",
)  # fmt: skip
TIMED = ("changes", "tempos")
ODDITIES = (*PLAYED, *TIMED)
# "odd waits": the share of rows whose wait is not 1/4, 1/2, 1, 2, 4... times the wait before, in beats
# "triplets", "fine rows": root of the share of rows on thirds of a beat; on what is neither that nor a 16th
# "quick", "half-quick": root of the share of waits below 0.14 and 0.3 s
# "crossed jumps", "forced doublesteps": root of the share of rows; "ways": panel widths that the feet go, by row
# "speed", "length": natural logarithm of rows a second and of rows
# "changes": ln(1 + stops + changes of tempo); "tempos": how evenly the rows are spread over different tempos, in nats
_QUICK, _HALF_QUICK = 0.14, 0.3  # s
_LONGEST = 4 * TICKS_PER_BEAT  # a longer wait counts as this one
_ROUND = 0.05  # octaves between a wait and the nearest power of two of the wait before that nobody counts
_LEAST_SECONDS = 1.0  # so that a chart of one row has a speed
_THIRDS = (TICKS_PER_BEAT // 3, 2 * TICKS_PER_BEAT // 3)
_SIXTEENTH = TICKS_PER_BEAT // 4


def played_oddities(plays: Plays) -> NDArray[np.float64]:
    """(k, `PLAYED`) of each of k plays; taps of rolls are no rows. 0 of a play with fewer than two rows."""
    rows, k = np.flatnonzero(plays.real.any(axis=0)), len(plays.plays)
    number = plays.number[rows]
    count = np.maximum(np.bincount(number, minlength=k), 1)

    def of_row(which: NDArray[np.int64], amount: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """How much of something (or how often it happens) for each row of a play, by the plays that have it."""
        return np.asarray(np.bincount(which, weights=amount, minlength=k) / count)

    tick, second = plays.joined(play.rows.tick for play in plays.plays)[rows], plays.second[rows]
    same = number[1:] == number[:-1]
    wait, seconds = np.minimum(np.diff(tick), _LONGEST), np.where(same, np.diff(second), np.inf)
    third = np.flatnonzero(same[1:] & same[:-1]) + 2  # rows with two rows of their play before them
    octaves = np.log2(wait[third - 1] / wait[third - 2])
    odd = third[np.abs(octaves - np.rint(octaves)) > _ROUND]
    inside = tick % TICKS_PER_BEAT
    thirds = np.isin(inside, _THIRDS)
    crossed = np.intersect1d(plays.rows_with("crossover"), plays.rows_with("jump"), assume_unique=True)
    left, right = plays.travels
    length = np.bincount(number[1:][same], weights=seconds[same], minlength=k)
    found = np.stack(
        [
            of_row(number[odd]),
            np.sqrt(of_row(number[thirds])),
            np.sqrt(of_row(number[~thirds & (inside % _SIXTEENTH != 0)])),
            np.sqrt(of_row(number[1:][seconds < _QUICK])),
            np.sqrt(of_row(number[1:][seconds < _HALF_QUICK])),
            np.sqrt(of_row(plays.number[crossed])),
            np.sqrt(of_row(plays.number[plays.rows_with("forced-doublestep")])),
            of_row(plays.number[left.row], left.way) + of_row(plays.number[right.row], right.way),
            np.log(count / np.maximum(np.abs(length), _LEAST_SECONDS)),
            np.log(count),
        ],
        axis=1,
    )
    found[count < 2] = 0.0
    return found


# Of the timing: what a player has to know by heart, or to read in time.

_CHANGE = 0.05  # octaves between the tempos of two rows that are felt: 3.5 %
_SAME_TEMPO = 0.1  # octaves; tempos that are nearer count as one
_STOP = 0.03  # s; a shorter one corrects the sync


class TimingOddities(NamedTuple):
    """Stops and changes of tempo among the rows of a chart; tempos : as in `TIMED`."""

    stops: int = 0
    changes: int = 0
    tempos: float = 0.0

    @property
    def numbers(self) -> tuple[float, float]:
        """Those of `TIMED`."""
        return math.log1p(self.stops + self.changes), self.tempos


class Oddities(NamedTuple):
    """What a chart is scored by: its numbers by `ODDITIES`, and what those of `TIMED` are made of."""

    numbers: tuple[float, ...]
    timing: TimingOddities


def timing_oddities(timing: Timing, tick: NDArray[np.int64]) -> TimingOddities:
    """Of a chart with this timing. tick : (n,) of its rows with steps, ascending

    A change counts where a row is played at another tempo than the row before. Rows are sorted by octaves from the
    middle row's tempo; of the shares p of what is found there, `tempos` is the entropy -sum p ln p (Shannon 1948).
    """
    if len(tick) < 2:
        return TimingOddities()
    first, last = int(tick[0]), int(tick[-1])
    stops = sum(
        first <= at <= last and float(value) > _STOP for of in (timing.stops, timing.delays) for at, value in of
    )
    starts, bpms = timing.tempos
    if len(bpms) == 1:
        return TimingOddities(stops)
    octaves = np.log2(bpms)[np.maximum(np.array(starts).searchsorted(tick, side="right") - 1, 0)]
    near = np.rint((octaves - np.median(octaves)) / _SAME_TEMPO).astype(np.int64)
    if near.min() == near.max():  # most files with several BPMs: the tempo of a recording
        tempos = 0.0
    else:
        shares = np.unique(near, return_counts=True)[1] / len(tick)
        tempos = float(-(shares * np.log(shares)).sum())
    return TimingOddities(stops, int((np.abs(octaves[1:] - octaves[:-1]) > _CHANGE).sum()), tempos)
