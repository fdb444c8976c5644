"""The dancer's joints: H-Anim names, hierarchy, rest positions and limits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.units import Array

# World: metres, +Y up, the dancer looks to +Z, so her left is +X. The pad's surface is y = 0. Rest pose: standing
# upright, feet parallel, arms in an A pose 45 degrees down in the frontal plane, palms facing the thighs. In the rest
# pose every local rotation is the identity and every joint's axes are the world's.


@dataclass(frozen=True, slots=True)
class Skeleton:
    """A joint tree. j joints, parents before children, joint 0 the root.

    names : H-Anim names; parents : int32 (j,), -1 for the root
    offsets : float64 (j, 3), rest position relative to the parent (the root: to the world), metres
    """

    names: tuple[str, ...]
    parents: NDArray[np.int32]
    offsets: NDArray[np.float64]

    @classmethod
    def from_rest(cls, names: tuple[str, ...], parents: NDArray[np.int32], rest: Array) -> Skeleton:
        """Return the skeleton with the joints at these places (j, 3) of the world in the rest pose."""
        offsets = rest.copy()
        offsets[1:] -= rest[parents[1:]]
        return cls(names, parents, offsets)

    def index(self, name: str) -> int:
        """Return the index of a joint. Raises ValueError if no joint has this name."""
        return self.names.index(name)

    @property
    def rest(self) -> NDArray[np.float64]:
        """The rest position of every joint in the world, (j, 3)."""
        out = self.offsets.copy()
        for j, p in enumerate(self.parents):
            if p >= 0:
                out[j] += out[p]
        return out


EYELID_CLOSING = 66.0  # degrees about +x that close the dancer's upper lids; the rest pose has them open
JAW_LAUGH = 11.0  # degrees about +x that open her mouth to a laugh; at rest she smiles

KNUCKLES, FINGERS = "metacarpophalangeal_3", "carpal_proximal_interphalangeal_3"  # the four fingers move as one

_DOWN = np.sqrt(0.5)
_LEFT_SIDE: tuple[tuple[str, str, tuple[float, float, float]], ...] = (
    ("l_hip", "HumanoidRoot", (0.088, 0.895, 0.0)),
    ("l_knee", "l_hip", (0.088, 0.485, 0.008)),
    ("l_talocrural", "l_knee", (0.088, 0.085, -0.018)),
    ("l_metatarsal", "l_talocrural", (0.088, 0.028, 0.097)),
    ("l_sternoclavicular", "vt4", (0.022, 1.395, 0.005)),
    ("l_shoulder", "l_sternoclavicular", (0.160, 1.380, -0.015)),
    ("l_elbow", "l_shoulder", (0.160 + 0.262 * _DOWN, 1.380 - 0.262 * _DOWN, -0.015)),
    ("l_radiocarpal", "l_elbow", (0.160 + 0.492 * _DOWN, 1.380 - 0.492 * _DOWN, -0.007)),
    (f"l_{KNUCKLES}", "l_radiocarpal", (0.160 + 0.574 * _DOWN, 1.380 - 0.570 * _DOWN, -0.007)),
    (f"l_{FINGERS}", f"l_{KNUCKLES}", (0.160 + 0.601 * _DOWN, 1.380 - 0.619 * _DOWN, -0.007)),
    ("l_eyeball_joint", "skullbase", (0.039, 1.589, 0.060)),
    ("l_eyelid_joint", "skullbase", (0.039, 1.589, 0.060)),
)
_MIDDLE: tuple[tuple[str, str | None, tuple[float, float, float]], ...] = (
    ("HumanoidRoot", None, (0.0, 0.935, 0.0)),
    ("vl5", "HumanoidRoot", (0.0, 0.995, -0.012)),
    ("vt10", "vl5", (0.0, 1.130, -0.018)),
    ("vt4", "vt10", (0.0, 1.290, -0.028)),
    ("vc4", "vt4", (0.0, 1.450, -0.018)),
    ("skullbase", "vc4", (0.0, 1.525, 0.002)),
    ("temporomandibular", "skullbase", (0.0, 1.552, 0.015)),
    ("braid1", "skullbase", (0.0, 1.628, -0.116)),
    ("braid2", "braid1", (0.0, 1.515, -0.150)),
    ("braid3", "braid2", (0.0, 1.405, -0.155)),
    ("braid4", "braid3", (0.0, 1.295, -0.155)),
)
ORDER = (
    "HumanoidRoot",
    *(f"{s}_{n}" for s in "lr" for n in ("hip", "knee", "talocrural", "metatarsal")),
    "vl5", "vt10", "vt4",
    *(f"{s}_{n}" for s in "lr" for n in ("sternoclavicular", "shoulder", "elbow", "radiocarpal")),
    "vc4", "skullbase",
    *(f"{s}_{n}" for s in "lr" for n in ("eyeball_joint", "eyelid_joint")),
    "braid1", "braid2", "braid3", "braid4",
    "temporomandibular",
    *(f"{s}_{n}" for s in "lr" for n in (KNUCKLES, FINGERS)),
)  # fmt: skip


def dancer_skeleton() -> Skeleton:
    """Return the skeleton of the project's own dancer: 1.70 m tall, 35 joints."""
    world: dict[str, tuple[str | None, tuple[float, float, float]]] = {n: (p, x) for n, p, x in _MIDDLE}
    for name, parent, (x, y, z) in _LEFT_SIDE:
        world[name] = (parent, (x, y, z))
        mirrored = parent.replace("l_", "r_", 1) if parent.startswith("l_") else parent
        world[name.replace("l_", "r_", 1)] = (mirrored, (-x, y, z))
    parents = np.array([-1 if (p := world[n][0]) is None else ORDER.index(p) for n in ORDER], dtype=np.int32)
    rest = np.array([world[n][1] for n in ORDER])
    return Skeleton.from_rest(ORDER, parents, rest)


