"""Both feet as the planner walks through a song: where they stand, until when they must, which way the body faces."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.moves import Move, Pivot
from dancetutor_cli.motion.plan import FootTrack
from dancetutor_cli.motion.swing.clearance import gaps_at, over
from dancetutor_cli.motion.swing.foot_path import NO_TIME
from dancetutor_cli.motion.swing.panels import ball_of, middle_of

Array = NDArray[np.float64]
SHORTEST = 0.02  # seconds; no swing is shorter
FREE_WINDOW = 0.001
SHORTEST_PIVOT = 0.04  # seconds
STAND = 0.045  # seconds; a foot that has landed stays down so long, if its next note leaves it the time
FARTHEST_TURN = np.radians(45.0)  # of the body from a foot that stands
HOME_OUT = 0.080  # metres; a waiting foot stands so far beside the middle of the pad: on no panel


@dataclass(frozen=True, slots=True)
class Evading:
    """A foot that goes up over mines: seconds of the first and the last one, and where it stood before."""

    first: float
    last: float
    ball: Array
    yaw: float


@dataclass
class Foot:
    """Where a foot is while the plan is made. side 0 is left; ball : (2,), x and z on the ground."""

    side: int
    ball: Array
    yaw: float  # without toe-out
    free: float = -np.inf  # the foot may not leave before
    landed: float = -np.inf  # when it came down
    turned: float = -np.inf  # when it last ended a pivot
    moves: list[Move] = field(default_factory=list)
    holds: dict[int, float] = field(default_factory=dict)  # columns that it holds: until when
    evading: Evading | None = None  # until its next step

    @property
    def outward(self) -> float:
        """1 for the left foot, -1 for the right one: which way its toes turn out."""
        return 1.0 if self.side == 0 else -1.0

    def move(self, move: Move, target: Array, yaw: float) -> None:
        """Add a move; afterwards the foot stands at its target."""
        if self.moves and move.lift - self.moves[-1].land < NO_TIME:
            heel = self.moves[-1].pitches[2]
            move = replace(move, pitches=(heel, max(heel, move.pitches[1]), *move.pitches[2:]))
        self.moves.append(move)
        self.ball, self.yaw, self.free = target, yaw, move.land + FREE_WINDOW
        self.landed = move.land

    def holding(self, time: float) -> bool:
        """Whether it is in the middle of a hold."""
        return any(end > time + FREE_WINDOW for end in self.holds.values())

    def latest(self, time: float, let_go: float) -> float:
        """When the foot leaves at the latest for a note: a hold that ends too late is let go a little early."""
        late = max(time - SHORTEST, self.rested(time))
        early = max(time - let_go, self.rested(time))
        return min(early, late) if self.free > early else late

    def earliest(self, time: float) -> float:
        """When the foot may leave for a note: it has come to rest, and no hold needs it."""
        return max(self.free, self.rested(time))

    def rested(self, time: float) -> float:
        """When the foot has come to rest after its last landing, as far as the next one leaves it the time."""
        return max(self.landed + min(STAND, (time - self.landed) / 3), self.turned + FREE_WINDOW)


class Footing:
    """Both feet and the unwrapped feet normal, degrees; what the body and the toes make of it.

    lead : the foot that leads, as in `Plan`
    """

    def __init__(self, context: Context, lead: int) -> None:
        self.context, self.settings, self.lead = context, context.settings, lead
        settings = context.settings
        self.normal = 0.0
        self.faced = 0.0  # which way the body faced after the last row, radians
        self.mined: Array = np.empty((0, 2))  # panels beside which feet land that mines pass soon
        self.toe_out = float(np.radians(settings.step.toe_out))
        self.feet = tuple(
            Foot(side, ball_of(np.array([x * HOME_OUT, 0.0]), x * self.toe_out), 0.0)
            for side, x in ((0, 1.0), (1, -1.0))
        )
        self._start = tuple((pair(f.ball), f.outward * self.toe_out) for f in self.feet)

    def tracks(self) -> tuple[FootTrack, FootTrack]:
        """Everything that both feet have done, from the start."""
        return self.track(self.feet[0]), self.track(self.feet[1])

    def track(self, foot: Foot, latest: int | None = None) -> FootTrack:
        """What a foot has done, all of it or only its latest moves."""
        first = 0 if latest is None else max(len(foot.moves) - latest, 0)
        place, yaw = self._start[foot.side]
        if first > 0:
            place, yaw = foot.moves[first - 1].target, foot.moves[first - 1].yaw
        return FootTrack(place, yaw, tuple(foot.moves[first:]))

    def toes(self, foot: Foot, yaw: float | None = None) -> float:
        """Where the toes of a foot point, at its own yaw or at another one; radians."""
        return float((foot.yaw if yaw is None else yaw) + foot.outward * self.toe_out)

    def line(self) -> float:
        """Which way the line between the feet faces as they stand, degrees; the feet normal goes by panels."""
        left, right = (middle_of(f.ball, self.toes(f)) for f in self.feet)
        return float(np.degrees(np.arctan2(right[1] - left[1], left[0] - right[0])))

    def body_yaw(self) -> float:
        """The yaw that the body aims at for the current feet normal, radians: crossed feet turn it less."""
        whole = 360.0 * round(self.normal / 360.0)
        rest = abs(self.normal - whole)
        k = self.settings.step.crossover_turn
        if rest > 135.0:
            at_135 = 90.0 + 45.0 * k
            rest = at_135 + (rest - 135.0) / 45.0 * (180.0 - at_135)
        elif rest > 90.0:
            rest = 90.0 + (rest - 90.0) * k
        return float(np.radians(whole + np.copysign(rest, self.normal - whole)))

    def turned_to(self, yaws: tuple[float, float] | None = None) -> float:
        """The yaw that the body turns to for the feet's yaws, those of now or others, radians.

        Where both stand, it is no farther from either than hips and ankles turn.
        """
        left, right = yaws or (self.feet[0].yaw, self.feet[1].yaw)
        mean = (left + right) / 2
        wanted = mean + self.settings.body.turn_to_feet * (self.body_yaw() - mean)
        if yaws is not None:
            return float(wanted)
        low, high = max(left, right) - FARTHEST_TURN, min(left, right) + FARTHEST_TURN
        return float(np.clip(wanted, min(low, mean), max(high, mean)))

    def limited(self, yaw: float, body: float) -> float:
        """A foot's yaw, not farther from the body's than hips allow."""
        limit = np.radians(self.settings.step.foot_turn)
        return float(np.clip(yaw, body - limit, body + limit))

    def pivot_yaw(self, foot: Foot, body: float, other: Array, other_toes: float) -> float:
        """How a standing foot is turned after it gave way to the body's yaw, as far as the other shoe leaves it room.

        Nor does it turn over a panel with a mine.

        other, other_toes : ball and toes of the other foot after its step
        """
        step = self.settings.step
        if abs(foot.yaw - body) <= np.radians(step.pivot_from):
            return foot.yaw
        wanted = float(np.clip(foot.yaw, body - np.radians(step.pivot_to), body + np.radians(step.pivot_to)))
        yaws = foot.yaw + np.linspace(1.0, 0.0, 9) * (wanted - foot.yaw)
        balls, toes = np.tile(foot.ball, (9, 1)), yaws + foot.outward * self.toe_out
        gaps = gaps_at(balls, toes, other, other_toes)
        mined = over(self.mined, balls, toes)
        clear = ~mined | mined[-1]  # the last one is how it stands: over a mine already, it may turn
        return float(yaws[np.argmax(clear & (gaps >= min(step.apart, gaps[clear].max())))])

    def pivot(self, foot: Foot, yaw: float, start: float, time: float) -> None:
        """The standing foot turns on its ball to a yaw."""
        begin = max(start, foot.moves[-1].land + FREE_WINDOW if foot.moves else start)
        if yaw == foot.yaw or begin > time - SHORTEST_PIVOT:
            return
        up = float(np.radians(self.settings.step.pivot_pitch))
        rest = foot.moves[-1].pitches[3] if foot.moves else 0.0
        pitches = (rest, max(up, rest), rest, rest)
        free, landed = foot.free, foot.landed
        move = Pivot(begin, time, pair(foot.ball), self.toes(foot, yaw), pitches)
        foot.move(move, foot.ball, yaw)
        foot.free, foot.landed, foot.turned = max(free, foot.free), landed, time


def pair(v: Array) -> tuple[float, float]:
    """An array of two as a tuple of floats."""
    return float(v[0]), float(v[1])
