"""The simulation: springs and dampers pull the ragdoll after its points. Also a second-order follower, and the goals of
the remaining distances.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from dancetutor_cli.dance.physics.ragdoll import Bone, Point, build, place_points, pose_of, turns_of
from dancetutor_cli.dance.physics.style import Follower, Style, engine
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.dance.smoothing import recursive_filter
from dancetutor_cli.dance.units import Array
from dancetutor_cli.run.errors import DancetutorError

if TYPE_CHECKING:
    from dancetutor_cli.dance.physics.pushes import Actor


MEAN, DEVIATION, LARGEST = 0.9, 0.5, 3.5  # goals of the distances of the points, centimetres

# A second-order follower gives a motion weight, sloppiness or snap, as an animator does.
#
# y + k1 y' + k2 y'' = x + k3 x', with k1 = z / (pi f), k2 = 1 / (2 pi f)^2, k3 = r z / (2 pi f). Frequency f is how
# quickly it follows, damping z how much it swings after, response r how it starts (0: slowly; above 1: it overshoots;
# negative: it first goes the other way). It is sampled with the bilinear rule, which is stable at any frequency.

_TRUNK = ("chest", "head")
_JOINTS = {
    "chest": ("vl5", "vt10", "vt4"),
    "head": ("vc4", "skullbase"),
    "arms": tuple(f"{s}_{n}" for s in "lr" for n in ("sternoclavicular", "shoulder", "elbow", "radiocarpal")),
}


def follower_path(values: Array, rate: float, follower: Follower) -> Array:
    """Return the path x (f, d), evenly sampled at `rate`, behind the follower, which is at rest in the first frame.

        y + k1 y' + k2 y'' = x + k3 x' ,    k1 = 2 z / w ,  k2 = 1 / w^2 ,  k3 = r z / w ,  w = 2 pi f

    with f, z, r of `Follower`; d/dt becomes 2 rate (1 - q) / (1 + q), q a delay by one frame (Tustin's bilinear rule).
    """
    omega = 2 * np.pi * follower.frequency
    k1, k2 = 2 * follower.damping / omega, 1.0 / omega**2
    k3 = follower.response * follower.damping / omega
    s = 2.0 * rate  # bilinear: d/dt becomes s (1 - 1/z) / (1 + 1/z)
    above = np.array([1 + k3 * s, 2.0, 1 - k3 * s])
    below = np.array([1 + k1 * s + k2 * s * s, 2 - 2 * k2 * s * s, 1 - k1 * s + k2 * s * s])
    return np.asarray(recursive_filter(above, below, values - values[0]) + values[0])


def follow_all(skeleton: Skeleton, rotations: Array, root: Array, style: Style) -> tuple[Array, Array]:
    """Return the ragdoll's targets (f, j, 4), (f, 3): the input at the update rate behind the style's followers."""
    rate, given = style.body.update_rate, rotations
    rotations = given.copy()
    for part in _TRUNK:
        if part in style.follower:
            for joint in (skeleton.index(name) for name in _JOINTS[part]):
                rotations[:, joint] = _followed(given[:, joint], rate, style.follower[part])
    if "pelvis" in style.follower:
        root = follower_path(root, rate, style.follower["pelvis"])
        rotations[:, 0] = _followed(given[:, 0], rate, style.follower["pelvis"])
    if "arms" in style.follower:
        _arms(skeleton, given, rotations, rate, style.follower["arms"])
    return rotations, root


def _arms(skeleton: Skeleton, given: Array, rotations: Array, rate: float, follower: Follower) -> None:
    """Filter arms in the frame of the turning body, in place, because they compensate the present movement of the
    trunk.

    Shoulders that did this some frames later or earlier would throw the hands about.
    """
    nowhere = np.zeros((len(given), 3))
    turned, world = (world_transforms(skeleton, turns, nowhere)[1] for turns in (given, rotations))
    heading = quat.continuous(quat.swing_twist(given[:, 0], quat.UP)[1])
    for joint in (skeleton.index(name) for name in _JOINTS["arms"]):
        seen = quat.multiply(quat.conjugate(heading), turned[:, joint])
        world[:, joint] = quat.multiply(heading, _followed(seen, rate, follower))
        parent = world[:, skeleton.parents[joint]]
        rotations[:, joint] = quat.multiply(quat.conjugate(parent), world[:, joint])


def _followed(turns: Array, rate: float, follower: Follower) -> Array:
    """Return turns (f, 4) behind a follower."""
    return quat.normalize(follower_path(quat.continuous(turns), rate, follower))


# Forces are actuators of the engine (implicitfast), which uses the place of a point in the present step. Forces that
# are set from outside before a plain step are one step old, and the simulation explodes at 240 Hz.

PIECE = 2400  # number of steps whose targets are in memory at once


@dataclass(frozen=True, slots=True)
class Ragdoll:
    """A skeleton with its bodies and points, and the style in which they follow the input."""

    skeleton: Skeleton
    bones: tuple[Bone, ...]
    points: tuple[Point, ...]
    style: Style


def simulate(
    ragdoll: Ragdoll, rotations: Array, root: Array, start: float, actors: Sequence[Actor] = ()
) -> tuple[Array, Array]:
    """Let the ragdoll follow: M(q) q'' + c(q, q') = J^T f + tau, in steps of the engine, with on each point

        f = kp (x_target - x) + kd (x_target' - x') ,    kp = m (2 pi w)^2 ,  kd = 2 z m 2 pi w

    x : the point on its body, x_target : on the input; m, w, z : mass, frequency and damping of `style.Spring` (the
    second thesis, chapter 4); tau : springs and dampers of joints, gravity, contacts and the style's forces.

    Parameters
    ----------
    rotations : (f, j, 4) local, and root : (f, 3), of the input at the style's update rate; start : second of the first
    actors : other forces and constraints

    Returns
    -------
    local rotations (f, j, 4), with the input's rotations for joints without a body, and root (f, 3)

    Raises
    ------
    DancetutorError with time and joint where the simulation fails.
    """
    mujoco, bones = engine(), ragdoll.bones
    model = build(ragdoll.skeleton, bones, ragdoll.points, ragdoll.style, "".join(a.constraints for a in actors))
    data = mujoco.MjData(model)
    joints = [bone.joint for bone in bones]
    poses = pose_of(bones, rotations[:2, joints], root[:2])
    data.qpos[:] = poses[0]
    mujoco.mj_differentiatePos(model, data.qvel, float(model.opt.timestep), poses[0], poses[-1])
    rate = ragdoll.style.body.update_rate
    forces = _forces(ragdoll)
    out = np.empty((len(root), model.nq))
    pelvis = data.xfrc_applied[1:]
    for first in range(0, len(root), PIECE):
        last = min(first + PIECE, len(root))
        pull, drag = _pulls(ragdoll, rotations, root, (first, last))
        pushed = quat.rotate(rotations[first:last, joints[0]][:, None], forces)
        for step in range(first, last):
            out[step] = data.qpos
            stiff = next((s for s in (actor.springs(step) for actor in actors) if s is not None), None)
            here = step - first
            data.ctrl[:] = pull[here] + drag[here] if stiff is None else stiff[0] * pull[here] + stiff[1] * drag[here]
            pelvis[:, :3] = pushed[step - first]
            for actor in actors:
                actor.before(model, data, step)
            mujoco.mj_step(model, data)
            if any(warning.number for warning in data.warning):
                raise _failed(ragdoll, model, data, start + step / rate)
    if not np.isfinite(out).all():
        raise _failed(ragdoll, model, data, start + int(np.argmin(np.isfinite(out).all(axis=1))) / rate)
    turned = rotations.copy()
    turned[:, joints] = turns_of(bones, out)
    return turned, out[:, :3].copy()


def _pulls(ragdoll: Ragdoll, rotations: Array, root: Array, frames: tuple[int, int]) -> tuple[Array, Array]:
    """Return the parts kp x_target and kd x_target' of the force on each point, newtons, from a frame to another.

    Each is (n, p) for n frames and the 3 coordinates of all points, one after the other.
    """
    first, last = frames
    low, high = max(first - 1, 0), min(last + 1, len(root))
    places = place_points(ragdoll.skeleton, ragdoll.bones, ragdoll.points, rotations[low:high], root[low:high])
    rate = ragdoll.style.body.update_rate
    speed = np.gradient(places, 1.0 / rate, axis=0) if len(places) > 1 else np.zeros_like(places)
    gains = [p.gains(ragdoll.style) for p in ragdoll.points]
    kp, kd = (np.array([g[k] for g in gains]) for k in (0, 1))
    part = slice(first - low, last - low)
    return (kp * places)[part].reshape(last - first, -1), (kd * speed)[part].reshape(last - first, -1)


def _forces(ragdoll: Ragdoll) -> Array:
    """Return the external force (b, 3) on each body in the pelvis's axes, newtons; bodies of a part share its force."""
    bones, style = ragdoll.bones, ragdoll.style
    out = []
    for bone in bones:
        x, y, z = style.force[bone.part]
        sharing = sum(b.part == bone.part and b.outward == bone.outward for b in bones)
        out.append(np.array([x * (bone.outward or 1.0), y, z]) / sharing)
    return np.array(out)


def _failed(ragdoll: Ragdoll, model: Any, data: Any, second: float) -> DancetutorError:
    """Return the error with the joint that failed, by the engine's warnings of positions, speeds and accelerations."""
    kinds = engine().mjtWarning
    name = ragdoll.bones[0].name
    for kind in (kinds.mjWARN_BADQACC, kinds.mjWARN_BADQVEL):
        warning = data.warning[int(kind)]
        if warning.number:
            body = int(model.dof_bodyid[min(max(warning.lastinfo, 0), model.nv - 1)])
            name = ragdoll.bones[body - 1].name  # body 0 is the world
    return DancetutorError(
        f"style {ragdoll.style.name}: the simulation fails at {second:.3f} s, joint {name}; "
        "lower the frequencies of its springs or its forces, or raise body.update_rate"
    )
