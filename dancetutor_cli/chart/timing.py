"""Beats and seconds of a chart, as StepMania 5 and ITGmania run them."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.names import TICKS_PER_BEAT

# Segments are kept as exact fractions of the decimals in the file; floats are made from them once.

Segments = tuple[tuple[int, Fraction], ...]  # (tick, value), sorted, one per tick
_FIXED = 1 << 80  # parts of a second in which sums are kept: no float noise, no endless fractions
_LONGEST = 1 << 2000  # sums with longer denominators, after thousands of changes in one gap, are rounded to _FIXED
SLOWEST, FASTEST = 0.25, 2.0  # limits of the music's speed; beyond them, the sound is poor and no feet can follow
_FAR = 1 << 40  # a tick beyond every chart


def heard_second(second: float, rate: float) -> float:
    """Return the second at which the moment `second` of a song is heard if its music plays at `rate` (1: as it is)."""
    return second / rate


@dataclass(frozen=True)
class Timing:
    """The timing of a song, or of a chart with its own. Segments are (tick, value), sorted, one per tick.

    bpms : BPM, never empty, the first at tick 0, all positive
    stops, delays : seconds
    warps, fakes : length in ticks
    offset : seconds as in the file; beat 0 is at second -offset
    """

    bpms: Segments
    stops: Segments = ()
    delays: Segments = ()
    warps: Segments = ()
    fakes: Segments = ()
    offset: Fraction = Fraction(0)

    def __post_init__(self) -> None:
        if not self.bpms or any(value.numerator <= 0 for _, value in self.bpms):
            raise ValueError("there must be BPMs, all above 0")

    def seconds(self, ticks: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return the second of a note on each tick, from the start of the music: after a delay, before a stop on it."""
        return self._knots.seconds(np.asarray(ticks, dtype=np.int64))

    def seconds_of_beats(self, beats: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the second of each beat, not rounded to ticks; on a stop, it is the second of a note there."""
        return self._knots.seconds(np.asarray(beats, dtype=np.float64) * TICKS_PER_BEAT)

    def beats(self, seconds: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the beat at each second; it stands still during stops and delays, and jumps over warps."""
        return self._knots.ticks(np.asarray(seconds, dtype=np.float64)) / TICKS_PER_BEAT

    def at_rate(self, rate: float) -> Timing:
        """Return the timing of music that plays at `rate` (1: as it is); at 0.5 everything comes twice as late."""
        if rate == 1.0:
            return self
        speed = Fraction(rate)

        def slower(segments: Segments) -> Segments:
            return tuple((tick, seconds / speed) for tick, seconds in segments)

        bpms = tuple((tick, bpm * speed) for tick, bpm in self.bpms)
        return replace(
            self, bpms=bpms, stops=slower(self.stops), delays=slower(self.delays), offset=self.offset / speed
        )

    def bpm_at(self, tick: int) -> float:
        """Return the BPM at a tick; a change on the tick counts, and the first BPM also holds before beat 0."""
        starts, values = self.tempos
        return values[max(bisect_right(starts, tick) - 1, 0)]

    def judged(self, ticks: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Whether the games judge a note on each tick: not in fake segments, and in warps only on a stop or delay."""
        ticks = np.asarray(ticks, dtype=np.int64)
        if not self.warps and not self.fakes:
            return np.ones(ticks.shape, dtype=bool)
        stopped = np.array([tick for tick, _ in (*self.stops, *self.delays)], dtype=np.int64)
        return ~((_inside(self.warps, ticks) & ~np.isin(ticks, stopped)) | _inside(self.fakes, ticks))

    def milliseconds(
        self,
        ticks: NDArray[np.int64],
        seconds: NDArray[np.float64] | None = None,
        first: NDArray[np.intp] | None = None,
    ) -> NDArray[np.int64]:
        """Return the milliseconds from the previous tick to each tick, rounded half up; 0 for the first.

        The decimals in the file are exact: if floats could round the wrong way, fractions are used.
        ticks : ascending
        seconds : the result of `seconds` for these ticks, if it is known
        first : indices at which a new ascending run of ticks begins; None: the ticks are one run
        """
        ticks = np.asarray(ticks, dtype=np.int64)
        out = np.zeros(ticks.shape, dtype=np.int64)
        if len(ticks) < 2:
            return out
        seconds = self.seconds(ticks) if seconds is None else seconds
        halves = (seconds[1:] - seconds[:-1]) * 1000 + 0.5
        out[1:] = np.floor(halves)
        doubt = np.abs(halves - np.rint(halves)) < 1e-6 + 4e-12 * np.abs(seconds).max()
        if first is not None:
            first = first[(first > 0) & (first < len(ticks))]
            out[first] = 0
            doubt[first - 1] = False
        for n, exact in self._exact_milliseconds(ticks, np.flatnonzero(doubt) + 1):
            out[n] = exact
        return out

    def _exact_milliseconds(self, ticks: NDArray[np.int64], which: NDArray[np.intp]) -> list[tuple[int, int]]:
        """Return each n of `which` with the exact milliseconds from tick n - 1 to tick n.

        Equal distances within one piece of time are computed once.
        """
        knots = self._knots
        at = np.searchsorted(knots.tick, ticks, side="right") - 1
        steady: dict[tuple[int, int], int] = {}
        out = []
        for n in which.tolist():
            a, b, i, j = int(ticks[n - 1]), int(ticks[n]), int(at[n - 1]), int(at[n])
            if i == j and i >= 0 and a != int(knots.tick[i]):
                if (i, b - a) not in steady:
                    steady[i, b - a] = _half_up((b - a) * knots.exact[i][2] * 1000)
                out.append((n, steady[i, b - a]))
            else:
                out.append((n, _half_up(knots.between(a, i, b, j) * 1000)))
        return out

    @cached_property
    def _knots(self) -> _Knots:
        return _Knots(self)

    @cached_property
    def tempos(self) -> tuple[list[int], list[float]]:
        """The ticks at which a BPM begins, and the BPMs."""
        return [tick for tick, _ in self.bpms], [float(value) for _, value in self.bpms]


class _Knots:
    """Time as linear pieces between knots, the ticks at which the timing changes.

    tick : int64, ascending
    before, note, after : float64, the second before the delay on the tick, of a note on it, and after its stop
    rate : float64, seconds per tick after the knot, 0 in a warp; first_rate : the rate before the first knot
    stops : whether any knot has a stop
    exact : the delay, the stop and the rate of each knot as fractions
    """

    def __init__(self, timing: Timing) -> None:
        bpms, stops, delays, warps = (dict(s) for s in (timing.bpms, timing.stops, timing.delays, timing.warps))
        ends = {tick + int(length) for tick, length in timing.warps}
        order = sorted({0, *bpms, *stops, *delays, *warps, *ends})
        none = Fraction(0)
        self.exact_first_rate = rate = moving = Fraction(60) / timing.bpms[0][1] / TICKS_PER_BEAT
        previous, end_of_warp = 0, -_FAR
        now = _fixed(-timing.offset)
        if order[0] < 0:  # stops and delays before beat 0 shift the rest; without them, beat 0 is at the offset
            now += _fixed(order[0] * moving)
            previous = order[0]
        self.exact: list[tuple[Fraction, Fraction, Fraction]] = []
        times: list[tuple[int, int, int]] = []
        for tick in order:
            now += _fixed((tick - previous) * rate)
            previous = tick
            if tick in bpms:
                moving = Fraction(60) / bpms[tick] / TICKS_PER_BEAT
            delay, stop = delays.get(tick, none), stops.get(tick, none)
            before, note = now, now + _fixed(delay)
            now = note + _fixed(stop)
            if tick in warps:
                end_of_warp = max(end_of_warp, tick + int(warps[tick]))
            rate = none if tick < end_of_warp else moving
            times.append((before, note, now))
            self.exact.append((delay, stop, rate))
        self.tick = np.array(order, dtype=np.int64)
        self.before, self.note, self.after = (np.array([t[i] / _FIXED for t in times]) for i in range(3))
        self.stops = bool((self.note != self.after).any())
        self.rate = np.array([float(r) for _, _, r in self.exact])
        self.first_rate = float(self.exact_first_rate)

    def seconds(self, ticks: NDArray[np.int64] | NDArray[np.float64]) -> NDArray[np.float64]:
        k = self.tick[1:].searchsorted(ticks, side="right")
        away = ticks - self.tick[k]
        out: NDArray[np.float64] = self.after[k] + away * self.rate[k]
        if self.stops:
            out = np.where(away == 0, self.note[k], out)
        early = ticks < self.tick[0]
        return np.where(early, self.before[0] + away * self.first_rate, out) if early.any() else out

    def ticks(self, seconds: NDArray[np.float64]) -> NDArray[np.float64]:
        i = np.searchsorted(self.after, seconds, side="right") - 1
        k = np.maximum(i, 0)
        rate, following = self.rate[k], np.append(self.tick[1:], _FAR)[k]
        passed = seconds - self.after[k]
        moving = np.minimum(self.tick[k] + passed / np.where(rate > 0, rate, 1), following)
        warping = np.where(passed > 0, following, self.tick[k])  # time passes in a warp only during a stop
        later = np.where(rate > 0, moving, warping)
        sooner = np.minimum(self.tick[0] + (seconds - self.before[0]) / self.first_rate, self.tick[0])
        out: NDArray[np.float64] = np.where(i < 0, sooner, later)
        return out

    def between(self, a: int, i: int, b: int, j: int) -> Fraction:
        """Return the exact seconds from a note on tick a to one on tick b. i, j : the last knots up to a and b"""
        if a == b:
            return Fraction(0)
        here, rate = a, self.exact[i][2] if i >= 0 else self.exact_first_rate
        total = self.exact[i][1] if i >= 0 and a == int(self.tick[i]) else Fraction(0)
        for knot in range(i + 1, j + 1):
            tick = int(self.tick[knot])
            delay, stop, after = self.exact[knot]
            total += (tick - here) * rate + delay
            if tick != b:
                total += stop
            if total.denominator > _LONGEST:
                total = Fraction(_fixed(total), _FIXED)
            here, rate = tick, after
        return total + (b - here) * rate


def _fixed(seconds: Fraction) -> int:
    return (seconds.numerator * _FIXED + seconds.denominator // 2) // seconds.denominator


def _half_up(value: Fraction) -> int:
    return (2 * value.numerator + value.denominator) // (2 * value.denominator)


def _inside(segments: Segments, ticks: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Whether each tick lies in the last segment that starts at or before it; values are lengths in ticks."""
    if not segments:
        return np.zeros(ticks.shape, dtype=bool)
    starts = np.array([tick for tick, _ in segments], dtype=np.int64)
    ends = starts + np.array([int(length) for _, length in segments], dtype=np.int64)
    i = np.searchsorted(starts, ticks, side="right") - 1
    found: NDArray[np.bool_] = (i >= 0) & (ticks < ends[np.maximum(i, 0)])
    return found
