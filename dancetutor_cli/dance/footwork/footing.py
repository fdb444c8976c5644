"""The state of both feet while a song is planned row by row: the row for the rules, holds, and palms on panels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from dancetutor_cli.dance.clearance import gaps_at, over, reduction
from dancetutor_cli.dance.context import Context, ball_of, middle_of
from dancetutor_cli.dance.plan import FootTrack, Move, Pivot, Press, Turn
from dancetutor_cli.dance.settings import MotionSettings
from dancetutor_cli.dance.settings_feet import StepSettings
from dancetutor_cli.dance.smoothing import smooth
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.play import Play

# A row of a play for the rules, with the rows before and after it.


@dataclass(frozen=True, slots=True)
class Row:
    """One row of a play. index : its number; time : seconds of the music; pressed : the columns of each limb that steps

    duration : seconds since the last move, at most the longest time of a move; turned : degrees that the feet normal
    turns
    """

    play: Play
    context: Context
    index: int
    time: float
    pressed: Mapping[int, list[int]]
    duration: float = 0.0
    turned: float = 0.0

    @property
    def feet(self) -> list[int]:
        """The feet that step, 0 left."""
        return sorted(limb for limb in self.pressed if limb < Limb.LEFT_HAND)

    @property
    def hands(self) -> bool:
        """Whether a palm presses a panel at this row."""
        return any(limb >= Limb.LEFT_HAND for limb in self.pressed)

    @property
    def cut(self) -> float:
        """How much the move is shortened because time is short, 0 to 1."""
        step = self.context.settings.step
        return float(reduction(self.duration, step.fast, step.longest))

    @property
    def jump_cut(self) -> float:
        """The same as `cut` for a jump, which counts as quick sooner, because both legs throw the body at once."""
        jump = self.context.settings.jump
        missing = (jump.inward_slow - self.duration) / max(jump.inward_slow - jump.inward_quick, 1e-9)
        return max(self.cut, float(np.clip(missing, 0.0, 1.0)))

    @property
    def hurry(self) -> float:
        """How short the time of the row is, from the longest move to a fast one, 0 to 1; `cut` grows as its cube."""
        step = self.context.settings.step
        return float(np.clip((step.longest - self.duration) / max(step.longest - step.fast, 1e-9), 0.0, 1.0))

    @property
    def haste(self) -> float:
        """How quick the move is: 0 at `step.fast` seconds or more, 1 at `step.hasty` seconds or less."""
        step = self.context.settings.step
        return float(np.clip((step.fast - self.duration) / (step.fast - step.hasty), 0.0, 1.0))

    @property
    def leisure(self) -> float:
        """How much time there is both before the row and after it, from a fast move to the longest one, 0 to 1."""
        step, second, limb = self.context.settings.step, self.play.rows.second, self.play.limb
        later = (float(second[j]) for j in range(self.index + 1, len(second)) if (limb[j] >= 0).any())
        time = min(self.duration, next(later, np.inf) - self.time)
        return float(np.clip((time - step.fast) / max(step.longest - step.fast, 1e-9), 0.0, 1.0))

    def next_place(self, side: int) -> Array | None:
        """Return the place (2,) of the next step of a foot, if it comes soon."""
        second, limb = self.play.rows.second, self.play.limb
        soon = second[self.index] + self.context.settings.step.following
        for j in range(self.index + 1, int(np.searchsorted(second, soon))):
            columns = np.flatnonzero(limb[j] == side)
            if len(columns):
                return np.asarray(self.context.panels[columns].mean(axis=0))
        return None


def pressed_by(play: Play, index: int) -> dict[int, list[int]]:
    """Return the columns of each limb that steps at a row."""
    out: dict[int, list[int]] = {}
    for column in np.flatnonzero(play.limb[index] >= 0):
        out.setdefault(int(play.limb[index, column]), []).append(int(column))
    return out


# Both feet while a song is planned row by row: where they stand, until when they must stand, the direction of the body.
#
# These classes are frozen: a rule makes a new footing from the given one, and the planner uses it or not.

SHORTEST_SWING = 0.02  # seconds; the shortest swing
FREE_WINDOW = 0.001


@dataclass(frozen=True, slots=True)
class Evading:
    """The state of a foot that rises over mines: seconds of the first and the last mine, and its place before them."""

    first: float
    last: float
    ball: Array
    yaw: float


@dataclass(frozen=True, slots=True)
class FootState:
    """The state of a foot while the plan is made. side 0 is left; ball : (2,), x and z on the ground.

    yaw : without toe-out, radians; start, start_toes : its place before the first of `moves`, which are the newest ones
    free : the foot may leave from this second on; landed : second of its landing; turned : second at which its last
    pivot ended
    step : the settings of steps
    holds : columns that it holds, each with its end; evading : until its next step
    """

    side: int
    ball: Array
    yaw: float
    start: tuple[float, float]
    start_toes: float
    step: StepSettings
    free: float = -np.inf
    landed: float = -np.inf
    turned: float = -np.inf
    moves: tuple[Move, ...] = ()
    holds: tuple[tuple[int, float], ...] = ()
    evading: Evading | None = None

    @property
    def outward(self) -> float:
        """1 for the left foot, -1 for the right one: the direction in which toes turn out."""
        return 1.0 if self.side == 0 else -1.0

    def with_move(self, move: Move, target: Array, yaw: float) -> FootState:
        """Return the foot after one more move, standing at its target."""
        if self.moves and move.lift - self.moves[-1].land < self.step.heel_stays:
            heel = self.moves[-1].pitches[2]
            top = max(heel, move.pitches[1])
            if isinstance(move, Pivot):  # it lowers its heel as it turns, if there is time
                slow = smooth((move.land - move.lift - self.step.pivot_flat) / self.step.pivot_flat_ease)
                top += float(slow) * (move.pitches[1] - top)
            move = replace(move, pitches=(heel, top, *move.pitches[2:]))
        return replace(
            self, ball=target, yaw=yaw, free=move.land + FREE_WINDOW, landed=move.land, moves=(*self.moves, move)
        )

    def with_last_move(self, last: Move) -> FootState:
        """Return the foot with another last move."""
        return replace(self, moves=(*self.moves[:-1], last))

    def without_last_move(self, evading: Evading) -> FootState:
        """Return the foot as if its last move, over a mine, had not begun."""
        return replace(self, ball=evading.ball, yaw=evading.yaw, moves=self.moves[:-1], evading=None)

    def split_moves(self, newest: int) -> tuple[tuple[Move, ...], FootState]:
        """Return the moves that are older than the newest ones, and the foot without them."""
        old = self.moves[:-newest]
        if not old:
            return (), self
        return old, replace(self, moves=self.moves[-newest:], start=old[-1].target, start_toes=old[-1].yaw)

    def track(self, newest: int | None = None) -> FootTrack:
        """Return the moves of the foot, as far as it has them, or only its newest ones."""
        foot = self if newest is None else self.split_moves(newest)[1]
        return FootTrack(foot.start, foot.start_toes, foot.moves)

    def is_holding(self, time: float) -> bool:
        """Whether the foot is in the middle of a hold."""
        return any(end > time + FREE_WINDOW for _, end in self.holds)

    def latest(self, time: float, lead: float) -> float:
        """When the foot leaves for a note at the latest; a hold that ends too late is released a little early."""
        late = max(time - SHORTEST_SWING, self.rest_time(time))
        early = max(time - lead, self.rest_time(time))
        return min(early, late) if self.free > early else late

    def earliest(self, time: float) -> float:
        """Return when the foot may leave for a note: it has come to rest, and no hold needs it."""
        return max(self.free, self.rest_time(time))

    def rest_time(self, time: float) -> float:
        """When the foot has come to rest after its last landing, as far as the next landing leaves time for it."""
        gap = time - self.landed
        stand = self.step.stand + self.step.stand_slow * max(gap - self.step.stand_quick, 0.0)
        return max(self.landed + min(stand, gap / 3), self.turned + FREE_WINDOW)


@dataclass(frozen=True, slots=True)
class TakeOff:
    """The take-off of a foot in a gallop: the row at which it lands, and the second at which it leaves the ground."""

    row: int
    time: float


@dataclass(frozen=True, slots=True)
class Footing:
    """Both feet and the unwrapped feet normal, degrees, and the directions of body and toes.

    normal : the feet normal: the direction at a right angle to the line from the left foot's panel to the right foot's
    panel, as in `Play.facing`, but whole turns count; 0 faces the screen, positive is left
    lead : the foot that leads, as in `Plan`; aim : the wanted yaw of the body; faced : the yaw of the body after the
    last row, radians
    resting : feet that stand where the dancer went home, until each steps again
    mined : (m, 2) panels that mines pass soon, beside landing feet; take_offs : of the last gallop, left and right
    """

    context: Context
    lead: int
    feet: tuple[FootState, FootState]
    normal: float = 0.0
    aim: float = 0.0
    faced: float = 0.0
    resting: tuple[bool, bool] = (False, False)
    mined: Array = field(default_factory=lambda: np.empty((0, 2)))
    take_offs: tuple[TakeOff, TakeOff] | None = None

    @classmethod
    def at_home(cls, context: Context, lead: int, place: float = 0.0) -> Footing:
        """Return both feet where the dancer waits, facing the screen. place : along x, metres, 0 in the middle"""
        return cls(context, lead, (_at_home(0, place, context.settings), _at_home(1, place, context.settings)))

    @property
    def settings(self) -> MotionSettings:
        """The settings of the dancer's motion."""
        return self.context.settings

    @property
    def toe_out(self) -> float:
        """How far toes point outward, radians."""
        return float(np.radians(self.context.settings.step.toe_out))

    def in_context(self, context: Context) -> Footing:
        """Return the same footing with other settings."""
        left, right = (replace(foot, step=context.settings.step) for foot in self.feet)
        return replace(self, context=context, feet=(left, right))

    def other(self, foot: FootState) -> FootState:
        """Return the other foot."""
        return self.feet[1 - foot.side]

    def with_foot(self, foot: FootState) -> Footing:
        """Return the footing with a new state of one foot."""
        return replace(self, feet=(foot, self.feet[1]) if foot.side == 0 else (self.feet[0], foot))

    def toes(self, foot: FootState, yaw: float | None = None) -> float:
        """Return the direction of the toes of a foot, at its own yaw or at another one; radians."""
        return float((foot.yaw if yaw is None else yaw) + foot.outward * self.toe_out)

    def line(self) -> float:
        """Return the direction of the line between the feet as they stand, degrees; the feet normal goes by panels."""
        left, right = (middle_of(f.ball, self.toes(f)) for f in self.feet)
        return float(np.degrees(np.arctan2(right[1] - left[1], left[0] - right[0])))

    def body_yaw(self) -> float:
        """Return the wanted yaw of the body, radians."""
        return self.aim

    def turned_to(self, yaws: tuple[float, float] | None = None) -> float:
        """Return the yaw to which the body turns for the yaws of the feet, present or given ones, radians.

        If both feet stand, it is no farther from either foot than hips and ankles turn.
        """
        left, right = yaws or (self.feet[0].yaw, self.feet[1].yaw)
        mean, farthest = (left + right) / 2, np.radians(self.settings.step.body_turn)
        wanted = mean + self.settings.body.turn_to_feet * (self.body_yaw() - mean)
        if yaws is not None:
            return float(wanted)
        low, high = max(left, right) - farthest, min(left, right) + farthest
        return float(np.clip(wanted, min(low, mean), max(high, mean)))

    def limit_yaw(self, yaw: float, body: float) -> float:
        """Return a foot's yaw, limited to the angle from the body that hips allow."""
        limit = np.radians(self.settings.step.foot_turn)
        return float(np.clip(yaw, body - limit, body + limit))

    def pivot_yaw(
        self, foot: FootState, body: float, other: Array, other_toes: float, limits: tuple[float, float] | None = None
    ) -> float:
        """Return the yaw of a standing foot after it has followed the body's yaw, as far as the other shoe leaves room.

        The foot does not turn over a panel with a mine, nor for only a few degrees.

        other, other_toes : ball and toes of the other foot after its step; limits : degrees from the body from which
        on it turns, and with which it ends; None: those of a step
        """
        step = self.settings.step
        least, most = np.radians(limits or (step.pivot_from, step.pivot_to))
        if abs(foot.yaw - body) <= least:
            return foot.yaw
        wanted = float(np.clip(foot.yaw, body - most, body + most))
        yaws = foot.yaw + np.linspace(1.0, 0.0, 9) * (wanted - foot.yaw)
        balls, toes = np.tile(foot.ball, (9, 1)), yaws + foot.outward * self.toe_out
        gaps = gaps_at(balls, toes, other, other_toes)
        mined = over(self.mined, balls, toes, self.settings.mines.keep_off)
        clear = ~mined | mined[-1]  # the last one is the present yaw: over a mine already, the foot may turn
        found = float(yaws[np.argmax(clear & (gaps >= min(step.apart, gaps[clear].max())))])
        return found if abs(found - foot.yaw) > np.radians(step.pivot_few) else foot.yaw

    def pivoted(self, foot: FootState, yaw: float, start: float, time: float) -> Footing:
        """Return the footing in which a standing foot has turned on its ball to a yaw, if there is time for it."""
        begin = max(start, foot.moves[-1].land + FREE_WINDOW if foot.moves else start)
        if yaw == foot.yaw or begin > time - self.settings.step.pivot_least:
            return self
        up = float(np.radians(self.settings.step.pivot_pitch))
        rest = foot.moves[-1].pitches[3] if foot.moves else 0.0
        pitches = (rest, max(up, rest), rest, rest)
        move = Pivot(begin, time, pair(foot.ball), self.toes(foot, yaw), pitches)
        done = foot.with_move(move, foot.ball, yaw)
        return self.with_foot(replace(done, free=max(foot.free, done.free), landed=foot.landed, turned=time))


