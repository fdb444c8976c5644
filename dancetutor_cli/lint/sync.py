"""The sync of beats and audio: how much later the music's attacks are than a chart's beats, and how sure that is."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.audio import Sound
from dancetutor_cli.chart.model import STEP_KINDS, Chart
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.lint.findings import Sync, sync_of

# docs/sync.md explains the method and has measured figures. All times are in seconds if no unit is given.

BLOCKS = 32  # parts of the song, of equal time
_LAG = 0.001  # step between two biases that are tried
_MARGIN = 0.1  # biases beyond half a beat on either side, so that the peak of a chart half a beat off is complete
_NEAR = 0.02  # a peak at least so far from the best one is its rival
_WITHIN = 0.025  # the peaks of the song's parts are searched so near to the best bias
_USUAL = 0.07  # authors hardly ever miss by more, so a larger bias must be better
_UNUSUAL = 0.2  # by this share of the best
_ODD = 0.7  # the most confidence in a bias that is neither usual nor usual with half a beat: maybe other music
_SLOPES = np.arange(-90, 91, 3) / 1000  # drifts over the whole song that are tried
_BETTER = 1.03  # factor by which a drift must be better than none
_SHORTEST, _LONGEST = 0.3, 1.2  # limits of the cycle (a beat, several beats, a part of one) in which biases are tried
_LEAST_ROWS, _LEAST_SECONDS = 24, 8.0
_MOST_ROWS = 12_000  # of rows and sixteenths together
_FASTEST = 1000  # BPM
_PARTS = 8
_NEIGHBOURS = 64  # rows in the running mean of loudness and of the density of notes
_SMOOTH = 0.002  # standard deviation of the bell that smooths profiles
# The values that give confidence 0 and 1; the least confidence decides.
_RAMPS = {"margin": (0.0, 0.3), "height": (3.0, 7.0), "spread": (-0.006, -0.0015), "peak": (0.05, 0.25),
          "parts": (0.0, 0.4)}  # fmt: skip

Curve = NDArray[np.float32]
Seconds = NDArray[np.float64]


class Judgement(NamedTuple):
    """A sync with the curves for a plot.

    lags : float64 (l,), biases that were tried; profile : float32 (BLOCKS, l), how well each part of the song fits them
    first, last : second of the first and of the last row; biases : float64 (BLOCKS,), nan for a part without a peak
    """

    sync: Sync
    lags: Seconds
    profile: Curve
    biases: Seconds
    first: float
    last: float


class _Rows(NamedTuple):
    """The r rows that are judged: all rows with notes, and all sixteenths between the first and the last of them.

    second : float64 (r,), second of each row; weight : float32 (r,), number of charts with a note there; a jump counts
        1.5
    beat, longest : seconds of the median beat, and the seconds that nine of ten beats do not exceed
    """

    second: Seconds
    weight: Curve
    beat: float
    longest: float


def judge(timing: Timing, charts: Sequence[Chart], onsets: Onsets) -> Judgement | Sync:
    """Return the judgement of charts with the same timing against their music; a `Sync` alone if they cannot be judged.

    The strength of onsets is cut around every row with notes and every sixteenth, and each cut is divided by the
    loudness around it. Cuts at rows with notes count for the bias that they show, cuts without notes against it (C).
    Together with the plain mean at the notes (N), this separates the rhythm from off-beats. A drift is a slope of the
    bias over the song, found by phase.
    """
    reason = _reason(timing, charts)
    if reason is None:
        rows = _rows(timing, charts)
        reason = _reason_of_rows(rows, onsets)
    if reason is not None:
        return sync_of(None, 0.0, reason=reason)
    cycle = _cycle(rows.longest)
    count = round((cycle + 2 * _MARGIN) / _LAG)
    lags: Seconds = (np.arange(count, dtype=np.float64) - count // 2) * np.float64(_LAG)
    contrast, mean = _profiles(rows, onsets, lags)
    return _judgement(rows, lags, cycle, contrast, mean)


def _reason(timing: Timing, charts: Sequence[Chart]) -> str | None:
    """Return why charts with this timing cannot be judged, or None."""
    if timing.warps:
        return "it has warps or negative stops"
    ticks = [int(chart.notes.tick[n]) for chart in charts for n in (0, -1) if len(chart.notes)]
    if not ticks:
        return "it has no notes"
    if any(bpm > _FASTEST for tick, bpm in timing.bpms if tick <= max(ticks)):
        return f"it has BPMs over {_FASTEST}"
    return None


def _rows(timing: Timing, charts: Sequence[Chart]) -> _Rows:
    weights: dict[int, float] = {}
    for chart in charts:
        notes = chart.notes
        steps = notes.judged & np.isin(notes.kind, STEP_KINDS)
        for tick, many in zip(*np.unique(notes.tick[steps], return_counts=True), strict=True):
            weights[int(tick)] = weights.get(int(tick), 0.0) + (1.5 if many > 1 else 1.0)
    noted = np.array(sorted(weights), dtype=np.int64)
    if len(noted) < _LEAST_ROWS:
        return _Rows(np.zeros(len(noted)), np.ones(len(noted), np.float32), 0.5, 0.5)
    first, last = int(noted[0]), int(noted[-1])
    sixteenth = TICKS_PER_BEAT // 4
    between = np.arange(-(-first // sixteenth), last // sixteenth + 1)[:_MOST_ROWS] * sixteenth
    ticks = np.union1d(noted, between)[:_MOST_ROWS]
    weight = np.array([weights.get(tick, 0.0) for tick in ticks.tolist()], np.float32)
    beats = timing.seconds_of_beats(
        np.arange(-(-first // TICKS_PER_BEAT), last // TICKS_PER_BEAT + 1, dtype=np.float64)
    )
    usual, longest = np.quantile(np.diff(beats), (0.5, 0.9)) if len(beats) > 1 else (0.5, 0.5)
    return _Rows(timing.seconds(ticks), weight, float(usual), float(longest))


def _reason_of_rows(rows: _Rows, onsets: Onsets) -> str | None:
    if len(rows.second) < _LEAST_ROWS or rows.second[-1] - rows.second[0] < _LEAST_SECONDS:
        return "it has too few notes"
    inside = (rows.second > onsets.start) & (rows.second < onsets.start + onsets.seconds)
    return None if inside.mean() > 0.5 else "most of its notes are outside the music"


def _cycle(beat: float) -> float:
    """Return the seconds of a beat, doubled or halved until it is long enough to distinguish biases, but not longer."""
    while beat < _SHORTEST:
        beat *= 2
    while beat > _LONGEST:
        beat /= 2
    return beat


def _profiles(rows: _Rows, onsets: Onsets, lags: Seconds) -> tuple[Curve, Curve]:
    """Return C and N (see `judge`) of each block of the song; float32 (BLOCKS, lags)."""
    cuts = np.empty((len(rows.second), len(lags)), np.float32)
    for first in range(0, len(cuts), 1024):
        cuts[first : first + 1024] = onsets.at(rows.second[first : first + 1024, None] + lags)
    loudness = cuts.mean(axis=1)
    cuts /= (_around(loudness) + 0.1 * loudness.mean() + 1e-9)[:, None]
    contrast = rows.weight - _around(rows.weight)
    place = (rows.second - rows.second[0]) / (rows.second[-1] - rows.second[0]) * BLOCKS
    member = np.clip(place.astype(np.int64), 0, BLOCKS - 1) == np.arange(BLOCKS)[:, None]
    return (
        _smooth((member * contrast).astype(np.float32) @ cuts / (np.abs(contrast).sum() + 1e-9)),
        _smooth((member * rows.weight).astype(np.float32) @ cuts / rows.weight.sum()),
    )


def _around(values: Curve) -> Curve:
    """Return the mean of the neighbours around each value."""
    half = _NEIGHBOURS // 2
    padded = np.pad(values, half, mode="edge").astype(np.float64).cumsum()
    out: Curve = ((padded[2 * half :] - np.append(0.0, padded)[: len(values)]) / (2 * half + 1)).astype(np.float32)
    return out


def _smooth(profiles: Curve) -> Curve:
    reach = round(3 * _SMOOTH / _LAG)
    bell = np.exp(-0.5 * (np.arange(-reach, reach + 1) * _LAG / _SMOOTH) ** 2)
    bell /= bell.sum()
    padded = np.pad(profiles, ((0, 0), (reach, reach)), mode="edge")
    out: Curve = np.array([np.convolve(row, bell, "valid") for row in padded], np.float32)
    return out


def _judgement(rows: _Rows, lags: Seconds, cycle: float, contrast: Curve, mean: Curve) -> Judgement:
    """Return the best bias and drift, with a confidence from the best rival and the agreement of the song's parts."""
    mean = mean - mean.mean(axis=1, keepdims=True)
    allowed = np.abs(lags) <= cycle / 2 + 0.03
    slope = _best_slope(contrast + 0.5 * mean, allowed)
    contrast, mean = _straightened(contrast, slope), _straightened(mean, slope)
    whole = np.where(allowed, contrast.sum(axis=0), -np.inf)
    is_unusual = np.abs(lags) > _USUAL
    worth = whole - _UNUSUAL * whole.max() * is_unusual
    best = int(worth.argmax())
    is_odd = is_unusual[best] and abs(abs(float(lags[best])) - rows.beat / 2) > _USUAL
    near = np.flatnonzero(np.abs(lags - lags[best]) <= _WITHIN)
    fine = mean + 2 * contrast
    thirds = np.arange(BLOCKS) * 3 // BLOCKS
    first, last = (_peak(lags, fine[thirds == third].sum(axis=0), near) for third in (0, 2))
    # The middles of the first and the last third are 2/3 of the song apart.
    drift = last - first + slope * 2 / 3
    confidence = _confidence(_Choice(lags, whole, worth, best, near, rows.beat), contrast + 0.5 * mean, fine)
    if is_odd:
        confidence = min(confidence, _ODD)
    sync = sync_of(_peak(lags, fine.sum(axis=0), near) * 1000, confidence, drift * 1000, rows.beat * 1000)
    level = fine.max(axis=1)
    biases = np.array([_peak(lags, row, near) for row in fine]) + slope * _middles()
    biases[level < 0.1 * np.median(level[level > 0]) if (level > 0).any() else level <= 0] = np.nan
    return Judgement(sync, lags, _straightened(fine, -slope), biases, float(rows.second[0]), float(rows.second[-1]))


