"""From a play to moves, row by row: asks the rules what they propose, and is the only one that applies it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.errors import DancetutorError
from dancetutor_cli.motion.baked import Contact
from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.foot_moves import Move, Swing
from dancetutor_cli.motion.footwork.chart_row import Row, pressed_by
from dancetutor_cli.motion.footwork.footing import SHORTEST, Footing, Proposal, pair
from dancetutor_cli.motion.footwork.holding import hold
from dancetutor_cli.motion.footwork.homing import HomeSteps, faces_as_at_home
from dancetutor_cli.motion.footwork.jumps import jump
from dancetutor_cli.motion.footwork.mines import avoid_mines
from dancetutor_cli.motion.footwork.pressing import press
from dancetutor_cli.motion.footwork.sidesteps import SideSteps
from dancetutor_cli.motion.footwork.steps import step
from dancetutor_cli.motion.footwork.turning import Facing, leading_foot, turn_start
from dancetutor_cli.motion.footwork.walks import first_place
from dancetutor_cli.motion.plan import Plan, Press, Turn
from dancetutor_cli.play.played import Limb, Play, StepKind

Array = NDArray[np.float64]
NEWEST = 8  # moves of a foot that rules may still look at or change


class Planner:
    """Walks through the rows of a play once. `second(tick)` gives the time of a tick in seconds of the music."""

    def __init__(self, play: Play, second: Callable[[int], float], context: Context) -> None:
        self.play, self.second, self.context, self.settings = play, second, context, context.settings
        lead = leading_foot(play, context.panels)
        self.footing = Footing.at_home(context, lead, first_place(play, context, lead))
        self.begin = self.footing
        self.asides = SideSteps(play, context, self.footing.lead)
        self.homes = HomeSteps(play, context, self.footing.lead)
        self.facing = Facing(play, self.settings)
        self.previous: float | None = None
        self.moves: tuple[list[Move], list[Move]] = ([], [])  # that no rule changes any more
        self.turns: list[Turn] = []
        self.presses: list[Press] = []
        self.touches: list[Contact] = []

    def run(self) -> Plan:
        """The plan of the whole song; DancetutorError if the play has no steps."""
        for i in range(len(self.play.rows)):
            self._row(i)
        if not self.touches:
            raise DancetutorError("the chart has no steps: there is nothing to dance")
        tracks = []
        for begin, old, foot in zip(self.begin.feet, self.moves, self.footing.feet, strict=True):
            tracks.append(replace(begin.track(), moves=(*old, *foot.moves)))
        touches = self._ended((tracks[0].moves, tracks[1].moves))
        turns, presses, first = tuple(self.turns), tuple(self.presses), touches[0].start
        plan = Plan((tracks[0], tracks[1]), turns, presses, touches, first, first, lead=self.footing.lead)
        return replace(plan, last=max(contact.end for contact in plan.contacts))

    def _row(self, i: int) -> None:
        time = float(self.play.rows.second[i])
        row = Row(self.play, self.context, i, time, pressed_by(self.play, i))
        soon = slice(int(np.searchsorted(self.play.rows.second, self._stays(i, time))))
        panels, mines = self.context.panels, self.play.rows.mines[soon]
        self.footing = replace(self.footing, mined=panels[mines[i + 1 :].any(axis=0)])
        self._apply(avoid_mines(row, self.footing))
        self.footing = replace(self.footing, mined=panels[mines[i:].any(axis=0) & (self.play.limb[i] < 0)])
        if row.feet:
            self._feet(row)
        for limb, columns in row.pressed.items():
            for column in columns:
                self._touch(row, limb, column)

    def _stays(self, i: int, time: float) -> float:
        """Until when mines matter to the feet that land at row i: for a while, and as long as they hold."""
        held = self.play.rows.hold_end[i][self.play.limb[i] >= 0]
        return max([time + self.settings.mines.ahead, *(self.second(int(tick)) for tick in held if tick >= 0)])

    def _feet(self, row: Row) -> None:
        """One foot steps or both jump, and the body turns with them; before that she may step aside, or home."""
        time, longest = row.time, self.settings.step.longest
        aside = None
        if self.previous is not None:
            asked = row, self.presses, self.footing
            aside = self.asides.before(*asked) or self.homes.before(*asked)
        if aside is not None:
            self._apply(aside)
            self.facing.begin_anew()
            self.previous = max(foot.landed for foot in self.footing.feet)
        turned = 0.0 if faces_as_at_home(row, self.footing) else self.facing.turn(row, self.footing)
        left, right = self.footing.resting
        self.footing = replace(self.footing, resting=(left and 0 not in row.feet, right and 1 not in row.feet))
        # added to what it was, and taken off again: what is left is exactly how far it has turned
        before = self.footing.normal
        aim = float(np.radians(self.facing.aim(row, before + turned, self.footing.lead)))
        self.footing = replace(self.footing, normal=before + turned, aim=aim)
        duration = longest if self.previous is None else min(longest, max(time - self.previous, SHORTEST))
        row = replace(row, duration=duration, turned=self.footing.normal - before)
        found = jump(row, self.footing) if len(row.feet) == 2 else step(row, row.feet[0], self.footing)
        yaw = found.footing.turned_to()
        far = abs(yaw - self.turns[-1].yaw) if self.turns else abs(yaw)
        turn = Turn(turn_start((time, duration), found.leaves, float(np.degrees(far)), self.settings.step), time, yaw)
        self._apply(replace(found, footing=replace(found.footing, faced=yaw), turn=turn))
        self.previous = time

    def _touch(self, row: Row, limb: int, column: int) -> None:
        """A limb comes down on a column."""
        kind, panel = int(self.play.rows.steps[row.index, column]), pair(self.context.panels[column])
        end = np.inf
        if kind == StepKind.HOLD:
            end = self.second(int(self.play.rows.hold_end[row.index, column]))
            self._apply(hold(self.footing, limb, column, row.time, end))
        if limb in (Limb.LEFT_HAND, Limb.RIGHT_HAND):
            palm = press(self.footing, limb - Limb.LEFT_HAND, panel, (row.time, end), self.presses)
            self.presses.append(palm)
            end = palm.end
        part = int(self.play.part[row.index, column])
        self.touches.append(Contact(row.time, end, limb, column, kind, part, row.index, panel))

    def _apply(self, proposal: Proposal) -> None:
        """Take over what a rule proposes; moves that are so old that no rule asks for them are put aside."""
        for done, foot in zip(self.moves, proposal.footing.feet, strict=True):
            if len(foot.moves) > 2 * NEWEST:
                old, foot = foot.settled(NEWEST)
                done += old
                proposal = replace(proposal, footing=proposal.footing.with_foot(foot))
        self.footing = proposal.footing
        if proposal.turn is not None:
            self.turns.append(proposal.turn)

    def _ended(self, moves: tuple[tuple[Move, ...], tuple[Move, ...]]) -> tuple[Contact, ...]:
        """All touches, in order, each until it must end; a foot that is not needed any more stays a while."""
        self.touches.sort(key=lambda c: (c.start, c.limb, c.column))
        lifts = [[m.lift for m in of_foot if isinstance(m, Swing)][-1:] for of_foot in moves]
        stays = self.settings.step.longest

        def ended(touch: Contact) -> Contact:
            left = touch.end < np.inf or any(lift >= touch.start for lift in lifts[touch.limb])
            return touch if left else replace(touch, end=touch.start + stays)

        return tuple(ended(touch) for touch in self.touches)
