"""Targets of the full-body IK at the times of the output; arms that hang, swing, or go down to a panel."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from dancetutor_cli.dance.context import Context, hold_share
from dancetutor_cli.dance.foot_path import Feet
from dancetutor_cli.dance.gait import walk_pose, with_gait
from dancetutor_cli.dance.ik.full_body import ArmGoal, Targets, arm_rotations
from dancetutor_cli.dance.ik.hands import (
    HandTargets,
    Hips,
    Torso,
    hanging_arms,
    hip_clearance,
    lead_hands_to_bar,
    leg_clearance,
    palm_down,
    trunk_at,
    trunk_clearance,
)
from dancetutor_cli.dance.ik.knees import (
    Hung,
    Legs,
    knee_poles,
    part_knees,
)
from dancetutor_cli.dance.plan import Plan, Press
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import SIDES, half_hips, palm_points
from dancetutor_cli.dance.rig.quaternion import UP, leaning
from dancetutor_cli.dance.rig.skeleton import beyond
from dancetutor_cli.dance.settings import MotionSettings
from dancetutor_cli.dance.settings_arms import ArmSettings
from dancetutor_cli.dance.smoothing import Controller, follow, sample_path, smooth, smooth_path, soft_excess
from dancetutor_cli.dance.trajectory.facing import crossing_share
from dancetutor_cli.dance.trajectory.height import jump_swing, tempo_factor
from dancetutor_cli.dance.trajectory.legs import ankle_of
from dancetutor_cli.dance.trajectory.posture import Trajectory
from dancetutor_cli.dance.trajectory.stance import leisure
from dancetutor_cli.dance.units import Array
from dancetutor_cli.dance.waits import waiting_at

FINGERS = np.radians(np.arange(-165.0, 180.0, 15.0))  # directions of fingers to try, around the preferred one
POLES = np.array([[1.0, 0.0, -0.3], [0.7, -0.25, -0.75], [0.3, -0.5, -1.0], [0.5, 0.5, -0.8]])  # of elbows, left chest
EASE, EASY = 15.0, 40.0  # degrees within its limits at which a joint is at ease; how much turned fingers count
WAVES = 1.3  # about the size of the sum of both waves
DRIFT = np.array([0.6, 0.5, 0.0])  # hands wander less up and down, for their height shows effort, and less aside
ASKEW = np.array([[0.3, -0.6, -0.8], [0.4, 0.6, 0.8]])  # one hand is a little lower and farther back
HELD_BACK = 0.25  # share of a stretch in which a hand is too quick, from which on it is held back all through
ASIDE_SOFT = 0.02  # metres over which a hand comes to its least distance outward in a lean
UP_SOFT = 0.06  # metres over which a hand begins to rise as it swings ahead or is raised aside
BENT_SOFT = 0.006  # metres over which an arm comes to its greatest length
LOWER = 0.6  # part by which a hand that is raised aside rises less at leisure
SWAYS = 1.5, 0.35  # seconds before and after over which she sways, and how far, for hands that swing all the way
EASED = 0.6  # seconds before and after over which arms begin to be at leisure
ELBOWS_IN = 0.62  # part of the way by which elbows turn to the body for another dancer; all of it is too much
GIVEN_WAY = 0.145  # metres that a hand gives way to another dancer with which its elbow turns to the body
SPUN = 0.5  # seconds before and after over which a spin is looked for
ASKEWED = 1.6  # about how far `_wandering` goes up and down


@dataclass(frozen=True, slots=True)
class Obstacles:
    """The targets of the parts of the body that hanging hands must not meet, at f times."""

    torso: Torso
    hips: Hips
    legs: Legs


class FreeHands(NamedTuple):
    """How free hands hang, at the n times of a trajectory.

    hang : (n, 2, 3) metres, where they hang from the shoulders, in the chest's upright axes
    lag : (n, 2, 3) metres, how far inertia takes them from there, in the world
    clear : (n, 2) 0 to 1, how much they must keep clear of the trunk: as far as they are held back, and always if there
    is a bar
    """

    hang: Array
    lag: Array
    clear: Array


def arm_targets(
    plan: Plan, body: Trajectory, at: Array, obstacles: Obstacles, free: FreeHands, context: Context
) -> HandTargets:
    """Return the targets of hands at times `at` (f,). obstacles : at the same times; free : at the body's times"""
    torso = obstacles.torso
    lean, upright = quat.swing_twist(torso.chest, UP)
    hang, lag, held = (sample_path(path, body.times, at) for path in free)
    arms = context.settings.arms
    # in a deep bend the other arm goes some of the way with the chest, its hand to the knees
    first, last = np.radians((arms.bend_from, arms.bend_full))
    bent = smooth((2.0 * np.arccos(np.clip(np.abs(lean[:, 0]), 0.0, 1.0)) - first) / (last - first))
    along = quat.multiply(quat.slerp(np.broadcast_to(quat.IDENTITY, lean.shape), lean, arms.bend_hang * bent), upright)
    hang = hang + bent[:, None, None] * np.array(
        [[arms.bend_out, 0.0, arms.bend_ahead], [-arms.bend_out, 0.0, arms.bend_ahead]]
    )
    wrists = torso.shoulders + quat.rotate(along[:, None], hang) + lag
    clear = context.settings.arms.clear_aside, context.settings.arms.clear_ahead
    wrists += held[..., None] * trunk_clearance(wrists, torso, clear)
    wrists += _out_from_a_lean(wrists, torso, upright, arms)
    wrists += hip_clearance(wrists, obstacles.hips, arms)
    out = np.empty((len(at), 2, 3))
    out[..., 0] = np.array([1.0, -1.0]) * (arms.elbow_out + (arms.bend_elbow_out - arms.elbow_out) * bent)[:, None]
    out[..., 1:] = -arms.elbow_down, -arms.elbow_back
    elbows = quat.rotate(upright[:, None], out)
    wrists += leg_clearance(wrists, torso.shoulders, elbows, obstacles.legs, context.skeleton, arms.legs_room)
    wrists += _bent(wrists - torso.shoulders, arms.longest)
    inward = _on_her_own_pad(wrists[..., 0], context)
    ahead = quat.rotate(upright, np.array([0.0, 0.0, arms.own_pad_ahead]))
    wrists += np.abs(inward)[..., None] * ahead[:, None]
    wrists[..., 0] += _on_her_own_pad(wrists[..., 0], context)
    wrists[..., 1] = np.maximum(wrists[..., 1], arms.lowest)
    elbows[..., 0] += ELBOWS_IN * np.clip(inward / GIVEN_WAY, -1.0, 1.0)
    straight = np.tile(quat.IDENTITY, (len(at), 2, 1))
    hands = HandTargets(wrists, straight, np.zeros((len(at), 2)), np.zeros((len(at), 2)), elbows)
    lead_hands_to_bar(plan.grips, at, hands, torso, context)
    for press in plan.presses:
        _press(press, at, hands, body, context)
    return hands


