"""The body in space: forward kinematics, masses, the points that touch the pad, dimensions derived from them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.skeleton import Skeleton, dancer_skeleton
from dancetutor_cli.dance.units import Array, Poses
from dancetutor_cli.run.kernels.compiling import njit

# Forward kinematics for all frames at once, from local joint rotations to places in the world.


def world_transforms(skeleton: Skeleton, rotations: Array, root: Array) -> tuple[Array, Array]:
    """Return the place and the rotation of every joint in the world.

    Parameters
    ----------
    skeleton : j joints
    rotations : (f, j, 4) local unit quaternions; root : (f, 3) world position of joint 0, metres

    Returns
    -------
    positions (f, j, 3) in metres and rotations (f, j, 4), both in the world
    """
    positions = np.empty((*rotations.shape[:2], 3))
    world = np.empty(rotations.shape)
    _forward(skeleton.parents, skeleton.offsets, np.ascontiguousarray(rotations), np.asarray(root), positions, world)
    return positions, world


@njit(cache=True)
def _forward(
    parents: NDArray[np.int32], offsets: Array, local: Array, root: Array, positions: Array, world: Array
) -> None:
    """Fill positions (f, j, 3) and world (f, j, 4)."""
    for f in range(len(local)):
        for j in range(len(parents)):
            p = parents[j]
            if p < 0:
                for k in range(3):  # not a row at once: numba would compile the error message for wrong shapes
                    positions[f, j, k] = root[f, k]
                for k in range(4):
                    world[f, j, k] = local[f, j, k]
                continue
            w, x, y, z = world[f, p, 0], world[f, p, 1], world[f, p, 2], world[f, p, 3]
            vx, vy, vz = offsets[j, 0], offsets[j, 1], offsets[j, 2]
            tx, ty, tz = 2.0 * (y * vz - z * vy), 2.0 * (z * vx - x * vz), 2.0 * (x * vy - y * vx)
            positions[f, j, 0] = positions[f, p, 0] + vx + w * tx + y * tz - z * ty
            positions[f, j, 1] = positions[f, p, 1] + vy + w * ty + z * tx - x * tz
            positions[f, j, 2] = positions[f, p, 2] + vz + w * tz + x * ty - y * tx
            a, b, c, d = local[f, j, 0], local[f, j, 1], local[f, j, 2], local[f, j, 3]
            world[f, j, 0] = w * a - x * b - y * c - z * d
            world[f, j, 1] = w * b + x * a + y * d - z * c
            world[f, j, 2] = w * c - x * d + y * a + z * b
            world[f, j, 3] = w * d + x * c - y * b + z * a


def joint_matrices(skeleton: Skeleton, rotations: Array, root: Array) -> Array:
    """Return joint to world matrices (f, j, 4, 4) for column vectors; arguments as in `world_transforms`."""
    positions, world = world_transforms(skeleton, rotations, root)
    out = np.zeros((*rotations.shape[:2], 4, 4))
    out[..., :3, :3] = quat.to_matrix(world)
    out[..., :3, 3] = positions
    out[..., 3, 3] = 1.0
    return out


def local_rotations(skeleton: Skeleton, world: Array) -> Array:
    """Return local rotations (f, j, 4) from world rotations (f, j, 4): the inverse of `world_transforms`."""
    local = world.copy()
    for joint, parent in enumerate(skeleton.parents):
        if parent >= 0:
            local[:, joint] = quat.multiply(quat.conjugate(world[:, parent]), world[:, joint])
    return local


# The mass of each part of the dancer, and her centre of mass.
#
# Masses are fractions of the body and centres lie on the line from a part's own joint to the next one, after the
# tables of de Leva (1996, adjustments to Zatsiorsky's parameters, female), rounded; the trunk is split over our
# spine joints.

GRAVITY = 9.81  # metres per second squared

# joint that carries the part, fraction of the body's mass, rest position of the part's centre (x of the left side)
PARTS = (
    ("HumanoidRoot", 0.147, (0.0, 0.930, -0.005)),
    ("vl5", 0.130, (0.0, 1.070, 0.000)),
    ("vt10", 0.100, (0.0, 1.210, -0.005)),
    ("vt4", 0.047, (0.0, 1.350, -0.015)),
    ("skullbase", 0.067, (0.0, 1.600, 0.005)),
    ("l_hip", 0.148, (0.088, 0.747, 0.003)),
    ("l_knee", 0.048, (0.088, 0.308, -0.003)),
    ("l_talocrural", 0.013, (0.088, 0.045, 0.030)),
    ("l_shoulder", 0.0255, (0.267, 1.273, -0.015)),
    ("l_elbow", 0.0140, (0.420, 1.120, -0.011)),
    ("l_radiocarpal", 0.0060, (0.560, 0.980, -0.005)),
)


def mass_points(skeleton: Skeleton) -> tuple[NDArray[np.int64], Array, Array]:
    """Return the body as point masses fixed to joints.

    Returns
    -------
    joint (m,), mass (m,) with sum 1, offset (m, 3) in the joint's axes, metres
    """
    rest = skeleton.rest
    joints, masses, offsets = [], [], []
    for name, mass, (x, y, z) in PARTS:
        for mirrored in (name, name.replace("l_", "r_", 1)) if name.startswith("l_") else (name,):
            joint = skeleton.index(mirrored)
            centre = np.array([x if mirrored == name else -x, y, z])
            joints.append(joint)
            masses.append(mass)
            offsets.append(centre - rest[joint])
    mass_array = np.array(masses)
    return np.array(joints), mass_array / mass_array.sum(), np.array(offsets)


def centre_of_mass(skeleton: Skeleton, positions: Array, world: Array) -> Array:
    """Return the centre of mass (f, 3) from the joints' world positions (f, j, 3) and rotations (f, j, 4)."""
    joints, masses, offsets = mass_points(skeleton)
    places = positions[:, joints] + quat.rotate(world[:, joints], offsets)
    return np.asarray(np.einsum("m,fmx->fx", masses, places))