@dataclass(frozen=True, slots=True)
class Proposal:
    """The proposal of a rule: both feet as they would be afterwards.

    leaves : when a foot leaves the ground for it, seconds; turn : the turn of the body, if the rule decides it
    """

    footing: Footing
    leaves: float = np.inf
    turn: Turn | None = None


def _at_home(side: int, place: float, settings: MotionSettings) -> FootState:
    out = 1.0 if side == 0 else -1.0
    toes = out * float(np.radians(settings.step.toe_out))
    ball = ball_of(np.array([place + out * settings.step.home, 0.0]), toes)
    return FootState(side, ball, 0.0, pair(ball), toes, settings.step)


def pair(v: Array) -> tuple[float, float]:
    """Return an array of two as a tuple of floats."""
    return float(v[0]), float(v[1])


# Holds: a foot that holds a panel may not leave it before the hold ends.

FORGOTTEN = 1.0  # seconds after which a hold that has ended no longer matters


def hold(footing: Footing, limb: int, column: int, time: float, end: float) -> Proposal:
    """Propose that a limb holds a column from `time` to `end`, seconds. Only feet are bound by a hold."""
    if limb >= Limb.LEFT_HAND:
        return Proposal(footing)
    foot: FootState = footing.feet[limb]
    holds = {c: e for c, e in foot.holds if e > time - FORGOTTEN} | {column: end}
    return Proposal(footing.with_foot(replace(foot, free=max(foot.free, end), holds=tuple(holds.items()))))