def _out_from_a_lean(wrists: Array, torso: Torso, upright: Array, arms: ArmSettings) -> Array:
    """Return how wrists (f, 2, 3) give way, (f, 2, 3), to a trunk that leans to the other side: softly, outward from
    the shoulder, which is then over the trunk, as people do for balance.
    """
    across = torso.shoulders[:, 0] - torso.shoulders[:, 1]
    higher = np.degrees(np.arcsin(np.clip(across[:, 1] / np.linalg.norm(across, axis=1), -1.0, 1.0)))
    outward = np.array([1.0, -1.0])
    share = smooth((higher[:, None] * outward - arms.aside_from) / (arms.aside_full - arms.aside_from))
    aside = quat.rotate(upright, quat.LEFT)[:, None] * outward[:, None]
    far = np.sum((wrists - torso.shoulders) * aside, axis=2)
    missing = soft_excess(arms.aside_out - far, ASIDE_SOFT)
    return np.asarray((share * missing)[..., None] * aside)


def _bent(arm: Array, longest: float) -> Array:
    """Return what keeps arms (f, 2, 3), shoulder to wrist, softly shorter than `longest`, so that elbows bend."""
    far = np.linalg.norm(arm, axis=2, keepdims=True)
    over = soft_excess(far - longest, BENT_SOFT)
    return np.asarray(-over / np.maximum(far, 1e-9) * arm)


