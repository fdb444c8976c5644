"""The body over the feet: where the weight is, how high, which way pelvis and chest turn, and how far they bend."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.gait import gaze_ahead, walking
from dancetutor_cli.motion.ik.rail import kept_back, leaning_share
from dancetutor_cli.motion.plan import Plan, Press, Turn, airborne
from dancetutor_cli.motion.settings import MotionSettings
from dancetutor_cli.motion.swing.foot_path import FootPath
from dancetutor_cli.motion.trajectory.balance import balanced_path
from dancetutor_cli.motion.trajectory.beat_bounce import groove
from dancetutor_cli.motion.trajectory.counter_rotation import counter_twist
from dancetutor_cli.motion.trajectory.crouch import haste, jump_crouch, jump_lean
from dancetutor_cli.motion.trajectory.height import HeightPath, height_path
from dancetutor_cli.numerics.controller import Controller, follow
from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.numerics.smoothing import low_pass, smooth_path
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.mass import GRAVITY, centre_of_mass
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
WRUNG = np.radians(110.0)  # before the screen is right behind her, the chest gives up looking at it over so far
YAW_SMOOTH = 0.08  # seconds over which the pelvis turns with each step
BALANCE, HEIGHT = "her balance", "the height of her body"  # what `softened` may name
STANDING_HEIGHT = 0.93  # metres, of the centre of mass


@dataclass(frozen=True, slots=True)
class BodyPath:
    """The body at n times, `rate` per second.

    mass : (n, 2), (x, z) of the centre of mass; mass_height : its height
    ground : (n, 2), (x, z) of the root; height : (n,) of the root; yaw, chest_yaw, head_yaw : (n,) radians, unwrapped
    tilt : (n, 2), horizontal (x, z) direction times angle by which the chest leans; reaching : (n, 2), 0 to 1, how far
    the body has bent for the left and right hand; heels : (n, 2), radians that they are raised for the ankles' sake
    softened : what had no solution within the limits of legs and soles, so that they gave way; for people
    """

    times: Array
    mass: Array
    mass_height: HeightPath
    ground: Array
    height: Array
    yaw: Array
    chest_yaw: Array
    head_yaw: Array
    tilt: Array
    reaching: Array
    heels: Array
    softened: tuple[str, ...] = ()


def body_path(
    plan: Plan, times: Array, feet: tuple[FootPath, FootPath], skeleton: Skeleton, settings: MotionSettings,
    before: BodyPath | None = None, above: Array | None = None, deeper: Array | None = None,
    keep: bool = False, tightened: int = 0,
) -> BodyPath:  # fmt: skip
    """All paths of the body on evenly spaced `times` (n,), feet sampled at the same times.

    before : the path found in the round before; None in the first
    above : (n, 3), centre of mass minus root as measured on a first bake; None for that of the rest pose
    keep : leave the path over the ground as it was before; tightened : as in `balanced_path`
    deeper : (p,) how far each press of a palm drew the root below where it was wanted, metres
    """
    rate = 1.0 / float(times[1] - times[0])
    if above is None:
        rest = np.tile(quat.IDENTITY, (1, len(skeleton.names), 1))
        mass = centre_of_mass(skeleton, *world_transforms(skeleton, rest, skeleton.offsets[None, 0]))
        above = np.tile((mass[0] - skeleton.offsets[0]) * [0.0, 1.0, 0.0], (len(times), 1))
    reaching = np.column_stack([_reaching(plan.presses, times, side, settings) for side in (0, 1)])
    if keep and before is not None:
        mass_ground, swept = before.mass, BALANCE in before.softened
    else:
        levers = _levers(before.mass_height if before else None, times)
        mass_ground, swept = balanced_path(feet, *levers, above[:, [0, 2]], times, settings, tightened, plan.hand)
    held = leaning_share(plan.grips, times)
    if plan.bar is not None and not (keep and before is not None):
        mass_ground = kept_back(mass_ground, held, plan.bar, settings.bar)
    ground = mass_ground - above[:, [0, 2]]
    turned = _yaw_target(plan.turns, times) + _turned_for_hands(plan.presses, times, settings)
    yaw = smooth_path(turned[:, None], np.ones(len(times)), rate, YAW_SMOOTH)[:, 0]
    gait = walking(plan.walks, times)
    sink = np.zeros(len(times)) if gait is None else gait.sink
    bent = _bent(plan.presses, deeper, times, settings)
    crouch = jump_crouch(plan, times, settings.jump)
    quick = haste(plan, times, settings)
    stance = settings.body.stance - settings.body.stream_crouch * quick - crouch
    busy = reaching.sum(axis=1) + held + (0.0 if gait is None else gait.own)
    beat = groove(plan.beats, times, quick, busy)
    sink = sink + settings.layers.bounce * beat
    mass_height = _height(
        feet, airborne(plan.feet), times, ground, yaw, stance, bent, sink, above[:, 1], skeleton, settings
    )
    height = mass_height.at(times) - above[:, 1]
    ahead = gaze_ahead(plan, times)
    chest, head = _looking(yaw, plan.presses, times, ground, rate, settings, ahead)
    loose = (1.0 - held) * (1.0 - reaching.max(axis=1)) * (1.0 if gait is None else 1.0 - gait.own)
    chest = chest + loose * counter_twist(feet, times, ground, mass_ground, yaw, chest, head, skeleton, settings.arms)
    tilt = _tilt(plan.presses, times, reaching, chest, ground, rate, settings, held)
    drop = np.radians(settings.layers.shoulder_drop) * stepping(feet, settings)
    tilt += drop[:, None] * np.column_stack((np.cos(chest), -np.sin(chest)))
    fold = np.radians(settings.jump.fold) * crouch + np.radians(settings.layers.beat_nod) * beat
    tilt += fold[:, None] * np.column_stack((np.sin(chest), np.cos(chest))) + jump_lean(plan, times, settings.jump)
    controller = Controller.of(settings.inertia.chest_frequency, settings.inertia.chest_damping)
    tilt = follow(tilt, rate, controller)
    softened = ((BALANCE,) if swept else ()) + ((HEIGHT,) if mass_height.softened else ())
    heels = np.zeros((len(times), 2))
    return BodyPath(times, mass_ground, mass_height, ground, height, yaw, chest, head, tilt, reaching, heels, softened)


def _levers(height: HeightPath | None, times: Array) -> tuple[Array, Array]:
    """y / (y'' + g) of the centre of mass, seconds squared, twice (n,): of its path, and of that without trembling.

    Standing still as long as its height is not known.
    """
    if height is None:
        still = np.full(len(times), STANDING_HEIGHT / GRAVITY)
        return still, still
    step = 1.0 / 60.0
    y = height.at(times)
    acceleration = (height.at(times + step) - 2 * y + height.at(times - step)) / step**2
    rate = 1.0 / float(times[1] - times[0])
    return _lever(y, acceleration, 0.4), _lever(low_pass(y, rate), low_pass(acceleration, rate), 0.3)


def _lever(y: Array, acceleration: Array, least: float) -> Array:
    return np.asarray(y / np.maximum(acceleration + GRAVITY, least * GRAVITY))


def _yaw_target(turns: tuple[Turn, ...], times: Array) -> Array:
    if not turns:
        return np.zeros_like(times)
    start = np.array([t.start for t in turns])
    end = np.array([t.end for t in turns])
    yaw = np.array([0.0, *(t.yaw for t in turns)])
    i = np.maximum(np.searchsorted(start, times, side="right") - 1, 0)
    s = (times - start[i]) / (end[i] - start[i])
    return np.asarray(yaw[i] + smooth(s) * (yaw[i + 1] - yaw[i]))


def leg_room(
    feet: tuple[FootPath, FootPath], ground: Array, yaw: Array, skeleton: Skeleton, reach: Array | float, side: int
) -> Array:
    """Highest root (n,) from which one leg still reaches its foot when hip and ankle are `reach` apart."""
    name = "lr"[side]
    hip = skeleton.offsets[skeleton.index(f"{name}_hip")]
    sine, cosine = np.sin(yaw), np.cos(yaw)
    hip_x = ground[:, 0] + hip[0] * cosine + hip[2] * sine
    hip_z = ground[:, 1] - hip[0] * sine + hip[2] * cosine
    ankle = ankle_of(feet[side], skeleton, side)
    aside = np.hypot(hip_x - ankle[:, 0], hip_z - ankle[:, 2])
    return np.asarray(ankle[:, 1] + np.sqrt(np.maximum(np.square(reach) - aside**2, 0.05)) - hip[1])


def ankle_of(foot: FootPath, skeleton: Skeleton, side: int) -> Array:
    """World position (f, 3) of the ankle joint of a foot."""
    meta = skeleton.offsets[skeleton.index(f"{'lr'[side]}_metatarsal")]
    up = skeleton.rest[skeleton.index(f"{'lr'[side]}_metatarsal")][1]
    sine, cosine = np.sin(foot.pitch), np.cos(foot.pitch)
    y = -meta[1] * cosine + meta[2] * sine  # the ankle seen from the ball's joint, heel up by pitch
    z = -meta[1] * sine - meta[2] * cosine
    x = -meta[0]
    out = foot.ball.copy()
    out[:, 0] += x * np.cos(foot.yaw) + z * np.sin(foot.yaw)
    out[:, 1] += up + y
    out[:, 2] += -x * np.sin(foot.yaw) + z * np.cos(foot.yaw)
    return out


def _height(
    feet: tuple[FootPath, FootPath], flights: Array, times: Array, ground: Array, yaw: Array, stance: Array,
    bent: Array, sink: Array, above: Array, skeleton: Skeleton, settings: MotionSettings,
) -> HeightPath:  # fmt: skip
    """Height of the centre of mass, as legs are as long as `stance` (n,) says.

    above : (n,) how far it is over the root; sink : (n,) how far a plant lets it sink
    """
    body = settings.body
    wanted = np.full(len(yaw), np.inf)
    highest = np.full(len(yaw), np.inf)
    for side in (0, 1):
        most = leg_room(feet, ground, yaw, skeleton, body.soft_reach, side)
        soft = leg_room(feet, ground, yaw, skeleton, stance, side)
        highest = np.minimum(highest, most)
        wanted = np.minimum(wanted, np.where(feet[side].down, soft, most - 0.004))
    lifted = np.maximum(feet[0].ball[:, 1], feet[1].ball[:, 1])
    wanted = np.minimum(wanted + body.step_rise * np.maximum(lifted, 0.0), highest - 0.002) - sink
    highest = highest - sink
    share, depth = bent[:, 0], bent[:, 1]
    wanted = wanted + share * (settings.hands.pelvis - depth - wanted)
    return height_path(times, wanted + above, highest + above, above, flights, body)


def stepping(feet: tuple[FootPath, FootPath], settings: MotionSettings) -> Array:
    """(n,) 1 while the left foot is in the air at full height, -1 for the right one, 0 when both are equally high."""
    return np.clip((feet[0].ball[:, 1] - feet[1].ball[:, 1]) / settings.step.height_slow, -1.0, 1.0)


def screen_yaw(ground: Array, settings: MotionSettings) -> Array:
    """Yaw (n,) from a place on the ground to the screen."""
    return np.asarray(np.arctan2(-0.5 * ground[:, 0], settings.look.distance - ground[:, 1]))


def _wrapped(angle: Array) -> Array:
    return np.asarray((angle + np.pi) % (2 * np.pi) - np.pi)


def _turned_for_hands(presses: tuple[Press, ...], times: Array, settings: MotionSettings) -> Array:
    """How far (n,) the body turns to the side of a hand that reaches behind it, radians."""
    out = np.zeros(len(times))
    for press in presses:
        if press.turn != 0.0:
            out += press.turn * press_share(press, times, settings.hands.reach_down)
    return out


def _looking(
    yaw: Array, presses: tuple[Press, ...], times: Array, ground: Array, rate: float, settings: MotionSettings,
    ahead: Array,
) -> tuple[Array, Array]:  # fmt: skip
    """Chest and head keep to the screen as far as they can (thesis 5.7); when the body turns past, they whip round.

    ahead (n,) : how much she looks where she walks and not at the screen
    """
    look = settings.look
    ones = np.ones(len(yaw))
    gap = _wrapped(screen_yaw(ground, settings) - yaw)
    torso = np.clip(look.torso_weight * gap, -np.radians(look.torso_limit), np.radians(look.torso_limit))
    torso = torso * smooth((np.pi - np.abs(gap)) / WRUNG)  # a spine is not wrung from one side to the other at once
    torso = torso * (1.0 - ahead)
    for press in (p for p in presses if p.turn != 0.0):  # the chest turns to the hand, not to the screen
        share = press_share(press, times, settings.hands.reach_down)
        torso = torso + share * (np.copysign(np.radians(look.torso_limit), press.turn) - torso)
    controller = Controller.of(settings.inertia.chest_frequency, settings.inertia.chest_damping)
    chest = yaw + follow(smooth_path(torso[:, None], ones, rate, 0.05), rate, controller)[:, 0]
    gap = _wrapped(screen_yaw(ground, settings) - chest)
    head = np.clip(look.head_weight * gap, -np.radians(look.head_limit), np.radians(look.head_limit))
    head = head * (1.0 - settings.walk.ahead * ahead)
    return chest, chest + smooth_path(head[:, None], ones, rate, 0.04)[:, 0]


def _bent(presses: tuple[Press, ...], deeper: Array | None, times: Array, settings: MotionSettings) -> Array:
    """(n, 2): how far the body has gone down to the floor, 0 to 1, and how much deeper than usual, metres."""
    out = np.zeros((len(times), 2))
    for k, press in enumerate(presses):
        share = press_share(press, times, settings.hands.reach_down)
        more = share > out[:, 0]
        out[more, 0] = share[more]
        out[:, 1] = np.maximum(out[:, 1], share * (0.0 if deeper is None else float(deeper[k])))
    return out


def press_share(press: Press, times: Array, down: float) -> Array:
    """How much of a press there is at each time, 0 to 1: all of it from its start to its end."""
    return smooth((times - press.start + down) / down) * smooth((press.end + down - times) / down)


def _reaching(presses: tuple[Press, ...], times: Array, side: int, settings: MotionSettings) -> Array:
    out = np.zeros_like(times)
    for press in presses:
        if press.side == side:
            down = settings.hands.reach_down
            out = np.maximum(out, press_share(press, times, down))
    return out


def _tilt(
    presses: tuple[Press, ...], times: Array, reaching: Array, chest: Array, ground: Array, rate: float,
    settings: MotionSettings, held: Array,
) -> Array:  # fmt: skip
    forward = np.column_stack((np.sin(chest), np.cos(chest)))
    lean = np.radians(settings.body.lean - held * (settings.body.lean + settings.bar.lean_back))
    tilt = lean[:, None] * forward
    for side in (0, 1):
        for press in (p for p in presses if p.side == side):
            down = settings.hands.reach_down
            near = (times > press.start - down) & (times < press.end + down)
            to = np.array(press.target) - ground[near] + 0.15 * forward[near]
            off = _wrapped(np.arctan2(to[:, 0], to[:, 1]) - chest[near])
            most = np.radians(settings.hands.bend_aside)
            way = chest[near] + np.clip(off, -most, most)
            to = np.column_stack((np.sin(way), np.cos(way)))
            s = smooth((times[near] - press.start + down) / down) * smooth((press.end + down - times[near]) / down)
            tilt[near] = tilt[near] + s[:, None] * (np.radians(settings.hands.bend) * to - tilt[near])
    return smooth_path(tilt, np.ones(len(times)), rate, 0.05)
