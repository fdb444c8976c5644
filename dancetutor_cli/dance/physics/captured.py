"""A captured motion of any humanoid on a body with the rig's joints: world rotations, with the body's own proportions.

Trunk, head, hands and feet turn in the world as the captured parts turn from their rest pose. Limbs take the directions
of the captured bones. Knees and elbows become pure hinges; the rest of a forearm's turn goes to the wrist. Legs end, in
closed form, where the captured feet stood, with all lengths in proportion to the legs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.physics.plants import lowest
from dancetutor_cli.dance.physics.repin import AnkleTracks, repinned
from dancetutor_cli.dance.physics.standing import (
    TRUNK,
    JointPaths,
    first_frame,
    segment_angles,
    standing_frames,
    standing_pose,
)
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import local_rotations, world_transforms
from dancetutor_cli.dance.rig.limbs import ARM, LEG, Chain, hinge_axis
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.smoothing import smooth
from dancetutor_cli.dance.units import Array, Poses
from dancetutor_cli.feet.play import runs
from dancetutor_cli.run.errors import FileError

# sines of a limb's bend: above the first, the bend shows the plane of the limb; below the second, it does not
BENT, STRAIGHT = 0.30, 0.09
CLEAR = 0.7  # cosine between both axes; above it, the bend alone gives the plane
UNEVEN = 0.12  # metres; a floor with larger differences has steps, and is not changed
_EXTENT = (("skullbase", "l_talocrural"), ("l_hip", "l_knee"), ("r_hip", "r_knee"))
OFF = 12.0  # degrees between the segments of a capture and of the result, on average, that are a fault
_LIMBS = (ARM, LEG)


@dataclass(frozen=True, slots=True)
class CapturedMotion:
    """The motion of a file, in the world of the file. f frames, j joints, parents before children.

    rest, rest_turns : (j, 3) and (j, 4) in the rest pose; times : (f,) seconds; places, turns : (f, j, 3), (f, j, 4)
    notes : parts of the file that are left out, for the user
    """

    path: Path
    names: tuple[str, ...]
    parents: NDArray[np.int32]
    rest: Array
    rest_turns: Array
    fps: float
    times: Array
    places: Array
    turns: Array
    notes: tuple[str, ...] = ()


def on_body(captured: CapturedMotion, joints: Mapping[str, int], body: Skeleton) -> Motion:
    """Transfer the captured motion to a body.

    Parameters
    ----------
    joints : for each joint of the rig that the file has, its index in the file; body : joints named as the rig's,
    standing on y = 0

    Returns
    -------
    Motion of `body`, with its lowest standing feet on y = 0, turned to face +Z

    Raises
    ------
    FileError if the file's joints lie in one point, if the up direction is unknown, or if the poses cannot be
    transferred.
    """
    captured = _without_reference(captured, joints)
    given = _Upright(captured, joints, body)
    frames = len(captured.times)
    world = np.empty((frames, len(body.names), 4))
    for joint, (name, parent) in enumerate(zip(body.names, body.parents.tolist(), strict=True)):
        if name in joints:
            world[:, joint] = given.delta(name)
        else:
            world[:, joint] = world[:, parent] if parent >= 0 else [1.0, 0.0, 0.0, 0.0]
    world[:, 0] = _level(world[:, 0], given)
    _spread(body, joints, world)
    for side in "lr":
        for chain in _LIMBS:
            _limb(body, given, side, chain, world)
    feet = _feet(body, given, world)
    rotations = local_rotations(body, world)
    hips = [quat.rotate(world[:, 0], body.offsets[body.index(f"{s}_hip")]) for s in "lr"]
    middle = (given.place("l_hip") + given.place("r_hip")) / 2 + feet.lift[:, None] * quat.UP
    root = middle - (hips[0] + hips[1]) / 2
    rotations, root = repinned(body, Poses(rotations, root), feet.feet)
    start = captured.times - captured.times[0]
    _check(given, body, Poses(rotations, root))
    return Motion(body, captured.fps, start, quat.continuous(rotations), root, (), notes=captured.notes)


def upright(captured: CapturedMotion, joints: Mapping[str, int], body: Skeleton) -> Array:
    """Return the captured skeleton itself, at the keys of the result of `on_body`.

    Parameters
    ----------
    joints, body : as for `on_body`

    Returns
    -------
    places (f, j, 3) of all of the file's joints, over y, looking to +Z, in metres in proportion to the body's legs

    Raises
    ------
    FileError as `on_body`.
    """
    captured = _without_reference(captured, joints)
    given = _Upright(captured, joints, body)
    return given.scale * quat.rotate(given.turn, captured.places)


def _check(given: _Upright, body: Skeleton, poses: Poses) -> None:
    """Raise FileError if the segments of the body do not point in the directions of the captured ones."""
    places, _ = world_transforms(body, *poses)
    paths = _paths(given.captured, given.joints)
    upright = replace(paths, places={name: given.place(name) for name in given.joints})
    angles = segment_angles(upright, {name: places[:, body.index(name)] for name in given.joints})
    mean, worst = float(np.mean(list(angles.values()))), max(angles, key=lambda name: angles[name])
    if not mean <= OFF:
        raise FileError(
            given.captured.path,
            f"its poses cannot be transferred: segments are {mean:.0f} degrees off on average, "
            f"{worst} {angles[worst]:.0f}; are its left and right, and its joints' names, right?",
        )


def _without_reference(captured: CapturedMotion, joints: Mapping[str, int]) -> CapturedMotion:
    """Return the motion without the rest pose that some converters put first, and from which all joints would jump."""
    first = first_frame(_paths(captured, joints))
    if not first or len(captured.times) - first < 2:
        return captured
    rest = slice(first, None)
    return replace(captured, times=captured.times[rest], places=captured.places[rest], turns=captured.turns[rest])


def _paths(captured: CapturedMotion, joints: Mapping[str, int]) -> JointPaths:
    """Return the paths of the rig's joints in the file."""
    return JointPaths(
        captured.path,
        captured.fps,
        {name: captured.places[:, k] for name, k in joints.items()},
        {name: captured.turns[:, k] for name, k in joints.items()},
        {name: captured.rest[k] for name, k in joints.items()},
        {name: captured.rest_turns[k] for name, k in joints.items()},
    )


