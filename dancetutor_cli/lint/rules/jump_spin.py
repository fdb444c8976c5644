"""DT203: the body turns beyond 180 degrees within a jump."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import ChartRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class JumpSpin(ChartRule):
    """The feet land on a jump only after turning past the dancer's back: a spin in the air.

    Both feet leave the pad, so unlike in a spin nothing guides the turn, and the screen is out of sight while landing.

    Bad:

        1000  L
        0100  R
        0001  L
        0011  RL

    Better:

        1000  L
        0100  R
        0010  L
        1001  LR
    """

    code = "DT203"
    name = "jump-spin"
    about_feet = True

    def is_silent(self, subject: ChartSubject) -> bool:
        """Whether she never spins."""
        return not subject.has("spin")

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each spin that ends in a jump."""
        for row in subject.rows_with("spin"):
            if subject.is_jump(row):
                yield self.finding("the body turns beyond 180 degrees within this jump", subject.at_row(row))
