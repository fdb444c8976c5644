"""Steps, jumps and gallops: when a foot leaves for its note, how high it goes and where it lands (thesis 5.5, 5.6)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.footwork.foothold import (
    Goal,
    Pose,
    Spot,
    around,
    beside,
    heel_up,
    landing,
    pose,
    shoes_apart,
)
from dancetutor_cli.motion.footwork.footing import Foot, Footing, pair
from dancetutor_cli.motion.footwork.jumps import Flight, Goals, fly, tuck_for
from dancetutor_cli.motion.footwork.mines import land_early, left_standing, resumed
from dancetutor_cli.motion.moves import Gallop, Hover, Jump, Step, Swing
from dancetutor_cli.motion.swing.timing import reduction
from dancetutor_cli.play.model import Part, Play
from dancetutor_cli.rig.mass import GRAVITY

Array = NDArray[np.float64]
LEAST_SWING = 0.09  # seconds; a foot is given so long where it is free
OVERLAP = 0.01  # seconds that it may leave before the other foot has landed: nobody sees so short a flight
LET_GO = 0.02  # seconds; a hold that ends so shortly before a note still has its foot
NEIGHBOURS = 0.45  # metres between panels that one foot can press together
ALTERNATING = 0.3  # seconds between taps of heel and toes for which the foot stays over both panels
FOLLOWING = 0.6  # seconds to its next step for which a foot comes down near the way there
FLAT = 0.45  # a quick jump has so much less tuck and raised heels
TOUCHING = 0.077  # metres between the middle lines of shoes that touch
ASIDE = 0.25  # metres that a foot gives way at most for the other one
LONGER = 0.03  # metres; a foot with so much the longer way leaves first in quick jumps
SHORTEST_FLIGHT = 0.12  # seconds; a gallop with less is two steps


class Steps:
    """Moves of the feet, note by note."""

    def __init__(self, play: Play, footing: Footing) -> None:
        self.play, self.footing, self.settings = play, footing, footing.settings
        self.panels = footing.context.panels
        self.take_off: dict[int, tuple[int, float]] = {}  # in a gallop: foot -> its row, and when it leaves the ground

    def step(self, i: int, time: float, duration: float, side: int, columns: list[int]) -> float:
        """One foot steps at row i, at `time`; `duration` seconds after the last move. Returns when it leaves."""
        step, jump, footing = self.settings.step, self.settings.jump, self.footing
        foot, other = footing.feet[side], footing.feet[1 - side]
        self._gallop(i, time, duration, side)
        cut = float(reduction(duration, step.fast, step.longest))
        up = resumed(foot, other, time, step.longest)
        body = footing.body_yaw()
        yaw = footing.limited(other.yaw + step.yaw_to_normal * (body - other.yaw), body)
        columns = self._with_held(i, foot, columns, time)
        goal = Goal(columns, self.play.part[i], yaw, cut, self._following(i, side))
        target, yaw = landing(footing, foot, goal, pose(footing, other))
        galloping = self.take_off.get(side, (-1, 0.0))[0] == i
        both = step.double_support + cut * (step.double_support_fast - step.double_support)
        lift = time - max(duration * (1.0 - both), min(LEAST_SWING, duration + OVERLAP))
        lift = self.take_off[side][1] if galloping else left_standing(other, self.settings, lift, time)
        lift = min(max(lift, foot.earliest(time)), foot.latest(time, step.let_go)) if up is None else up
        kind: type[Swing] = Step
        height = step.height_slow + cut * (step.height_fast - step.height_slow)
        if np.linalg.norm(target - foot.ball) < 0.05:
            height = max(height * step.jack_height, step.height_fast)
        if up is not None:
            kind, height = Hover, max(height, self.settings.mines.height)
        if galloping:
            kind, height = Gallop, max(height, self.settings.mines.height)
            if other.side in self.take_off and self.take_off[other.side][0] > i:  # the first of the two
                kind, height = Jump, GRAVITY * (time - lift) ** 2 / 8
        if kind is Step and self._leap(time, duration, foot, (target, yaw), columns):
            return foot.moves[-1].lift
        pitches = heel_up(step, cut, step.lift_pitch, step.swing_pitch, step.land_pitch, columns)
        toes = footing.toes(foot, yaw)
        if kind is Step:
            after = footing.turned_to((yaw, other.yaw) if side == 0 else (other.yaw, yaw))
            footing.pivot(other, footing.pivot_yaw(other, after, target, toes), lift, time)
        bulge = around(footing, foot, (lift, time), target, yaw, other)
        swing = kind(lift, time, pair(target), toes, pitches, height, bulge)
        if isinstance(swing, Jump):
            tuck = tuck_for(float(np.linalg.norm(target - foot.ball)), jump.tuck, jump.far)
            swing = replace(swing, tuck=tuck, middles=(pair(foot.ball), pair(target)))
        foot.move(swing, target, yaw)
        return lift

    def _following(self, i: int, side: int) -> Array | None:
        """The place (2,) of the next step of a foot after row i, if it comes soon."""
        second, limb = self.play.rows.second, self.play.limb
        for j in range(i + 1, int(np.searchsorted(second, second[i] + FOLLOWING))):
            columns = np.flatnonzero(limb[j] == side)
            if len(columns):
                return np.asarray(self.panels[columns].mean(axis=0))
        return None

    def _with_held(self, i: int, foot: Foot, columns: list[int], time: float) -> list[int]:
        """A heel or toe that taps alone does so beside a panel that the rest of the foot holds: a bracket."""
        if len(columns) != 1 or self.play.part[i, columns[0]] == Part.WHOLE:
            return columns
        here = self.panels[columns[0]]
        held = [c for c, end in foot.holds.items() if end > time - LET_GO and c != columns[0]]
        near = [c for c in held if np.linalg.norm(self.panels[c] - here) < NEIGHBOURS]
        return columns + (near[-1:] or self._other_part(i, foot.side, columns[0]))

    def _other_part(self, i: int, side: int, column: int) -> list[int]:
        """The panel beside one that a heel or toe taps alone, where the other end of the foot taps soon: two rolls."""
        rows, part = self.play.rows, self.play.part
        for j in (i + 1, i - 1, i + 2, i - 2):
            if not 0 <= j < len(rows) or abs(rows.second[j] - rows.second[i]) > ALTERNATING:
                continue
            for c in np.flatnonzero(self.play.limb[j] == side):
                other = part[j, c] not in (Part.WHOLE, part[i, column]) and c != column
                if other and np.linalg.norm(self.panels[c] - self.panels[column]) < NEIGHBOURS:
                    return [int(c)]
        return []

    def _gallop(self, i: int, time: float, duration: float, side: int) -> None:
        """A step after a wait, and soon after it one of the other foot: one jump whose second foot lands later."""
        jump, rows = self.settings.jump, self.play.rows
        if i + 1 >= len(rows) or duration < jump.gallop_wait:
            return
        gap = float(rows.second[i + 1]) - time
        following = self.play.limb[i + 1]
        steps = np.flatnonzero(following >= 0)
        if not (0.0 < gap <= jump.gallop and len(steps) == 1 and following[steps[0]] == 1 - side):
            return
        flight = min(float(np.sqrt(8 * jump.apex_near / GRAVITY)), jump.flight_share * duration)
        take_off = max(time - flight, *(f.earliest(time) for f in self.footing.feet))
        if take_off > time - SHORTEST_FLIGHT:
            return
        self.take_off = {side: (i, take_off), 1 - side: (i + 1, take_off)}

    def jump(self, i: int, time: float, duration: float, pressed: dict[int, list[int]], turned: float) -> float:
        """Both feet land at row i; `turned` : degrees that the feet normal turns. Returns when they leave."""
        jump, step, footing = self.settings.jump, self.settings.step, self.footing
        latest = min(land_early(foot, self.settings, time) for foot in footing.feet)
        columns = [self._with_held(i, f, pressed[f.side], time) for f in footing.feet]
        goals = self._jump_goals(i, columns, float(reduction(duration, step.fast, step.longest)))
        far = max(float(np.linalg.norm(g - f.ball)) for (g, _), f in zip(goals, footing.feet, strict=True))
        apex = jump.apex_near + min(far / jump.far, 1.0) * (jump.apex_far - jump.apex_near)
        if len(pressed) > 2:  # bending down to a panel: feet only just leave the ground
            apex = jump.apex_hands
        take_off = self._take_off(time, min(float(np.sqrt(8 * apex / GRAVITY)), jump.flight_share * duration))
        if latest < take_off:  # over a mine
            take_off = max(latest, *(f.rested(time) for f in footing.feet))
        self._fly(take_off, time, duration, goals, columns, turned)
        return take_off

    def _leap(self, time: float, duration: float, foot: Foot, goal: tuple[Array, float], columns: list[int]) -> bool:
        """A step too far for a straddle, or to where the other foot is in the way: both feet leave the ground, and the
        other one lands beside. False if it is neither."""
        step, jump, footing = self.settings.step, self.settings.jump, self.footing
        other = footing.feet[1 - foot.side]
        landed = Pose(goal[0], footing.toes(foot, goal[1]))
        away = goal[0] - other.ball
        far = float(np.linalg.norm(away))
        in_the_way = shoes_apart(landed, pose(footing, other)) < TOUCHING
        if far <= step.leap and not in_the_way:
            return False
        apex = jump.apex_near if in_the_way else jump.apex_far
        flight = min(float(np.sqrt(8 * apex / GRAVITY)), jump.flight_share * duration)
        take_off = self._take_off(time, flight)
        bound = other.free if in_the_way else max(foot.free, other.free)
        if time - take_off < SHORTEST_FLIGHT or bound > take_off:
            return False
        yaw = footing.limited(other.yaw + step.yaw_to_normal * (footing.body_yaw() - other.yaw), footing.body_yaw())
        goals = [goal, goal]
        if in_the_way:
            goals[other.side] = beside(
                footing, other, Spot(other.ball, np.full(2, ASIDE)), other.ball, other.yaw, landed
            )
        else:
            goals[other.side] = (goal[0] - step.leap_stance * away / far, yaw)
        self._fly(take_off, time, duration, goals, [columns, columns], 0.0)
        return True

    def _fly(
        self, take_off: float, time: float, duration: float, goals: Goals, columns: list[list[int]], turned: float
    ) -> None:
        """Both feet in the air from `take_off` to `time`."""
        jump, step = self.settings.jump, self.settings.step
        cut = float(reduction(duration, step.fast, step.longest))
        eased = 1.0 - FLAT * cut
        lift, land = eased * jump.lift_pitch, eased * jump.land_pitch
        pitches = [heel_up(step, cut, lift, lift, land, c) for c in columns]
        first = self._first(take_off, time, duration, goals)
        fly(self.footing, Flight(take_off, time, turned, eased, first), goals, pitches)

    def _first(self, take_off: float, time: float, duration: float, goals: Goals) -> tuple[float, float]:
        """When each foot leaves the ground in a quick jump: the one with the longer way before both take off."""
        step, feet = self.settings.step, self.footing.feet
        ways = [float(np.linalg.norm(ball - f.ball)) for (ball, _), f in zip(goals, feet, strict=True)]
        side = int(ways[1] > ways[0])
        foot, (target, yaw) = feet[side], goals[side]
        out = [take_off, take_off]
        early = max(foot.earliest(time), time - duration * (1.0 - step.double_support_fast))
        straight = around(self.footing, foot, (early, time), target, yaw, feet[1 - side]) == (0.0, 0.0)
        if straight and ways[side] > ways[1 - side] + LONGER:
            out[side] -= float(reduction(duration, step.fast, step.longest)) * max(take_off - early, 0.0)
        return out[0], out[1]

    def _jump_goals(self, i: int, columns: list[list[int]], cut: float) -> Goals:
        """Where both balls land, and the feet's yaws."""
        footing = self.footing
        body = footing.body_yaw()
        yaws = [footing.limited(f.yaw + self.settings.jump.yaw_to_normal * (body - f.yaw), body) for f in footing.feet]
        goals: dict[int, tuple[Array, float]] = {}
        # brackets have no choice: they are first
        for foot in sorted(footing.feet, key=lambda f: (-len(columns[f.side]), f.side != footing.lead)):
            side = 1 - foot.side
            ball, yaw = goals.get(side, (self.panels[columns[side]].mean(axis=0), yaws[side]))
            other = Pose(ball, footing.toes(footing.feet[side], yaw))
            wish = columns[foot.side], self.play.part[i], yaws[foot.side], cut, self._following(i, foot.side)
            goals[foot.side] = landing(footing, foot, Goal(*wish), other)
        return [goals[0], goals[1]]

    def _take_off(self, time: float, flight: float) -> float:
        feet: tuple[Foot, ...] = self.footing.feet
        latest = (f.latest(time, self.settings.step.let_go) for f in feet)
        take_off = min(max(time - flight, *(f.earliest(time) for f in feet)), *latest)
        return max(take_off, *(f.rested(time) for f in feet))
