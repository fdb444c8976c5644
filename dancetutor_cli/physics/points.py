"""Retargeting points: where on the ragdoll springs and dampers pull, End, Center or Hybrid Center.

Each bone has one point, at its end or its middle, and beside it two extra ones that keep it from turning about itself;
the pelvis has the root's and both hips', whose extra ones are before and behind.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.errors import UsageError, did_you_mean
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.skeleton import Skeleton

if TYPE_CHECKING:
    from dancetutor_cli.physics.ragdoll import Bone
    from dancetutor_cli.physics.style import Style

Array = NDArray[np.float64]
# name of the point at the end of a bone, by the bone's joint without its side
_ENDS = {
    "vl5": "vt10", "vt10": "vt4", "vt4": "vc4", "vc4": "skullbase", "skullbase": "skull_tip",
    "sternoclavicular": "shoulder", "shoulder": "elbow", "elbow": "radiocarpal", "radiocarpal": "hand_tip",
    "hip": "knee", "knee": "talocrural", "talocrural": "metatarsal",
}  # fmt: skip
_ASIDE = {"pelvis": 0.08, "spine": 0.11, "chest": 0.11, "head": 0.08, "feet": 0.045, "hands": 0.04}
_ASIDE_OF_LIMBS = 0.06  # metres from a point to an extra one


@dataclass(frozen=True, slots=True)
class Point:
    """bone : index of its body; offset : (3,) in the body's axes from its joint, metres; share : of the body's mass

    extra : whether it is one of the two beside the point of that name
    """

    name: str
    bone: int
    part: str
    offset: Array
    mass: float
    extra: bool

    def gains(self, style: Style) -> tuple[Array, Array]:
        """kp (3,) in N/m and kd (3,) in N s/m along the world's axes; zero where the style disables the point."""
        if self.name in style.disabled:
            return np.zeros(3), np.zeros(3)
        spring = style.springs[self.part]
        omega = 2 * np.pi * np.array(spring.frequency)
        return self.mass * omega**2, 2 * np.array(spring.damping) * self.mass * omega


def points_of(skeleton: Skeleton, bones: tuple[Bone, ...], style: Style) -> tuple[Point, ...]:
    """The points of a ragdoll as a style wants them. UsageError if it disables one that there is not."""
    out: list[Point] = []
    for index, bone in enumerate(bones):
        places = _places(skeleton, bone, style)
        for name, centre, aside in places:
            offsets = [centre, centre + aside, centre - aside] if style.extra_points else [centre]
            mass = bone.mass / (len(places) * len(offsets))
            out += [Point(name, index, bone.part, o, mass, k > 0) for k, o in enumerate(offsets)]
    names = sorted({p.name for p in out})
    for name in style.disabled:
        if name not in names:
            near = did_you_mean(name, names)
            raise UsageError(f"style {style.name}: there is no retargeting point '{name}'{near}: {', '.join(names)}")
    return tuple(out)


def _places(skeleton: Skeleton, bone: Bone, style: Style) -> list[tuple[str, Array, Array]]:
    """Name, offset, and the way to an extra point."""
    if bone.parent < 0:
        hips = [(s, skeleton.offsets[skeleton.index(f"{s}_hip")]) for s in "lr"]
        ahead = np.array([0.0, 0.0, _ASIDE["pelvis"]])
        return [("root", np.zeros(3), ahead), *((f"{s}_hip", place, ahead) for s, place in hips)]
    sided = bone.outward != 0
    bare = bone.name[2:] if sided else bone.name
    name = f"{bone.name[:2]}{_ENDS[bare]}" if sided else _ENDS[bare]
    middle = style.placement == "center" or (style.placement == "hybrid" and bone.part != "feet")
    across = np.array([1.0, 0.0, 0.0]) if abs(bone.along[0]) < 0.5 else np.array([0.0, 0.0, 1.0])
    across = across - bone.along * (across @ bone.along)
    aside = _ASIDE.get(bone.part, _ASIDE_OF_LIMBS) * across / np.linalg.norm(across)
    return [(name, bone.end * (0.5 if middle else 1.0), aside)]


def place_points(
    skeleton: Skeleton, bones: tuple[Bone, ...], points: tuple[Point, ...], rotations: Array, root: Array
) -> Array:
    """World positions (f, p, 3) of the points of a skeleton posed by local rotations (f, j, 4) and root (f, 3)."""
    positions, world = world_transforms(skeleton, rotations, root)
    joints = [bones[p.bone].joint for p in points]
    return np.asarray(positions[:, joints] + quat.rotate(world[:, joints], np.array([p.offset for p in points])))