class _Upright:
    """The captured motion turned to face +Z over y, in the lengths of the body's legs.

    theirs : metres between the captured hips; wider : by which each of the body's hips is farther from the middle
    """

    def __init__(self, captured: CapturedMotion, joints: Mapping[str, int], body: Skeleton) -> None:
        self.captured, self.joints = captured, joints
        if any(float(np.ptp(captured.places[:, [joints[a], joints[b]]], axis=1).max()) < 1e-6 for a, b in _EXTENT):
            raise FileError(captured.path, "its joints are all at one point; export it with the lengths of its bones")
        pose = standing_pose(_paths(captured, joints), body)
        self.turn, self.rest, self.turns = pose.turn, pose.places, pose.turns
        self.scale = _leg({n: body.rest[body.index(n)] for n in joints}) / _leg(self.rest)
        hips = [body.rest[body.index(f"{s}_hip")] for s in "lr"]
        self.theirs = self.scale * float(np.linalg.norm(self.rest["l_hip"] - self.rest["r_hip"]))
        self.wider = (float(np.linalg.norm(hips[0] - hips[1])) - self.theirs) / 2

    def place(self, name: str) -> Array:
        """Return the world path (f, 3) of a joint, metres of the body."""
        return self.scale * quat.rotate(self.turn, self.captured.places[:, self.joints[name]])

    def delta(self, name: str) -> Array:
        """Return the world turn (f, 4) of a joint from the standing pose of the captured person."""
        turned = quat.multiply(self.turn, self.captured.turns[:, self.joints[name]])
        return quat.multiply(turned, quat.conjugate(self.turns[name]))

    def bone(self, name: str, tip: str) -> Array:
        """Return the bone (3,) in the standing pose of the captured person."""
        return np.asarray(self.rest[tip] - self.rest[name])


