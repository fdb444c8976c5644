"""The stand of a captured person: the up direction, the beginning of the clip, and the pose from which joints turn.

The pose of a file with all channels at 0 is used if it is a standing person. Otherwise (bones along one axis, as many
studios export them) the pose is found from the motion. Joints of a person move, but each keeps directions of its own
(to the next joint, to the left, to the floor while a foot stands) that are known for a standing body.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.limbs import hinge_axis
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.units import Array
from dancetutor_cli.run.errors import FileError

STANDS = 0.8  # least cosine between upright and trunk and legs of a standing pose
CLEARLY = 0.5  # mean of the bodies' directions along an axis, from which on this axis is up
TOWARDS = 0.5  # length of the mean direction of a person, from which on it is one direction
STILL = 0.25  # metres per second, for a body of the rig's size: slower feet may stand
LOW = 0.06  # metres over its lowest height up to which a foot may stand
_X, _Y, _Z = np.eye(3)
TRUNK = ("HumanoidRoot", "vl5", "vt10", "vt4", "vc4", "skullbase")
_LEGS = (("hip", "knee"), ("knee", "talocrural"))


@dataclass(frozen=True, slots=True)
class StandingPose:
    """The pose from which joints turn, upright over +Y and facing +Z.

    turn : (4,) from the file's world to the upright one; places, turns : (3,) and (4,) of each joint in the pose
    """

    turn: Array
    places: dict[str, Array]
    turns: dict[str, Array]


@dataclass(frozen=True, slots=True)
class JointPaths:
    """The joints of the rig that a file has. places, turns : (f, 3) and (f, 4) of each; rest, rest_turns : its zero
    pose
    """

    path: Path
    fps: float
    places: Mapping[str, Array]
    turns: Mapping[str, Array]
    rest: Mapping[str, Array]
    rest_turns: Mapping[str, Array]


def standing_pose(given: JointPaths, body: Skeleton) -> StandingPose:
    """Return the pose from which joints turn. body : named as the rig's; its rest pose is the wanted standing pose

    Raises FileError if the up direction is unknown.
    """
    zero = _upright_axes(given.rest)
    axis = _up_axis(given, zero)
    if zero is not None:
        stands = _to_upright(*zero)
        places = {name: quat.rotate(stands, place) for name, place in given.rest.items()}
        turns = {name: quat.multiply(stands, turn) for name, turn in given.rest_turns.items()}
        same = float(axis @ zero[1]) > 0.99
        return StandingPose(_facing(given, stands if same else _to_upright(*_mean_axes(given, axis))), places, turns)
    turn = _to_upright(*_mean_axes(given, axis))
    upright = {name: quat.rotate(turn, path) for name, path in given.places.items()}
    turned = {name: quat.multiply(turn, turns) for name, turns in given.turns.items()}
    return _from_motion(turn, JointPaths(given.path, given.fps, upright, turned, {}, {}), body)


def standing_frames(path: Array, fps: float) -> NDArray[np.bool_]:
    """Return the frames (f,) in which an ankle (f, 3) may stand: low and slow, or the lowest ones if it never rests."""
    if len(path) < 3:
        return np.ones(len(path), dtype=bool)
    speed = np.linalg.norm(np.gradient(path, 1.0 / fps, axis=0), axis=1)
    low = path[:, 1] < np.percentile(path[:, 1], 5) + LOW
    still = low & (speed < STILL)
    return np.asarray(still if still.sum() >= 5 else low)


def _unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12))


def _left(at: Mapping[str, Array]) -> Array:
    return np.asarray(at["l_hip"] - at["r_hip"] + at["l_shoulder"] - at["r_shoulder"])


def _upwards(at: Mapping[str, Array]) -> Array:
    return np.asarray(at["skullbase"] - (at["l_talocrural"] + at["r_talocrural"]) / 2)


def _upright_axes(rest: Mapping[str, Array]) -> tuple[Array, Array] | None:
    """Return left and up (3,) of a person who stands along an axis of the file; None for any other pose."""
    up = _upwards(rest)
    axis = np.eye(3)[np.abs(up).argmax()] * np.sign(up[np.abs(up).argmax()])
    left = _left(rest) - (_left(rest) @ axis) * axis
    bones = [rest["skullbase"] - (rest["l_hip"] + rest["r_hip"]) / 2]
    bones += [rest[f"{s}_{a}"] - rest[f"{s}_{b}"] for s in "lr" for a, b in _LEGS]
    if min(float(np.linalg.norm(bone)) for bone in (*bones, left)) < 1e-9:
        return None
    stands = all(float(_unit(bone) @ axis) > STANDS for bone in bones)
    return (_unit(left), axis) if stands else None


def _up_axis(given: JointPaths, zero: tuple[Array, Array] | None) -> Array:
    """Return the axis (3,) of the file's world that points up over the whole clip."""
    mean = _unit(_upwards(given.places)).mean(axis=0)
    most = int(np.abs(mean).argmax())
    if zero is not None and float(mean @ zero[1]) > abs(mean[most]) - 0.1:
        return zero[1]
    if abs(mean[most]) > CLEARLY:
        return np.asarray(np.eye(3)[most] * np.sign(mean[most]))
    if zero is not None:
        return zero[1]
    raise FileError(
        given.path, "neither its zero pose nor its motion shows which way is up; add a few seconds of standing"
    )