# Palms on panels: how long they press, and how far the body turns if the panel is not in front of it.


def press(
    footing: Footing, side: int, panel: tuple[float, float], span: tuple[float, float], earlier: Sequence[Press]
) -> Press:
    """Return the press of a palm on a panel.

    side : 0 left, 1 right; span : second of the note, and end of a hold, infinite for a tap
    earlier : all presses so far
    """
    hands, (time, end) = footing.settings.hands, span
    end = max(time + hands.press, end if end < np.inf else 0.0)
    before = [p.end for p in earlier if p.side == side]
    lead = min(hands.reach_down, max(time - before[-1], SHORTEST_SWING) if before else np.inf)
    return Press(time, end, side, panel, _turn_to_panel(footing, side, panel), lead)


def _turn_to_panel(footing: Footing, side: int, panel: tuple[float, float]) -> float:
    """Return how far the body turns to the hand's side, radians, for a panel that is not in front of it."""
    hands, feet = footing.settings.hands, footing.feet
    away = np.array(panel) - (feet[0].ball + feet[1].ball) / 2
    off = (np.arctan2(away[0], away[1]) - footing.turned_to() + np.pi) % (2 * np.pi) - np.pi
    beyond = np.clip(abs(np.degrees(off)) - hands.turn_from, 0.0, hands.turn_most)
    return float(np.radians(beyond) * (1.0 if side == 0 else -1.0))
