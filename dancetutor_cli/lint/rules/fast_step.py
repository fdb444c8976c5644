"""The rule DT305: a step that is too far for its time."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

from dancetutor_cli.feet.preset import DropReason
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.rule import EPSILON, ChartRule, passages

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject

_FEET_STEP = 0.045  # seconds; quicker rows are too quick for feet: 16ths at 333 BPM
_PASSAGE = 8  # beats
_SIXTEENTH = 0.13  # seconds: 16ths at 115 BPM
_HEEL_AND_TOE = 14  # meter of Pump charts from which one foot takes two neighbouring panels with heel and toe
_GRACE = 0.06  # seconds; two rows closer together are not 16ths
_AS_ONE = 0.03  # seconds; two rows closer together are probably meant as one
_NEIGHBOUR_TAP_METER = 13  # meter from which a foot that holds a panel also taps a neighbouring panel
_QUICK = 20  # meter from which players do not play every note
_NEIGHBOUR = 1.5  # panel widths between neighbouring panels, at most
_FEW = 2  # most far steps of a passage that are reported one by one
_NUMBERS = {3: "three", 4: "four"}
_RESTED = 0.2  # seconds since a foot's last step after which it is as good as the other foot


class FastStep(ChartRule):
    """One foot has to travel farther than it can in the time since its last step.

    Steps that the dancer of the films cannot take are always reported, whatever the limits: steps within 80 ms of the
    foot's last step, to a panel that is not next to it. They are reported once in two measures. They are an info in
    charts of meter 20 and more, in rolls, and if the other foot could take them.

    - A flam is not reported if the other foot is free for one of its two steps, or becomes free at the end of its hold.
    - Three panels among 16ths, and two, one and two panels in a row, have a message of their own.
    - Rows less than 30 ms apart are reported as a slip of the grid. Three or more rows less than 45 ms apart are
      reported as a burst, once in two measures.
    - On Pump pads it is an info from meter 14 on, because these players take neighbouring panels with heel and toe.
      From meter 13 on it is not reported if the other foot is on a hold and can tap a panel next to it.
    - Three or more other such steps of one foot, at most two measures apart, are one finding.

    `max_speed`: panel widths per second, in a straight line from panel to panel. `min_seconds`: steps closer together
    are a flam, one movement of the foot, and do not count.

    Bad (max_speed = 2): the left foot crosses the whole pad in half a second.

        1000  L
        0001  L
        0000
        0000

    Better (max_speed = 2):

        1000  L
        0001  R
        0000
        0000
    """

    code = "DT305"
    name = "fast-step"
    about_feet = True

    def check(self, subject: ChartSubject) -> Iterable[Finding]:
        """One finding for each step that is too fast, or for each passage of rows that are too quick."""
        feet, bursts = subject.facts, []
        moves: dict[tuple[str, str], list[tuple[int, int, str]]] = {}  # by foot and severity
        reported: set[tuple[int, str]] = set()
        limits = self.options["max_speed"], self.options["min_seconds"]
        for row, column, way, seconds in feet.too_fast(*limits) if feet else ():
            if rows := burst(subject, row):
                bursts.append(rows)
            elif feet and not _free_foot_takes_it(subject, row, self.options["max_speed"]):
                place, message = _dense(subject, row)
                least = {"severity": "info"} if _has_heel_and_toe(subject) else {}
                if not message and subject.pause(row) >= _AS_ONE:
                    foot = feet.limb_name(row, column)
                    message = f"the {foot} has to travel {way:.1f} panel widths in {seconds * 1000:.0f} ms"
                    moves.setdefault((foot, least.get("severity", "")), []).append((row, column, message))
                    reported.add((row, message))
                    continue
                if subject.pause(row) < _AS_ONE:
                    place = row
                    apart = f"{subject.pause(row) * 1000:.0f} ms"
                    message = f"this row comes {apart} after the row before: were they meant as one?"
                    least = {}
                if (place, message) not in reported:
                    yield self.finding(message, subject.at_row(place, column if place == row else None), **least)
                reported.add((place, message))
        for (_, severity), found in moves.items():
            yield from self._moves(subject, found, {"severity": severity} if severity else {})
        end = -math.inf
        for rows in sorted(bursts):
            if subject.beat(rows[0]) > end + _PASSAGE:
                quickest = 1000 * min(subject.pause(row) for row in rows[1:])
                message = f"{len(rows)} rows {quickest:.0f} ms apart: too quick for feet"
                yield self.finding(message, subject.at_row(rows[1]))
            end = subject.beat(rows[-1])
        yield from self._leaps(subject, {row for rows in bursts for row in rows} | {row for row, _ in reported})

    def _moves(
        self, subject: ChartSubject, found: list[tuple[int, int, str]], least: dict[str, str]
    ) -> Iterable[Finding]:
        """Yield a finding for each far step of a foot, or one for a passage of many, where the feet are surest."""
        for passage in passages(found, lambda one: subject.beat(one[0]), _PASSAGE):
            rows = [row for row, _, _ in passage]
            if len(rows) <= _FEW:
                for row, column, message in passage:
                    yield self.finding(message, subject.at_row(row, column), **least)
                continue
            row, column, message = passage[subject.most_confident(rows)]
            first, last = (round(subject.beat(one), 3) for one in (rows[0], rows[-1]))
            message += f"; {len(rows)} of them from beat {first:g} to {last:g}"
            yield self.finding(message, subject.at_row(row, column), **least)

    def _leaps(self, subject: ChartSubject, reported: set[int]) -> Iterable[Finding]:
        """Yield one finding for each passage of steps that are not played and not reported yet."""
        from dancetutor_cli.feet.play import StepKind  # imports numpy, which a kept result does not need

        end = -math.inf
        known = [subject.beat(row) for row in sorted(reported)]
        for row, column, why in sorted(subject.too_quick):
            if why != DropReason.LEAP:
                continue
            beat = subject.beat(row)
            if beat > end + _PASSAGE and not any(beat - _PASSAGE <= one <= beat for one in known):
                foot = subject.facts.limb_name(row, column) if subject.facts else "foot"
                roll = subject.play is not None and subject.play.rows.steps[row, column] == StepKind.ROLL_TAP
                expected = roll or subject.chart.meter >= _QUICK or _has_heel_and_toe(subject)
                expected = expected or _free_foot_takes_it(subject, row, self.options["max_speed"])
                least = {"severity": "info"} if expected else {}
                yield self.finding(f"the {foot} would have to leap to this panel", subject.at_row(row, column), **least)
            end = beat


def burst(subject: ChartSubject, row: int) -> list[int]:
    """Return the rows around a row that are too quick for feet, if there are at least three; else none."""
    rows = subject.step_rows
    first = last = int(rows.searchsorted(row))
    while first and subject.pause(int(rows[first])) < _FEET_STEP:
        first -= 1
    while last + 1 < len(rows) and subject.pause(int(rows[last + 1])) < _FEET_STEP:
        last += 1
    return rows[first : last + 1].tolist() if last - first >= 2 else []


def _has_heel_and_toe(subject: ChartSubject) -> bool:
    """Whether this is a Pump chart whose players take two panels with heel and toe."""
    return subject.chart.steps_type.startswith("pump") and subject.chart.meter >= _HEEL_AND_TOE


def _dense(subject: ChartSubject, row: int) -> tuple[int, str]:
    """Return row and message if three panels at once, or two panels before and after one step, are the fault.

    Otherwise, the message is "".
    """
    rows = subject.step_rows
    at = int(rows.searchsorted(row))
    for place in range(max(at - 2, 0), at + 1):
        panels = len(subject.step_columns(int(rows[place])))
        before = subject.pause(int(rows[place]))
        after = subject.pause(int(rows[place + 1])) if place + 1 < len(rows) else math.inf
        if panels >= 3 and min(before, after) < _SIXTEENTH:
            where = f"{1000 * after:.0f} ms before the next step"
            if after >= _SIXTEENTH:
                where = f"{1000 * before:.0f} ms after the step before"
            around = rows[max(place - 1, 0) : place + 3].tolist()
            sixteenths = sum(_GRACE <= subject.pause(one) < _SIXTEENTH for one in around) > 1
            among = " in the middle of 16ths" if sixteenths else ""
            return int(rows[place]), f"{_NUMBERS.get(panels, panels)} panels{among}, {where}"
    for first in (at - 2, at - 1):
        if first >= 0 and first + 2 < len(rows):
            counts = [len(subject.step_columns(int(one))) for one in rows[first : first + 3]]
            apart = max(subject.pause(int(one)) for one in rows[first + 1 : first + 3])
            if counts == [2, 1, 2] and apart < _SIXTEENTH:
                return row, f"two panels, then one, then two in 16ths, {1000 * apart:.0f} ms apart"
    return row, ""


def _other_hold_ends(subject: ChartSubject, before: int, row: int) -> bool:
    """Whether the other foot's hold ends between two single steps, and it can take the second step uncrossed."""
    from dancetutor_cli.lint.other_foot import panels_before

    play, pad = subject.play, subject.pad
    if play is None or pad is None or any((play.limb[one] >= 0).sum() != 1 for one in (before, row)):
        return False
    limb, first, second = int(play.limb[row].max()), int(play.limb[before].argmax()), int(play.limb[row].argmax())
    ends = play.rows.hold_end[:before].max(axis=0, initial=0)
    ending = (ends > play.rows.tick[before]) & (ends <= play.rows.tick[row])
    stood = panels_before(subject, before)
    if limb > 1 or stood[1 - limb] < 0 or not ending[stood[1 - limb]]:
        return False
    x, _ = (pad.panels[second] - pad.panels[first]) * (1 if limb == 0 else -1)
    return bool(x >= -EPSILON)


