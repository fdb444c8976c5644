"""The ragdoll: capsules and boxes with density as a model of the engine, and the points where springs pull it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.limbs import hinge_axis
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.units import Array
from dancetutor_cli.run.errors import UsageError, choose_text

if TYPE_CHECKING:
    from dancetutor_cli.dance.physics.style import Style

# Retargeting points: the points of the ragdoll where springs and dampers pull (End, Center or Hybrid Center).
#
# Each bone has one point, at its end or its middle, and two extra points beside it, which keep the bone from turning
# about itself. The pelvis has the points of the root and of both hips; their extra points are before and behind.

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
    """A retargeting point. bone : index of its body; offset : (3,) in the body's axes from its joint, metres; mass :
    its share of the body's mass

    extra : whether it is one of the two extra points beside the point of that name
    """

    name: str
    bone: int
    part: str
    offset: Array
    mass: float
    extra: bool

    def gains(self, style: Style) -> tuple[Array, Array]:
        """Return kp (3,) in N/m and kd (3,) in N s/m along the world's axes; zero if the style disables the point."""
        if self.name in style.disabled:
            return np.zeros(3), np.zeros(3)
        spring = style.points.get(self.name, style.springs[self.part])
        omega = 2 * np.pi * np.array(spring.frequency)
        return self.mass * omega**2, 2 * np.array(spring.damping) * self.mass * omega


def points_of(skeleton: Skeleton, bones: tuple[Bone, ...], style: Style) -> tuple[Point, ...]:
    """Return the points of a ragdoll for a style. Raises UsageError if the style names an unknown point or joint."""
    out: list[Point] = []
    for index, bone in enumerate(bones):
        places = _places(skeleton, bone, style)
        for name, centre, aside in places:
            offsets = [centre, centre + aside, centre - aside] if style.extra_points else [centre]
            mass = bone.mass / (len(places) * len(offsets))
            out += [Point(name, index, bone.part, o, mass, k > 0) for k, o in enumerate(offsets)]
    points, joints = sorted({p.name for p in out}), [bone.name for bone in bones if bone.parent >= 0]
    _check_names(style, "retargeting point", (*style.disabled, *style.points), points)
    _check_names(style, "joint with stiffness", style.stiffness, joints)
    return tuple(out)


def _check_names(style: Style, what: str, given: Iterable[str], names: list[str]) -> None:
    for name in given:
        if name not in names:
            raise UsageError(f"style {style.name}: there is no {what} '{name}'{choose_text(name, names)}")


def _places(skeleton: Skeleton, bone: Bone, style: Style) -> list[tuple[str, Array, Array]]:
    """Return name, offset, and the vector to an extra point."""
    if bone.parent < 0:
        hips = [(s, skeleton.offsets[skeleton.index(f"{s}_hip")]) for s in "lr"]
        ahead = np.array([0.0, 0.0, _ASIDE["pelvis"]])
        return [("root", np.zeros(3), ahead), *((f"{s}_hip", place, ahead) for s, place in hips)]
    sided = bone.outward != 0
    bare = bone.name[2:] if sided else bone.name
    name = f"{bone.name[:2]}{_ENDS[bare]}" if sided else _ENDS[bare]
    middle = style.placement == "center" or (style.placement == "hybrid" and bone.part != "feet")
    across = quat.LEFT if abs(bone.along[0]) < 0.5 else quat.AHEAD
    across = across - bone.along * (across @ bone.along)
    aside = _ASIDE.get(bone.part, _ASIDE_OF_LIMBS) * across / np.linalg.norm(across)
    return [(name, bone.end * (0.5 if middle else 1.0), aside)]


def place_points(
    skeleton: Skeleton, bones: tuple[Bone, ...], points: tuple[Point, ...], rotations: Array, root: Array
) -> Array:
    """Return world positions (f, p, 3) of points of a pose: local rotations (f, j, 4) and root (f, 3)."""
    positions, world = world_transforms(skeleton, rotations, root)
    joints = [bones[p.bone].joint for p in points]
    return np.asarray(positions[:, joints] + quat.rotate(world[:, joints], np.array([p.offset for p in points])))


# All bodies have the world's axes in the rest pose, so the rotation of a body is the world rotation of its joint. Knees
# and elbows have two hinges (bend and twist); all other joints are spherical with a cone as limit, as in chapter 4 of
# the thesis on retargeting. Ankles are spherical too, because in a straddle they bend aside while the sole stays flat.