def mass_of(skeleton: Skeleton, poses: Poses) -> Array:
    """Return the centre of mass (f, 3) of poses."""
    return centre_of_mass(skeleton, *world_transforms(skeleton, *poses))


# The points of the body that touch the pad: the sole corners of each foot, and the palms.
#
# Soles are a little wider than the foot: the dancer wears flat shoes. Each point belongs to a joint and is given
# in the joint's axes, which are the world's in the rest pose. Heel and ball turn with the ankle, the toes with the
# metatarsal joint; in the rest pose all of them lie on the ground.

# name, joint, rest position of the left foot's point relative to (x of the ankle, 0, 0), metres
SOLE = (
    ("heel_in", "talocrural", (-0.028, 0.0, -0.070)),
    ("heel_out", "talocrural", (0.028, 0.0, -0.070)),
    ("ball_in", "metatarsal", (-0.040, 0.0, 0.092)),
    ("ball_out", "metatarsal", (0.042, 0.0, 0.082)),
    ("toe_in", "metatarsal", (-0.030, 0.0, 0.172)),
    ("toe_out", "metatarsal", (0.026, 0.0, 0.160)),
)
SOLE_NAMES = tuple(name for name, _, _ in SOLE)
SIDES = ("l", "r")
_PALM_REACH, _PALM_DEPTH = 0.085, 0.022  # from the wrist along the hand, and from the middle of the hand to its palm


@dataclass(frozen=True, slots=True)
class BodyPoint:
    """A point fixed to a joint: `offset` (3,) in the joint's axes, metres."""

    joint: int
    offset: Array


def sole_points(skeleton: Skeleton) -> tuple[tuple[BodyPoint, ...], tuple[BodyPoint, ...]]:
    """Return the sole points of the left and the right foot, in the order of `SOLE_NAMES`."""
    rest = skeleton.rest
    feet = []
    for side, mirror in zip(SIDES, (1.0, -1.0), strict=True):
        middle = rest[skeleton.index(f"{side}_talocrural")][0]
        points = []
        for _, joint_name, (x, y, z) in SOLE:
            joint = skeleton.index(f"{side}_{joint_name}")
            points.append(BodyPoint(joint, np.array([middle + mirror * x, y, z]) - rest[joint]))
        feet.append(tuple(points))
    return feet[0], feet[1]


def palm_points(skeleton: Skeleton) -> tuple[BodyPoint, BodyPoint]:
    """Return the middle of the left and the right palm, on the skin."""
    rest = skeleton.rest
    out = []
    for side in SIDES:
        wrist = skeleton.index(f"{side}_radiocarpal")
        along = hand_direction(skeleton, side)
        out.append(BodyPoint(wrist, _PALM_REACH * along + _PALM_DEPTH * palm_normal(skeleton, side)))
        assert rest.shape[1] == 3
    return out[0], out[1]


def hand_direction(skeleton: Skeleton, side: str) -> Array:
    """Return the unit vector from the wrist to the fingers in the rest pose: the line of the upper arm."""
    d = skeleton.offsets[skeleton.index(f"{side}_elbow")]
    return np.asarray(d / np.linalg.norm(d))