def _on_her_own_pad(x: Array, context: Context) -> Array:
    """Return how wrists at x (f, 2) give way, (f, 2), to another dancer, softly: they stay within her pad's edge."""
    if context.sides is None:
        return np.zeros_like(x)
    outward, keep = 1.0 - 2.0 * context.sides[0], context.settings.arms.own_pad
    edge = context.ground.low[0] if outward > 0.0 else context.ground.high[0]
    inside = outward * (x - edge) - keep
    return np.asarray(outward * soft_excess(-inside, ASIDE_SOFT))


def free_hands(plan: Plan, body: Trajectory, context: Context) -> FreeHands:
    """Return how hands hang that have nothing to do, at the body's times: with the legs, the music and inertia."""
    settings, skeleton, arms = context.settings, context.skeleton, context.settings.arms
    rate = 1.0 / float(body.times[1] - body.times[0])
    effort = moving_mean(tempo_factor(plan, body.times, settings), rate, arms.effort)[:, None]
    wander, askew = _wandering(body.times + context.phase, arms), ASKEW
    if plan.lead == 1:  # a song in which the right foot leads has left and right hand exchanged
        wander, askew = (ways[..., ::-1, :] * [-1.0, 1.0, 1.0] for ways in (wander, askew))
    # the two hands are never equally high and never swing equally far
    unlike = 1.0 + arms.unlike * (wander + askew)[..., 1] / ASKEWED
    groove = settings.groove
    easy = leisure(plan, body.times, replace(groove, leisure_from=groove.hands_from, leisure_full=groove.hands_full))
    waiting = waiting_at(plan, body.times, context)
    swaying = np.minimum(moving_mean(np.abs(body.sway), rate, SWAYS[0]) / SWAYS[1] + waiting.share, 1.0)
    easy = moving_mean(easy * swaying, rate, EASED)[:, None]
    sway = (groove.hands + easy * (groove.hands_easy - groove.hands)) * body.sway[:, None]
    pump = arms.stream_pump * effort * body.arms[:, 2:3]  # in streams arms pump in turn
    swing = unlike * _swing(plan, body, settings) + (sway + pump) * [-1.0, 1.0]  # with the shoulder that turns forward
    swing += (arms.wander + arms.stream_wander * effort) * wander[..., 2] + arms.askew * askew[..., 2]
    swing += waiting.swing
    # forearms are up in one phrase of the music, and hang in another, less far where hands swing
    carried = body.arms[:, 4:] * (1.0 + easy * (arms.carried_easy - 1.0))
    out = np.array([1.0, -1.0]) * (arms.out + arms.stream_out * effort + arms.carried_out * _upward(carried))
    eased = (effort, unlike, easy, body.arms[:, 3:4]), (swing, out)
    hang = hanging_arms(carried, *eased, context)
    way = hang - hanging_arms(np.zeros_like(carried), *eased, context)
    raised = _upward(np.outer(body.arms[:, 1], (1.0, -1.0)))
    hang[..., 0] += raised * [1.0, -1.0]
    hang[..., 1] += 0.5 * (1.0 - LOWER * easy) * raised
    jump = (jump_swing(plan, body.times, settings.jump) * (1.0 - body.reaching.max(axis=1)))[:, None]
    hang[..., 1] += 0.5 * arms.jump_up * (jump + jump**2)
    hang[..., 2] += arms.jump * jump
    hang += ((arms.wander + arms.stream_wander * effort)[..., None] * wander + arms.askew * askew) * DRIFT
    hang += waiting.hands
    share = crossing_share(plan.grips, body.times, settings.across)
    for side, sign in ((0, 1.0), (1, -1.0)):  # the near hand is behind her, out of the other one's way
        behind = np.array([sign * settings.across.free_out, -arms.down, -settings.across.free_back])
        hang[:, side] += np.maximum(sign * share, 0.0)[:, None] * (behind - hang[:, side])
    free = 1.0 - hold_share(plan.grips, body.times, settings.bar.reach_time)
    hang += free[..., None] * (_behind_the_chest((hang, way), body.chest_yaw, rate, arms) - hang)
    chest = leaning(body.tilt, body.chest_yaw)
    upright = quat.from_axis_angle(UP, body.chest_yaw)
    pelvis = np.column_stack((body.ground[:, 0], body.height, body.ground[:, 1]))
    controller = Controller.of(settings.inertia.hand_frequency, settings.inertia.hand_damping)
    lag, held = np.empty_like(hang), np.empty(hang.shape[:2])
    for side, name in enumerate(SIDES):
        arm = skeleton.rest[skeleton.index(f"{name}_shoulder")] - skeleton.offsets[0]
        target = pelvis + quat.rotate(chest, arm) + quat.rotate(upright, hang[:, side])
        late = _at_most(follow(target, rate, controller) - target, arms.lag)
        back, held[:, side] = _speed_limit_offset(target + late, rate, arms)
        lag[:, side] = late + back
    if context.bar is not None:  # behind her back, a hand has the trunk in its way
        held[:] = 1.0
    return FreeHands(hang, lag, held)