NOMINAL = 1000.0  # kg/m^3 at which springs are measured
LIMIT = 0.009  # seconds in which a joint returns from beyond its limit
_CHAINS = (  # in the engine's order: each body, then all below it
    ("HumanoidRoot", "vl5", "vt10", "vt4", "vc4", "skullbase"),
    *(("vt4", *(f"{s}_{n}" for n in ("sternoclavicular", "shoulder", "elbow", "radiocarpal"))) for s in "lr"),
    *(("HumanoidRoot", *(f"{s}_{n}" for n in ("hip", "knee", "talocrural"))) for s in "lr"),
)
_END = {"vt4": "vc4"}  # the child at the end of the bone, for joints with several children
# name without side: part of `style.PARTS`, radius in metres, cone of a spherical joint in degrees
_SHAPES = {
    "HumanoidRoot": ("pelvis", 0.105, 180.0),
    "vl5": ("spine", 0.100, 65.0),
    "vt10": ("spine", 0.105, 65.0),
    "vt4": ("chest", 0.105, 65.0),
    "vc4": ("head", 0.050, 75.0),
    "skullbase": ("head", 0.080, 85.0),
    "sternoclavicular": ("clavicles", 0.040, 45.0),
    "shoulder": ("arms", 0.042, 170.0),
    "elbow": ("arms", 0.034, 155.0),
    "radiocarpal": ("hands", 0.028, 130.0),
    "hip": ("thighs", 0.068, 140.0),
    "knee": ("shanks", 0.046, 155.0),
    "talocrural": ("feet", 0.030, 75.0),
}
_TIPS = {
    "skullbase": (0.0, 0.17, 0.0),
    "radiocarpal": 0.15,
    "talocrural": (0.0, -0.057, 0.115),
}  # leaves, metres
_HINGED = {"knee": (-8.0, 155.0, 12.0), "elbow": (-5.0, 155.0, 12.0)}  # degrees: bend, and twist both ways
FOOT_BOX = (0.045, 0.022, 0.120)  # half sizes of a foot, metres
HEEL = -0.060  # metres from the ankle to the heel, ahead
_FLOOR = 'type="plane" size="0 0 1" quat="0.70710678 -0.70710678 0 0" contype="1" conaffinity="2"'


@dataclass(frozen=True, slots=True)
class Bone:
    """One body of the ragdoll. joint : index in the skeleton; name : of the rig; parent : index of a bone, -1 for none

    end : (3,) from its joint to its end, metres, rest pose; hinge : axis of its bend, None for a spherical joint
    mass : kilograms at the nominal density
    """

    joint: int
    name: str
    parent: int
    part: str
    end: Array
    hinge: Array | None
    mass: float

    @property
    def along(self) -> Array:
        """The unit vector of the bone in the rest pose."""
        return np.asarray(self.end / np.linalg.norm(self.end))

    @property
    def outward(self) -> float:
        """1 for a left part, -1 for a right one, 0 in the middle."""
        return 1.0 if self.name.startswith("l_") else -1.0 if self.name.startswith("r_") else 0.0


def bones_of(skeleton: Skeleton) -> tuple[Bone, ...]:
    """Return the bodies of the ragdoll, parents before children; toes, eyes, lids, jaw and braid have none."""
    rest = skeleton.rest
    out: list[Bone] = []
    names: list[str] = []
    for chain in _CHAINS:
        for place, name in enumerate(chain):
            if name in names:
                continue
            bare = name[2:] if name[1] == "_" else name
            part, radius, _ = _SHAPES[bare]
            joint = skeleton.index(name)
            after = _END.get(name, chain[place + 1] if place + 1 < len(chain) else None)
            end = _tip(skeleton, name, bare) if after is None else rest[skeleton.index(after)] - rest[joint]
            parent = names.index(chain[place - 1]) if place else -1
            names.append(name)
            out.append(Bone(joint, name, parent, part, end, _hinge(bare, end), _mass(bare, radius, end)))
    return tuple(out)


def _tip(skeleton: Skeleton, name: str, bare: str) -> Array:
    if bare == "radiocarpal":
        along = skeleton.offsets[skeleton.index(f"{name[0]}_elbow")]
        return np.asarray(_TIPS[bare] * along / np.linalg.norm(along))
    return np.array(_TIPS[bare])


def _hinge(bare: str, end: Array) -> Array | None:
    return hinge_axis(bare, end) if bare in _HINGED else None


def _mass(bare: str, radius: float, end: Array) -> float:
    if bare == "talocrural":
        return NOMINAL * 8 * float(np.prod(FOOT_BOX))
    return NOMINAL * np.pi * radius**2 * (float(np.linalg.norm(end)) + 4 / 3 * radius)


def build(skeleton: Skeleton, bones: tuple[Bone, ...], points: tuple[Point, ...], style: Style, more: str = "") -> Any:
    """Build the engine's model: bodies, joints, sites, floor, and for each point three actuators of a spring-damper (x,
    y, z).

    The control of an actuator is kp times the target place plus kd times the target speed of its point.
    more : XML of the equality section
    """
    numbers = style.body
    actuators = "".join(_actuators(k, p, style) for k, p in enumerate(points))
    text = (
        f'<mujoco><compiler angle="degree"/><option timestep="{1 / numbers.update_rate:.9f}" '
        f'gravity="0 {-numbers.gravity:.6f} 0" integrator="implicitfast" cone="elliptic" iterations="30"/>'
        f'<default><geom contype="0" conaffinity="0"/></default>'
        f'<worldbody><site name="w"/><geom {_FLOOR} friction="{numbers.friction:.4f} 0.005 0.0001"/>'
        f"{_body(skeleton, bones, 0, points, style)}</worldbody><equality>{more}</equality>"
        f"<actuator>{actuators}</actuator></mujoco>"
    )
    from dancetutor_cli.dance.physics.style import engine

    return engine().MjModel.from_xml_string(text)