def _leg(places: Mapping[str, Array]) -> float:
    """Return the mean length of both legs."""
    bones = [(f"{s}_{a}", f"{s}_{b}") for s in "lr" for a, b in (("hip", "knee"), ("knee", "talocrural"))]
    return sum(float(np.linalg.norm(places[a] - places[b])) for a, b in bones) / 2


def _level(pelvis: Array, given: _Upright) -> Array:
    """Return turns (f, 4) of a pelvis wider than the captured one: it leans aside less, so its hips rise no more."""
    if given.wider <= 0.0:
        return pelvis
    line = quat.rotate(pelvis, quat.LEFT)
    level = line * [1.0, given.theirs / (given.theirs + 2 * given.wider), 1.0]
    return quat.multiply(quat.between(line, level), pelvis)


def _spread(body: Skeleton, joints: Mapping[str, int], world: Array) -> None:
    """Turn joints of trunk and neck that the file lacks by their share between the neighbours that it has."""
    known = [k for k, name in enumerate(TRUNK) if name in joints]
    for before, after in pairwise(known):
        for k in range(before + 1, after):
            share = np.full(len(world), (k - before) / (after - before))
            low, high = (world[:, body.index(TRUNK[e])] for e in (before, after))
            world[:, body.index(TRUNK[k])] = quat.slerp(low, high, share)
    for side in "lr":
        if f"{side}_sternoclavicular" not in joints:
            world[:, body.index(f"{side}_sternoclavicular")] = world[:, body.index("vt4")]


def _limb(body: Skeleton, given: _Upright, side: str, chain: Chain, world: Array) -> None:
    """Write turns of an arm or leg into `world`: bones in the directions of the captured ones, the middle joint a
    hinge.
    """
    upper, middle, end = (f"{side}_{name}" for name in chain)
    first, second = body.offsets[body.index(middle)], body.offsets[body.index(end)]
    hinge = hinge_axis(chain[1], second)
    u, v = (given.place(b) - given.place(a) for a, b in ((upper, middle), (middle, end)))
    u, v = (x / np.maximum(np.linalg.norm(x, axis=1, keepdims=True), 1e-9) for x in (u, v))
    base = quat.multiply(given.delta(upper), quat.between(first, given.bone(upper, middle)))
    axis, bend = _plane(u, v, quat.rotate(base, hinge))
    world[:, body.index(upper)] = _frame(first, hinge, u, axis)
    along = first / np.linalg.norm(first)
    bent = float(np.arctan2(np.cross(along, second) @ hinge, second @ along))
    turned = quat.multiply(world[:, body.index(upper)], quat.from_axis_angle(hinge, bend - bent))
    turned = quat.multiply(quat.between(quat.rotate(turned, second), v), turned)  # where the plane is in doubt
    world[:, body.index(middle)] = turned
    if chain[1] == "elbow":
        hand = quat.between(second, given.bone(middle, end))
        world[:, body.index(end)] = quat.multiply(given.delta(end), hand)


def _plane(u: Array, v: Array, axis: Array) -> tuple[Array, Array]:
    """Return the hinge's axis (f, 3) in the world, and the bend (f,) about it, of two bones along u and v.

    axis : (f, 3) of the captured upper bone. It may be turned about the bone, by an angle that differs from rig to rig.
    This angle is found over the whole clip, because people bend in the right direction most of the time. Where a limb
    is straight, the captured axis decides.
    """
    normal = np.cross(u, v)
    sine = np.linalg.norm(normal, axis=1)
    normal = normal / np.maximum(sine, 1e-9)[:, None]
    axis = _square(axis, u)
    angle = np.arctan2(np.sum(np.cross(axis, normal) * u, axis=1), np.sum(axis * normal, axis=1))
    weight = np.where(sine > STRAIGHT, sine**2, 0.0)
    mean = np.arctan2(np.sum(weight * np.sin(angle)), np.sum(weight * np.cos(angle))) if weight.any() else 0.0
    axis = quat.rotate(quat.from_axis_angle(u, np.full(len(u), mean)), axis)
    sign = np.where(np.sum(axis * normal, axis=1) < 0, -1.0, 1.0)
    share = smooth((sine - STRAIGHT) / (BENT - STRAIGHT))
    share = (share * smooth(np.abs(np.sum(axis * normal, axis=1)) / CLEAR))[:, None]
    axis = _square(share * sign[:, None] * normal + (1 - share) * axis, u)
    return axis, sign * np.arctan2(sine, np.sum(u * v, axis=1))


