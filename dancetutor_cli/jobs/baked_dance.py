"""A dance that is baked when it is first wanted, alone or with another dancer."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from dancetutor_cli.jobs.bake import Asked, BakeTask, bake_asked, plan_asked, wishes_of

if TYPE_CHECKING:
    from dancetutor_cli.bake.styled import Styled
    from dancetutor_cli.character.mesh import Character
    from dancetutor_cli.motion.baked import Bar, Motion
    from dancetutor_cli.motion.plan import Plan


@dataclass
class BakedDance:
    """What is asked for, made when it is first wanted; as `formats.writers.Dance` describes it.

    other : the one with whom she dances, on another part of the pad of both; their motions begin together
    """

    asked: Asked
    task: BakeTask
    character: Character
    other: BakedDance | None = None

    @property
    def title(self) -> str:
        """Of the song."""
        return self.asked.song.title

    @property
    def label(self) -> str:
        """Of the chart, for people."""
        return self.asked.chart.label

    @property
    def section(self) -> tuple[float, float]:
        """First and last second that is wanted."""
        return self.asked.section or (-math.inf, math.inf)

    @cached_property
    def styled(self) -> Styled:
        """The motion of the project's own dancer in the style, and how far the ragdoll was from it."""
        from dancetutor_cli.bake.styled import styled
        from dancetutor_cli.motion.settings import load_settings

        befalls = wishes_of(self.task.push, self.task.trip, rate=self.task.rate)
        settings = load_settings(self.task.motion, self.task.form)
        return styled(bake_asked(self.asked, self.task, self.sides), self.task.style, settings, befalls)

    @property
    def place(self) -> tuple[float, float]:
        """Where the middle of her pad is from that of both, (x, z) in metres; of one dancer (0, 0)."""
        from dancetutor_cli.jobs.two import pad_of_both, place_on

        if self.other is None:
            return 0.0, 0.0
        chart = self.asked.chart
        return place_on(pad_of_both(chart.written_type), chart, self.asked.pad)

    @property
    def sides(self) -> tuple[int, int] | None:
        """From which side she comes and to which she goes beside another one; None of one dancer."""
        from dancetutor_cli.jobs.two import sides_of

        if self.other is None:
            return None
        both = sorted((self.asked.chart, self.other.asked.chart), key=lambda part: part.player)
        return sides_of(both)[int(both[1] is self.asked.chart)]

    @property
    def own_motion(self) -> Motion:
        """The motion of the project's own dancer, whoever dances, on her own pad."""
        return self.styled.motion

    @cached_property
    def motion(self) -> Motion:
        """The motion for the character's skeleton."""
        from dancetutor_cli.character.retarget import retarget
        from dancetutor_cli.motion.baked import held_from, shifted

        begin = min(float(one.own_motion.times[0]) for one in (self, self.other) if one is not None)
        return shifted(held_from(retarget(self.own_motion, self.character), begin), *self.place)

    def notes(self, of_motion: bool) -> tuple[str, ...]:
        """What there is to say, for people: of the whole motion, or only of the moves."""
        if of_motion:
            return self.own_motion.notes
        from dancetutor_cli.play.let_go import told

        start, end = self.section
        line = told([one for one in self.moves[0].let_go if start <= one.second <= end])
        return (line,) if line else ()

    @cached_property
    def moves(self) -> tuple[Plan, Bar | None]:
        """Only the moves, and the bar that she holds."""
        return plan_asked(self.asked, self.task, self.sides)
