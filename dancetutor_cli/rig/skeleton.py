"""The dancer's joints: H-Anim names, hierarchy and rest positions.

World: metres, +Y up, the dancer looks to +Z, so her left is +X. The pad's surface is y = 0. Rest pose: standing
upright, feet parallel, arms in an A pose 45 degrees down in the frontal plane, palms facing the thighs. In the rest
pose every local rotation is the identity and every joint's axes are the world's.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Skeleton:
    """A joint tree. j joints, parents before children, joint 0 the root.

    names : H-Anim names; parents : int32 (j,), -1 for the root
    offsets : float64 (j, 3), rest position relative to the parent (the root: to the world), metres
    """

    names: tuple[str, ...]
    parents: NDArray[np.int32]
    offsets: NDArray[np.float64]

    def index(self, name: str) -> int:
        """Index of a joint; ValueError if there is none of that name."""
        return self.names.index(name)

    @property
    def rest(self) -> NDArray[np.float64]:
        """Rest position of every joint in the world, (j, 3)."""
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
    """The skeleton of the project's own dancer: 1.70 m tall, 35 joints."""
    world: dict[str, tuple[str | None, tuple[float, float, float]]] = {n: (p, x) for n, p, x in _MIDDLE}
    for name, parent, (x, y, z) in _LEFT_SIDE:
        world[name] = (parent, (x, y, z))
        mirrored = parent.replace("l_", "r_", 1) if parent.startswith("l_") else parent
        world[name.replace("l_", "r_", 1)] = (mirrored, (-x, y, z))
    parents = np.array([-1 if (p := world[n][0]) is None else ORDER.index(p) for n in ORDER], dtype=np.int32)
    rest = np.array([world[n][1] for n in ORDER])
    offsets = rest.copy()
    offsets[1:] -= rest[parents[1:]]
    return Skeleton(ORDER, parents, offsets)