def _upward(x: Array) -> Array:
    """Return max(x, 0), rounded off over about `UP_SOFT` metres around 0, and 0 at 0."""
    return np.asarray((x + np.sqrt(x**2 + UP_SOFT**2) - UP_SOFT) / 2.0)


def _at_most(way: Array, most: float) -> Array:
    """Return ways (n, 3) that are softly kept shorter than `most`."""
    far = np.linalg.norm(way, axis=1, keepdims=True)
    return np.asarray(way * (most * np.tanh(far / most) / np.maximum(far, 1e-9)))


def _speed_limit_offset(path: Array, rate: float, arms: ArmSettings) -> tuple[Array, Array]:
    """Return how a hand leaves its path (n, 3) in the world, (n, 3): where it is too quick it takes a shorter way. And
    how much (n,) it is held back, 0 to 1.
    """
    ones = np.ones(len(path))
    quick = np.linalg.norm(np.gradient(path, axis=0), axis=1) * rate
    if quick.max() <= arms.quick:
        return np.zeros_like(path), np.zeros(len(path))
    held = moving_mean(smooth((quick - arms.quick) / arms.quicker), rate, 2.0 * arms.hold_back)
    share = smooth(held / HELD_BACK)[:, None]
    return _at_most(share * (smooth_path(path, ones, rate, arms.hold_back) - path), arms.held_back), share[:, 0]


def moving_mean(tempo: Array, rate: float, around: float) -> Array:
    """Return the mean (n,) of the tempo from `around` seconds before to `around` seconds after: the effort."""
    width = max(1, round(around * rate))
    summed = np.cumsum(np.concatenate((np.repeat(tempo[:1], width), tempo, np.repeat(tempo[-1:], width))))
    return np.asarray((summed[2 * width :] - summed[: -2 * width]) / (2 * width))


def _behind_the_chest(hands: tuple[Array, Array], yaw: Array, rate: float, arms: ArmSettings) -> Array:
    """Return hands (n, 2, 3) in quick turns of the chest, yaw (n,) radians: nearer to the body, and later than the
    chest.

    hands : where they hang, and the part of it by which they are carried, which a quick turn takes away
    """
    (hang, way), ones, most = hands, np.ones(len(yaw)), np.radians(arms.turn_late)
    late = smooth_path(yaw[:, None], ones, rate, arms.turn_time)[:, 0] - yaw
    late = most * np.tanh(late / most)
    quick = np.abs(np.gradient(yaw)) * rate
    drawn = smooth((quick - np.radians(arms.turn_easy)) / np.radians(arms.turn_quick))[:, None]
    drawn = smooth_path(drawn, ones, rate, arms.turn_time)
    spin = np.abs(moving_mean(np.gradient(yaw) * rate, rate, SPUN))  # on and on, not to and fro
    spinning = smooth((spin - np.radians(arms.spin_easy)) / np.radians(arms.spin_quick))[:, None]
    near = hang - np.maximum(0.7 * drawn, spinning)[..., None] * way
    near[..., 0] -= arms.drawn_in * drawn * np.array([1.0, -1.0])
    near[..., 2] *= 1.0 - arms.drawn_back * drawn
    return quat.rotate(quat.from_axis_angle(UP, late)[:, None], near)