def _can_tap_neighbour(subject: ChartSubject, before: int, row: int) -> bool:
    """Whether the other foot holds a panel and can also tap one of two single steps beside this panel, uncrossed."""
    import numpy as np

    from dancetutor_cli.lint.other_foot import panels_before

    play, pad = subject.play, subject.pad
    if play is None or pad is None or subject.chart.meter < _NEIGHBOUR_TAP_METER:
        return False
    if any((play.limb[one] >= 0).sum() != 1 for one in (before, row)):
        return False
    limb, columns = int(play.limb[row].max()), [int(play.limb[one].argmax()) for one in (before, row)]
    if limb > 1 or (held := panels_before(subject, before)[1 - limb]) < 0:
        return False
    if play.rows.hold_end[:before, held].max(initial=-1) < play.rows.tick[row]:
        return False
    for tapped, stepped in (columns, columns[::-1]):
        beside = np.hypot(*(pad.panels[tapped] - pad.panels[held])) <= _NEIGHBOUR
        way = (pad.panels[tapped, 0] - pad.panels[stepped, 0]) * (1 if limb == 0 else -1)
        if beside and way >= -EPSILON:
            return True
    return False


def _free_foot_takes_it(subject: ChartSubject, row: int, max_speed: float) -> bool:
    """Whether two single steps are a flam for two feet, in which the other foot has time to take the first step."""
    import numpy as np

    from dancetutor_cli.lint.other_foot import panels_before

    play, pad, rows = subject.play, subject.pad, subject.step_rows
    at = int(rows.searchsorted(row))
    if play is None or pad is None or subject.facts is None or at < 2:
        return False
    before = int(rows[at - 1])
    if _other_hold_ends(subject, before, row) or _can_tap_neighbour(subject, before, row):
        return True
    if any((play.limb[one] >= 0).sum() != 1 or subject.facts.down[one] != 1 for one in (before, row)):
        return False
    limb, first, second = int(play.limb[row].max()), int(play.limb[before].argmax()), int(play.limb[row].argmax())
    if limb > 1 or int(play.limb[before, first]) != limb or min(stood := panels_before(subject, before)) < 0:
        return False
    stepped = subject.facts.presses.of(1 - limb).row
    since = int(stepped.searchsorted(before)) - 1
    if since < 0:
        return False
    seconds = play.rows.second[before] - play.rows.second[stepped[since]]
    way = float(np.hypot(*(pad.panels[first] - pad.panels[stood[1 - limb]])))
    came = float(np.hypot(*(pad.panels[second] - pad.panels[stood[limb]])))
    x, y = (pad.panels[first] - pad.panels[second]) * (1 if limb == 0 else -1)
    uncrossed = abs(np.degrees(np.arctan2(y, x))) <= 90 + EPSILON
    in_time = seconds >= _RESTED and way <= max_speed * seconds and came <= max_speed * subject.pause(before)
    return bool(uncrossed and in_time)
