"""The dancer's motion on another character: the same world rotations, with feet and pressing hands at the same places.

A fitted character (`characters.fit_character`) rests as the dancer does with identity rotations, so a world rotation
delta is the world rotation itself. Legs are then solved in closed form with the character's own lengths, so that its
soles stand where hers do.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import local_rotations, world_transforms
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.smoothing import upper_envelope
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.limbs import Limb

STRETCH = 0.995  # of the leg's length: the knee never locks
SINK = 0.3  # seconds over which a character with short legs sinks into a wide stance
HAND_BLEND = 0.25  # seconds over which a hand leaves its own way for the panel
_LEG, _ARM = ("hip", "knee", "talocrural"), ("shoulder", "elbow", "radiocarpal")


class _LimbGoal(NamedTuple):
    """The target of a limb's end. side : "l" or "r"; chain : 3 joints; target : (f, 3); weight : (f,), 0 to 1"""

    side: str
    chain: tuple[str, str, str]
    target: Array
    weight: Array


def onto(motion: Motion, own: Skeleton) -> Motion:
    """Return the motion for a skeleton with the dancer's rest pose; the same motion if it is the dancer's skeleton.

    Joints without a counterpart keep their rest rotation. Times and contacts stay.
    """
    if own.names == motion.skeleton.names and np.allclose(own.offsets, motion.skeleton.offsets, atol=1e-9):
        return motion
    positions, world = world_transforms(motion.skeleton, motion.rotations, motion.root)
    source = {name: (positions[:, j], world[:, j]) for j, name in enumerate(motion.skeleton.names)}
    turned = _world_rotations(own, source, len(motion.times))
    always = np.ones(len(motion.times))
    limbs = [_LimbGoal(side, _LEG, _ankle_target(motion.skeleton, own, source, side), always) for side in "lr"]
    for number, side in enumerate("lr"):
        weight = _hand_weight(motion, Limb.LEFT_HAND + number)
        if weight.any():
            limbs.append(_LimbGoal(side, _ARM, source[f"{side}_radiocarpal"][0], weight))
    root = _root(motion, own, turned, limbs)
    for limb in limbs:
        turned = _limb(own, turned, root, limb, source)
    return replace(motion, skeleton=own, rotations=quat.continuous(local_rotations(own, turned)), root=root)


def _world_rotations(own: Skeleton, source: dict[str, tuple[Array, Array]], frames: int) -> Array:
    """Return the world rotation (f, j, 4) of every joint: that of its counterpart, or of its parent."""
    out = np.empty((frames, len(own.names), 4))
    for j, (name, parent) in enumerate(zip(own.names, own.parents.tolist(), strict=True)):
        out[:, j] = source[name][1] if name in source else out[:, parent]
    return out


def _ankle_target(dancer: Skeleton, own: Skeleton, source: dict[str, tuple[Array, Array]], side: str) -> Array:
    """Return the places of the character's ankle that put its sole where the dancer's is.

    The ground under the ball of the foot is the point that both share: heels and toes turn about it.
    """
    place, turn = source[f"{side}_talocrural"]
    point = _under_ball(dancer, side)
    return np.asarray(place + quat.rotate(turn, point) - quat.rotate(turn, _under_ball(own, side)))


def _under_ball(skeleton: Skeleton, side: str) -> Array:
    """Return the vector from ankle to ground under the ball of the foot, in the rest pose with soles on y = 0."""
    ankle = skeleton.rest[skeleton.index(f"{side}_talocrural")]
    ahead = 1.3 * ankle[1]  # where there is no toe joint
    if f"{side}_metatarsal" in skeleton.names:
        ahead = skeleton.rest[skeleton.index(f"{side}_metatarsal")][2] - ankle[2]
    return np.array([0.0, -ankle[1], ahead])


def _root(motion: Motion, own: Skeleton, turned: Array, limbs: list[_LimbGoal]) -> Array:
    """Return root positions (f, 3): height and sway between the feet in proportion to the legs, within their reach.

    The character sinks for a wide stance, early and smoothly; only what is left is a pull towards the target.
    """
    share = min(1.0, own.rest[0, 1] / motion.skeleton.rest[0, 1])
    middle = np.mean([limb.target for limb in limbs if limb.chain is _LEG], axis=0)
    root: Array = middle + (motion.root - middle) * share
    root[:, 1] = motion.root[:, 1] * own.rest[0, 1] / motion.skeleton.rest[0, 1]
    places, _ = world_transforms(own, local_rotations(own, turned), np.zeros_like(root))
    starts = [places[:, own.index(f"{limb.side}_{limb.chain[0]}")] for limb in limbs]
    reach = [STRETCH * sum(_lengths(own, limb.side, limb.chain)) for limb in limbs]
    sink = np.zeros(len(root))
    for start, length, limb in zip(starts, reach, limbs, strict=True):
        if limb.chain is _LEG:
            way = root + start - limb.target
            aside = np.minimum(np.hypot(way[:, 0], way[:, 2]), 0.85 * length)
            sink = np.maximum(sink, way[:, 1] - np.sqrt(length**2 - aside**2))
    root[:, 1] -= upper_envelope(motion.times, sink, SINK)
    for _ in range(16):
        for start, length, limb in zip(starts, reach, limbs, strict=True):
            way = root + start - limb.target
            distance = np.linalg.norm(way, axis=1)
            over = limb.weight * np.maximum(distance - length, 0.0)
            root = root - way * (over / np.maximum(distance, 1e-9))[:, None]
    return root


