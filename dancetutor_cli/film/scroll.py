"""The scroll speed of notes: the games' C, X and M modifiers, and the scroll and speed segments of a chart."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.run.errors import UsageError

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song

Seconds = NDArray[np.float64]
Beats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Scroll:
    """The speed of the notes. At a value of 1, one beat is the spacing of one arrow.

    mode : "C": `value` beats a minute at any tempo; "X": `value` times the song's own beats; "M": like X, with the
        tempo of `reading_bpm` scrolling like C at `value`
    """

    mode: str
    value: float

    def factor(self, scroll_bpm: float) -> float:
        """Return the arrow spacings per second (C) or per beat (X and M); scroll_bpm : the tempo for M."""
        if self.mode == "C":
            return self.value / 60
        return self.value if self.mode == "X" else self.value / max(scroll_bpm, 1.0)


READ = 0.9  # share of the time with notes that is no faster than the tempo of an M mod
REST = 1.0  # maximum weight of the time until the next note, seconds


def reading_bpm(seconds: Seconds, beats: Beats, speeds: NDArray[np.float64]) -> float | None:
    """Return the highest tempo of a chart without the fastest tenth of its time, in beats a minute as drawn.

    None if there is no tempo. The games take the song's displayed or highest tempo. With a gimmick burst, which may be
    sixteen times as fast, or with tempos written at an eighth and #SCROLLS of 8, the notes would overlap or fly past.

    seconds, beats : the time of the rows, float64 (r,), ascending, beats as drawn
    speeds : the factor of the speed segments at each row
    """
    length = np.diff(seconds)
    here = length > 1e-4
    moved = np.abs(np.diff(beats)) * speeds[1:]
    tempo, weight = 60 * moved[here] / length[here], np.minimum(length[here], REST)
    weight = weight[tempo > 1.0]
    tempo = tempo[tempo > 1.0]
    if len(tempo) == 0:
        return None
    order = np.argsort(tempo, kind="stable")
    heard = np.cumsum(weight[order])
    return float(tempo[order][np.searchsorted(heard, READ * heard[-1])])


def parse_scroll(text: str) -> Scroll:
    """Parse a scroll speed such as "C600", "X2", "2x" or "M600"; UsageError shows the allowed values."""
    match = re.fullmatch(r"([CXM])(\d+(?:\.\d+)?)|(\d+(?:\.\d+)?)([XCM])", text.strip().upper())
    if match:
        mode, value = (match[1], match[2]) if match[1] else (match[4], match[3])
        low, high = (0.1, 20.0) if mode == "X" else (30.0, 3000.0)
        if low <= float(value) <= high:
            return Scroll(mode, float(value))
        raise UsageError(f"--scroll {text}: {mode} takes {low:g} to {high:g}")
    raise UsageError(f"--scroll {text}: write C600 (constant speed), X2 (twice the song's speed) or M600 (600 at most)")


@dataclass(frozen=True, slots=True)
class ScrollSegments:
    """#SCROLLS of a chart: from each of `beats`, notes move `ratios` times as far per beat. The beats ascend."""

    beats: Beats
    ratios: NDArray[np.float64]

    def drawn_beats(self, beat: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the beats as they are drawn: the integral of the ratios."""
        if len(self.beats) == 0:
            return beat
        starts = np.concatenate([[0.0], np.cumsum(np.diff(self.beats) * self.ratios[:-1])])
        index = np.clip(np.searchsorted(self.beats, beat, side="right") - 1, 0, None)
        result: NDArray[np.float64] = starts[index] + (beat - self.beats[index]) * self.ratios[index]
        return result


def parse_segments(text: str) -> ScrollSegments:
    """Read a #SCROLLS value, "beat=ratio,..."; invalid entries are left out, as in the games."""
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


@dataclass(frozen=True, slots=True)
class SpeedSegments:
    """#SPEEDS of a chart: a factor of the distances between all notes, which changes during the song; s segments.

    From start to end of a segment, the factor changes evenly from the ratio of the segment before (1 before the first)
    to this segment's ratio, and stays there. The games ignore the factor with C mods.

    start, end : float64 (s,), seconds of the music, ascending; ratio : float64 (s,)
    """

    start: Seconds
    end: Seconds
    ratio: NDArray[np.float64]

    def at(self, seconds: Seconds) -> NDArray[np.float64]:
        """Return the factor at each second."""
        if len(self.start) == 0:
            return np.ones(len(seconds))
        index = np.searchsorted(self.start, seconds, side="right") - 1
        before = np.concatenate([[1.0], self.ratio])[np.maximum(index, 0)]
        here = np.maximum(index, 0)
        length = self.end[here] - self.start[here]
        passed = np.divide(seconds - self.start[here], length, out=np.ones(len(seconds)), where=length > 0)
        factor = before + (self.ratio[here] - before) * np.minimum(passed, 1.0)
        # Before the first segment: the ratio of a sudden segment already applies, a gradual one has not begun.
        early = 1.0 if self.end[0] > self.start[0] else float(self.ratio[0])
        return np.asarray(np.where(index < 0, early, factor))


def parse_speeds(text: str, seconds_of: Callable[[Beats], Seconds]) -> SpeedSegments:
    """Read a #SPEEDS value, "beat=ratio=length=unit,..." with a length in beats (unit 0) or seconds (unit 1).

    Invalid entries are left out, as in the games.

    seconds_of : returns the second of the music of each beat
    """
    found: dict[float, tuple[float, float, bool]] = {}
    for entry in text.split(","):
        try:
            beat, ratio, length, *unit = (float(part) for part in entry.split("="))
        except ValueError:
            continue
        if all(map(math.isfinite, (beat, ratio, length))) and length >= 0:
            found[beat] = ratio, length, bool(unit and unit[0] == 1)
    if not found or {ratio for ratio, _, _ in found.values()} == {1.0}:
        return SpeedSegments(np.zeros(0), np.zeros(0), np.zeros(0))
    beats = np.array(sorted(found))
    rows = np.array([found[b] for b in beats.tolist()], dtype=np.float64)
    lengths, start = rows[:, 1], seconds_of(beats)
    end = np.where(rows[:, 2] > 0, start + lengths, seconds_of(beats + lengths))
    return SpeedSegments(start, end, rows[:, 0])


def segments_of(song: Song, chart: Chart) -> ScrollSegments:
    """Return the chart's #SCROLLS."""
    return parse_segments(_timing_tag(song, chart, "SCROLLS"))


def speeds_of(song: Song, chart: Chart) -> SpeedSegments:
    """Return the chart's #SPEEDS."""
    return parse_speeds(_timing_tag(song, chart, "SPEEDS"), chart.timing.seconds_of_beats)


def _timing_tag(song: Song, chart: Chart, name: str) -> str:
    """Return a timing tag: the chart's own if the chart has split timing, else the song's."""
    return (song.tags if chart.timing is song.timing else chart.tags).get(name, "")