def _wandering(times: Array, arms: ArmSettings) -> Array:
    """Return slow waves (n, 2, 3) for both hands, about 1 in amplitude; people do not move both arms alike."""
    hands = np.arange(6).reshape(2, 3)
    waves = ((arms.wander_slow, arms.wander_behind), (arms.wander_quick, arms.wander_quick_behind))
    slow, fast = (np.sin(2 * np.pi * (times[:, None, None] / every + share * hands)) for every, share in waves)
    return np.asarray((slow + arms.wander_share * fast) / WAVES)


def _swing(plan: Plan, body: Trajectory, settings: MotionSettings) -> Array:
    """Return how far forward each hand (n, 2) is at the body's times: for the legs' momentum, or as in a walk."""
    both = np.outer(body.arms[:, 0], (-1.0, 1.0))
    gait = walk_pose(plan.walks, body.times, settings.walk)
    return both if gait is None else np.asarray((1.0 - gait.own[:, None]) * both + gait.hands)


def _press(press: Press, at: Array, hands: HandTargets, body: Trajectory, context: Context) -> None:
    """Lead a hand down to its panel and up again, at times `at` (f,)."""
    numbers, side, wrists = context.settings.hands, press.side, hands.wrists
    down = numbers.reach_down
    near = np.flatnonzero((at > press.start - press.lead) & (at < press.end + down))
    if not len(near):
        return
    t = at[near]
    hand, pole = _lay_down(press, body, context)
    wrist = np.array([press.target[0], 0.0, press.target[1]]) - quat.rotate(
        hand, palm_points(context.skeleton)[side].offset
    )
    going = np.clip((t - press.start + press.lead) / press.lead, 0.0, 1.0)
    leaving = np.clip((t - press.end) / down, 0.0, 1.0)
    across = smooth(going) * (1.0 - smooth(leaving))
    # straight down at a definite speed, so that the touch has a time; up again softly
    sink = (1.0 - np.cos(np.pi / 2 * going)) * np.where(leaving > 0, 1.0 - smooth(leaving), 1.0)
    free = wrists[near, side]
    goal = free + across[:, None] * (wrist - free)
    ahead = np.maximum(press.start - t, 0.0)
    slap = numbers.slap * ahead * np.exp(-((ahead / numbers.slap_time) ** 2))
    goal[:, 1] = wrist[1] + (1.0 - sink) * np.maximum(free[:, 1] - wrist[1], 0.0) + slap
    wrists[near, side] = goal
    hands.rotation[near, side] = hand
    pin = smooth(1.0 + (t - press.start) / numbers.follow_in) * (1.0 - smooth((t - press.end) / numbers.follow_out))
    for pins in (hands.pinned, hands.pull):
        pins[near, side] = np.maximum(pins[near, side], pin)
    hands.elbows[near, side] += across[:, None] * (pole - hands.elbows[near, side])