def _lengths(skeleton: Skeleton, side: str, chain: tuple[str, str, str]) -> tuple[float, float]:
    a, b, c = (skeleton.rest[skeleton.index(f"{side}_{name}")] for name in chain)
    return float(np.linalg.norm(b - a)), float(np.linalg.norm(c - b))


def _limb(own: Skeleton, turned: Array, root: Array, limb: _LimbGoal, source: dict[str, tuple[Array, Array]]) -> Array:
    """Return world rotations with one limb solved: its end at `target` where weight (f,) is 1, bent as the dancer's.

    The cosine law gives the bend; the twist of both bones stays the dancer's. The last joint keeps its world rotation.
    """
    side, chain, target, weight = limb
    upper, lower, last = (own.index(f"{side}_{name}") for name in chain)
    positions, _ = world_transforms(own, local_rotations(own, turned), root)
    start, end = positions[:, upper], positions[:, last]
    goal = end + (target - end) * weight[:, None]
    first, second = _lengths(own, side, chain)
    way = goal - start
    distance = np.linalg.norm(way, axis=1, keepdims=True)
    axis = way / np.maximum(distance, 1e-9)
    span = np.clip(distance, abs(first - second) * 1.001 + 1e-6, (first + second) * 0.9999)
    along = (first**2 - second**2 + span**2) / (2 * span)
    aside = np.sqrt(np.maximum(first**2 - along**2, 0.0))
    bend = source[f"{side}_{chain[1]}"][0] - (source[f"{side}_{chain[0]}"][0] + source[f"{side}_{chain[2]}"][0]) / 2
    forward = quat.rotate(turned[:, upper], np.array([0.0, 0.0, 1.0 if chain is _LEG else -1.0]))
    bend = bend + 0.02 * forward  # a straight limb shows no bend: knees to the front, elbows to the back
    bend = bend - np.sum(bend * axis, axis=1, keepdims=True) * axis
    bend /= np.maximum(np.linalg.norm(bend, axis=1, keepdims=True), 1e-9)
    middle = start + along * axis + aside * bend
    tip = start + axis * span
    out = turned.copy()
    for joint, tip_joint, line in ((upper, lower, middle - start), (lower, last, tip - middle)):
        current = quat.rotate(out[:, joint], own.rest[tip_joint] - own.rest[joint])
        out[:, joint] = quat.multiply(quat.between(current, line), out[:, joint])
    return _carry(own, turned, out, (upper, lower))


def _carry(own: Skeleton, before: Array, after: Array, moved: tuple[int, int]) -> Array:
    """Turn joints of the limb that have no counterpart (twist bones, between the named ones) with their parent."""
    named = {"hip", "knee", "talocrural", "metatarsal", "shoulder", "elbow", "radiocarpal"}
    dirty = set(moved)
    for j, parent in enumerate(own.parents.tolist()):
        if parent in dirty and j not in moved and own.names[j][2:] not in named:
            local = quat.multiply(quat.conjugate(before[:, parent]), before[:, j])
            after[:, j] = quat.multiply(after[:, parent], local)
            dirty.add(j)
    return after


def _hand_weight(motion: Motion, limb: int) -> Array:
    """Return weights (f,): 1 while the hand presses a panel or holds the bar, eased over `HAND_BLEND`."""
    out = np.zeros(len(motion.times))
    spans = [(c.start, c.end) for c in motion.contacts if c.limb == limb]
    spans += [(g.start, g.end) for g in motion.grips if g.side == limb - Limb.LEFT_HAND]
    for start, end in spans:
        early = np.clip(1 - (start - motion.times) / HAND_BLEND, 0, 1)
        late = np.clip(1 - (motion.times - end) / HAND_BLEND, 0, 1)
        t = np.minimum(early, late)
        out = np.maximum(out, t * t * (3 - 2 * t))
    return out
