"""Ankles within their limits, and soles that roll where an ankle would otherwise bend too far."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.context import HALF_PANEL
from dancetutor_cli.dance.foot_path import Feet, FootPath
from dancetutor_cli.dance.ik.full_body import Targets
from dancetutor_cli.dance.plan import Pivot, Plan, Swing
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import points_in_world, sole_points, world_transforms
from dancetutor_cli.dance.rig.skeleton import Skeleton, beyond, within
from dancetutor_cli.dance.smoothing import smooth
from dancetutor_cli.dance.units import Array, Poses
from dancetutor_cli.feet.limbs import Part
from dancetutor_cli.feet.play import runs

# Ankles within their limits: feet in the air follow their shanks, and the knees over standing feet turn.

LIMIT_MARGIN = 0.5  # degrees inside the limit
# angles of a knee, in the order in which they are tried
GIVES = np.radians([0.0, 4.0, -4.0, 8.0, -8.0, 12.0, -12.0, 16.0, -16.0, 20.0, -20.0, 24.0, -24.0])
NEAR, ROOM = 2.0, 1.0  # degrees from its limit at which an ankle is checked; degrees kept to the limit afterwards
UNDER, HALVINGS = 2e-4, 6  # metres that a turning sole may be under the ground; halvings to find how far it turns
UP_FROM, UP_TO = 0.004, 0.030  # metres over the ground between which a foot becomes free to turn: lower, it would touch


def ease_ankles(skeleton: Skeleton, poses: Poses, feet: tuple[FootPath, FootPath]) -> None:
    """Turn feet back in place, as far as their soles stay over the ground; `feet` at the times of the poses.

    Ankles stay in their places.
    """
    for side, foot in enumerate(feet):
        name = f"{'lr'[side]}_talocrural"
        joint, rotations = skeleton.index(name), poses.rotations
        free = freedom(foot)
        bent = np.flatnonzero((beyond(skeleton, name, rotations[:, joint]) > -LIMIT_MARGIN) & (free > 0.0))
        if not len(bent):
            continue
        some = Poses(rotations[bent], poses.root[bent])
        eased = within(skeleton, name, rotations[bent, joint], LIMIT_MARGIN)
        floor = np.minimum(_lowest(skeleton, some, side), 0.0) - UNDER

        def turned(share: Array, joint: int = joint, some: Poses = some, eased: Array = eased) -> Poses:
            out = some.rotations.copy()
            out[:, joint] = quat.slerp(out[:, joint], eased, share)
            return Poses(out, some.root)

        share, least = free[bent], np.zeros(len(bent))
        deep = _lowest(skeleton, turned(share), side) < floor
        most = share.copy()
        for _ in range(HALVINGS if deep.any() else 0):
            middle = (least + most) / 2
            well = _lowest(skeleton, turned(middle), side) >= floor
            least, most = np.where(well, middle, least), np.where(well, most, middle)
        rotations[bent] = turned(np.where(deep, least, share)).rotations


def _lowest(skeleton: Skeleton, poses: Poses, side: int) -> Array:
    """Return the height (f,) of the lowest point of a sole, metres."""
    points = points_in_world(skeleton, sole_points(skeleton)[side], *poses)
    return np.asarray(points[..., 1].min(axis=1))


def freedom(foot: FootPath) -> Array:
    """Return how free (f,) a foot is to turn with its shank: 0 on the ground or close to it, 1 in the air."""
    up = np.clip((foot.ball[:, 1] - UP_FROM) / (UP_TO - UP_FROM), 0.0, 1.0)
    return np.where(foot.down, 0.0, up)


def giving_knees(skeleton: Skeleton, poses: Poses, around: int) -> Array:
    """Return the turns (f, 2) of knees outward about hip-ankle lines, radians, that keep legs within their limits.

    They are the limits of hips, and of ankles over feet that stand, or nearly stand. The turn is as small as possible,
    and the same in each stretch of frames.

    around : frames before and after a stretch in which the knees turn and turn back; they must do no harm there either
    """
    out = np.zeros((len(poses.root), 2))
    for side, name in enumerate("lr"):
        joints = [f"{name}_{joint}" for joint in ("talocrural", "hip")]
        past = np.maximum(*(beyond(skeleton, one, poses.rotations[:, skeleton.index(one)]) for one in joints))
        for first, end in runs(past > -NEAR):
            if past[first:end].max() > 0.0:
                seen = slice(max(first - around, 0), end + around)
                inside = np.zeros(len(past), dtype=bool)
                inside[first:end] = True
                near = Poses(poses.rotations[seen], poses.root[seen])
                out[first:end, side] = _least_give(skeleton, near, inside[seen], name)
    return out


def _least_give(skeleton: Skeleton, poses: Poses, inside: NDArray[np.bool_], name: str) -> float:
    """Return how far one knee turns outward: the smallest turn that brings ankle and hip within their limits.

    It is measured in the frames `inside`, of the ankle in those in which the foot is low, and must make no other frame
    worse. If there is no such turn, the result is 0.
    """
    hip, knee, ankle, ball = (skeleton.index(f"{name}_{n}") for n in ("hip", "knee", "talocrural", "metatarsal"))
    places, world = world_transforms(skeleton, poses.rotations, poses.root)
    high = places[:, ball, 1] > skeleton.rest[ball][1] + UP_TO
    line = places[:, ankle] - places[:, hip]
    line /= np.linalg.norm(line, axis=1, keepdims=True)
    pelvis = quat.conjugate(world[:, skeleton.parents[hip]])
    past = np.empty((len(GIVES), len(line)))
    for k, give in enumerate(GIVES if name == "r" else -GIVES):
        turn = quat.from_axis_angle(line, np.full(len(line), give))
        thigh, shank = quat.multiply(turn, world[:, hip]), quat.multiply(turn, world[:, knee])
        foot = quat.multiply(quat.conjugate(shank), world[:, ankle])
        hips = beyond(skeleton, f"{name}_hip", quat.multiply(pelvis, thigh))
        ankles = beyond(skeleton, f"{name}_talocrural", foot)
        past[k] = np.maximum(np.where(high, -np.inf, ankles), hips) + ROOM
    worst = past[:, inside].max(axis=1)
    worst[(past > np.maximum(past[0], 0.0)).any(axis=1)] = np.inf
    least = max(0.0, float(worst.min()))
    return float(GIVES[int(np.argmax(worst <= least))]) if least <= ROOM else 0.0


# Soles that roll: where its ankle would bend too far, a foot lands on an edge, or with its heel up, and becomes flat as
# the body comes over it.

SOLE_ROUNDS = 4  # rounds of turning a sole and checking the result
MOST = np.radians((18.0, 20.0))  # radians that a sole rolls at most, and that its heel rises at most
PRESSED, FADE = 0.006, 0.04  # seconds around a note in which a sole does not roll off its panel, and in which it begins


@dataclass(frozen=True, slots=True)
class Edges:
    """The two edges, at smaller and at larger x, of a sole that lies flat, as seen from the joint of its ball.

    balls : (2, 3) places of the edges beside the ball; lines : (2, 3) unit vectors along them; ankle : (3,)
    """

    balls: Array
    lines: Array
    ankle: Array


@dataclass(frozen=True, slots=True)
class RollingSole:
    """A foot in m frames. World rotations (m, 4): of its shank, of the foot, and of a flat foot with the same yaw.

    give : (m, 2) how much the foot may roll and its heel may rise, 0 to 1
    """

    name: str
    shank: Array
    turn: Array
    straight: Array
    give: Array


def edges_of(skeleton: Skeleton, side: int) -> Edges:
    """Return the edges of the left (0) or the right sole."""
    name, points = "lr"[side], sole_points(skeleton)[side]
    ball = skeleton.rest[skeleton.index(f"{name}_metatarsal")]
    places = np.array([skeleton.rest[p.joint] + p.offset - ball for p in points[:4]])
    heels, balls = (pair[np.argsort(pair[:, 0])] for pair in (places[:2], places[2:]))
    lines = (balls - heels) / np.linalg.norm(balls - heels, axis=1, keepdims=True)
    return Edges(balls, lines, skeleton.rest[skeleton.index(f"{name}_talocrural")] - ball)


def rolled_soles(
    skeleton: Skeleton, plan: Plan, posed: tuple[Array, Feet, Targets, Poses], rises: Array
) -> Targets | None:
    """Return targets with which the ankles of feet on the ground, or a little over it, are within their limits.

    A foot that touches the ground, or would touch it, keeps its place. Returns None if no target changes.

    posed : times (f,), feet, targets and poses there; rises : (f, 2) how much heels may rise, 0 to 1
    """
    times, feet, targets, poses = posed
    ankles, soles, toes, found = targets.ankles.copy(), targets.soles.copy(), targets.toes.copy(), False
    for side, foot in enumerate(feet):
        name = f"{'lr'[side]}_talocrural"
        joint, edges, low = skeleton.index(name), edges_of(skeleton, side), 1.0 - freedom(foot)
        past = beyond(skeleton, name, poses.rotations[:, joint]) > -LIMIT_MARGIN
        at = np.flatnonzero(past & (low > 0.0) & (foot.pitch > -1e-6))
        if not len(at):
            continue
        found = True
        shank = world_transforms(skeleton, poses.rotations[at], poses.root[at])[1][:, skeleton.parents[joint]]
        give = low[at, None] * np.column_stack((may_roll(plan, side, times[at]), rises[at, side]))
        sole = RollingSole(name, shank, soles[at, side], quat.from_axis_angle(quat.UP, foot.yaw[at]), give)
        angles = _angles(skeleton, sole, edges)
        ball = ankles[at, side] - quat.rotate(sole.turn, edges.ankle)
        edge = quat.rotate(sole.straight, edges.balls[_down(angles)])
        angles[:, 0] *= _pressing(plan, side, ball + edge, times[at])
        roll, both = _turns(angles, sole.straight, edges)
        soles[at, side], toes[at, side] = quat.multiply(both, sole.turn), quat.multiply(roll, toes[at, side])
        ankles[at, side] = ball + edge - quat.rotate(roll, edge) + quat.rotate(soles[at, side], edges.ankle)
    return replace(targets, ankles=ankles, soles=soles, toes=toes) if found else None


def may_roll(plan: Plan, side: int, at: Array) -> Array:
    """Return how much (f,) a foot may roll at times `at` (f,), 0 to 1.

    It may not roll in a stand in which it turns on its ball, because it would slide.
    """
    out = np.ones(len(at))
    swings = [move for move in plan.feet[side].moves if isinstance(move, Swing)]
    stands = np.array([(-np.inf, *(m.land for m in swings)), (*(m.lift for m in swings), np.inf)]).T
    turns = [move.lift for move in plan.feet[side].moves if isinstance(move, Pivot)]
    still = [stands[np.searchsorted(stands[:, 0], turn, side="right") - 1] for turn in turns]
    for start, end in still:
        out = np.minimum(out, smooth((np.maximum(start - at, at - end) - PRESSED) / FADE))
    return out


def _pressing(plan: Plan, side: int, edge: Array, at: Array) -> Array:
    """Return how much (f,) a sole may roll onto an edge that is at (f, 3), 0 to 1.

    It is 0 while the sole presses a panel beside that edge, or two panels.
    """
    out = np.ones(len(at))
    for contact in (c for c in plan.contacts if c.limb == side):
        away = np.abs(at - contact.start) - PRESSED
        beside = np.abs(edge[:, [0, 2]] - np.array(contact.panel)).max(axis=1) > HALF_PANEL
        beside |= contact.part != Part.WHOLE
        out = np.where(beside, np.minimum(out, smooth(away / FADE)), out)
    return out


def _down(angles: Array) -> NDArray[np.int64]:
    """Return which edge (m,) of a rolling sole stays on the ground."""
    return np.asarray(angles[:, 0] < 0.0, dtype=np.int64)


def _turns(angles: Array, straight: Array, edges: Edges) -> tuple[Array, Array]:
    """Return the world rotations (m, 4) of toes and foot. The rise of the heel turns the foot before it rolls.

    angles : (m, 2) radians that the sole rolls, its larger x up, and that its heel rises
    """
    roll = quat.from_axis_angle(quat.rotate(straight, edges.lines[_down(angles)]), angles[:, 0])
    rise = quat.from_axis_angle(quat.rotate(straight, quat.LEFT), angles[:, 1])
    return roll, quat.multiply(roll, rise)


def _angles(skeleton: Skeleton, sole: RollingSole, edges: Edges) -> Array:
    """Return how far (m, 2) a sole rolls and its heel rises, as in `_turns`, so that its ankle is within its limits."""
    axes = [quat.rotate(sole.straight, np.array(axis)) for axis in ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0))]
    angles, least, most = np.zeros((len(sole.turn), 2)), [-MOST[0], 0.0], MOST
    for _ in range(SOLE_ROUNDS):
        now = quat.multiply(_turns(angles, sole.straight, edges)[1], sole.turn)
        eased = within(skeleton, sole.name, quat.multiply(quat.conjugate(sole.shank), now), LIMIT_MARGIN)
        more = quat.multiply(quat.multiply(sole.shank, eased), quat.conjugate(now))
        more = 2.0 * np.where(more[:, :1] < 0.0, -more, more)[:, 1:]
        angles += np.stack([np.sum(more * axis, axis=1) for axis in axes], axis=1)
        angles = np.clip(angles, sole.give * least, sole.give * most)
    return angles