# The limits of each joint of a person: hinges, and ball joints split into swing and twist about their bone.
#
# Angles are degrees of the local rotation from the rest pose, for the left side; the right side is its mirror image.
# +X turns a leg backward and a spine forward, +Z lifts the left leg or arm aside. Ranges are those of a limber adult
# in everyday textbooks of functional anatomy, rounded.

Range = tuple[float, float]
_FREE = (-180.0, 180.0)


@dataclass(frozen=True, slots=True)
class Limit:
    """The limits of a joint in degrees: of the swing about X and about Z, and of the twist about the bone (Y without a
    bone).

    cone : largest swing about any axis
    """

    x: Range = _FREE
    z: Range = _FREE
    twist: Range = _FREE
    cone: float = 180.0


LIMITS: dict[str, Limit] = {
    "l_hip": Limit((-130, 40), (-45, 65), (-55, 60)),
    "l_knee": Limit((-8, 155), (-2, 2), (-2, 2)),
    "l_talocrural": Limit((-46, 60), (-38, 38), (-45, 45)),
    "l_metatarsal": Limit((-65, 40), (-3, 3), (-3, 3)),
    "vl5": Limit((-25, 50), (-30, 30), (-30, 30)),
    "vt10": Limit((-25, 50), (-30, 30), (-35, 35)),
    "vt4": Limit((-25, 50), (-30, 30), (-35, 35)),
    "l_sternoclavicular": Limit(cone=25.0, twist=(-25, 25)),
    "l_shoulder": Limit(cone=140.0, twist=(-100, 100)),
    "l_elbow": Limit(twist=(-3, 3), cone=155.0),
    "l_radiocarpal": Limit(cone=97.0, twist=(-95, 95)),
    "vc4": Limit((-45, 40), (-35, 35), (-50, 50)),
    "skullbase": Limit((-50, 40), (-35, 35), (-55, 55)),
    "l_eyeball_joint": Limit(cone=40.0),
}


def excess(skeleton: Skeleton, rotations: Array) -> dict[str, Array]:
    """Return the degrees (f,) by which each limited joint is past its limits, 0 within; rotations (f, j, 4) local."""
    out = {}
    for joint, name in enumerate(skeleton.names):
        mirrored = name.startswith("r_")
        limit = LIMITS.get(name.replace("r_", "l_", 1) if mirrored else name)
        if limit is not None:
            past = _past(limit, rotations[:, joint], _bone(skeleton, joint), -1.0 if mirrored else 1.0)
            out[name] = np.maximum(past, 0.0)
    return out


def beyond(skeleton: Skeleton, name: str, rotations: Array) -> Array:
    """Return the degrees (f,) by which local rotations (f, 4) of a joint are past a limit; negative within."""
    mirrored = name.startswith("r_")
    limit = LIMITS[name.replace("r_", "l_", 1) if mirrored else name]
    return _past(limit, rotations, _bone(skeleton, skeleton.index(name)), -1.0 if mirrored else 1.0)


def within(skeleton: Skeleton, name: str, rotations: Array, margin: float) -> Array:
    """Return the rotations (f, 4) of one joint, with swing and twist kept `margin` degrees inside their limits."""
    limit, sign = LIMITS[name.replace("r_", "l_", 1)], -1.0 if name.startswith("r_") else 1.0
    bone = _bone(skeleton, skeleton.index(name))
    swing, twist = quat.swing_twist(rotations, bone)
    swung, twisted = np.degrees(quat.to_vector(swing)), sign * np.degrees(quat.to_vector(twist) @ bone)
    swung[:, 0] = np.clip(swung[:, 0], limit.x[0] + margin, limit.x[1] - margin)
    swung[:, 2] = sign * np.clip(sign * swung[:, 2], limit.z[0] + margin, limit.z[1] - margin)
    twisted = np.radians(sign * np.clip(twisted, limit.twist[0] + margin, limit.twist[1] - margin))
    size = np.linalg.norm(swung, axis=1)
    axis = np.where(size[:, None] > 1e-9, swung / np.maximum(size, 1e-9)[:, None], [1.0, 0.0, 0.0])
    size = np.minimum(size, limit.cone - margin)
    return quat.multiply(quat.from_axis_angle(axis, np.radians(size)), quat.from_axis_angle(bone, twisted))


def _bone(skeleton: Skeleton, joint: int) -> Array:
    """Return the unit vector about which a joint twists: along the arm for arm joints, otherwise upright."""
    name = skeleton.names[joint]
    if name.endswith(("shoulder", "elbow", "radiocarpal")):
        side = name[0]
        along = skeleton.offsets[skeleton.index(f"{side}_elbow")]
        return np.asarray(along / np.linalg.norm(along))
    return np.array([0.0, 1.0, 0.0])


def _past(limit: Limit, q: Array, bone: Array, sign: float) -> Array:
    swing, twist = quat.swing_twist(q, bone)
    twisted = np.degrees(quat.to_vector(twist) @ bone)
    swung = np.degrees(quat.to_vector(swing))
    past = np.linalg.norm(swung, axis=1) - limit.cone
    for value, (low, high) in (
        (swung[:, 0], limit.x),
        (sign * swung[:, 2], limit.z),
        (sign * twisted, limit.twist),
    ):
        past = np.maximum(past, np.maximum(low - value, value - high))
    return np.asarray(past)
