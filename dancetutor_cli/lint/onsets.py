"""Where a music's attacks are: the strength of onsets over time, and the same at given moments."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.audio import Sound

_WINDOW, _HOP = 256, 64  # samples: 11.6 and 2.9 ms at 22.05 kHz
_BANDS = 16
_LOWEST, _HIGHEST = 60.0, 10_000.0  # Hz
_RISE = 2  # hops over which power rises
_FLOOR = 0.01  # of a band's mean power: below it nothing rises
_CHUNK = 8192  # windows that are transformed at once
# Rises are seen early, for the first of a window's samples to be loud is enough: measured with clicks in noise.
_EARLY = 0.0025  # seconds

Curve = NDArray[np.float32]


class Onsets(NamedTuple):
    """Strength of onsets: float32 (f,), one for each `step` seconds from `start` on."""

    strength: Curve
    start: float
    step: float

    def at(self, seconds: NDArray[np.float64]) -> Curve:
        """The strength at some moments, linear between its values, 0 outside; of the shape of `seconds`."""
        place = np.clip((seconds - self.start) / self.step, 0, len(self.strength) - 1.001)
        left = place.astype(np.int32)
        share = (place - left).astype(np.float32)
        below, above = self.strength[left], self.strength[left + 1]
        out: Curve = below + share * (above - below)
        return out

    @property
    def seconds(self) -> float:
        """How much of the music was looked at."""
        return len(self.strength) * self.step


def onsets(sound: Sound) -> Onsets:
    """The half-wave rectified rise of log power over two hops, summed over 16 bands.

    A band's power P counts as log10(P + 0.01 mean P), so that what is far below the band's mean makes no onset.
    """
    power = _band_power(sound)
    level = np.log10(power + _FLOOR * power.mean(axis=0) + 1e-12)
    rise = np.maximum(level[_RISE:] - level[:-_RISE], 0).sum(axis=1)
    middle = (_WINDOW / 2 + _RISE / 2 * _HOP) / sound.rate
    return Onsets(np.append(rise, np.zeros(2, np.float32)), sound.start + middle + _EARLY, _HOP / sound.rate)


def _band_power(sound: Sound) -> Curve:
    """Power in each band of each window; float32 (windows, bands)."""
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
    """Which bin counts to which band: bands of equal width on a scale of logarithms, of one bin at least."""
    frequency = np.fft.rfftfreq(_WINDOW, 1 / rate)
    edges = np.geomspace(_LOWEST, _HIGHEST, _BANDS + 1)
    matrix = np.zeros((len(frequency), _BANDS), np.float32)
    low = np.searchsorted(frequency, edges[:-1])
    high = np.searchsorted(frequency, edges[1:])
    for band in range(_BANDS):
        first = max(int(low[band]), 1, band and int(np.flatnonzero(matrix[:, band - 1])[-1]) + 1)
        matrix[first : max(int(high[band]), first + 1), band] = 1
    return matrix
