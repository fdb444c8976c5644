"""What acts on a ragdoll while it follows, beside its springs: joints of the soles that hold and break, stiff knees."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.physics.plants import Plants
from dancetutor_cli.rig import quaternion as quat
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.soles import sole_points

if TYPE_CHECKING:
    from dancetutor_cli.physics.simulation import Ragdoll

Array = NDArray[np.float64]
NEAR = 0.008  # metres over the floor at which a corner of a sole gets a joint
SLOW, AIMED = 0.6, 0.03  # m/s and metres: only where the input's corner moves no faster, and is no higher
HOLD, LIFT = 600.0, 60.0  # newtons along the floor and off it at which a corner's joint breaks
KNEE = 10.0  # degrees of bend below which a knee is damped: an inner angle of 170 degrees
DAMPING = 8.0  # N m s/rad at a straight knee


class Actor(ABC):
    """Takes part in a simulation. `constraints` : XML of the engine's equality section"""

    constraints = ""

    @abstractmethod
    def before(self, model: Any, data: Any, step: int) -> None:
        """Called before each step of the engine."""

    def springs(self, step: int) -> tuple[Array, Array] | None:
        """Parts of kp and kd (a,) that the actuators have in a step; None: all of them."""
        return None


class StiffKnees(Actor):
    """Knees damped from 170 degrees on, so that they do not pop: rotations beyond are possible, but slow."""

    def __init__(self, ragdoll: Ragdoll) -> None:
        self.names = [f"{s}_knee" for s in "lr"]
        self.base = ragdoll.style.numbers.stiffness
        self.places: list[tuple[int, int]] = []

    def before(self, model: Any, data: Any, step: int) -> None:
        """Set the damping of both knees' bends."""
        if not self.places:
            for name in self.names:
                joint = int(model.body(name).jntadr[0])
                self.places.append((int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint])))
        for angle, speed in self.places:
            bend = np.degrees(data.qpos[angle])
            model.dof_damping[speed] = self.base + DAMPING * min(max(1.0 - bend / KNEE, 0.0), 1.0)


class BreakableSoles(Actor):
    """Four joints between each foot's corners and the floor: made where the sole touches it, broken by too much force.

    Which of them held in which step is `plants`.
    """

    def __init__(self, ragdoll: Ragdoll, rotations: Array, root: Array) -> None:
        skeleton = ragdoll.skeleton
        rest = skeleton.rest
        positions, world = world_transforms(skeleton, rotations, root)
        bodies = [bone.name for bone in ragdoll.bones]
        self.bodies: list[int] = []
        self.offsets, targets, lines = [], [], []
        for side, points in zip("lr", sole_points(skeleton), strict=True):
            ankle = skeleton.index(f"{side}_talocrural")
            for point in points[:4]:  # heel in, heel out, ball in, ball out
                offset = rest[point.joint] + point.offset - rest[ankle]
                self.bodies.append(bodies.index(f"{side}_talocrural") + 1)  # body 0 is the world
                self.offsets.append(offset)
                targets.append(positions[:, ankle] + quat.rotate(world[:, ankle], offset))
                anchor = " ".join(f"{x:.9g}" for x in offset)
                lines.append(
                    f'<connect body1="{side}_talocrural" anchor="{anchor}" active="false" solref="0.012 1" '
                    'solimp="0.95 0.99 0.001"/>'
                )
        self.constraints = "".join(lines)
        self.aimed = np.stack(targets, axis=1)
        speed = np.gradient(self.aimed, 1.0 / ragdoll.style.numbers.update_rate, axis=0)
        self.slow = (np.linalg.norm(speed[..., [0, 2]], axis=2) < SLOW) & (self.aimed[..., 1] < AIMED)
        self.held = np.zeros(self.slow.shape, dtype=bool)

    def before(self, model: Any, data: Any, step: int) -> None:
        """Break joints that too much force pulls at, make those whose corners touch the floor."""
        active = np.flatnonzero(data.eq_active)
        for place, corner in enumerate(active.tolist()):
            x, y, z = data.efc_force[3 * place : 3 * place + 3] if data.nefc >= 3 * place + 3 else (0.0, 0.0, 0.0)
            leaves = not self.slow[step, corner] and self.aimed[step, corner, 1] > AIMED
            if leaves or np.hypot(x, z) > HOLD or -y > LIFT:
                data.eq_active[corner] = 0
        for corner in np.flatnonzero(self.slow[step] & (data.eq_active == 0)).tolist():
            body = self.bodies[corner]
            matrix = data.xmat[body].reshape(3, 3)
            place = data.xpos[body] + matrix @ self.offsets[corner]
            if place[1] < NEAR:
                model.eq_data[corner, 3:6] = place
                data.eq_active[corner] = 1
        self.held[step] = data.eq_active != 0

    def plants(self) -> Plants:
        """Which ends of both feet were held in each step."""
        held = self.held.reshape(-1, 2, 2, 2)  # step, foot, heel or ball, in or out
        either = held[..., 0] | held[..., 1]
        return Plants(either[:, :, 0], either[:, :, 1])
