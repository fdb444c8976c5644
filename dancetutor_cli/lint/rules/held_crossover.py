"""DT215: a foot crosses the other one, which a hold keeps on its panel."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import Occurrence, TimedRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class HeldCrossover(TimedRule):
    """One foot steps across the other, which has to stay on a hold: neither a switch nor a turn gets her out of it.

    In a crossover the foot that is crossed goes on with the next step; here it cannot, and the other one has to come
    back the way it went. Crossings at most four measures apart are one finding: a foot that goes round a held one
    turns her again and again.

    `max_seconds`: only steps at most this long after the step before count; with more time she turns and comes back.

    Bad (max_seconds = 0.6):

        0020  R
        1000  L
        0001  L
        0030

    Better (max_seconds = 0.6):

        0020  R
        1000  L
        0100  L
        0030
    """

    code = "DT215"
    name = "held-crossover"
    passage_beats = 16

    def is_silent(self, subject: ChartSubject) -> bool:
        """Whether the feet are never crossed, or nothing is held."""
        return subject.feet is None or not subject.feet.has_holds or not subject.feet.crossed_runs()

    def occurrences(self, subject: ChartSubject) -> Iterable[Occurrence]:
        """Each single step after which the feet are newly crossed, while the other foot holds."""
        if subject.play is None or subject.feet is None:
            return
        limbs = subject.play.limb
        for row in self.quick(subject, [first for first, _ in subject.feet.crossed_runs()]):
            pressed = subject.pressed(row)
            foot = int(limbs[row].max())
            if len(pressed) == 1 and foot <= 1 and subject.feet.holds(1 - foot, row):
                feet = ("left", "right") if foot == 0 else ("right", "left")
                said = f"the {feet[0]} foot crosses the {feet[1]} one, which a hold keeps on its panel"
                yield Occurrence(row, subject.pause(row), said)