def _mean_axes(given: JointPaths, axis: Array) -> tuple[Array, Array]:
    """Return left and up (3,) over a clip."""
    left = _unit(_left(given.places))
    left = left - (left @ axis)[:, None] * axis
    mean = left.mean(axis=0)
    if float(np.linalg.norm(mean)) < TOWARDS:
        mean = left[: max(1, round(given.fps))].mean(axis=0)
    if float(np.linalg.norm(mean)) < 1e-6:
        raise FileError(given.path, "its hips and shoulders are in one line, so its direction is unknown")
    return _unit(mean), axis


def _to_upright(left: Array, up: Array) -> Array:
    """Return the turn (4,) that takes left to +X and up to +Y."""
    return np.asarray(quat.from_matrix(np.stack([left, up, np.cross(left, up)])))


def _facing(given: JointPaths, turn: Array) -> Array:
    """Return the turn to upright, and half around if the person's back would face the camera nearly all the time."""
    left = quat.rotate(turn, _unit(_left(given.places))) * [1.0, 0.0, 1.0]
    mean = left.mean(axis=0)
    if float(np.linalg.norm(mean)) < TOWARDS or mean[0] > 0:
        return turn
    angle = np.arctan2(mean[2], mean[0])  # about +Y it takes the mean left to +X
    return quat.multiply(quat.from_axis_angle(_Y, np.asarray(angle)), turn)


# The pose from the motion. All paths are upright.


def _from_motion(turn: Array, given: JointPaths, body: Skeleton) -> StandingPose:
    """Return the pose in which each joint's own directions point as the directions of the body at rest."""
    at, rest = given.places, {name: body.rest[body.index(name)] for name in given.places}
    turns = {}
    for name, (first, second) in _directions(given, body).items():
        own = [_own(given.turns[name], way) for way in (first[0], second[0])]
        turns[name] = quat.multiply(_axes(first[1], second[1]), quat.conjugate(_axes(*own)))
    for name, path in given.turns.items():
        turns.setdefault(name, path[0])
    places: dict[str, Array] = {}
    for name in sorted(at, key=body.index):
        above = int(body.parents[body.index(name)])
        while above >= 0 and body.names[above] not in places:
            above = int(body.parents[above])
        if above < 0:
            places[name] = np.zeros(3)
            continue
        parent = body.names[above]
        way = _unit(rest[name] - rest[parent])
        if parent.endswith("talocrural"):  # the height of ankles over toes differs from rig to rig
            way = quat.rotate(turns[parent], _own(given.turns[parent], at[name] - at[parent]))
        places[name] = places[parent] + float(np.median(np.linalg.norm(at[name] - at[parent], axis=1))) * way
    return StandingPose(turn, places, turns)


_Way = tuple[Array, Array]  # a direction (f, 3) in the motion, and its direction (3,) in the pose


def _directions(given: JointPaths, body: Skeleton) -> dict[str, tuple[_Way, _Way]]:
    """Return two directions of each joint that turns; the first one is kept exactly."""
    at = given.places
    hips, chest = _unit(at["l_hip"] - at["r_hip"]), _unit(at["l_shoulder"] - at["r_shoulder"])

    def way(name: str, tip: str) -> _Way:
        return at[tip] - at[name], body.rest[body.index(tip)] - body.rest[body.index(name)]

    trunk = [name for name in TRUNK if name in at]
    size = float(np.linalg.norm(_upwards(at), axis=1).max())
    lefts = {"HumanoidRoot": hips, "vl5": _unit(hips + chest), "vt10": _unit(hips + chest)}
    out: dict[str, tuple[_Way, _Way]] = {}
    for k, name in enumerate(trunk[:-1]):
        far = (tip for tip in trunk[k + 1 :] if float(np.linalg.norm(at[tip] - at[name], axis=1).max()) > 0.01 * size)
        out[name] = way(name, next(far, "skullbase")), (lefts.get(name, chest), _X)
    lower = next((n for n in ("vt4", "vt10", "vl5") if n in at), "HumanoidRoot")
    out["skullbase"] = (np.tile(_Y, (len(chest), 1)), _Y), (chest, _X)  # people look level, on average
    for side in "lr":
        collar, shoulder, elbow, wrist = (
            f"{side}_{n}" for n in ("sternoclavicular", "shoulder", "elbow", "radiocarpal")
        )
        upper, forearm = way(shoulder, elbow), way(elbow, wrist)
        if collar in at:
            out[collar] = way(collar, shoulder), way(lower, "skullbase")
        ahead = np.cross(chest, _unit(at["skullbase"] - at[lower]))
        out[shoulder] = upper, (ahead, _Z)
        bent = np.cross(_unit(upper[0]), _unit(forearm[0]))
        out[wrist] = forearm, (bent, hinge_axis("elbow", forearm[1]))
        out[f"{side}_hip"] = way(f"{side}_hip", f"{side}_knee"), (hips, _X)
        out |= _foot_directions(given, side, hips)
    return out