def palm_normal(skeleton: Skeleton, side: str) -> Array:
    """Return the unit vector out of the palm in the rest pose: towards the thigh, square to the hand."""
    x, y, _ = hand_direction(skeleton, side)
    normal = np.array([y, -x, 0.0])
    return normal if normal[1] < 0 else -normal


def points_in_world(skeleton: Skeleton, points: tuple[BodyPoint, ...], rotations: Array, root: Array) -> Array:
    """Return world positions (f, p, 3) of body points; rotations (f, j, 4) local, root (f, 3)."""
    return place(points, *world_transforms(skeleton, rotations, root))


def place(points: tuple[BodyPoint, ...], positions: Array, world: Array) -> Array:
    """Return world positions (f, p, 3) of body points from the joints' world positions and rotations."""
    return np.stack([positions[:, p.joint] + quat.rotate(world[:, p.joint], p.offset) for p in points], axis=1)


# Dimensions of the body that follow from the skeleton, its masses and its soles.

BALL_AHEAD = 0.046  # metres that the ball of the foot lies ahead of the middle of the sole
HALF_SHOE = 0.083  # metres from the middle of a shoe to the ends of its capsule's line
SOLE_HALF_WIDTH = 0.022  # metres, of the part of a sole that can carry the whole weight
SOLE_FRONT, SOLE_BACK_TOES, SOLE_BACK_HEEL = (
    0.065,
    -0.012,
    -0.125,
)  # ends of that part, ahead of the ball: at the front, at the back on toes, at the back with the heel down
# moments of inertia about the vertical, square metres per mass of the body: pelvis and belly; chest, head and arms
PELVIS_INERTIA, CHEST_INERTIA = 0.0031, 0.0100
SPINE_SHARES = (0.34, 0.67)  # how far the bones under vt10 and vt4 are turned from the pelvis to the chest
# corners of a sole, and the middles of heel and toes, metres from the ball: ahead, aside
SHOE_OUTLINE = np.array(
    [(-0.166, 0.032), (-0.166, 0.0), (-0.166, -0.032), (0.0, 0.046), (0.0, -0.046), (0.084, 0.034), (0.084, 0.0),
     (0.084, -0.034)]
)  # fmt: skip


def _place(skeleton: Skeleton, name: str) -> tuple[float, float, float]:
    x, y, z = skeleton.rest[skeleton.index(name)]
    return float(x), float(y), float(z)


def half_hips(skeleton: Skeleton) -> float:
    """Return the distance from the middle of the pelvis to a hip, metres."""
    return _place(skeleton, "l_hip")[0]


def ball_to_ankle(skeleton: Skeleton) -> float:
    """Return how far the ankle lies behind the ball of the foot, metres."""
    return _place(skeleton, "l_metatarsal")[2] - _place(skeleton, "l_talocrural")[2]


def ball_height(skeleton: Skeleton) -> float:
    """Return how high the joint of the ball lies over the sole, metres."""
    return _place(skeleton, "l_metatarsal")[1]


def heel_to_ball(skeleton: Skeleton) -> float:
    """Return how far the edge of the heel lies behind the joint of the ball, metres."""
    return _place(skeleton, "l_metatarsal")[2] - min(point[2] for _, _, point in SOLE)


def leg_masses(skeleton: Skeleton) -> tuple[tuple[float, float], ...]:
    """Return the parts of a leg: place of the centre, from hip (0) to ankle (1), and share of the body's mass."""
    hip, ankle = _place(skeleton, "l_hip")[1], _place(skeleton, "l_talocrural")[1]
    total = sum(mass * (2 if name.startswith("l_") else 1) for name, mass, _ in PARTS)
    legs = ("l_hip", "l_knee", "l_talocrural")
    return tuple(
        (min((hip - centre[1]) / (hip - ankle), 1.0), mass / total) for name, mass, centre in PARTS if name in legs
    )


def leg_length(skeleton: Skeleton) -> float:
    """Return the length of thigh and shank together, metres."""
    return float(sum(np.linalg.norm(skeleton.offsets[skeleton.index(f"l_{n}")]) for n in ("knee", "talocrural")))


@lru_cache(maxsize=1)
def dancer_foot() -> tuple[float, float]:
    """Return `heel_to_ball` and `ball_height` of the project's own dancer."""
    skeleton = dancer_skeleton()
    return heel_to_ball(skeleton), ball_height(skeleton)
