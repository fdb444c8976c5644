"""The film's clock: which second of the music each frame shows. The music drives; frames only sample it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from dancetutor_cli.chart.timing import heard
from dancetutor_cli.errors import UsageError
from dancetutor_cli.motion.baked import Cut


@dataclass(frozen=True, slots=True)
class Pass:
    """One run through a stretch of the music. start, end : seconds of the music; rate : 0.5 is half speed.

    sound_from : the music is silent before this second, while `count` beats are counted in
    rest : seconds of the music at its end in which nobody steps and the music fades: she comes to rest
    """

    start: float
    end: float
    rate: float = 1.0
    sound_from: float = -math.inf
    count: int = 0
    rest: float = 0.0

    @property
    def until(self) -> float:
        """The second of the music up to which its notes are danced."""
        return self.end - self.rest

    @property
    def seconds(self) -> float:
        """How long it lasts in the film."""
        return self.shown(self.end)

    def shown(self, second: float) -> float:
        """Seconds of the film from the pass's beginning to a second of the music."""
        return heard(second - self.start, self.rate)


@dataclass(frozen=True, slots=True)
class Moment:
    """What a frame shows: a second of the music, and the rate at which it is played there."""

    second: float
    rate: float = 1.0

    @property
    def heard(self) -> float:
        """The second in the music as it is heard: at half speed everything comes at twice its second."""
        return heard(self.second, self.rate)


@dataclass(frozen=True, slots=True)
class Clock:
    """Maps film seconds to music seconds over one or more passes. fps : frames per second of the film."""

    passes: tuple[Pass, ...]
    fps: int

    def __post_init__(self) -> None:
        if not self.passes or any(p.end <= p.start for p in self.passes):
            raise UsageError("the section to render is empty")

    @property
    def seconds(self) -> float:
        """Length of the film."""
        return sum(p.seconds for p in self.passes)

    @property
    def frames(self) -> int:
        """Number of frames: enough to cover the film."""
        return max(1, math.ceil(self.seconds * self.fps - 1e-6))

    def at(self, frame: int) -> tuple[float, int]:
        """Second of the music that a frame shows, and which pass it lies in.

        Frame k is on the screen from k / fps on. What happens at a second T shows in the first frame not before T.
        """
        film = frame / self.fps
        for number, one in enumerate(self.passes):
            if film < one.seconds - 1e-9:
                return one.start + film * one.rate, number
            film -= one.seconds
        return self.passes[-1].end, len(self.passes) - 1

    def cut_at(self, rate: float) -> Cut:
        """What is danced at a rate, from the first pass to the last, in seconds of the music as it is heard then.

        Before the step that passes count to nobody steps, nor while the music fades.
        """
        first, last = self.passes[0], self.passes[-1]
        seconds = (first.start, last.end, first.sound_from if first.count else -math.inf, last.until)
        start, end, steps_from, steps_until = (heard(second, rate) for second in seconds)
        return Cut(start, end, steps_from, steps_until if last.rest else math.inf)

    def moment(self, frame: int) -> Moment:
        """The second of the music that a frame shows, with the rate of its pass."""
        second, number = self.at(frame)
        return Moment(second, self.passes[number].rate)


@dataclass(frozen=True, slots=True)
class Moments(Clock):
    """A clock for single pictures: frame k shows the k-th of `times`, seconds of the music."""

    times: tuple[float, ...] = ()

    @property
    def frames(self) -> int:
        """Number of pictures."""
        return len(self.times)

    def at(self, frame: int) -> tuple[float, int]:
        """Second of the music that a picture shows; there is only one pass."""
        return self.times[frame], 0
