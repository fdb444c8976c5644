"""Rules about one foot that steps twice or three times in a row on different panels."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import TYPE_CHECKING

from dancetutor_cli.lint.rule import EPSILON, MoveRule, Occurrence, TimedRule

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject

_BEFORE, _AFTER = 3, 1  # steps before and after a row that are near
_CROSSED_RATHER = 0.15  # seconds: a 16th at 100 BPM; at this speed, players prefer a short crossover to a doublestep
ONE_PAD = 2.0  # panel widths from the leftmost to the rightmost panel
_SHORT = 2  # most crossed rows of a short crossover
_LONG, _LONGER = 0.25, 1.45  # seconds, times the step beside it: a dotted note and longer, after which one begins again
_LED = 3  # the same, between two pads


class Doublestep(MoveRule):
    """A doublestep: the foot that has just stepped steps again, on another panel, although the other foot is free.

    Players expect left and right to alternate, so a doublestep makes them stumble. Most doublesteps are accidents of
    the pattern before them.

    Not reported:
    - doublesteps that a hold or a mine forces, and brackets (two panels at once are one step);
    - the first step after a pause of about two steps, or a step just before one: players take a side panel with the
      foot on that side;
    - steps before or after a jump, after a wall of mines, or next to a holdswitch:
      there, players can go on with either foot;
    - doublesteps that cross the feet, and 16ths where a short crossover avoids the doublestep;
    - groups of steps, if the gap between groups is about twice the gap between steps, and each group can start on the
      foot that keeps it uncrossed;
    - steps at 0.25 s and slower, if a quicker group begins with the step, or if the
      same foot could also step twice after the next rest instead.

    It is only an info:
    - on Pump, if the step goes to or from the centre, at 0.25 s and slower;
    - if alternating feet would cross once, and a jump after that uncrosses them;
    - on two pads, after a jack, if alternating feet would be crossed for three steps at most.

    `max_seconds`: only steps at most this long after the step before count. After a longer rest, players begin with
    either foot. by-meter: a doublestep is reported if at most `share` per cent of the charts of this meter have one
    that is as quick. Slower than 0.32 s it is never reported, because nobody stumbles on the 4ths of an easy chart.
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
    editor_code = "DS"
    foot_rank = 1
    foot_reach = 1
    fixed_by_moves = True
    unwanted_move = "doublestep"
    move = "doublestep"
    times = "doublestep"
    slowest = 0.32

    def rows(self, subject: ChartSubject) -> Iterable[int]:
        """Return the quick doublesteps for which there is no other way to dance that players prefer."""
        from dancetutor_cli.lint.other_foot import Freedom, fewest_crossed, in_groups

        facts, longest = subject.facts, self.longest(subject)
        found = facts.own(facts.candidates.free_doublesteps) if facts else []
        return [
            row for row in self.quick(subject, found)
            if subject.pause(row) >= self.options["min_seconds"] and not any_foot_near(subject, row)
            and not _has_better_start(subject, row, longest) and not _at_a_pause(subject, row)
            and not (in_groups(subject, row) and fewest_crossed(subject, row, Freedom(longest)) == 0)
        ]  # fmt: skip

    def is_expected(self, subject: ChartSubject, rows: list[int]) -> bool:
        """Whether players expect it: a Pump centre, one crossover to a jump, or a way between two pads after a jack."""
        from dancetutor_cli.lint.other_foot import Freedom, fewest_crossed, led_by_a_jack

        if all(
            _round_the_centre(subject, row) or _crosses_to_jump(subject, row, self.longest(subject)) for row in rows
        ):
            return True
        if subject.pad is None or subject.pad.width <= ONE_PAD:
            return False
        changing = Freedom(self.longest(subject), switch=0.0)
        return all(led_by_a_jack(subject, row) and fewest_crossed(subject, row, changing) <= _LED for row in rows)

    def message(self, subject: ChartSubject, row: int) -> str:
        """Return the message, which names the foot."""
        return f"the {subject.foot_name(row)} foot steps twice although the other foot is free"


def _at_a_pause(subject: ChartSubject, row: int) -> bool:
    """Whether a quicker group begins with this step, or the next step comes so late that the repeat can be there."""
    from dancetutor_cli.lint.other_foot import exchanged_is_uncrossed, panels_before

    rows = subject.step_rows
    at = int(rows.searchsorted(row))
    if at + 1 == len(rows):
        return False
    pause, after = subject.pause(row), subject.pause(int(rows[at + 1]))
    if pause >= _LONG - EPSILON and pause >= _LONGER * after:
        return True
    waits = after >= _LONG - EPSILON and after >= _LONGER * pause
    return waits and exchanged_is_uncrossed(subject, rows[at : at + 1], panels_before(subject, row))


def _round_the_centre(subject: ChartSubject, row: int) -> bool:
    """Whether one of both panels is the centre of a Pump pad, and there is time to twist."""
    rows = subject.step_rows
    if not subject.chart.steps_type.startswith("pump") or subject.pause(row) < _LONG - EPSILON:
        return False
    before = int(rows[int(rows.searchsorted(row)) - 1])
    return any(column % 5 == 2 for one in (before, row) for column in subject.step_columns(one))