def _middles() -> Seconds:
    """Return the places of the blocks' middles in the song, from -0.5 to 0.5."""
    return (np.arange(BLOCKS) + 0.5) / BLOCKS - 0.5


def _best_slope(profiles: Curve, allowed: NDArray[np.bool_]) -> float:
    """Return the drift with which the parts of the song fit each other best; 0 if it is hardly better than none."""
    count = profiles.shape[1]
    spectrum, turns = np.fft.rfft(profiles, axis=1), np.fft.rfftfreq(count, _LAG)
    sums = [(spectrum * np.exp(2j * np.pi * np.outer(slope * _middles(), turns))).sum(axis=0) for slope in _SLOPES]
    heights = np.fft.irfft(np.array(sums), count, axis=1)[:, allowed].max(axis=1)
    best, none = int(heights.argmax()), len(_SLOPES) // 2
    return float(_SLOPES[best]) if heights[best] > _BETTER * heights[none] else 0.0


def _straightened(profiles: Curve, slope: float) -> Curve:
    """Return profiles of blocks, moved back by a drift of `slope` seconds over the song."""
    if slope == 0.0:
        return profiles
    count = profiles.shape[1]
    turn = np.exp(2j * np.pi * np.fft.rfftfreq(count, _LAG)[None, :] * (slope * _middles())[:, None])
    out: Curve = np.fft.irfft(np.fft.rfft(profiles, axis=1) * turn, count, axis=1).astype(np.float32)
    return out


