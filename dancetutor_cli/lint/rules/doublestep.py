"""DT201: one foot steps twice in a row on different panels."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import MoveRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject

_BEFORE, _AFTER = 3, 1  # steps
_JUMPED = 0.13  # seconds: a 16th at 115 BPM


class Doublestep(MoveRule):
    """The cheapest way to play this row moves the foot that has just stepped, although the other foot is free.

    Players expect left and right in turn; a doublestep makes them stumble, and is mostly an accident of the pattern
    before it. Doublesteps that a hold forces or a mine asks for are not reported, nor brackets: both panels at once are
    no step after the other. Nor those beside a bracket that has time to be jumped, or a hold that changes feet: any
    foot may go on there. Nor those that cross the feet: the other foot would be there uncrossed.

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
            and not _begun_anew(subject, row) and not subject.feet.crossed(row)
        ]  # fmt: skip

    def message(self, subject: ChartSubject, row: int) -> str:
        """Which foot."""
        return f"the {subject.foot_name(row)} foot steps twice in a row though the other is free"


def _begun_anew(subject: ChartSubject, row: int) -> bool:
    """Whether a bracket that can be jumped as well, or a hold that changes feet, is near: there any foot may go on."""
    assert subject.play is not None
    rows = subject.step_rows
    at = int(rows.searchsorted(row))
    for one in rows[max(at - _BEFORE, 0) : at + _AFTER + 1].tolist():
        pair = subject.brackets(one) and len(subject.pressed(one)) == 2 and not subject.is_jump(one)
        if (pair and subject.pause(one) > _JUMPED) or (one < row and "holdswitch" in subject.play.moves[one]):
            return True
    return False