def _foot_directions(given: JointPaths, side: str, hips: Array) -> dict[str, tuple[_Way, _Way]]:
    """Return the directions of a foot: its own up is the up of the world while it stands."""
    ankle, toes = f"{side}_talocrural", f"{side}_metatarsal"
    at = given.places
    leg = float(np.median(np.linalg.norm(at[f"{side}_hip"] - at[ankle], axis=1)))
    stands = standing_frames(at[ankle] * (0.83 / max(leg, 1e-9)), given.fps)
    up = (np.where(stands[:, None], _Y, 0.0), _Y)
    if toes not in at:
        return {ankle: (up, (hips, _X))}
    ahead = (at[toes] - at[ankle], _Z)
    return {ankle: (up, ahead), toes: (up, ahead)}


def _own(turns: Array, ways: Array) -> Array:
    """Return the mean of directions (f, 3), each seen from the joint that turns (f, 4)."""
    return _unit(quat.rotate(quat.conjugate(turns), ways).mean(axis=0))


def _axes(first: Array, second: Array) -> Array:
    """Return the turn (4,) of axes whose x is the first direction and whose y is towards the second."""
    x = _unit(first)
    y = second - (second @ x) * x
    if float(np.linalg.norm(y)) < 1e-6:
        y = np.eye(3)[np.abs(x).argmin()] - x[np.abs(x).argmin()] * x
    y = _unit(y)
    return np.asarray(quat.from_matrix(np.stack([x, y, np.cross(x, y)], axis=1)))


# Rest poses that converters write before the motion.

_SEARCHED = 3.0  # seconds at the beginning of a clip in which a rest pose is searched
# from a rest pose, joints jump by this many times the next step, and by this part of a leg's length
JUMP, JUMP_LEAST = 8.0, 0.12
JUMP_ZERO, ALIKE = 2.0, np.radians(0.5)  # of a pose that is the file's zero pose: times what comes next; to be it


def first_frame(given: JointPaths) -> int:
    """Return the frame in which the motion begins, after a rest pose of still frames from which joints jump."""
    names = sorted(given.places)
    places = np.stack([given.places[name] for name in names], axis=1)
    leg = sum(float(np.linalg.norm(given.places[f"l_{a}"][0] - given.places[f"l_{b}"][0])) for a, b in _LEGS)
    places = places - places[:, names.index("HumanoidRoot"), None]
    moves = np.linalg.norm(np.diff(places[: round(_SEARCHED * given.fps) + 12], axis=0), axis=2).max(axis=1)
    still = 0.002 * leg
    for k, move in enumerate(moves[: max(1, len(moves) - 2)].tolist()):
        after = float(np.median(moves[k + 1 : k + 11])) if k + 1 < len(moves) else 0.0
        if move > max((JUMP_ZERO if _is_zero(given, k) else JUMP) * after, JUMP_LEAST * leg):
            return k + 1
        if move > still:
            break
    return 0


def _is_zero(given: JointPaths, frame: int) -> bool:
    """Whether a frame has the file's zero pose, at any place."""
    deltas = np.stack([quat.multiply(t[frame], quat.conjugate(given.rest_turns[n])) for n, t in given.turns.items()])
    return bool(quat.angle_between(deltas[:1], deltas).max() < ALIKE)


def segment_angles(given: JointPaths, places: Mapping[str, Array]) -> dict[str, float]:
    """Return the mean angle, degrees, between each segment of a capture (upright) and of the result."""
    out = {}
    ends = [("l_hip", "l_shoulder"), ("r_hip", "r_shoulder")]
    for side in "lr":
        for chain in (("shoulder", "elbow", "radiocarpal"), ("hip", "knee", "talocrural")):
            ends += [(f"{side}_{a}", f"{side}_{b}") for a, b in pairwise(chain)]
    for a, b in ends:
        one, two = _unit(given.places[b] - given.places[a]), _unit(places[b] - places[a])
        cosine = np.clip(np.sum(one * two, axis=1), -1.0, 1.0)
        out[f"{a} to {b}"] = float(np.degrees(np.arccos(cosine)).mean())
    return out
