"""The film's clock: the passes of a film, the second of the music that each frame shows, and blocks of joints."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Kind
from dancetutor_cli.chart.names import TICKS_PER_BEAT, TICKS_PER_MEASURE
from dancetutor_cli.chart.timing import FASTEST, SLOWEST, heard_second
from dancetutor_cli.dance.motion import Cut
from dancetutor_cli.run.errors import DancetutorError, UsageError

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart


@dataclass(frozen=True, slots=True)
class Pass:
    """A pass through a stretch of the music; a practice film shows its number and speed to players as a run.

    start, end : seconds of the music; rate : 0.5 is half speed
    sound_from : the music is silent before this second, while `count` beats are counted in
    rest : seconds of the music at the end of the pass, in which nobody steps, the music fades and the dancer comes to
        rest
    """

    start: float
    end: float
    rate: float = 1.0
    sound_from: float = -math.inf
    count: int = 0
    rest: float = 0.0

    @property
    def until(self) -> float:
        """The second of the music up to which the notes of this pass are danced."""
        return self.end - self.rest

    @property
    def seconds(self) -> float:
        """The length of this pass in the film, seconds."""
        return self.film_seconds(self.end)

    def film_seconds(self, second: float) -> float:
        """Return the seconds of the film from the beginning of this pass to a second of the music."""
        return heard_second(second - self.start, self.rate)


@dataclass(frozen=True, slots=True)
class Moment:
    """The second of the music that a frame shows, and the rate at which the music is played there."""

    second: float
    rate: float = 1.0

    @property
    def heard_second(self) -> float:
        """The second in the music as it is heard: at half speed each event comes at twice its second."""
        return heard_second(self.second, self.rate)


@dataclass(frozen=True, slots=True)
class Clock:
    """A map from film seconds to music seconds over one or more passes. fps : frames per second of the film."""

    passes: tuple[Pass, ...]
    fps: int

    def __post_init__(self) -> None:
        if not self.passes or any(p.end <= p.start for p in self.passes):
            raise UsageError("the section to render is empty")

    @property
    def seconds(self) -> float:
        """The length of the film, seconds."""
        return sum(p.seconds for p in self.passes)

    @property
    def frames(self) -> int:
        """The smallest number of frames that covers the film."""
        return max(1, math.ceil(self.seconds * self.fps - 1e-6))

    def at(self, frame: int) -> tuple[float, int]:
        """Return the second of the music that a frame shows, and the index of the frame's pass.

        Frame k is on the screen from k / fps on. An event at second T shows in the first frame that is not before T.
        """
        film = frame / self.fps
        for number, one in enumerate(self.passes):
            if film < one.seconds - 1e-9:
                return one.start + film * one.rate, number
            film -= one.seconds
        return self.passes[-1].end, len(self.passes) - 1

    def cut_at(self, rate: float) -> Cut:
        """Return the part that is danced at `rate`, from the first pass to the last, in seconds of the music as heard.

        Nobody steps during the count-in or while the music fades.
        """
        first, last = self.passes[0], self.passes[-1]
        seconds = (first.start, last.end, first.sound_from if first.count else -math.inf, last.until)
        start, end, steps_from, steps_until = (heard_second(second, rate) for second in seconds)
        return Cut(start, end, steps_from, steps_until if last.rest else math.inf)

    def moment(self, frame: int) -> Moment:
        """Return the second of the music that a frame shows, with the rate of its pass."""
        second, number = self.at(frame)
        return Moment(second, self.passes[number].rate)


@dataclass(frozen=True, slots=True)
class PictureClock(Clock):
    """A clock for single pictures: frame k shows the k-th of `times`, seconds of the music."""

    times: tuple[float, ...] = ()

    @property
    def frames(self) -> int:
        """The number of pictures."""
        return len(self.times)

    def at(self, frame: int) -> tuple[float, int]:
        """Return the second of the music that a picture shows, and 0, the index of the only pass."""
        return self.times[frame], 0


# The passes of a film: their stretch of the music, number and speed, with count-in, claps and metronome.

LEAD_IN, LEAD_OUT = 2.0, 3.0  # seconds before the first and after the last note
REST = 2.2  # seconds of film after a passage, in which the dancer can step home, stand and smile
# Minimum and maximum seconds, as heard, between the numbers of a count-in. Some gimmick songs have 19 BPM.
COUNTABLE = (0.3, 1.6)


@dataclass(frozen=True, slots=True)
class Practice:
    """Aids for practice. loop : number of passes (0: one for each rate)

    count_in : beats counted before each pass
    rest : seconds of film after the last pass, in which the dancer comes to rest
    claps : a clap on each step; metronome : a tick on each beat
    """

    loop: int = 0
    count_in: int = 0
    claps: bool = False
    metronome: bool = False
    rest: float = 0.0


def parse_rates(text: str) -> tuple[float, ...]:
    """Parse a list of rates such as "0.5,0.75,1.0"; UsageError for a rate outside `SLOWEST` to `FASTEST`."""
    try:
        rates = tuple(float(part) for part in text.split(","))
    except ValueError:
        rates = ()
    if not rates or not all(SLOWEST <= rate <= FASTEST for rate in rates):
        raise UsageError(
            f"--rate {text}: write speeds from {SLOWEST:g} to {FASTEST:g}, separated by commas, such as 0.5,0.75,1"
        )
    return rates


def passes_of(chart: Chart, practice: Practice, rates: tuple[float, ...], start: float, end: float) -> tuple[Pass, ...]:
    """Return the passes through a section, at each of the rates in turn, each with its count-in.

    With a count-in, the measures without steps at the beginning of the section are left out. A count-in counts beats,
    or half or double beats if beats are too slow or too fast to count.
    """
    lead = 0.0
    if practice.count_in:
        start = _first_measure(chart, start, end)
        beat = 60 / chart.timing.bpm_at(round(float(chart.timing.beats(np.array([start]))[0]) * TICKS_PER_BEAT))
        lead = practice.count_in * _count_in_interval(beat, min(rates))
    count = practice.loop or len(rates)
    passes = [
        Pass(start - lead, end, rates[i % len(rates)], start if lead else -math.inf, practice.count_in)
        for i in range(count)
    ]
    rest = practice.rest * passes[-1].rate
    return (*passes[:-1], replace(passes[-1], end=end + rest, rest=rest))


def _count_in_interval(beat: float, rate: float) -> float:
    """Return the seconds of the music between two numbers of a count-in.

    This is one beat, halved or doubled until it can be counted at `rate`.
    """
    least, most = (second * rate for second in COUNTABLE)
    while beat > most:
        beat /= 2
    while 0 < beat < least:
        beat *= 2
    return beat


def _first_measure(chart: Chart, start: float, end: float) -> float:
    """Return the second at which the measure with a section's first step begins, but not before `start`.

    A section without steps has `start`.
    """
    notes = chart.notes
    stepped = notes.tick[~np.isin(notes.kind, (Kind.MINE, Kind.FAKE))]
    seconds = chart.timing.seconds(stepped)
    here = stepped[(seconds >= start - 1e-6) & (seconds < end)]
    if len(here) == 0:
        return start
    measure = here.min() // TICKS_PER_MEASURE * TICKS_PER_MEASURE
    return max(start, float(chart.timing.seconds(np.array([measure]))[0]))


def whole_song(chart: Chart) -> tuple[float, float]:
    """Return the start and end of the film of a whole chart, in seconds of the music.

    The film lasts from the beginning of the music to a few seconds after the last note.
    """
    notes = chart.notes
    if len(notes) == 0:
        raise DancetutorError(f"{chart.label}: the chart has no notes, so there is nothing to render")
    ticks = np.array([notes.tick.min(), notes.last_tick])
    first, last = chart.timing.seconds(ticks)
    return min(0.0, float(first) - LEAD_IN), float(last) + LEAD_OUT


# The dancer's joints in the frames of a film, computed for a block of frames at once, which is fast.

BLOCK = 64  # frames in a block


class JointBlocks:
    """The dancer's joints, computed in fixed blocks of frames.

    The blocks are always the same, so that no bit of a frame depends on the frames that were drawn before it.

    joints_at : returns the world matrices (f, j, 4, 4) of the joints at f moments
    """

    def __init__(self, joints_at: Callable[[Sequence[Moment]], NDArray[np.float64]], clock: Clock) -> None:
        self._joints_at, self._clock = joints_at, clock
        self._block, self._joints = -1, np.zeros((0, 0, 4, 4))

    def at(self, number: int) -> NDArray[np.float64]:
        """Return the world matrices (j, 4, 4) of the joints in frame `number`."""
        block = number // BLOCK
        if block != self._block:
            frames = range(block * BLOCK, min((block + 1) * BLOCK, self._clock.frames))
            self._joints = self._joints_at([self._clock.moment(k) for k in frames])
            self._block = block
        joints: NDArray[np.float64] = self._joints[number - block * BLOCK]
        return joints
