"""Small movements on top of all others, multiplied in each joint's own space: breath, blinks, a laugh at the end.

Additive layers as in the blog of the project's sources: the main rotation first, then the layer. They touch no joint
between the root and a foot, so no contact moves; while a palm is on the floor they are off.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.ik.full_body import Poses
from dancetutor_cli.motion.layers.glances import Glances
from dancetutor_cli.motion.waits import Waiting
from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.quaternion import UP
from dancetutor_cli.rig.skeleton import EYELID_CLOSING, JAW_LAUGH, Skeleton
from dancetutor_cli.rig.soles import hand_direction, palm_normal

Array = NDArray[np.float64]
ACROSS, FRONT = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
SEED = 20140513


@dataclass(frozen=True, slots=True)
class Doing:
    """What she does at f times, as far as layers go by it.

    stepping : (f,) -1 to 1, the left foot (positive) or the right one is in the air
    free : (f,) 0 where a palm is on the floor or the bar, else 1; lead, last : as in `Plan`
    beat : (f,) as in `Trajectory`; waiting, glances : at the same times
    """

    stepping: Array
    free: Array
    lead: int
    last: float
    beat: Array
    waiting: Waiting
    glances: Glances


def add_layers(poses: Poses, times: Array, doing: Doing, context: Context) -> None:
    """Add all layers to the poses at `times` (f,), seconds, in place."""
    skeleton, settings, rotations = context.skeleton, context.settings.layers, poses.rotations
    groove, beat = context.settings.groove, doing.beat
    stepping, free, lead = doing.stepping, doing.free, doing.lead
    breath = np.sin(2 * np.pi * times / settings.breath_time)
    raised = (np.radians(settings.breath_shoulders) * breath - np.radians(groove.shrug) * beat) * free
    for k, (side, sign) in enumerate((("l", 1.0), ("r", -1.0))):
        shrug = doing.waiting.shrug[:, k] * free
        _shrug(skeleton, rotations, side, sign * (raised + shrug))
    for side, phase, bent in (
        ("lr"[lead], 0.0, 1.0 - settings.wrist_unlike),
        ("rl"[lead], settings.wrist_behind, 1.0 + settings.wrist_unlike),
    ):
        hand = hand_direction(skeleton, side)
        drop = bent + settings.wrist_wave * np.sin(2 * np.pi * (times / settings.wrist_time + phase))
        _turn(
            skeleton,
            rotations,
            f"{side}_radiocarpal",
            np.cross(hand, palm_normal(skeleton, side)),
            (np.radians(settings.wrists) * drop + doing.waiting.flap[:, "lr".index(side)]) * free,
        )
    glance, neck = doing.glances, context.settings.look.neck_share
    bob = np.radians(settings.head_bob) * stepping * free + doing.waiting.tilt + glance.tilt
    _turn(skeleton, rotations, "skullbase", FRONT, -bob)
    nod = np.radians(settings.breath_nod) * breath + np.radians(groove.nod) * beat
    _turn(skeleton, rotations, "vc4", ACROSS, nod)
    for joint, share in (("vc4", neck), ("skullbase", 1.0 - neck)):
        _turn(skeleton, rotations, joint, UP, share * glance.yaw)
        _turn(skeleton, rotations, joint, ACROSS, -share * glance.pitch)
    for side in "lr":
        _turn(skeleton, rotations, f"{side}_eyeball_joint", UP, glance.eyes)
    closed = np.radians(EYELID_CLOSING) * eyelids(times, settings.blink_time, settings.blink)
    for side in "lr":
        _turn(skeleton, rotations, f"{side}_eyelid_joint", ACROSS, closed)
    laugh = smooth(np.clip((times - doing.last - settings.laugh_after) / settings.laugh_rise, 0.0, 1.0))
    _turn(skeleton, rotations, "temporomandibular", ACROSS, np.radians(JAW_LAUGH) * laugh)


def _shrug(skeleton: Skeleton, rotations: Array, side: str, angle: Array) -> None:
    """Raise a shoulder by turning its collarbone; the arm goes up with it and hangs as it did, or hands would swing
    into thighs."""
    _turn(skeleton, rotations, f"{side}_sternoclavicular", FRONT, angle)
    j = skeleton.index(f"{side}_shoulder")
    rotations[:, j] = quat.multiply(quat.from_axis_angle(FRONT, -angle), rotations[:, j])


def _turn(skeleton: Skeleton, rotations: Array, joint: str, axis: Array, angle: Array) -> None:
    if joint in skeleton.names:
        j = skeleton.index(joint)
        rotations[:, j] = quat.multiply(rotations[:, j], quat.from_axis_angle(axis, angle))


def eyelids(times: Array, every: float, blink: float) -> Array:
    """How far the lids are closed (f,), 0 to 1: blinks of `blink` seconds, always at the same times."""
    cell = np.floor(times / every).astype(np.int64)
    out = np.zeros_like(times)
    for c in np.unique(cell):
        start = (c + np.random.default_rng([SEED, int(c) & 0xFFFFFFFF]).uniform(0.1, 0.8)) * every
        s = (times - start) / blink
        near = (s > 0) & (s < 1)
        out[near] = np.where(s < 0.4, smooth(s / 0.4), 1.0 - smooth((s - 0.4) / 0.6))[near]
    return out
