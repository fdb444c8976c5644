"""Rules about far turns of the body: spins, turns within a jump, half turns at once."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import EPSILON, ChartRule, MoveRule, Occurrence
from dancetutor_cli.lint.rules.fast_step import burst

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject

UNCROSSED = 90.0  # degrees that the body may be turned without the feet being crossed
SIDEWAYS = 140.0  # degrees: one foot is across the other, more beside it than before it
_REST = 0.25  # seconds of a breath, see `Freedom.rest`
_MANY = 4  # more spins than this are the idea of a chart and make one finding
_TWISTS = 20  # meter of Pump charts from which players expect to turn
_ONE_RING = 4  # panels of a pad on which a full turn can only go round the same four panels
_UNROUND = 1.3  # how many times farther one of four panels in a ring may be from their middle than another
ONE_PAD = 2.0  # panel widths from the leftmost to the rightmost panel


class Spin(MoveRule):
    """A spin: the pattern turns the dancer past 180 degrees, unless a foot doublesteps to avoid it.

    Not reported:
    - steps between two rests or jumps, if the feet stay uncrossed when the other foot begins. A rest is about twice the
      pace of the passage, or the long half of a swing rhythm; two panels at once can always be jumped;
    - a walk along two pads on which one foot passes the other;
    - a phrase that begins after a jump, if one crossover avoids the spin;
    - spins in a burst, which DT305 reports.

    More than four spins in a chart are one finding. A spin in a jump is DT203.

    It is only an info:
    - on Pump from meter 20 on;
    - for twists on a pad of more than four panels that do not go around four panels, such as twists around the Pump
      centre;
    - where mines leave no other panel.

    `max_seconds`: only steps at most this long after the step before count. With more time players turn back instead.

    Bad (max_seconds = 0.6): the feet turn on instead of uncrossing.

        1000  L
        0100  R
        0001  L
        0010  R

    Better (max_seconds = 0.6): the last step goes back.

        1000  L
        0100  R
        0001  L
        0100  R
    """

    code = "DT202"
    name = "spin"
    foot_rank = 3
    foot_reach = 1
    fixed_by_moves = True
    unwanted_move = "spin"
    move = "spin"
    description = "the pattern turns the dancer past 180 degrees, unless a foot doublesteps"
    times = "spin"

    def rows(self, subject: ChartSubject) -> Iterable[int]:
        """Return the spins that are not in a jump; DT203 reports spins in a jump."""
        return [row for row in subject.rows_with(self.move) if not subject.is_jump(row)]

    def occurrences(self, subject: ChartSubject) -> Iterable[Occurrence]:
        """Yield each spin, with the longest pause since the feet were uncrossed: given time, players uncross them."""
        from dancetutor_cli.lint.other_foot import Freedom, fewest_crossed

        play, longest = subject.play, self.longest(subject)
        if play is None:
            return
        for row in self.rows(subject):
            first = row
            while first and abs(play.facing[first - 1]) > UNCROSSED:
                first -= 1
            steps = [at for at in range(first, row + 1) if play.rows.steps[at].any()]
            slowest = max(map(subject.pause, steps))
            if (
                slowest > longest + EPSILON
                or self._has_uncrossed_start(subject, row)
                or self._walks(subject, row)
                or burst(subject, row)
            ):
                continue
            free = Freedom(longest, rest=_REST)
            if fewest_crossed(subject, row, free) <= self._after_pair(subject, row):
                continue
            yield Occurrence(row, slowest, self.description)

    def _has_uncrossed_start(self, subject: ChartSubject, row: int) -> bool:
        """Whether the steps around the spin, or the steps up to the rest before it, are uncrossed on the other foot."""
        from dancetutor_cli.lint.other_foot import exchanged_is_uncrossed, goes_on_the_other_foot, segment

        quick, rows = self.longest(subject), subject.step_rows
        if goes_on_the_other_foot(subject, row, quick):
            return True
        at = int(rows.searchsorted(row))
        if not at or not subject.beginnings.fresh_starts(quick)[at]:
            return False
        first, last = segment(subject, at, quick)
        return goes_on_the_other_foot(subject, int(rows[at - 1]), quick) and exchanged_is_uncrossed(
            subject, rows[first : last + 1], swap=False
        )

    def _after_pair(self, subject: ChartSubject, row: int) -> int:
        """Return how many steps may be crossed instead of a spin: one after two panels at once, else none."""
        from dancetutor_cli.lint.other_foot import segment

        rows = subject.step_rows
        first = segment(subject, int(rows.searchsorted(row)), self.longest(subject))[0]
        return int(first > 0 and len(subject.step_columns(int(rows[first - 1]))) > 1)

    def is_expected(self, subject: ChartSubject, rows: list[int]) -> bool:
        """Whether the author means the spins: a Pump chart of twists, steps not in a ring, or steps between mines."""
        pump, meter = subject.chart.steps_type.startswith("pump"), subject.chart.meter
        if pump and meter >= _TWISTS:
            return True
        twisted = subject.pad is not None and len(subject.pad) > _ONE_RING
        return all((twisted and not _goes_round(subject, row)) or _between_mines(subject, row) for row in rows)

    def passages(self, found: list[Occurrence], subject: ChartSubject) -> Iterable[list[Occurrence]]:
        """Return each spin alone, or all spins together in a chart with many."""
        return [found] if len(found) > _MANY else [[one] for one in found]

    def _walks(self, subject: ChartSubject, row: int) -> bool:
        """Whether the dancer only walks along two pads, where one foot passes beside the other."""
        play, pad = subject.play, subject.pad
        if play is None or pad is None or row == 0:
            return False
        beside = max(abs(play.facing[row - 1]), abs(play.facing[row])) >= SIDEWAYS
        return bool(beside and pad.width > ONE_PAD)


def _goes_round(subject: ChartSubject, row: int) -> bool:
    """Whether four single steps, with the step of the row, go round four panels of a ring in order."""
    import numpy as np

    rows, pad = subject.step_rows, subject.pad
    if pad is None:
        return False
    at = int(rows.searchsorted(row))
    for first in range(max(0, at - 3), min(at, len(rows) - 4) + 1):
        steps = [subject.step_columns(int(one)) for one in rows[first : first + 4]]
        if any(len(step) != 1 for step in steps):
            continue
        places = pad.panels[[step[0] for step in steps]]
        x, y = (places - places.mean(axis=0)).T
        far, turned = np.hypot(x, y), np.diff(np.degrees(np.arctan2(y, x)))
        turned = (turned + 180.0) % 360.0 - 180.0
        if far.max() <= _UNROUND * far.min() and abs(np.sign(turned).sum()) == 3 and abs(turned).max() < 180.0:
            return True
    return False


def _between_mines(subject: ChartSubject, row: int) -> bool:
    """Whether a row has a wall of mines, so that the author means every step."""
    from dancetutor_cli.lint.play_facts import WALL

    return subject.play is not None and int(subject.play.rows.mines[row].sum()) >= WALL


class JumpSpin(ChartRule):
    """A spin in a jump: to land this jump, the dancer has to turn past 180 degrees.

    Both feet leave the pad, so nothing guides the turn as in a normal spin, and the player cannot see the screen on
    landing.

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
    foot_rank = 4
    fixed_by_moves = True
    unwanted_move = "spin"
    about_feet = True

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each spin that ends in a jump."""
        for row in subject.rows_with("spin"):
            if subject.is_jump(row):
                yield self.finding("the body turns past 180 degrees in this jump", subject.at_row(row))


class HalfTurn(ChartRule):
    """A half turn: between two rows the body turns by 180 degrees at once, from one side to the other.

    `max_seconds`: only rows at most this long after the step before count; with more time the dancer turns step by
    step.

    Bad (max_seconds = 0.6):

        0100  L
        0010  R
        0110  RL
        0000

    Better (max_seconds = 0.6):

        0100  L
        0010  R
        0110  LR
        0000
    """

    code = "DT304"
    name = "half-turn"
    foot_rank = 13
    foot_reach = 1
    about_feet = True

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each half turn."""
        facts = subject.facts
        for row in facts.own(facts.candidates.half_turns) if facts else ():
            if subject.pause(row) <= self.options["max_seconds"] + EPSILON:
                yield self.finding(
                    f"the body turns by 180 degrees at once{_landing(subject, row)}", subject.at_row(row)
                )


def _landing(subject: ChartSubject, row: int) -> str:
    """Return which foot turns the body, and where it lands: ": the left foot lands behind the right one".

    "" for a jump, or if the feet are side by side.
    """
    play = subject.play
    if play is None or subject.pad is None or (play.feet[row] < 0).any() or subject.is_jump(row):
        return ""
    foot = int((play.limb[row] == Limb.RIGHT_FOOT).any())
    ahead = subject.pad.panels[play.feet[row], 1]
    if ahead[0] == ahead[1]:
        return ""
    way = "in front of" if ahead[foot] > ahead[1 - foot] else "behind"
    one, other = ("left", "right")[foot], ("right", "left")[foot]
    return f", and the {one} foot lands {way} the {other} one"