def _lay_down(press: Press, body: Trajectory, context: Context) -> tuple[Array, Array]:
    """Return how a palm lies on its panel: the hand's rotation (4,) and where its elbow points (3,).

    Of many directions, the one that is easiest for shoulder and wrist as the body is at the note and as the palm
    leaves; and among these the one whose fingers point most from the body to the panel.
    """
    when, side, skeleton = (
        np.array([press.start, min(press.end, press.start + context.settings.hands.held)]),
        press.side,
        context.skeleton,
    )
    trunk = trunk_at(body, when, context)
    chest, chest_yaw, shoulders = trunk.chest, trunk.chest_yaw, trunk.shoulders(skeleton)
    panel = np.array([press.target[0], 0.0, press.target[1]])
    away = panel - shoulders[0].mean(axis=0)
    liked = np.arctan2(away[0] + 0.3 * np.sin(chest_yaw[0]), away[2] + 0.3 * np.cos(chest_yaw[0]))
    out = (1.0, -1.0)[side]
    poles = quat.rotate(chest[0], POLES * [out, 1.0, 1.0])
    aside = np.repeat(out * FINGERS, len(poles))
    poles = np.tile(poles, (len(FINGERS), 1))
    down = palm_down(skeleton, side, np.array([0.0, 0.0, 1.0]))
    laid = quat.multiply(quat.from_axis_angle(UP, liked + aside), down)
    wrists = panel - quat.rotate(laid, palm_points(skeleton)[side].offset)
    strain = np.zeros(len(wrists))
    for shoulder, turned in zip(shoulders[:, side], chest, strict=True):
        # the body is pulled until the arm reaches
        goal = ArmGoal(np.tile(shoulder, (len(wrists), 1)), np.tile(turned, (len(wrists), 1)), wrists, laid, poles)
        joints = arm_rotations(skeleton, side, goal)
        past = (
            beyond(skeleton, f"{SIDES[side]}_{name}", joints[k]) for name, k in (("shoulder", 0), ("radiocarpal", 2))
        )
        strain = np.maximum(strain, sum(np.maximum(degrees + EASE, 0.0) ** 2 for degrees in past))
    best = int(np.argmin(EASY * aside**2 + strain))
    return laid[best], poles[best]


TOES_BEND = np.radians(40.0)  # a foot whose heel is farther up carries its toes


def ik_targets(
    plan: Plan, body: Trajectory, feet: Feet, at: Array, context: Context, free: FreeHands | None = None
) -> Targets:
    """Return targets at the times `at` (f,); `feet` are sampled there, `body` on its own even times.

    free : `free_hands` of the body, from a caller who needs targets at several times; None: computed here
    """
    skeleton = context.skeleton
    trunk = trunk_at(body, at, context)
    gait = walk_pose(plan.walks, at, context.settings.walk)
    if gait is not None:
        pelvis_rotation, chest = with_gait(gait, trunk.pelvis_rotation, trunk.chest)
        trunk = trunk._replace(pelvis_rotation=pelvis_rotation, chest=chest)
    pelvis, shoulders = trunk.pelvis, trunk.shoulders(skeleton)
    ankles = np.stack([ankle_of(f, skeleton, side) for side, f in enumerate(feet)], axis=1)
    straight = [quat.from_axis_angle(UP, f.yaw) for f in feet]
    soles = [quat.multiply(t, quat.from_axis_angle(quat.LEFT, f.pitch)) for t, f in zip(straight, feet, strict=True)]
    # toes stay level while the heel is up, as far as they bend, and go up with the foot
    toes = [
        quat.multiply(t, quat.from_axis_angle(quat.LEFT, f.pitch - np.clip(f.pitch, 0.0, TOES_BEND)))
        for t, f in zip(straight, feet, strict=True)
    ]
    poles = knee_poles(trunk.yaw, feet, ankles - pelvis[:, None], half_hips(skeleton), context.settings.knees)
    hung = Hung(pelvis, trunk.pelvis_rotation, ankles)
    poles = hung.legs(skeleton, poles).turned(sample_path(body.knees, body.times, at))
    poles = part_knees(skeleton, hung, poles, context.settings.knees)
    obstacles = Obstacles(
        Torso(shoulders, trunk.chest), Hips(pelvis, trunk.pelvis_rotation), hung.legs(skeleton, poles)
    )
    hands = arm_targets(plan, body, at, obstacles, free or free_hands(plan, body, context), context)
    return Targets(
        pelvis, trunk.pelvis_rotation, trunk.chest, shoulders, hands.wrists, hands.rotation, hands.pinned, hands.elbows,
        ankles, np.stack(soles, axis=1), np.stack(toes, axis=1), poles, hands.pull,
    )  # fmt: skip


def translated(targets: Targets, by: Array) -> Targets:
    """Return the same targets with the body moved by (f, 3) metres; feet and pinned palms stay."""
    shoulders = targets.shoulders + by[:, None]
    wrists = targets.wrists + by[:, None] * (1.0 - targets.pinned[..., None])
    return replace(targets, pelvis=targets.pelvis + by, shoulders=shoulders, wrists=wrists)
