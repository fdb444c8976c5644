"""Beat to second and back, as StepMania 5 and ITGmania count: BPMs, stops, delays, warps, fake segments, offset.

Everything is kept as exact fractions of the decimals in the file; floats are made from them once.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import TICKS_PER_BEAT

Segments = tuple[tuple[int, Fraction], ...]  # (tick, value), sorted, one per tick
_FAR = 1 << 40  # a tick beyond every chart


@dataclass(frozen=True, slots=True)
class _Knots:
    """Piecewise linear time. Knot i: tick, second there (of notes, after all of it), seconds per tick from there on."""

    tick: NDArray[np.int64]
    note: NDArray[np.float64]
    after: NDArray[np.float64]
    rate: NDArray[np.float64]
    exact: tuple[tuple[Fraction, Fraction, Fraction], ...]  # delay at the knot, stop at the knot, rate


@dataclass(frozen=True)
class Timing:
    """The timing of a song or of a chart of its own. Segments are (tick, value); values in BPM, seconds or ticks.

    bpms : never empty, the first at tick 0, all positive; offset : seconds, as in the file (beat 0 is at -offset)
    """

    bpms: Segments
    stops: Segments = ()
    delays: Segments = ()
    warps: Segments = ()
    fakes: Segments = ()
    offset: Fraction = Fraction(0)
    _knots: _Knots = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if not self.bpms or any(value <= 0 for _, value in self.bpms):
            raise ValueError("BPMs must be there and positive")
        object.__setattr__(self, "_knots", _walk(self))

    def seconds(self, ticks: NDArray[np.int64]) -> NDArray[np.float64]:
        """Second of a note on each tick, from the start of the music: after a delay, before a stop on it."""
        ticks = np.asarray(ticks, dtype=np.int64)
        k = self._knots
        i = np.clip(np.searchsorted(k.tick, ticks, side="right") - 1, 0, None)
        moved = k.after[i] + (ticks - k.tick[i]) * k.rate[i]
        return np.where(ticks == k.tick[i], k.note[i], moved)

    def seconds_of_beats(self, beats: NDArray[np.float64]) -> NDArray[np.float64]:
        """Second of each beat, not rounded to ticks; a beat on a stop is the note's second."""
        t = np.asarray(beats, dtype=np.float64) * TICKS_PER_BEAT
        k = self._knots
        i = np.clip(np.searchsorted(k.tick, t, side="right") - 1, 0, None)
        moved = k.after[i] + (t - k.tick[i]) * k.rate[i]
        return np.where(t == k.tick[i], k.note[i], moved)

    def beats(self, seconds: NDArray[np.float64]) -> NDArray[np.float64]:
        """Beat at each second; it rests during stops and delays, and jumps over warps."""
        s = np.asarray(seconds, dtype=np.float64)
        k = self._knots
        i = np.clip(np.searchsorted(k.after, s, side="right") - 1, 0, None)
        rate = np.where(k.rate[i] > 0, k.rate[i], np.inf)
        t = k.tick[i] + (s - k.after[i]) / rate
        limit = np.append(k.tick[1:], _FAR)[i]
        out: NDArray[np.float64] = np.minimum(t, limit) / TICKS_PER_BEAT
        return out

    def bpm_at(self, tick: int) -> float:
        """BPM in force at a tick; a change on the tick counts."""
        value = self.bpms[0][1]
        for at, bpm in self.bpms:
            if at > tick:
                break
            value = bpm
        return float(value)

    def judged(self, ticks: NDArray[np.int64]) -> NDArray[np.bool_]:
        """False where the games judge nothing: in a warp (but not on a stop or delay in it) and in a fake segment."""
        ticks = np.asarray(ticks, dtype=np.int64)
        stopped = np.array([t for t, v in (*self.stops, *self.delays) if v != 0], dtype=np.int64)
        return ~((_inside(self.warps, ticks) & ~np.isin(ticks, stopped)) | _inside(self.fakes, ticks))

    def milliseconds(self, ticks: NDArray[np.int64]) -> NDArray[np.int64]:
        """Time since the previous of the given ascending ticks, exact, rounded half up to milliseconds; first 0."""
        ticks = np.asarray(ticks, dtype=np.int64)
        out = np.zeros(len(ticks), dtype=np.int64)
        if len(ticks) < 2:
            return out
        k = self._knots
        at = np.clip(np.searchsorted(k.tick, ticks, side="right") - 1, 0, None)
        cache: dict[tuple[int, int], int] = {}
        on_knot = ticks == k.tick[at]
        for n in range(1, len(ticks)):
            i, j = int(at[n - 1]), int(at[n])
            if i == j and not on_knot[n - 1]:
                key = (i, int(ticks[n] - ticks[n - 1]))
                if key not in cache:
                    cache[key] = _half_up(key[1] * k.exact[i][2] * 1000)
                out[n] = cache[key]
            else:
                out[n] = _half_up(self._between(int(ticks[n - 1]), i, int(ticks[n]), j) * 1000)
        return out

    def _between(self, a: int, i: int, b: int, j: int) -> Fraction:
        k = self._knots
        total = Fraction(0)
        if a == b:
            return total
        if a == k.tick[i]:
            total += k.exact[i][1]
        here = a
        for knot in range(i + 1, j + 1):
            total += (int(k.tick[knot]) - here) * k.exact[knot - 1][2] + k.exact[knot][0]
            here = int(k.tick[knot])
            if knot < j or b != here:
                total += k.exact[knot][1]
        return total + (b - here) * k.exact[j][2]


def _half_up(value: Fraction) -> int:
    return (2 * value.numerator + value.denominator) // (2 * value.denominator)


def _inside(segments: Segments, ticks: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Whether each tick lies in the last segment that starts at or before it; values are lengths in ticks."""
    if not segments:
        return np.zeros(ticks.shape, dtype=bool)
    starts = np.array([t for t, _ in segments], dtype=np.int64)
    ends = np.array([float(t + length) for t, length in segments])
    i = np.searchsorted(starts, ticks, side="right") - 1
    return (i >= 0) & (ticks < ends[np.clip(i, 0, None)])


def _walk(timing: Timing) -> _Knots:
    """Follow the song once through all changes, in the games' order: warp end, BPM, delay, note, stop, warp start."""
    bpms, stops, delays, warps = (dict(s) for s in (timing.bpms, timing.stops, timing.delays, timing.warps))
    rows = set(bpms) | set(stops) | set(delays) | set(warps)
    rows |= {round(t + length) for t, length in timing.warps if length > 0}
    order = sorted(rows | {0})
    now, rate = -timing.offset, Fraction(60) / timing.bpms[0][1] / TICKS_PER_BEAT
    previous, destination = order[0], None
    now += order[0] * rate  # changes before beat 0 run at the first BPM
    ticks, notes, afters, rates, exact = [], [], [], [], []
    for row in order:
        if destination is None:
            now += (row - previous) * rate
        previous = row
        if destination is not None and row >= destination:
            destination = None
        if row in bpms:
            rate = Fraction(60) / bpms[row] / TICKS_PER_BEAT
        delay, stop = delays.get(row, Fraction(0)), stops.get(row, Fraction(0))
        now += delay
        notes.append(float(now))
        now += stop
        if row in warps and warps[row] > 0:
            end = round(row + warps[row])
            destination = end if destination is None else max(destination, end)
        ticks.append(row)
        afters.append(float(now))
        rates.append(0.0 if destination is not None else float(rate))
        exact.append((delay, stop, Fraction(0) if destination is not None else rate))
    return _Knots(np.array(ticks), np.array(notes), np.array(afters), np.array(rates), tuple(exact))
