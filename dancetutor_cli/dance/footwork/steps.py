"""Steps, brackets and jumps: when feet leave for their notes, how high they go and where they land."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from dancetutor_cli.dance.clearance import evenness
from dancetutor_cli.dance.context import HALF_PANEL, PANEL, is_on_beat
from dancetutor_cli.dance.footwork.flights import Goals, galloping, hop, leap, take_off_for, tuck_for
from dancetutor_cli.dance.footwork.foothold import (
    Goal,
    Pose,
    heel_of_step,
    heel_up,
    landing_place,
    pose,
    step_height,
    swing_detour,
)
from dancetutor_cli.dance.footwork.footing import Footing, FootState, Proposal, Row, TakeOff, pair
from dancetutor_cli.dance.footwork.mines import flown_on, landed_early, resumed, stayed_up, wait_for_other_foot
from dancetutor_cli.dance.plan import Gallop, Hover, Jump, Step, Swing
from dancetutor_cli.dance.rig.body import GRAVITY
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.limbs import Part

# Brackets: one foot on two panels, heel on one and toes on the other, also where they tap in turn.

NEIGHBOURS = 1.6 * PANEL  # metres between panels that one foot can press together


def under_the_foot(row: Row, foot: FootState) -> list[int]:
    """Return the columns under a foot after a row: the columns that it presses, and one that its other end holds.

    A heel or toe that taps alone, beside a panel that the rest of the foot holds, is a bracket.
    """
    columns, panels = row.pressed[foot.side], row.context.panels
    if len(columns) != 1 or row.play.part[row.index, columns[0]] == Part.WHOLE:
        return columns
    here = panels[columns[0]]
    held = [c for c, end in foot.holds if end > row.time - row.context.settings.step.bracket_late and c != columns[0]]
    near = [c for c in held if np.linalg.norm(panels[c] - here) < NEIGHBOURS]
    return columns + (near[-1:] or _other_part(row, foot.side, columns[0]))


def _other_part(row: Row, side: int, column: int) -> list[int]:
    """Return the neighbour of a panel that heel or toe taps alone, if the other end taps it soon (two rolls)."""
    rows, part, i, panels = row.play.rows, row.play.part, row.index, row.context.panels
    for j in (i + 1, i - 1, i + 2, i - 2):
        if not 0 <= j < len(rows) or abs(rows.second[j] - rows.second[i]) > row.context.settings.step.bracket_between:
            continue
        for c in np.flatnonzero(row.play.limb[j] == side):
            other = part[j, c] not in (Part.WHOLE, part[i, column]) and c != column
            if other and np.linalg.norm(panels[c] - panels[column]) < NEIGHBOURS:
                return [int(c)]
    return []


# Jumps: both feet land at one row; their places and height (thesis 5.5, 5.6).


def jump(row: Row, footing: Footing) -> Proposal:
    """Propose a jump: both feet land at a row."""
    numbers, time = footing.settings.jump, row.time
    footing, latest = flown_on(footing, time)
    until = [time, time]
    for foot in footing.feet:
        down, until[foot.side] = landed_early(foot, footing.settings, time)
        footing = footing.with_foot(down)
    latest = min(latest, *until)
    columns = [under_the_foot(row, f) for f in footing.feet]
    goals = _goals(row, footing, columns)
    far = max(float(np.linalg.norm(g - f.ball)) for (g, _), f in zip(goals, footing.feet, strict=True))
    way = min(far / numbers.far, 1.0)
    apex = numbers.apex_near + way * (numbers.apex_far - numbers.apex_near)
    if row.hands:  # bending down to a panel: feet leave the ground only a little
        apex = numbers.apex_hands
    share = numbers.flight_share - row.jump_cut * (1.0 - way) * (numbers.flight_share - numbers.flight_near)
    take_off = take_off_for(footing, time, min(float(np.sqrt(8 * apex / GRAVITY)), share * row.duration))
    if latest < take_off:  # over a mine
        take_off = max(latest, *(f.rest_time(time) for f in footing.feet))
    found = hop(row, footing, take_off, goals, columns, row.turned)
    return replace(found, footing=stayed_up(footing, found.footing, until, take_off))


def _goals(row: Row, footing: Footing, columns: list[list[int]]) -> Goals:
    """Return where both balls land, and the yaws of the feet."""
    body, panels = footing.body_yaw(), row.context.panels
    share = footing.settings.jump.yaw_to_normal
    yaws = [footing.limit_yaw(f.yaw + share * (body - f.yaw), body) for f in footing.feet]
    goals: dict[int, tuple[Array, float]] = {}
    # a bracket has no choice of its place, so it is first
    for foot in sorted(footing.feet, key=lambda f: (-len(columns[f.side]), f.side != footing.lead)):
        side = 1 - foot.side
        ball, yaw = goals.get(side, (panels[columns[side]].mean(axis=0), yaws[side]))
        other = Pose(ball, footing.toes(footing.feet[side], yaw))
        wanted = columns[foot.side], row.play.part[row.index], yaws[foot.side], row.jump_cut, row.next_place(foot.side)
        goals[foot.side] = landing_place(footing, foot, Goal(*wanted), other)
    return [goals[0], goals[1]]


# Steps: when one foot leaves for its note, how high it goes and where it lands (thesis 5.5, 5.6).


def step(row: Row, side: int, footing: Footing) -> Proposal:
    """Propose a step of one foot: from the ground, from the air over a mine, or as a part of a gallop."""
    numbers, time = footing.settings.step, row.time
    footing = galloping(row, side, footing)
    resuming, up = resumed(footing.feet[side], footing.feet[1 - side], time, footing.settings)
    footing = _make_room(row, side, footing.with_foot(resuming))
    foot, other = footing.feet[side], footing.feet[1 - side]
    body = footing.body_yaw()
    wanted = footing.limit_yaw(other.yaw + numbers.yaw_to_normal * (body - other.yaw), body)
    columns = under_the_foot(row, foot)
    goal = Goal(columns, row.play.part[row.index], wanted, row.cut, row.next_place(side), row.haste)
    target, yaw = landing_place(footing, foot, goal, pose(footing, other))
    if _taps_again(row, foot, columns):
        target, yaw = foot.ball, foot.yaw
    gallop = _gallop(row, side, footing)
    if gallop is not None:
        lift = gallop.time
    else:
        standing, lift = wait_for_other_foot(
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
        footing = _give_way(footing, foot, (target, yaw), (lift, time))
    heel = heel_of_step(numbers, row.leisure, row.haste)
    if kind is Jump:  # legs that push off need it
        heel = replace(heel, flat=(footing.settings.jump.lift_flat, footing.settings.jump.swing_flat))
    pitches = heel_up(numbers, row.cut, heel, columns)
    bulge = swing_detour(footing, foot, (lift, time), target, yaw, footing.other(foot))
    height += numbers.height_far * float(np.hypot(bulge.x, bulge.z)) * (kind is Step)
    swing = kind(lift, time, pair(target), footing.toes(foot, yaw), pitches, height, bulge)
    if isinstance(swing, Jump):
        jump = footing.settings.jump
        tuck = tuck_for(float(np.linalg.norm(target - foot.ball)), time - lift, jump)
        swing = replace(swing, tuck=tuck, middles=(pair(foot.ball), pair(target)))
    return Proposal(footing.with_foot(foot.with_move(swing, target, yaw)), lift)


def _make_room(row: Row, side: int, footing: Footing) -> Footing:
    """Return the footing in which the other foot turns with the body, if this foot lands beside it on its panel.

    A foot that lies across the panel would leave room for half a shoe, and the rest would hang over the edge of the
    pad.
    """
    foot, other = footing.feet[side], footing.feet[1 - side]
    panel = row.context.panels[row.pressed[side]].mean(axis=0)
    if row.next_place(side) is not None or (np.abs(other.ball - panel) > HALF_PANEL).any():
        return footing
    turned = footing.pivot_yaw(other, footing.body_yaw(), foot.ball, footing.toes(foot))
    return footing.pivoted(other, turned, row.time - row.duration, row.time)


def _taps_again(row: Row, foot: FootState, columns: list[int]) -> bool:
    """Whether a foot landed on the row's panel so shortly before that there is no time to move it."""
    on = (np.abs(foot.ball - row.context.panels[columns]) <= HALF_PANEL).all(axis=1).any()
    return bool(on) and row.time - foot.landed < row.context.settings.step.again


