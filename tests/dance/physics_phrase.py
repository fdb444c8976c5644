"""A short phrase made of sines, for tests that let a ragdoll follow it."""

import numpy as np

from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton

X, Y, Z = np.eye(3)


def phrase(seconds: float = 2.0, straight: bool = False, fps: int = 60) -> Motion:
    """Treading on the spot, 2 cm over the floor: knees, arms, forearms and head turn; `straight` keeps the knees so."""
    skeleton = dancer_skeleton()
    t = np.arange(round(seconds * fps) + 1) / fps
    w = 2 * np.pi * t
    rotations = np.zeros((len(t), len(skeleton.names), 4))
    rotations[..., 0] = 1

    def turn(name: str, axis: np.ndarray, degrees: np.ndarray | float) -> None:
        j = skeleton.index(name)
        angle = np.broadcast_to(np.radians(degrees), t.shape)
        rotations[:, j] = quat.multiply(rotations[:, j], quat.from_axis_angle(axis, angle))

    for s, sign in (("l", 1), ("r", -1)):
        bend = 1.0 + 0.0 * t if straight else 45 + 40 * np.sin(w) * sign
        turn(f"{s}_hip", X, -bend / 2)
        turn(f"{s}_knee", X, bend)
        turn(f"{s}_talocrural", X, -bend / 2)
        turn(f"{s}_shoulder", X, 25 * sign * np.sin(w))
        arm = skeleton.offsets[skeleton.index(f"{s}_elbow")]
        turn(f"{s}_elbow", np.cross(arm, Z), 40 + 25 * np.sin(1.3 * w))
        turn(f"{s}_radiocarpal", arm, 50 * np.sin(1.5 * w))
    turn("vl5", Y, 12 * np.sin(w))
    turn("vt10", X, 8 + 6 * np.sin(2 * w))
    turn("skullbase", Y, 25 * np.sin(0.7 * w))
    root = np.column_stack((0.05 * np.sin(w / 2), 0.96 + 0.02 * np.sin(2 * w), 0.03 * np.cos(w / 2)))
    return Motion(skeleton, float(fps), t, rotations, root, ())
