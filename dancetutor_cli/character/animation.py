"""The dancers of `animate`: each dancer of a performance, or of a section of it, for one file."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from dancetutor_cli.character.onto_skeleton import onto
from dancetutor_cli.dance.motion import Cut, padded_from, shifted
from dancetutor_cli.dance.performance import Performance, Performer
from dancetutor_cli.dance.pieces import PieceRunner, in_turn
from dancetutor_cli.feet.unplayable import dropped_notes_message

if TYPE_CHECKING:
    from dancetutor_cli.character.mesh import Character
    from dancetutor_cli.dance.motion import Bar, Motion
    from dancetutor_cli.dance.pieces import BakedPiece
    from dancetutor_cli.dance.plan import Plan


@dataclass(frozen=True)
class Animation:
    """The animation of a performance; motions are made when they are first needed.

    section : first and last second of the music as it is heard, None: the whole dance
    """

    performance: Performance
    section: tuple[float, float] | None = None
    run: PieceRunner = in_turn

    @cached_property
    def baked_pieces(self) -> list[BakedPiece]:
        """The motion of each dancer on the dancer's own pad, with the body of the project's dancer."""
        return self.performance.bake(None if self.section is None else Cut(*self.section), self.run)

    @property
    def begin(self) -> float:
        """The second at which the motions of all dancers begin."""
        return min(float(one.motion.times[0]) for one in self.baked_pieces)


@dataclass(frozen=True)
class AnimatedDancer:
    """One dancer of an animation, for a format; motion and moves are made when they are first needed.

    number : index of the dancer; character : the character that dances
    """

    animation: Animation
    number: int
    character: Character

    @property
    def title(self) -> str:
        """The title of the song."""
        return self._dancer.solved.song.title

    @property
    def label(self) -> str:
        """The label of the chart, for people."""
        return self._dancer.solved.chart.label

    @property
    def section(self) -> tuple[float, float]:
        """The first and the last second of the section."""
        return self.animation.section or (-math.inf, math.inf)

    @property
    def baked_piece(self) -> BakedPiece:
        """The motion on the dancer's own pad, with the body of the project's dancer, whichever character dances."""
        return self.animation.baked_pieces[self.number]

    @property
    def place(self) -> tuple[float, float]:
        """The middle of the dancer's pad from the middle of all pads, (x, z) in metres; (0, 0) for one dancer."""
        return self._dancer.place

    @cached_property
    def motion(self) -> Motion:
        """The motion for the character's skeleton, beginning at the same time as those of the other dancers."""
        return shifted(
            padded_from(onto(self.baked_piece.motion, self.character.skeleton), self.animation.begin), *self.place
        )

    @property
    def moves(self) -> tuple[Plan, Bar | None]:
        """The moves, and the bar that the dancer holds."""
        return self._dancer.plan, self._dancer.context.bar

    def notes(self, of_motion: bool) -> tuple[str, ...]:
        """Return the notes for people, about the whole motion or only about the moves."""
        if of_motion:
            return self.baked_piece.motion.notes
        start, end = self.section
        line = dropped_notes_message([one for one in self._dancer.plan.dropped if start <= one.second <= end])
        return (line,) if line else ()

    @property
    def _dancer(self) -> Performer:
        return self.animation.performance.dancers[self.number]
