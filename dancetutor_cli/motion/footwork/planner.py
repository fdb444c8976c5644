"""From a play to moves, row by row: when each foot leaves and lands, where, and how far it turns (thesis 5.5, 5.6)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.errors import DancetutorError
from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.footwork.contacts import Touches
from dancetutor_cli.motion.footwork.footing import SHORTEST, Footing
from dancetutor_cli.motion.footwork.mines import avoid_mines
from dancetutor_cli.motion.footwork.sidesteps import SideSteps
from dancetutor_cli.motion.footwork.steps import Steps
from dancetutor_cli.motion.plan import Plan, Turn
from dancetutor_cli.play.model import Limb, Play

Array = NDArray[np.float64]
LEAD = 10.0  # degrees that a turning body is at most ahead of a foot that turns with it
WIDE, LATE = 120.0, 0.03  # degrees beyond which a turn begins later, and by how many seconds at most
STEEPEST = 1.875  # largest slope of `ease.smooth`
NO_WAY = 1e-6  # metres
HALF_TURN = 1e-6  # degrees from half a turn
ASIDE = 15.0  # degrees from the feet normal from which on it matters how the feet really stand
MINES_AHEAD = 0.7  # seconds for which a landing foot keeps off panels with mines


class Planner:
    """Walks through the rows of a play once. `second(tick)` gives the time of a tick in seconds of the music."""

    def __init__(self, play: Play, second: Callable[[int], float], context: Context) -> None:
        self.play, self.panels, self.settings = play, context.panels, context.settings
        self.footing = Footing(context, leading_foot(play, context.panels))
        self.steps = Steps(play, self.footing)
        self.touches = Touches(play, second, self.footing)
        self.asides = SideSteps(play, self.footing)
        self.previous: float | None = None
        self.turns: list[Turn] = []

    def run(self) -> Plan:
        """The plan of the whole song; DancetutorError if the play has no steps."""
        for i in range(len(self.play.rows)):
            self._row(i)
        touches = self.touches.all()
        if not touches:
            raise DancetutorError("the chart has no steps: there is nothing to dance")
        feet, turns, presses = self.footing.tracks(), tuple(self.turns), tuple(self.touches.presses)
        plan = Plan(feet, turns, presses, touches, touches[0].start, touches[0].start, lead=self.footing.lead)
        return replace(plan, last=max(contact.end for contact in plan.contacts))

    def _row(self, i: int) -> None:
        time = float(self.play.rows.second[i])
        pressed: dict[int, list[int]] = {}
        for column in np.flatnonzero(self.play.limb[i] >= 0):
            pressed.setdefault(int(self.play.limb[i, column]), []).append(int(column))
        soon = slice(int(np.searchsorted(self.play.rows.second, self._stays(i, time))))
        self.footing.mined = self.panels[self.play.rows.mines[soon][i + 1 :].any(axis=0)]
        avoid_mines(self.play, i, time, self.footing, set(pressed))
        self.footing.mined = self.panels[self.play.rows.mines[soon][i:].any(axis=0) & (self.play.limb[i] < 0)]
        feet = sorted(side for side in pressed if side < Limb.LEFT_HAND)
        if feet:
            self._feet(i, time, feet, pressed)
        for limb, columns in pressed.items():
            for pressed_column in columns:
                self.touches.add(i, time, limb, pressed_column)

    def _stays(self, i: int, time: float) -> float:
        """Until when mines matter to the feet that land at row i: for a while, and as long as they hold."""
        held = self.play.rows.hold_end[i][self.play.limb[i] >= 0]
        return max([time + MINES_AHEAD, *(self.touches.second(int(tick)) for tick in held if tick >= 0)])

    def _feet(self, i: int, time: float, feet: list[int], pressed: dict[int, list[int]]) -> None:
        """One foot steps or both jump, and the body turns with them; before that she may step aside."""
        longest = self.settings.step.longest
        aside = None if self.previous is None else self.asides.before(i, time, list(pressed), self.touches.presses)
        if aside is not None:
            self.turns.append(aside)
            self.footing.faced = aside.yaw
            self.previous = max(foot.landed for foot in self.footing.feet)
        turn = (self.play.facing[i] - self.footing.normal + 180.0) % 360.0 - 180.0
        if abs(abs(turn) - 180.0) < HALF_TURN:  # either way is as far: how the feet stand decides, or which foot steps
            stand = (self.footing.line() - self.footing.normal + 180.0) % 360.0 - 180.0
            first = feet[0] if len(feet) == 1 else self.footing.lead
            turn = 180.0 * float(np.sign(stand) if ASIDE < abs(stand) < 180.0 - ASIDE else 2 * first - 1)
        before = self.footing.normal
        self.footing.normal += turn
        duration = longest if self.previous is None else min(longest, max(time - self.previous, SHORTEST))
        if len(feet) == 2:
            leaves = self.steps.jump(i, time, duration, pressed, self.footing.normal - before)
        else:
            leaves = self.steps.step(i, time, duration, feet[0], pressed[feet[0]])
        yaw = self.footing.turned_to()
        far = abs(yaw - self.turns[-1].yaw) if self.turns else abs(yaw)
        self.turns.append(Turn(_turn_start(time, duration, leaves, float(np.degrees(far))), time, yaw))
        self.footing.faced = yaw
        self.previous = time


def leading_foot(play: Play, panels: Array) -> int:
    """The foot that steps first alone, 0 left or 1 right; else the first lopsided jump tells.

    It leads: wherever both sides are equal, what it asks for is done, so a mirrored play is danced mirrored.
    panels : (c, 2) on the ground. A play that is its own mirror image is led by the left foot.
    """
    feet = [(play.limb == side).any(axis=1) for side in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT)]
    alone = np.flatnonzero(feet[0] != feet[1])
    if len(alone):
        return int(feet[1][alone[0]])
    left, right = (np.asarray(play.limb == side) for side in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT))
    aside, ahead = (left | right) @ panels[:, 0], (left.astype(np.int8) - right) @ panels[:, 1]
    for x, z in zip(aside, ahead, strict=True):  # each changes its sign in the mirror
        if max(abs(x), abs(z)) > NO_WAY:
            return int(x < 0) if abs(x) > NO_WAY else int(z < 0)
    return 0


def _turn_start(time: float, duration: float, leaves: float, far: float) -> float:
    """When the body begins to turn `far` degrees for a move: as that begins, but not so long before the foot leaves the
    ground that body and foot would ever be turned much farther from each other than they are anyway."""
    ahead = 2.0 * LEAD / (STEEPEST * max(far, LEAD)) * (time - leaves)
    late = LATE * float(np.clip(far / WIDE - 1.0, 0.0, 1.0))  # for the body's path is smooth: it turns before it begins
    return max(time - duration, leaves - ahead + late)