def _crosses_to_jump(subject: ChartSubject, row: int, quick: float) -> bool:
    """Whether alternating feet cross only once, by less than 180 degrees, before two panels at once uncross them."""
    from dancetutor_cli.lint.other_foot import exchanged_facings, panels_before, segment

    assert subject.facts is not None
    rows = subject.step_rows
    at = int(rows.searchsorted(row))
    last = segment(subject, at, quick, forwards_only=True)[1]
    if last + 1 >= len(rows) or len(subject.step_columns(int(rows[last + 1]))) != 2:
        return False
    if (subject.facts.down[rows[at : last + 1]] != 1).any() or subject.pause(row) < _CROSSED_RATHER:
        return False
    facings = exchanged_facings(subject, rows[at : last + 1], panels_before(subject, row))
    crossed = [abs(one) > 90 + EPSILON for one in facings]
    return max(map(abs, facings)) < 180 and sum(one != two for one, two in pairwise([False, *crossed])) == 1


def any_foot_near(subject: ChartSubject, row: int) -> bool:
    """Whether a bracket that can be jumped, a wall of mines or a holdswitch is near."""
    assert subject.play is not None
    rows = subject.step_rows
    at = int(rows.searchsorted(row))
    for place in range(max(at - _BEFORE, 0), min(at + _AFTER + 1, len(rows))):
        one = int(rows[place])
        pair = subject.brackets(one) and len(subject.step_columns(one)) == 2 and not subject.is_jump(one)
        switched = one < row and "holdswitch" in subject.play.moves[one]
        if pair or switched or (place <= at and subject.beginnings.after_walls[place]):
            return True
    return False


def _has_better_start(subject: ChartSubject, row: int, quick: float) -> bool:
    """Whether players prefer another way: the other foot first before or after the step, or a short crossover."""
    from dancetutor_cli.lint.other_foot import exchanged_facings, exchanged_is_uncrossed, panels_before, segment

    assert subject.play is not None and subject.facts is not None
    rows, pause = subject.step_rows, subject.pause(row)
    at = int(rows.searchsorted(row))
    if subject.beginnings.rests[at]:
        return True
    before, last = segment(subject, at - 1, quick)[0], segment(subject, at, quick, forwards_only=True)[1]
    foot = int(subject.play.limb[row].max())
    if _own_side(subject, int(rows[before]), exchanged=True) and exchanged_is_uncrossed(
        subject, rows[before:at], panels_before(subject, int(rows[before]))
    ):
        return True
    ends = last + 1 < len(rows)
    stand = panels_before(subject, row)
    if ends and _own_side(subject, int(rows[last + 1])) and exchanged_is_uncrossed(subject, rows[at : last + 1], stand):
        return True
    facings = exchanged_facings(subject, rows[at : last + 1], stand)
    crossed = [abs(one) for one in facings if abs(one) > 90 + EPSILON]
    return (
        ends
        and pause <= _CROSSED_RATHER + EPSILON
        and foot <= 1
        and len(crossed) <= _SHORT
        and max(crossed, default=0.0) < 180
    )


def _own_side(subject: ChartSubject, row: int, *, exchanged: bool = False) -> bool:
    """Whether a row is a single step on the foot's own side of its pad; exchanged : on the other foot's side."""
    assert subject.play is not None and subject.pad is not None
    limbs = subject.play.limb[row]
    if (limbs >= 0).sum() != 1 or limbs.max() > 1:
        return False
    panels, column = subject.pad.panels, int(limbs.argmax())
    half = len(panels) // 2
    of_pad = panels[half * (2 * column // len(panels)) :][:half] if subject.pad.width > ONE_PAD else panels
    off = panels[column, 0] - of_pad[:, 0].mean()
    right = (int(limbs.max()) == 1) != exchanged
    return bool(off > EPSILON if right else off < -EPSILON)


class TripleStep(TimedRule):
    """A triple step: one foot steps three times in a row, each time on another panel: two doublesteps without a rest.

    Not reported:
    - steps while the other foot is on a hold, taps of a roll, and steps around a mine;
    - steps before or after a jump, after a wall of mines, or next to a holdswitch:
      there, players can go on with either foot;
    - steps after a jack, if alternating feet stay uncrossed.

    `max_seconds`: only steps at most this far apart count. With by-meter, the limit is the longest time at which at
    most `share` per cent of the charts of this meter have a doublestep (DT201).
    `min_seconds`: steps closer together are a flam, one movement of the foot.

    Bad (max_seconds = 0.6):

        0001  R
        1000  L
        0100  L
        0010  L

    Better (max_seconds = 0.6):

        0001  R
        1000  L
        0100  R
        0010  L
    """

    code = "DT209"
    name = "triple-step"
    editor_code = "DS"
    foot_rank = 2
    foot_reach = 1
    fixed_by_moves = True
    unwanted_move = "doublestep"
    times = "doublestep"
    slowest = Doublestep.slowest

    def occurrences(self, subject: ChartSubject) -> Iterable[Occurrence]:
        """Yield each third step that is quick enough. Slow steps do not count, so they decide where a run begins."""
        from dancetutor_cli.lint.other_foot import Freedom, fewest_crossed, led_by_a_jack

        spans = self.options["min_seconds"], self.longest(subject)
        for row, seconds in subject.facts.triple_steps(*spans) if subject.facts else ():
            free = Freedom(self.longest(subject))
            in_turn = led_by_a_jack(subject, row) and fewest_crossed(subject, row, free) == 0
            if in_turn or any_foot_near(subject, row):
                continue
            yield Occurrence(row, seconds, f"the {subject.foot_name(row)} foot steps three times in a row")
