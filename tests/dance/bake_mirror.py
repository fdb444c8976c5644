"""Mirror images, left for right: of a play, and of a motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.play import Play

OTHER = np.array([Limb.RIGHT_FOOT, Limb.LEFT_FOOT, Limb.RIGHT_HAND, Limb.LEFT_HAND], dtype=np.int8)
PARTS = {
    "root": ("HumanoidRoot",),
    "legs": ("hip", "knee", "talocrural", "metatarsal"),
    "spine": ("vl5", "vt10", "vt4", "vc4", "skullbase"),
    "arms": ("sternoclavicular", "shoulder", "elbow", "radiocarpal"),
    "gaze": ("eyeball_joint", "eyelid_joint"),
}


def mirrored_play(play: Play, columns: NDArray[np.int64]) -> Play:
    """The play of the mirrored chart by mirrored feet. columns : of each column its mirror image."""
    rows = play.rows
    image = replace(
        rows, steps=rows.steps[:, columns], hold_end=rows.hold_end[:, columns], mines=rows.mines[:, columns]
    )
    limb = play.limb[:, columns]
    feet = play.feet[:, ::-1]
    return replace(
        play,
        rows=image,
        limb=np.where(limb >= 0, OTHER[np.maximum(limb, 0)], limb).astype(np.int8),
        part=play.part[:, columns],
        feet=np.where(feet >= 0, columns[np.maximum(feet, 0)], feet).astype(np.int16),
        facing=-play.facing,
    )


def mirrored_motion(motion: Motion) -> Motion:
    """The motion seen in a mirror: x changes its sign, left and right joints change places."""
    names = motion.skeleton.names
    swap = {"l_": "r_", "r_": "l_"}
    image = [names.index(swap[n[:2]] + n[2:]) if n[:2] in swap else k for k, n in enumerate(names)]
    return replace(
        motion, rotations=motion.rotations[:, image] * [1.0, 1.0, -1.0, -1.0], root=motion.root * [-1.0, 1.0, 1.0]
    )


def apart(a: Motion, b: Motion) -> dict[str, tuple[float, float]]:
    """How far two motions with the same keys are apart at most, by part of the body: millimetres and degrees."""
    np.testing.assert_allclose(a.times, b.times, atol=1e-9)
    (places, turns), (others, other_turns) = (world_transforms(m.skeleton, m.rotations, m.root) for m in (a, b))
    far = 1000 * np.linalg.norm(places - others, axis=2)
    angle = np.degrees(2 * np.arccos(np.clip(np.abs(np.sum(turns * other_turns, axis=2)), 0.0, 1.0)))
    out = {}
    for part, ends in PARTS.items():
        joints = [k for k, name in enumerate(a.skeleton.names) if name.endswith(ends)]
        assert joints
        out[part] = float(far[:, joints].max()), float(angle[:, joints].max())
    return out
