"""The simulation: springs and dampers draw the ragdoll after the points of the input, step by step.

Forces are actuators of the engine (implicitfast), which sees the place that a point has in this very step: forces set
from outside before a plain step are one step old, and that explodes at 240 Hz.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.errors import DancetutorError
from dancetutor_cli.physics.backend import engine
from dancetutor_cli.physics.points import Point, place_points
from dancetutor_cli.physics.ragdoll import Bone, build, pose_of, turns_of
from dancetutor_cli.physics.style import Style
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.skeleton import Skeleton

if TYPE_CHECKING:
    from dancetutor_cli.physics.actors import Actor

Array = NDArray[np.float64]
PIECE = 2400  # steps whose targets are held at once


@dataclass(frozen=True, slots=True)
class Ragdoll:
    """A skeleton with its bodies and points, and the style in which they follow."""

    skeleton: Skeleton
    bones: tuple[Bone, ...]
    points: tuple[Point, ...]
    style: Style


def simulate(
    ragdoll: Ragdoll, rotations: Array, root: Array, start: float, actors: Sequence[Actor] = ()
) -> tuple[Array, Array]:
    """Let the ragdoll follow.

    Parameters
    ----------
    rotations : (f, j, 4) local, and root : (f, 3), of the input at the style's update rate; start : second of the first
    actors : what else acts on it

    Returns
    -------
    local rotations (f, j, 4), those of joints without a body as in the input, and root (f, 3)

    Raises
    ------
    DancetutorError with time and joint where the simulation fails.
    """
    mujoco, bones, points = engine(), ragdoll.bones, ragdoll.points
    model = build(ragdoll.skeleton, bones, points, ragdoll.style, "".join(a.constraints for a in actors))
    data = mujoco.MjData(model)
    joints = [bone.joint for bone in bones]
    poses = pose_of(bones, rotations[:2, joints], root[:2])
    data.qpos[:] = poses[0]
    mujoco.mj_differentiatePos(model, data.qvel, float(model.opt.timestep), poses[0], poses[-1])
    rate = ragdoll.style.numbers.update_rate
    gains = [p.gains(ragdoll.style) for p in points]
    kp, kd = (np.array([g[k] for g in gains]) for k in (0, 1))
    forces = _forces(ragdoll)
    out = np.empty((len(root), model.nq))
    pelvis = data.xfrc_applied[1:]
    for first in range(0, len(root), PIECE):
        last = min(first + PIECE, len(root))
        low, high = max(first - 1, 0), min(last + 1, len(root))
        places = place_points(ragdoll.skeleton, bones, points, rotations[low:high], root[low:high])
        speed = np.gradient(places, 1.0 / rate, axis=0) if len(places) > 1 else np.zeros_like(places)
        part = slice(first - low, last - low)
        pull, drag = ((k * v)[part].reshape(last - first, -1) for k, v in ((kp, places), (kd, speed)))
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


def _forces(ragdoll: Ragdoll) -> Array:
    """External force (b, 3) on each body in the pelvis's axes, newtons; a part's force is shared by its bodies."""
    bones, style = ragdoll.bones, ragdoll.style
    out = []
    for bone in bones:
        x, y, z = style.force[bone.part]
        sharing = sum(b.part == bone.part and b.outward == bone.outward for b in bones)
        out.append(np.array([x * (bone.outward or 1.0), y, z]) / sharing)
    return np.array(out)


def _failed(ragdoll: Ragdoll, model: Any, data: Any, second: float) -> DancetutorError:
    """The engine says which degree of freedom broke, with warnings of its positions, speeds and accelerations."""
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
