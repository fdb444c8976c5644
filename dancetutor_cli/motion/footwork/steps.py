"""Steps: one foot goes to its note, when it leaves, how high it goes and where it lands (thesis 5.5, 5.6)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.foot_moves import Gallop, Hover, Jump, Step, Swing
from dancetutor_cli.motion.footwork.brackets import under_the_foot
from dancetutor_cli.motion.footwork.chart_row import Row
from dancetutor_cli.motion.footwork.flights import tuck_for
from dancetutor_cli.motion.footwork.foothold import Goal, around, heel_of_step, heel_up, landing, pose
from dancetutor_cli.motion.footwork.footing import Footing, FootState, Proposal, TakeOff, pair
from dancetutor_cli.motion.footwork.gallops import galloping
from dancetutor_cli.motion.footwork.leaps import leap
from dancetutor_cli.motion.footwork.mines import left_standing, resumed
from dancetutor_cli.motion.swing.pace import evenness
from dancetutor_cli.motion.swing.panels import HALF_PANEL
from dancetutor_cli.rig.mass import GRAVITY

Array = NDArray[np.float64]


def step(row: Row, side: int, footing: Footing) -> Proposal:
    """One foot steps at a row: from the ground, out of the air over a mine, or as a part of a gallop."""
    numbers, time = footing.settings.step, row.time
    footing = galloping(row, side, footing)
    resuming, up = resumed(footing.feet[side], footing.feet[1 - side], time, footing.settings)
    footing = _room_made(row, side, footing.with_foot(resuming))
    foot, other = footing.feet[side], footing.feet[1 - side]
    body = footing.body_yaw()
    wanted = footing.limited(other.yaw + numbers.yaw_to_normal * (body - other.yaw), body)
    columns = under_the_foot(row, foot)
    goal = Goal(columns, row.play.part[row.index], wanted, row.cut, row.following(side), row.haste)
    target, yaw = landing(footing, foot, goal, pose(footing, other))
    if _taps_again(row, foot, columns):
        target, yaw = foot.ball, foot.yaw
    gallop = _gallop(row, side, footing)
    if gallop is not None:
        lift = gallop.time
    else:
        standing, lift = left_standing(
            other, footing.settings, _lift(row, footing, float(np.linalg.norm(target - foot.ball))), time
        )
        footing = footing.with_foot(standing)
    lift = min(max(lift, foot.earliest(time)), foot.latest(time, numbers.let_go)) if up is None else up
    kind, height = _kind(row, footing, (foot, time - lift), target, up is not None)
    if kind is Jump:
        height = GRAVITY * (time - lift) ** 2 / 8
    if kind is Step:
        leapt = leap(row, foot, (target, yaw), columns, footing)
        if leapt is not None:
            return replace(leapt, leaves=leapt.footing.feet[side].moves[-1].lift)
        footing = _given_way(footing, foot, (target, yaw), (lift, time))
    heel = heel_of_step(numbers)
    if kind is Jump:  # legs that push off need it
        heel = replace(heel, flat=(footing.settings.jump.lift_flat, footing.settings.jump.swing_flat))
    pitches = heel_up(numbers, row.cut, heel, columns)
    bulge = around(footing, foot, (lift, time), target, yaw, footing.other(foot))
    height += numbers.height_far * float(np.hypot(bulge.x, bulge.z)) * (kind is Step)
    swing = kind(lift, time, pair(target), footing.toes(foot, yaw), pitches, height, bulge)
    if isinstance(swing, Jump):
        jump = footing.settings.jump
        tuck = tuck_for(float(np.linalg.norm(target - foot.ball)), time - lift, jump)
        swing = replace(swing, tuck=tuck, middles=(pair(foot.ball), pair(target)))
    return Proposal(footing.with_foot(foot.moved(swing, target, yaw)), lift)


def _room_made(row: Row, side: int, footing: Footing) -> Footing:
    """The footing in which the other foot turns with the body, if this one comes to stay beside it on its panel.

    One that lies across the panel would leave room for half a shoe, and the rest would hang over the pad's edge.
    """
    foot, other = footing.feet[side], footing.feet[1 - side]
    panel = row.context.panels[row.pressed[side]].mean(axis=0)
    if row.following(side) is not None or (np.abs(other.ball - panel) > HALF_PANEL).any():
        return footing
    turned = footing.pivot_yaw(other, footing.body_yaw(), foot.ball, footing.toes(foot))
    return footing.pivoted(other, turned, row.time - row.duration, row.time)


def _taps_again(row: Row, foot: FootState, columns: list[int]) -> bool:
    """Whether a foot has come down on the row's panel so shortly before that there is no time to shift it."""
    on = (np.abs(foot.ball - row.context.panels[columns]) <= HALF_PANEL).all(axis=1).any()
    return bool(on) and row.time - foot.landed < row.context.settings.step.again


def _gallop(row: Row, side: int, footing: Footing) -> TakeOff | None:
    """The take-off of the foot that steps at a row, if it does so in a gallop."""
    found = footing.take_offs
    return found[side] if found is not None and found[side].row == row.index else None


def _lift(row: Row, footing: Footing, far: float) -> float:
    """When a foot would leave for its note, so far away, metres: it has a least time, and both feet stand for a part of
    what there is, of a fast step the less the farther it is."""
    numbers = footing.settings.step
    least = numbers.double_support_near * max(1.0 - far / numbers.double_support_far, 0.0)
    fast = numbers.double_support_fast + row.haste * (least - numbers.double_support_fast)
    both = numbers.double_support + row.cut * (fast - numbers.double_support)
    return row.time - max(row.duration * (1.0 - both), min(numbers.least_swing, row.duration + numbers.overlap))


def _kind(
    row: Row, footing: Footing, going: tuple[FootState, float], target: Array, hovering: bool
) -> tuple[type[Swing], float]:
    """What kind of swing it is, and how high the foot goes, metres; the height of a jump follows from its time.

    going : the foot and how many seconds it takes
    """
    numbers, mines, (foot, duration) = footing.settings.step, footing.settings.mines, going
    far = float(np.linalg.norm(target - foot.ball))
    fast = numbers.height_fast + row.haste * (numbers.height_hasty - numbers.height_fast)
    fast += row.haste * float(evenness(duration, numbers)) * (numbers.height_even - numbers.height_hasty)
    fast += numbers.height_far * max(far - numbers.far, 0.0)
    height = numbers.height_slow + row.cut * (fast - numbers.height_slow)
    if far < numbers.on_the_spot:
        height = max(height * numbers.jack_height, fast)
    kind: type[Swing] = Step
    if hovering:
        kind, height = Hover, max(height, mines.height)
    if _gallop(row, foot.side, footing) is not None:
        jump = footing.settings.jump
        kind, height = Gallop, max(height, mines.height, jump.apex_near + 2 * jump.tuck)  # up with the body
        assert footing.take_offs is not None
        if footing.take_offs[1 - foot.side].row > row.index:  # the first of the two
            kind = Jump
    return kind, height


def _given_way(footing: Footing, foot: FootState, goal: tuple[Array, float], span: tuple[float, float]) -> Footing:
    """The standing foot turns with the body while the other one goes to its goal, from lift to landing."""
    other, (target, yaw) = footing.other(foot), goal
    after = footing.turned_to((yaw, other.yaw) if foot.side == 0 else (other.yaw, yaw))
    turned = footing.pivot_yaw(other, after, target, footing.toes(foot, yaw))
    return footing.pivoted(other, turned, *span)