def _gallop(row: Row, side: int, footing: Footing) -> TakeOff | None:
    """Return the take-off of the foot that steps at a row, if it does so in a gallop."""
    found = footing.take_offs
    return found[side] if found is not None and found[side].row == row.index else None


def _lift(row: Row, footing: Footing, far: float) -> float:
    """Return when a foot leaves for its note, `far` metres away.

    A swing has a least time, and both feet stand for a part of the available time. For a fast step, this part is
    smaller if the note is farther away.
    """
    numbers = footing.settings.step
    least = numbers.double_support_near * max(1.0 - far / numbers.double_support_far, 0.0)
    fast = numbers.double_support_fast + row.haste * (least - numbers.double_support_fast)
    both = numbers.double_support + row.cut * (fast - numbers.double_support)
    return row.time - max(row.duration * (1.0 - both), min(numbers.least_swing, row.duration + numbers.overlap))


def _kind(
    row: Row, footing: Footing, going: tuple[FootState, float], target: Array, hovering: bool
) -> tuple[type[Swing], float]:
    """Return the kind of a swing, and the height of the foot, metres; the height of a jump follows from its time.

    going : the foot and the seconds of its swing
    """
    numbers, mines, (foot, duration) = footing.settings.step, footing.settings.mines, going
    far = float(np.linalg.norm(target - foot.ball))
    fast = numbers.height_fast + row.haste * (numbers.height_hasty - numbers.height_fast)
    fast += row.haste * float(evenness(duration, numbers)) * (numbers.height_even - numbers.height_hasty)
    fast += numbers.height_far * max(far - numbers.far, 0.0)
    accent = numbers.height_accent * (1.0 - row.haste)
    fast *= 1.0 + (accent if is_on_beat(row.context, row.time) else -accent)
    slow = step_height(far, row.time, row.context)
    least = numbers.height_lands * duration / (np.pi * max(numbers.rising + numbers.falling, 0.2))
    height = max(slow + row.cut * (fast - slow), least)
    kind: type[Swing] = Step
    if hovering:
        kind, height = Hover, max(height, mines.height)
    if _gallop(row, foot.side, footing) is not None:
        jump = footing.settings.jump
        kind, height = Gallop, max(height, mines.height, jump.apex_near + 2 * jump.tuck)  # up with the body
        assert footing.take_offs is not None
        if footing.take_offs[1 - foot.side].row > row.index:  # this foot lands first
            kind = Jump
    return kind, height


def _give_way(footing: Footing, foot: FootState, goal: tuple[Array, float], span: tuple[float, float]) -> Footing:
    """Return the footing in which the standing foot turns with the body while the other one swings to its goal."""
    other, (target, yaw) = footing.other(foot), goal
    after = footing.turned_to((yaw, other.yaw) if foot.side == 0 else (other.yaw, yaw))
    turned = footing.pivot_yaw(other, after, target, footing.toes(foot, yaw))
    return footing.pivoted(other, turned, *span)
