"""How fast notes scroll: the games' C, X and M modifiers, and the scroll segments of a chart."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.errors import UsageError

Seconds = NDArray[np.float64]
Beats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Scroll:
    """Speed of the notes. `mode` "C": `value` beats a minute whatever the song does; "X": times the song's own beats;
    "M": like X, so that the fastest part of the song scrolls like C at `value`. One beat is one arrow's spacing at 1.
    """

    mode: str
    value: float

    def factor(self, fastest_bpm: float) -> float:
        """Arrow spacings per second (C) or per beat (X and M)."""
        if self.mode == "C":
            return self.value / 60
        return self.value if self.mode == "X" else self.value / max(fastest_bpm, 1.0)


def parse_scroll(text: str) -> Scroll:
    """ "C600", "X2", "2x" or "M600"; UsageError says what is allowed."""
    match = re.fullmatch(r"([CXM])(\d+(?:\.\d+)?)|(\d+(?:\.\d+)?)([XCM])", text.strip().upper())
    if match:
        mode, value = (match[1], match[2]) if match[1] else (match[4], match[3])
        low, high = (0.1, 20.0) if mode == "X" else (30.0, 3000.0)
        if low <= float(value) <= high:
            return Scroll(mode, float(value))
        raise UsageError(f"scroll speed {text!r} is out of range: {mode} takes {low:g} to {high:g}")
    raise UsageError(f"unknown scroll speed {text!r}: write C600 (constant), X2 (times the song) or M600 (at most)")


@dataclass(frozen=True, slots=True)
class ScrollSegments:
    """#SCROLLS of a chart: from each beat on, notes move `ratio` times as far per beat. Beats ascend."""

    beats: Beats
    ratios: NDArray[np.float64]

    def shown(self, beat: NDArray[np.float64]) -> NDArray[np.float64]:
        """The beats as far as they are drawn: the integral of the ratios."""
        if len(self.beats) == 0:
            return beat
        starts = np.concatenate([[0.0], np.cumsum(np.diff(self.beats) * self.ratios[:-1])])
        index = np.clip(np.searchsorted(self.beats, beat, side="right") - 1, 0, None)
        result: NDArray[np.float64] = starts[index] + (beat - self.beats[index]) * self.ratios[index]
        return result


def parse_segments(text: str) -> ScrollSegments:
    """Read a #SCROLLS value, "beat=ratio,..."; entries that make no sense are left out, as the games do."""
    found: dict[float, float] = {}
    for entry in text.split(","):
        left, equals, right = entry.partition("=")
        try:
            beat, ratio = float(left), float(right)
        except ValueError:
            continue
        if equals and math.isfinite(beat) and math.isfinite(ratio):
            found[beat] = ratio
    if not found or set(found.values()) == {1.0}:
        return ScrollSegments(np.zeros(0), np.zeros(0))
    beats = sorted(found)
    return ScrollSegments(np.array(beats), np.array([found[b] for b in beats]))