def _peak(lags: Seconds, values: Curve, near: NDArray[np.int64]) -> float:
    """Return the lag of the highest value among those at `near`, by a parabola through the value and its neighbours."""
    at = int(near[values[near].argmax()])
    if not 0 < at < len(values) - 1:
        return float(lags[at])
    before, here, after = (float(values[n]) for n in (at - 1, at, at + 1))
    bend = before - 2 * here + after
    return float(lags[at]) + (_LAG * 0.5 * (before - after) / bend if bend < 0 else 0.0)


class _Choice(NamedTuple):
    """The best bias among `lags`. whole : float64 (l,), how well each bias fits the song, -inf if it is not allowed

    worth : `whole` less a penalty for unusual biases; best : index of the chosen bias; near : indices around it
    beat : seconds of the median beat
    """

    lags: Seconds
    whole: Seconds
    worth: Seconds
    best: int
    near: NDArray[np.int64]
    beat: float

    def is_same(self, lags: Seconds, near: float) -> NDArray[np.bool_]:
        """Return which biases mean the same as the best one, within `near` seconds.

        If the best bias is more than a quarter beat, a bias one beat away from it also means the same.
        """
        away = np.abs(lags - self.lags[self.best])
        if abs(float(self.lags[self.best])) > self.beat / 4:
            away = np.minimum(away, np.abs(away - self.beat))
        same: NDArray[np.bool_] = away <= near
        return same


