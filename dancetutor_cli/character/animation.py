"""The dancers of `animate`: a performance, or a section of it, as each of its dancers is written to a file."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from dancetutor_cli.character.onto_skeleton import onto
from dancetutor_cli.dance.motion import Cut, padded_from, shifted
from dancetutor_cli.dance.performance import Performance, Performer
from dancetutor_cli.dance.pieces import PieceRunner, in_turn
from dancetutor_cli.feet.play import dropped_notes_message

if TYPE_CHECKING:
    from dancetutor_cli.character.mesh import Character
    from dancetutor_cli.dance.motion import Bar, Motion
    from dancetutor_cli.dance.pieces import BakedPiece
    from dancetutor_cli.dance.plan import Plan


@dataclass(frozen=True)
class Animation:
    """What is animated of a performance; motions are made when they are first wanted.

    section : first and last second of the music as it is heard, None: the whole dance
    """

    performance: Performance
    section: tuple[float, float] | None = None
    run: PieceRunner = in_turn

    @cached_property
    def baked(self) -> list[BakedPiece]:
        """Of each dancer the motion of the project's own dancer, on her own pad."""
        return self.performance.motions(None if self.section is None else Cut(*self.section), self.run)

    @property
    def begin(self) -> float:
        """The second at which the motions of all begin."""
        return min(float(one.motion.times[0]) for one in self.baked)


@dataclass(frozen=True)
class AnimatedDancer:
    """One dancer of an animation, for a format; motion and moves are made when they are first needed.

    number : which one; character : who dances
    """

    animation: Animation
    number: int
    character: Character

    @property
    def title(self) -> str:
        """Of the song."""
        return self._dancer.solved.song.title

    @property
    def label(self) -> str:
        """Of the chart, for people."""
        return self._dancer.solved.chart.label

    @property
    def section(self) -> tuple[float, float]:
        """First and last second that is wanted."""
        return self.animation.section or (-math.inf, math.inf)

    @property
    def baked(self) -> BakedPiece:
        """The motion of the project's own dancer on her own pad, whichever character dances."""
        return self.animation.baked[self.number]

    @property
    def place(self) -> tuple[float, float]:
        """Where the middle of her pad is from that of all, (x, z) in metres; of one dancer (0, 0)."""
        return self._dancer.place

    @cached_property
    def motion(self) -> Motion:
        """The motion for the character's skeleton, beginning with those of the others."""
        return shifted(padded_from(onto(self.baked.motion, self.character.skeleton), self.animation.begin), *self.place)

    @property
    def moves(self) -> tuple[Plan, Bar | None]:
        """Only the moves, and the bar that she holds."""
        return self._dancer.plan, self._dancer.context.bar

    def notes(self, of_motion: bool) -> tuple[str, ...]:
        """What there is to say, for people: of the whole motion, or only of the moves."""
        if of_motion:
            return self.baked.motion.notes
        start, end = self.section
        line = dropped_notes_message([one for one in self._dancer.plan.let_go if start <= one.second <= end])
        return (line,) if line else ()

    @property
    def _dancer(self) -> Performer:
        return self.animation.performance.dancers[self.number]