def _square(axis: Array, bone: Array) -> Array:
    """Return unit vectors (f, 3): the part of an axis that is square to the bone (f, 3)."""
    axis = axis - np.sum(axis * bone, axis=1, keepdims=True) * bone
    return np.asarray(axis / np.maximum(np.linalg.norm(axis, axis=1, keepdims=True), 1e-9))


def _frame(bone: Array, hinge: Array, u: Array, axis: Array) -> Array:
    """Return the turns (f, 4) that take a bone and the hinge square to it to u and axis, (f, 3) each."""
    first = quat.between(bone, u)
    turned = quat.rotate(first, hinge)
    angle = np.arctan2(np.sum(np.cross(turned, axis) * u, axis=1), np.sum(turned * axis, axis=1))
    return quat.multiply(quat.from_axis_angle(u, angle), first)


@dataclass(frozen=True, slots=True)
class _Feet:
    """The targets of ankles and feet; lift : metres (f,) by which the file's hips must rise to stand on y = 0."""

    feet: AnkleTracks
    lift: Array


def _feet(body: Skeleton, given: _Upright, world: Array) -> _Feet:
    """Return flat feet in stands, with their balls over the captured ones, and write feet and toes of `world`.

    They stand farther apart by as much as the body's hips are wider. Legs that slant to a narrow stance would need
    impossible ankles.
    """
    places, turns, stands, raised = [], [], [], []
    for side in "lr":
        ankle, toes = f"{side}_talocrural", f"{side}_metatarsal"
        path, own = given.place(ankle), body.offsets[body.index(toes)]
        standing = standing_frames(path, given.captured.fps)
        level, theirs = quat.IDENTITY, own
        if toes in given.rest:
            way = given.bone(ankle, toes)
            level = quat.from_axis_angle(quat.UP, np.asarray(np.arctan2(way[0], way[2])))
            theirs = given.scale * np.array([0.0, way[1], np.hypot(way[0], way[2])])
        turn = quat.multiply(given.delta(ankle), level)
        up = quat.rotate(quat.conjugate(turn[standing]), quat.UP).mean(axis=0)
        level = quat.multiply(level, quat.between(quat.UP, up))
        turn = quat.multiply(given.delta(ankle), level)
        world[:, body.index(ankle)] = turn
        world[:, body.index(toes)] = quat.multiply(given.delta(toes), level) if toes in given.rest else turn
        wider = np.array([given.wider if side == "l" else -given.wider, 0.0, 0.0])
        places.append(path + quat.rotate(turn, wider + (theirs - own) * [0.0, 1.0, 1.0]))
        raised.append(float(theirs[1] - own[1]))
        turns.append(turn)
        stands.append(standing)
    feet = AnkleTracks(np.stack(places, axis=1), np.stack(turns, axis=1))
    low = lowest(body, feet)
    lift = -_floor(low, np.stack(stands, axis=1))
    lifted = feet.places + lift[:, None, None] * quat.UP
    lifted += np.maximum(-(low + lift[:, None]), 0.0)[..., None] * quat.UP
    return _Feet(AnkleTracks(lifted, feet.turns), lift + float(np.mean(raised)))


def _floor(low: Array, standing: NDArray[np.bool_]) -> Array:
    """Return the height (f,) of the floor under the dancer: feet (f, 2) at rest stand on it; between rests it is
    interpolated.

    Captured floors are rarely level: a foot at rest may lie centimetres higher at the other end of the room.
    """
    knots = []
    for k in (0, 1):
        for first, end in runs(standing[:, k]):
            knots.append(((first + end - 1) / 2, float(np.median(low[first:end, k])), end - first))
    heights = np.array([height for _, height, _ in knots])
    if np.ptp(heights) > UNEVEN:
        return np.full(len(low), np.median(low[standing]))
    knots.sort()
    return np.asarray(np.interp(np.arange(len(low)), [at for at, _, _ in knots], [height for _, height, _ in knots]))
