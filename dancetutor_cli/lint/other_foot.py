"""Whether another way to dance a passage crosses the feet less, and where the dancer may begin with either foot."""

from __future__ import annotations

import math
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.feet.play import Play
from dancetutor_cli.lint.play_facts import WALL
from dancetutor_cli.lint.rule import EPSILON

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


# The steps at which the dancer may begin again with either foot, found once for all steps of a play.

RESTED = 0.45  # seconds; after a longer pause, feet need not alternate: 9 of 10 labelled crossings are quicker
REST = 1.75  # times the pace of the passage: a quarter among eighths, not the longer note of a gallop
_SHORTEST = 0.22  # seconds of the shortest rest
_AROUND = 7  # steps to either side that set the pace


class Beginnings:
    """The k steps of a play, numbered from 0, and where the dancer begins again with either foot.

    rows : (k,) row of each step; pauses : (k,) seconds since the step before, inf for the first
    """

    def __init__(self, play: Play, rows: NDArray[np.int64], pauses: NDArray[np.float64]) -> None:
        self._play, self._rows, self._pauses = play, rows, pauses
        self._anew: dict[float, NDArray[np.bool_]] = {}
        self._starts: dict[float, NDArray[np.int64]] = {}

    @cached_property
    def rests(self) -> NDArray[np.bool_]:
        """(k,) whether the pause before a step is about twice the pace of the steps around it."""
        rests, count = self._pauses >= _SHORTEST, len(self._rows)
        long = np.flatnonzero(rests)
        around = long[:, None] + np.arange(-_AROUND, _AROUND + 1)
        known = (around >= 1) & (around < count)  # the first step has no pause before it
        times = np.sort(np.where(known, self._pauses[around.clip(0, count - 1)], np.inf), axis=1)
        many = known.sum(axis=1)
        middle = times[np.arange(len(long)), np.maximum(many - 1, 0) // 2]  # the median, or the lesser middle value
        rests[long] = self._pauses[long] >= REST * np.where(many > 0, middle, 0.0)
        return rests

    @cached_property
    def pairs(self) -> NDArray[np.bool_]:
        """(k,) whether more than one panel is pressed, in a jump or a bracket."""
        return np.asarray((self._play.limb[self._rows] >= 0).sum(axis=1) > 1)

    @cached_property
    def after_walls(self) -> NDArray[np.bool_]:
        """(k,) whether a wall of mines, for which dancers leave the panels, is between a step and the step before."""
        found = np.zeros(len(self._rows), dtype=bool)
        walls = np.concatenate([[0], (self._play.rows.mines.sum(axis=1) >= WALL).cumsum()])
        found[1:] = walls[self._rows[1:]] > walls[self._rows[:-1] + 1]
        return found

    def fresh_starts(self, quick: float) -> NDArray[np.bool_]:
        """Return (k,) whether the dancer may begin with either foot at a step.

        This holds for the first step, for two panels at once, and after a rest, a wall of mines or two panels at once.
        quick : the longest time (s) between steps that is quick and so no rest, even if longer than `RESTED`
        """
        if quick not in self._anew:
            anew = self.rests | self.pairs | self.after_walls | (self._pauses > max(RESTED, quick + EPSILON))
            anew[1:] |= self.pairs[:-1]
            anew[:1] = True
            self._anew[quick] = anew
        return self._anew[quick]

    def segment(self, at: int, quick: float) -> tuple[int, int]:
        """Return the first and the last step of the passage around a step in which the dancer does not begin again."""
        if quick not in self._starts:
            self._starts[quick] = np.flatnonzero(self.fresh_starts(quick))
        starts = self._starts[quick]
        after = int(starts.searchsorted(at, side="right"))
        return int(starts[after - 1]), int(starts[after]) - 1 if after < len(starts) else len(self._rows) - 1


# Whether a passage is also uncrossed on the other foot: after a rest or a jump, players begin with either foot.

_CROSSED = 90.0 + 1e-6  # degrees


def goes_on_the_other_foot(subject: ChartSubject, row: int, quick: float, *, jacked: bool = False) -> bool:
    """Whether the steps around a row, from one rest or jump to the next, never cross with left and right exchanged.

    quick : the longest time (s) between steps that the rule calls quick, so no rest, even if longer than `RESTED`
    jacked : the exchange begins at the row itself, where one foot steps twice; it need not begin after a rest, but must
        end at one
    """
    if subject.facts is None or subject.play is None:
        return False
    rows = subject.step_rows
    first, last = segment(subject, int(rows.searchsorted(row)), quick, forwards_only=jacked)
    stand = panels_before(subject, int(rows[first])) if jacked else None
    return exchanged_is_uncrossed(subject, rows[first : last + 1], stand)


def segment(subject: ChartSubject, at: int, quick: float, *, forwards_only: bool = False) -> tuple[int, int]:
    """Return the first and the last step of the passage around step `at` in which the dancer does not begin again."""
    first, last = subject.beginnings.segment(at, quick)
    return at if forwards_only else first, last


def panels_before(subject: ChartSubject, row: int) -> list[int]:
    """Return the panels of both feet before a row, -1 for a foot that may be anywhere."""
    assert subject.play is not None
    return [int(one) for one in subject.play.feet[row - 1][:2]] if row else [-1, -1]


def exchanged_is_uncrossed(
    subject: ChartSubject, rows: NDArray[np.int64], stand: list[int] | None = None, *, swap: bool = True
) -> bool:
    """Whether these rows are single steps that never cross the feet with left and right exchanged.

    stand : panels of both feet before the rows; swap : whether the feet are exchanged
    """
    play, feet = subject.play, subject.facts
    if play is None or feet is None:
        return False
    single = ((play.limb[rows] >= 0).sum(axis=1) == 1) & (feet.down[rows] == 1)
    facings = exchanged_facings(subject, rows, stand, swap=swap) if single.all() else [180.0]
    return all(abs(one) <= _CROSSED for one in facings)


def exchanged_facings(
    subject: ChartSubject, rows: NDArray[np.int64], stand: list[int] | None = None, *, swap: bool = True
) -> list[float]:
    """Return the degrees that the body is turned after each of some single steps, 0 while a foot may be anywhere."""
    assert subject.play is not None
    left, right = (-1, -1) if stand is None else stand
    limbs = subject.play.limb[rows]
    facings = []
    for column, foot in zip(limbs.argmax(axis=1).tolist(), limbs.max(axis=1).tolist(), strict=True):
        if (1 - foot if swap else foot) & 1:
            right = column
        else:
            left = column
        facings.append(0.0 if left < 0 or right < 0 else subject.angles[left][right])
    return facings


# Whether another way to dance the steps around a row crosses the feet less. After a breath, dancers choose a foot.

_BEFORE, _AFTER = 16, 12  # steps to either side of the row, if no rest comes first
_BREATH = 0.22  # seconds of the shortest breath: a shorter pause is part of a run
_SWUNG = 0.2  # seconds of the shortest breath if `Freedom.rest` is set: the long half of a swing rhythm is a breath
_NEAR = 5  # steps
_UNKNOWN = -1


class Freedom(NamedTuple):
    """The moves that the dancer may make besides alternating the feet. After a rest, either foot may begin.

    quick : the longest time (s) between steps that the rule calls quick
    rest : a pause of at least so many seconds is compared only with the steps before it, see `is_breath`
    switch : after at least so many seconds, the feet may change on a panel that is stepped on again
    slip : after at least so many seconds, one foot may step twice in a row, once in the phrase: after a jack, or to the
        other of two pads
    spins : whether the body may turn on past the back
    lead : after at least so many seconds, either foot may begin if the next step comes in about half that time
    """

    quick: float
    rest: float = math.inf
    switch: float = math.inf
    slip: float = math.inf
    spins: bool = False
    lead: float = math.inf


class _Stand(NamedTuple):
    """Panels of both feet (left, right), the last foot that stepped, degrees of the body, whether a foot slipped."""

    panels: tuple[int, int]
    last: int
    facing: float
    slipped: bool


def fewest_crossed(subject: ChartSubject, row: int, freedom: Freedom) -> float:
    """Return the least number of crossed steps with which the phrase around a row can be danced with this freedom.

    The result is inf if there is no way, or if the phrase has a hold or two panels at once.
    """
    play, feet = subject.play, subject.facts
    if play is None or feet is None or subject.pad is None:
        return math.inf
    rows = subject.step_rows
    at = int(rows.searchsorted(row))
    first = last = at
    while first > max(at - _BEFORE, 0) and not _begins(subject, first, freedom):
        first -= 1
    while last + 1 < min(at + _AFTER, len(rows)) and not _begins(subject, last + 1, freedom):
        last += 1
    phrase = rows[first : last + 1]
    if ((play.limb[phrase] >= 0).sum(axis=1) != 1).any() or (feet.down[phrase] != 1).any():
        return math.inf
    columns = play.limb[phrase].argmax(axis=1).tolist()
    anew = bool(subject.beginnings.fresh_starts(freedom.quick)[first])
    ways = _starts(subject, first, anew=anew)
    before = int(play.limb[int(rows[first - 1])].argmax()) if first and not anew else _UNKNOWN
    for place, column in enumerate(columns):
        step = _Step(subject, first + place, column, before, freedom)
        ways = step.stances_after(ways, free=anew and place == 0)
        before = column
    return min(ways.values(), default=math.inf)


def _begins(subject: ChartSubject, at: int, freedom: Freedom) -> bool:
    """Whether a phrase begins with step `at`; if `freedom.rest` is set, a breath also begins a phrase."""
    if subject.beginnings.fresh_starts(freedom.quick)[at]:
        return True
    return freedom.rest < math.inf and is_breath(subject, at, freedom.rest)


def is_breath(subject: ChartSubject, at: int, rest: float = math.inf) -> bool:
    """Whether step `at` begins a group: the pause before it is about twice the pauses before and after that pause.

    rest : a pause of at least so many seconds need only be about twice the pause before it
    """
    rows = subject.step_rows
    pause = subject.pause(int(rows[at]))
    before = subject.pause(int(rows[at - 1])) if at > 1 else math.inf
    after = subject.pause(int(rows[at + 1])) if at + 1 < len(rows) else math.inf
    least = _BREATH if rest == math.inf else _SWUNG
    return pause >= least and pause >= REST * (before if pause >= rest else max(before, after))


def in_groups(subject: ChartSubject, row: int) -> bool:
    """Whether one of the few steps before and after a row begins a group."""
    at = int(subject.step_rows.searchsorted(row))
    return any(
        is_breath(subject, one) for one in range(max(at - _NEAR, 1), min(at + _NEAR + 1, len(subject.step_rows)))
    )


def led_by_a_jack(subject: ChartSubject, row: int) -> bool:
    """Whether two of the few steps before a row, one after the other, are on the same panels."""
    rows = subject.step_rows
    at = int(rows.searchsorted(row))
    pressed = [subject.step_columns(int(one)) for one in rows[max(at - _NEAR, 0) : at]]
    return any(one == two for one, two in pairwise(pressed))


def has_mine_since_step(subject: ChartSubject, row: int) -> bool:
    """Whether a mine is between the step before a row and the row, or in the row. Authors mark footswitches so."""
    assert subject.play is not None
    before = int(subject.step_rows[int(subject.step_rows.searchsorted(row)) - 1])
    return bool(subject.play.rows.mines[before + 1 : row + 1].any())


def _starts(subject: ChartSubject, first: int, *, anew: bool) -> dict[_Stand, int]:
    play, rows = subject.play, subject.step_rows
    assert play is not None
    if anew:
        return {_Stand((_UNKNOWN, _UNKNOWN), _UNKNOWN, 0.0, False): 0}
    left, right = panels_before(subject, int(rows[first]))
    last = int(play.limb[int(rows[first - 1])].max())
    return {_Stand((left, right), last, float(play.facing[int(rows[first]) - 1]), False): 0}


class _Step(NamedTuple):
    """One step of the phrase: step `at` of the play, on panel `column`, after a step on panel `before`."""

    subject: ChartSubject
    at: int
    column: int
    before: int
    freedom: Freedom

    def stances_after(self, ways: dict[_Stand, int], *, free: bool) -> dict[_Stand, int]:
        """Return the stances after this step, each with its least number of crossed steps.

        free : whether either foot may take the step
        """
        subject, freedom = self.subject, self.freedom
        pause = subject.pause(int(subject.step_rows[self.at]))
        free = free or is_breath(subject, self.at, freedom.rest) or (pause >= freedom.lead and self._leads(pause))
        again = self.column == self.before
        slips = pause >= freedom.slip and (self._after_jacks() or self._to_other_pad())
        found: dict[_Stand, int] = {}
        for stand, crossed in ways.items():
            for foot in (0, 1):
                same = foot == stand.last
                allowed = free or stand.last == _UNKNOWN or same == again or (again and pause >= freedom.switch)
                slipped = stand.slipped
                if not allowed and same and slips and not slipped:
                    allowed = slipped = True
                after = self._stood(stand, foot, slipped) if allowed else None
                if after is not None:
                    count = crossed + (abs(after.facing) > _CROSSED)
                    found[after] = min(found.get(after, count), count)
        return found

    def _stood(self, stand: _Stand, foot: int, slipped: bool) -> _Stand | None:
        """Return the stance with this foot on the panel; None if the dancer would turn past the back without leave."""
        left, right = (self.column, stand.panels[1]) if foot == 0 else (stand.panels[0], self.column)
        if left == right and left != _UNKNOWN:  # the foot that was there makes room
            left, right = (left, _UNKNOWN) if foot == 0 else (_UNKNOWN, right)
        facing = 0.0
        if min(left, right) >= 0:
            facing = self.subject.angles[left][right]
        if not self.freedom.spins and (abs(facing - stand.facing) > 180 or abs(facing) >= 180):
            return None
        return _Stand((left, right), foot, facing, slipped)

    def _leads(self, pause: float) -> bool:
        rows = self.subject.step_rows
        return self.at + 1 < len(rows) and pause >= REST * self.subject.pause(int(rows[self.at + 1]))

    def _after_jacks(self) -> bool:
        pressed = [self.subject.step_columns(int(one)) for one in self.subject.step_rows[max(self.at - 2, 0) : self.at]]
        return len(pressed) == 2 and pressed[0] == pressed[1]

    def _to_other_pad(self) -> bool:
        assert self.subject.pad is not None
        half, two = len(self.subject.pad) // 2, self.subject.pad.width > 2.5
        return two and self.before >= 0 and (self.before < half) != (self.column < half)
