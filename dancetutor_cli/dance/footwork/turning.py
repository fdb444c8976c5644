"""How the body turns with the feet: how far at a row, from when on, and which way if both are possible."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterator

import numpy as np

from dancetutor_cli.dance.footwork.footing import Footing, Row
from dancetutor_cli.dance.settings import MotionSettings
from dancetutor_cli.dance.settings_feet import StepSettings
from dancetutor_cli.dance.smoothing import STEEPEST
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.play import Play
from dancetutor_cli.feet.solver.techniques import side_of_half_turn

NO_WAY = 1e-6  # metres
HALF_TURN = 1e-6  # degrees that a turn may differ from half a turn
ALL_ROUND = 180.0  # degrees; rows do not affect each other if the body could turn this far between them
SPIN = 1.1  # a body in a spin may turn this many times as fast as the feet do on average
ASIDE = 15.0  # degrees from the feet normal; from here on the actual places of the feet matter


def shorter(normal: float, facing: float) -> float:
    """Return the degrees from one to the other by the shorter way, positive left; half a turn is negative."""
    return float((facing - normal + 180.0) % 360.0 - 180.0)


def is_half(turn: float) -> bool:
    """Whether both ways round are equally far, degrees."""
    return abs(abs(turn) - 180.0) < HALF_TURN


def rounds(normal: float, turn: float, rounded: float) -> float:
    """Return how far all the way round, a multiple of 360 degrees, the dancer has gone after a turn from a feet normal.

    rounded : the result before the turn. With her back to the screen, the dancer is in the round that she came from
    """
    after = normal + turn
    if is_half(shorter(0.0, after)):
        return rounded if turn == 0.0 else after - float(np.copysign(180.0, turn))
    return 360.0 * round(after / 360.0)


def passing_turn(turn: float, normal: float, foot: int, seconds: float, step: StepSettings) -> float:
    """Return the turn, degrees, in which one foot passes the other on the side that the form prefers, if it can.

    turn : the turn without a form; normal : of the feet before; foot : the foot that steps, 0 left; seconds : time for
    the turn
    """
    other = turn - float(np.copysign(360.0, turn))
    enough = max(180.0 + HALF_TURN, step.turn_rate * seconds)
    if step.crossing == 0.0 or abs(turn) < step.crossing_from or abs(other) > enough:
        return turn
    # Half-way, the line from the standing foot to this foot points to the screen, or away from it.
    ahead = float(np.sin(np.radians(normal + turn / 2))) * (2 * foot - 1)
    return turn if ahead * (1.5 - step.crossing) >= -NO_WAY else other


def body_yaw(normal: float, settings: MotionSettings) -> float:
    """Return the direction of the body for a feet normal, both in degrees: crossed feet turn the body less."""
    whole = 360.0 * round(normal / 360.0)
    rest = abs(normal - whole)
    step = settings.step
    first, last = step.crossover_from, step.crossover_to
    there = first + (last - first) * step.crossover_turn
    if rest > last:
        rest = there + (rest - last) / (180.0 - last) * (180.0 - there)
    elif rest > first:
        rest = first + (rest - first) * step.crossover_turn
    return float(whole + np.copysign(rest, normal - whole))


class Facing:
    """The direction of the body at each row: with the feet, but no faster than dancers turn who know the next rows.

    If the feet turn faster than the body should, it begins earlier and ends later. If a turn is undone at once, the
    body makes only a part of it. Meanwhile the legs cross, within their limit. Of all paths that are slow enough, the
    one whose largest distance from the feet is smallest lies half-way between the lowest path over them and the highest
    path under them.
    """

    def __init__(self, play: Play, settings: MotionSettings) -> None:
        self.play, self.settings = play, settings
        steps = ((play.limb == Limb.LEFT_FOOT) | (play.limb == Limb.RIGHT_FOOT)).any(axis=1)
        self.rows = np.flatnonzero(steps)
        self._steps: list[int] = self.rows.tolist()
        self._second: list[float] = play.rows.second.tolist()
        self._facing: list[float] = play.facing.tolist()
        feet = [(play.limb == side).any(axis=1) for side in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT)]
        self._alone: list[int] = np.where(feet[0] == feet[1], -1, feet[1]).tolist()  # the foot that steps alone, or -1
        # the direction of half turns at rows, chosen with a look ahead
        self.halves: dict[int, float] = {}
        self.past: list[tuple[float, float]] = []  # seconds and wanted yaw, degrees, row by row
        self.rounded = 0.0  # degrees that the dancer has gone all the way round, 360 for each spin to the left

    def aim(self, row: Row, normal: float, lead: int) -> float:
        """Return the yaw to aim at for a row's feet normal, degrees; the caller must ask for rows in order."""
        step = self.settings.step
        wanted = body_yaw(normal, self.settings)
        self.past = [was for was in self.past if was[0] > row.time - ALL_ROUND / step.turn_rate]
        self.past.append((row.time, wanted))
        around = [*self.past, *self._coming(row, normal, lead)]
        # in a spin the body turns evenly, as fast as the feet do on average: a slower body would catch up in jerks
        spin = SPIN * abs(around[-1][1] - self.past[0][1]) * step.turn_rate / (2.0 * ALL_ROUND)
        slack = [max(step.turn_rate, spin) * abs(time - row.time) for time, _ in around]
        low = max(yaw - free for (_, yaw), free in zip(around, slack, strict=True))
        high = min(yaw + free for (_, yaw), free in zip(around, slack, strict=True))
        return float(min(max((low + high) / 2, normal - step.turn_crossed), normal + step.turn_crossed))

    def turn(self, row: Row, footing: Footing) -> float:
        """Return the turn of the feet normal at a row, degrees, positive left: of the form, of the play, or the
        shorter.

        The caller must ask for rows in order, for each before its aim.
        """
        j, normal = row.index, footing.normal
        self.rounded = rounds(normal, 0.0, self.rounded)  # the dancer may have gone home meanwhile
        turn = shorter(normal, float(self.play.facing[j]))
        if is_half(turn):
            # if the play leaves it open, the stance of the feet decides, unless the look ahead has decided
            stand = shorter(footing.normal, footing.line())
            first = float(np.sign(stand)) if ASIDE < abs(stand) < 180.0 - ASIDE else 0.0
            turn = self.halves.get(j, self._half(j, normal, self.rounded, first or self._side(j, footing.lead)))
        turn = self._as_formed(j, turn, normal)
        self.rounded = rounds(normal, turn, self.rounded)
        return turn

    def _half(self, j: int, normal: float, rounded: float, side: float) -> float:
        """Return half a turn at row `j`, left or right. It does not go on around the back: that would be a spin.

        side : 1 left, -1 right, for a dancer who turns her back to the screen directly; not used if she stands aside
        later
        """
        facing = self.play.facing[self.rows[self.rows >= j]]
        if not is_half(float(facing[0])):
            return 180.0 * float(np.sign(rounded + facing[0] - normal))
        return 180.0 * side_of_half_turn(facing, side)

    def _as_formed(self, j: int, turn: float, normal: float) -> float:
        """Return the turn at row `j` of the play as the form prefers it, if one foot steps."""
        k, alone = bisect_left(self._steps, j), self._alone[j]
        if alone < 0 or k == 0:
            return turn
        seconds = self._second[j] - self._second[self._steps[k - 1]]
        return passing_turn(turn, normal, alone, seconds, self.settings.step)

    def _side(self, j: int, lead: int) -> float:
        """Return the side, 1 left, to which the foot that steps at row `j` passes ahead of the other one."""
        return 2.0 * (self._alone[j] if self._alone[j] >= 0 else lead) - 1.0

    def begin_anew(self) -> None:
        """Forget the rows before a stand, because the dancer has turned to the screen."""
        self.past = []

    def _coming(self, row: Row, normal: float, lead: int) -> Iterator[tuple[float, float]]:
        """Yield the coming rows, as far as they matter."""
        latest, rounded = row.time + ALL_ROUND / self.settings.step.turn_rate, self.rounded
        for k in range(bisect_right(self._steps, row.index), len(self._steps)):
            j = self._steps[k]
            if self._second[j] > latest:
                return
            turn = shorter(normal, self._facing[j])
            if is_half(turn):
                turn = self.halves.setdefault(j, self._half(j, normal, rounded, self._side(j, lead)))
            turn = self._as_formed(j, turn, normal)
            rounded, normal = rounds(normal, turn, rounded), normal + turn
            yield self._second[j], body_yaw(normal, self.settings)