def _vector(values: Array) -> str:
    return " ".join(f"{v:.9g}" for v in values)


def _body(skeleton: Skeleton, bones: tuple[Bone, ...], index: int, points: tuple[Point, ...], style: Style) -> str:
    bone = bones[index]
    rest = skeleton.rest
    place = rest[bone.joint] if bone.parent < 0 else rest[bone.joint] - rest[bones[bone.parent].joint]
    sites = "".join(f'<site name="p{k}" pos="{_vector(p.offset)}"/>' for k, p in enumerate(points) if p.bone == index)
    inner = "".join(_body(skeleton, bones, k, points, style) for k, other in enumerate(bones) if other.parent == index)
    return (
        f'<body name="{bone.name}" pos="{_vector(place)}">{_joints(bone, style)}{_geom(bone, rest, style)}'
        f"{sites}{inner}</body>"
    )


def _joints(bone: Bone, style: Style) -> str:
    if bone.parent < 0:
        return "<freejoint/>"
    stiffness = style.stiffness.get(bone.name, style.body.stiffness)
    stiff = f'damping="{stiffness:.6g}" stiffness="{style.body.spring:.6g}" solreflimit="{LIMIT:g} 1"'
    limited = "true" if style.limits else "false"
    bare = bone.name[2:] if bone.name[1] == "_" else bone.name
    if bone.hinge is None:
        return f'<joint type="ball" {stiff} limited="{limited}" range="0 {_SHAPES[bare][2]}"/>'
    low, high, twist = _HINGED[bare]
    return (
        f'<joint type="hinge" axis="{_vector(bone.hinge)}" {stiff} limited="{limited}" range="{low} {high}"/>'
        f'<joint type="hinge" axis="{_vector(bone.along)}" {stiff} limited="{limited}" range="{-twist} {twist}"/>'
    )


def _geom(bone: Bone, rest: Array, style: Style) -> str:
    density = f'density="{style.density[bone.part]:.6g}"'
    bare = bone.name[2:] if bone.name[1] == "_" else bone.name
    if bare == "talocrural":
        rubs = f'friction="{style.body.friction:.4f} 0.005 0.0001" contype="2" conaffinity="1"'
        low, ball = FOOT_BOX[1] - rest[bone.joint][1], bone.end[2]
        parts = ((HEEL, ball, rubs), (ball, HEEL + 2 * FOOT_BOX[2], ""))  # toes bend where they touch the ground
        return "".join(
            f'<geom type="box" size="{FOOT_BOX[0]} {FOOT_BOX[1]} {abs(b - a) / 2:.9g}" '
            f'pos="0 {low:.9g} {(a + b) / 2:.9g}" {density} {more}/>'
            for a, b, more in parts
        )
    return f'<geom type="capsule" size="{_SHAPES[bare][1]}" fromto="0 0 0 {_vector(bone.end)}" {density}/>'


def _actuators(index: int, point: Point, style: Style) -> str:
    kp, kd = point.gains(style)
    out = []
    for axis in range(3):
        gear = " ".join("1" if k == axis else "0" for k in range(6))
        out.append(
            f'<general site="p{index}" refsite="w" gear="{gear}" gaintype="fixed" gainprm="1" biastype="affine" '
            f'biasprm="0 {-kp[axis]:.9g} {-kd[axis]:.9g}"/>'
        )
    return "".join(out)


def pose_of(bones: tuple[Bone, ...], turns: Array, root: Array) -> Array:
    """Return the engine's generalised positions (f, q) from local rotations (f, b, 4) of the bones and root (f, 3)."""
    out = [root, turns[:, 0]]
    for k, bone in enumerate(bones[1:], 1):
        out += [turns[:, k]] if bone.hinge is None else [bend_and_twist(bone, turns[:, k])]
    return np.concatenate(out, axis=1)


def bend_and_twist(bone: Bone, turns: Array) -> Array:
    """Return the angles (f, 2) in radians of a hinged joint: about its hinge, and about the bone."""
    assert bone.hinge is not None
    swing, twist = quat.swing_twist(turns, bone.along)
    return np.column_stack([_angle(swing, bone.hinge), _angle(twist, bone.along)])


def _angle(q: Array, axis: Array) -> Array:
    angle = 2.0 * np.arctan2(q[:, 1:] @ axis, q[:, 0])
    return np.asarray((angle + np.pi) % (2 * np.pi) - np.pi)


def turns_of(bones: tuple[Bone, ...], poses: Array) -> Array:
    """Return local rotations (f, b, 4) of the bones from generalised positions (f, q)."""
    out = [poses[:, 3:7]]
    at = 7
    for bone in bones[1:]:
        if bone.hinge is None:
            out.append(poses[:, at : at + 4])
            at += 4
        else:
            bend = quat.from_axis_angle(bone.hinge, poses[:, at])
            out.append(quat.multiply(bend, quat.from_axis_angle(bone.along, poses[:, at + 1])))
            at += 2
    return quat.normalize(np.stack(out, axis=1))
