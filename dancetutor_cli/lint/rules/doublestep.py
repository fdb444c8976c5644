"""DT201: one foot steps twice in a row on different panels."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import MoveRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class Doublestep(MoveRule):
    """The cheapest way to play this row moves the foot that has just stepped, although the other foot is free.

    Players expect left and right in turn; a doublestep makes them stumble, and is mostly an accident of the pattern
    before it. Doublesteps that a hold forces or a mine asks for are not reported, nor brackets: both panels at once are
    no step after the other.

    `max_seconds`: only steps at most this long after the step before count; after a longer rest players put down
    whichever foot they like. by-meter: what at most `share` per cent of the charts of a meter have.
    `min_seconds`: steps closer together are a flam, one movement of the foot.

    Bad (max_seconds = 0.6):

        1000  L
        0001  R
        1000  L
        0010  L

    Better (max_seconds = 0.6):

        1000  L
        0001  R
        0100  L
        0010  R
    """

    code = "DT201"
    name = "doublestep"
    move = "doublestep"
    times = "doublestep"

    def rows(self, subject: ChartSubject) -> Iterable[int]:
        """Doublesteps from one panel to another, no mine between them."""
        return [
            row for row in subject.rows_with(self.move)
            if subject.feet and subject.feet.follows_freely(row) and subject.pause(row) >= self.options["min_seconds"]
        ]  # fmt: skip

    def message(self, subject: ChartSubject, row: int) -> str:
        """Which foot."""
        return f"the {subject.foot_name(row)} foot steps twice in a row though the other is free"