def turn_start(move: tuple[float, float], leaves: float, far: float, step: StepSettings) -> float:
    """Return when the body begins to turn `far` degrees for a move: at the beginning of the move, or later.

    It begins later if body and foot would otherwise be turned much farther from each other than they are anyway.

    move : second of its landing, and its duration; leaves : second at which a foot leaves the ground
    """
    time, duration = move
    ahead = 2.0 * step.turn_ahead / (STEEPEST * max(far, step.turn_ahead)) * (time - leaves)
    late = step.turn_late * float(
        np.clip(far / step.turn_wide - 1.0, 0.0, 1.0)
    )  # the body's path is smooth, so it turns before the turn begins
    return max(time - duration, leaves - ahead + late)


def leading_foot(play: Play, panels: Array) -> int:
    """Return the foot that steps first alone, 0 left or 1 right; if there is none, the first asymmetric jump decides.

    This foot leads: where both sides are equal, it decides, so a mirrored play is danced mirrored.

    panels : (c, 2) on the ground. The left foot leads a play that is its own mirror image.
    """
    feet = [(play.limb == side).any(axis=1) for side in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT)]
    alone = np.flatnonzero(feet[0] != feet[1])
    if len(alone):
        return int(feet[1][alone[0]])
    left, right = (np.asarray(play.limb == side) for side in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT))
    aside, ahead = (left | right) @ panels[:, 0], (left.astype(np.int8) - right) @ panels[:, 1]
    for x, z in zip(aside, ahead, strict=True):  # each changes its sign in the mirror image
        if max(abs(x), abs(z)) > NO_WAY:
            return int(x < 0) if abs(x) > NO_WAY else int(z < 0)
    return 0