def _confidence(choice: _Choice, rhythm: Curve, fine: Curve) -> float:
    """Return the confidence, 0 to 1: the least of five measures, each on its ramp in `_RAMPS`.

    margin : the lead over the best rival; height : of the peak over the median; spread : of the song's parts
    peak : the absolute height of the peak; parts : the share of the song's parts with the same best bias
    """
    lags, whole, worth, best, near, _ = choice
    far = ~choice.is_same(lags, _NEAR)
    inside = whole[np.isfinite(whole)]
    deviation = float(np.median(np.abs(inside - np.median(inside)))) * 1.4826 + 1e-9
    parts = fine.reshape(_PARTS, -1, len(lags)).sum(axis=1)
    peaks = lags[near[parts[:, near].argmax(axis=1)]]
    own = np.where(np.isfinite(whole), rhythm.reshape(_PARTS, -1, len(lags)).sum(axis=1), -np.inf).argmax(axis=1)
    measured = {
        "margin": float(worth[best] - worth[far].max()) / (float(whole.max()) + 1e-9),
        "height": float(whole[best] - np.median(inside)) / deviation,
        "spread": -float(np.median(np.abs(peaks - np.median(peaks)))) * 1.4826,
        "peak": float(whole[best]),
        "parts": float(choice.is_same(lags[own], _NEAR).mean()),
    }
    return min(float(np.clip((measured[name] - low) / (high - low), 0, 1)) for name, (low, high) in _RAMPS.items())


# The attacks of the music: the strength of onsets over time, and at given moments.

_WINDOW, _HOP = 256, 64  # samples: 11.6 and 2.9 ms at 22.05 kHz
_BANDS = 16
_LOWEST, _HIGHEST = 60.0, 10_000.0  # Hz
_RISE = 2  # hops over which power rises
_FLOOR = 0.01  # of a band's mean power; rises far below it do not count
_CHUNK = 8192  # windows that are transformed at once
# A rise appears this much too early, as soon as a window contains a loud sample: measured with clicks in noise.
_EARLY = 0.0025  # seconds


class Onsets(NamedTuple):
    """The strength of onsets: float32 (f,), a value every `step` seconds from second `start` on."""

    strength: Curve
    start: float
    step: float

    def at(self, seconds: NDArray[np.float64]) -> Curve:
        """Return the strength at some moments, linear between the values, in the shape of `seconds`.

        Before the curve, it is the first value; after the curve, about the last value, which is 0.
        """
        place = np.clip((seconds - self.start) / self.step, 0, len(self.strength) - 1.001)
        left = place.astype(np.int32)
        share = (place - left).astype(np.float32)
        below, above = self.strength[left], self.strength[left + 1]
        out: Curve = below + share * (above - below)
        return out

    @property
    def seconds(self) -> float:
        """The length of the curve in seconds."""
        return len(self.strength) * self.step


def onsets(sound: Sound) -> Onsets:
    """Return the half-wave rectified rise of log power over two hops, summed over 16 bands.

    A band's power P counts as log10(P + 0.01 mean P), so that power far below the band's mean makes no onset.
    """
    power = _band_power(sound)
    level = np.log10(power + _FLOOR * power.mean(axis=0) + 1e-12)
    rise = np.maximum(level[_RISE:] - level[:-_RISE], 0).sum(axis=1)
    middle = (_WINDOW / 2 + _RISE / 2 * _HOP) / sound.rate
    return Onsets(np.append(rise, np.zeros(2, np.float32)), sound.start + middle + _EARLY, _HOP / sound.rate)


def _band_power(sound: Sound) -> Curve:
    """Return the power in each band of each window; float32 (windows, bands)."""
    padded = np.concatenate([sound.samples, np.zeros(_WINDOW, np.float32)])
    windows = np.lib.stride_tricks.sliding_window_view(padded, _WINDOW)[::_HOP]
    shape = np.hanning(_WINDOW + 1)[:-1].astype(np.float32)
    matrix = _band_matrix(sound.rate)
    out = np.empty((len(windows), matrix.shape[1]), np.float32)
    for first in range(0, len(windows), _CHUNK):
        spectrum = np.fft.rfft(windows[first : first + _CHUNK] * shape, axis=1)
        out[first : first + _CHUNK] = (spectrum.real**2 + spectrum.imag**2) @ matrix
    return out


def _band_matrix(rate: int) -> Curve:
    """Return (bins, bands) with 1 where a bin is in a band. Bands have equal logarithmic width and at least one bin."""
    frequency = np.fft.rfftfreq(_WINDOW, 1 / rate)
    edges = np.geomspace(_LOWEST, _HIGHEST, _BANDS + 1)
    matrix = np.zeros((len(frequency), _BANDS), np.float32)
    low = np.searchsorted(frequency, edges[:-1])
    high = np.searchsorted(frequency, edges[1:])
    for band in range(_BANDS):
        first = max(int(low[band]), 1, band and int(np.flatnonzero(matrix[:, band - 1])[-1]) + 1)
        matrix[first : max(int(high[band]), first + 1), band] = 1
    return matrix
