"""DT206: in a jump, a foot leaves its panel to the other foot."""

from __future__ import annotations

from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import MoveRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class JumpFootswitch(MoveRule):
    """In this jump a foot that already stands on one of its panels has to change to the other one.

    Bad: the right foot stands on the up arrow and must leave it in mid-air:

        <  .  .  .   L
        .  .  ^  .   R
        .  v  .  .   L
        <  .  ^  .   must be shared the other way round

    Better: a jump on the panels that the feet stand on, or on two new ones.
    """

    code = "DT206"
    name = "jump-footswitch"
    move = "jump-footswitch"

    def message(self, subject: ChartSubject, row: int) -> str:
        """The same for every jump footswitch."""
        return "a foot changes panels within this jump: jump footswitch"
