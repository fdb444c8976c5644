"""A small character and poses for the tests of the renderers. Run it to write the golden frames again."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from dancetutor_cli.character.mesh import Character, Material, Mesh
from dancetutor_cli.dance.rig.body import joint_matrices
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.film.scene.scene import FrameState, Scene

GOLDEN = Path(__file__).resolve().parent.parent / "data" / "golden"
SIZE = (160, 90)
FACE = (1.0, 0.0, 0.0, 1.0)  # the front of the head; nothing else is red
_BONES = (  # joint, the joint it ends at, radius
    ("l_hip", "l_knee", 0.07), ("l_knee", "l_talocrural", 0.055), ("l_talocrural", "l_metatarsal", 0.045),
    ("r_hip", "r_knee", 0.07), ("r_knee", "r_talocrural", 0.055), ("r_talocrural", "r_metatarsal", 0.045),
    ("HumanoidRoot", "vt10", 0.12), ("vt10", "vc4", 0.13),
    ("l_shoulder", "l_elbow", 0.045), ("l_elbow", "l_radiocarpal", 0.04),
    ("r_shoulder", "r_elbow", 0.045), ("r_elbow", "r_radiocarpal", 0.04),
)  # fmt: skip


def _ball(centre, radii, joint, sides=12, rings=7):
    """An ellipsoid: positions, normals, triangles."""
    points, normals = [], []
    for r in range(rings + 1):
        for s in range(sides + 1):
            a, b = math.pi * r / rings, 2 * math.pi * s / sides
            n = np.array([math.sin(a) * math.sin(b), math.cos(a), math.sin(a) * math.cos(b)])
            points.append(np.asarray(centre) + n * radii)
            scaled = n / np.asarray(radii)
            normals.append(scaled / np.linalg.norm(scaled))
    triangles = []
    for r in range(rings):
        for s in range(sides):
            a, b = r * (sides + 1) + s, (r + 1) * (sides + 1) + s
            triangles += [(a, b, b + 1), (a, b + 1, a + 1)]
    return points, normals, triangles, [joint] * len(points)


def _tube(start, end, radius, joint):
    """A rounded bone: an ellipsoid turned so that its poles lie beyond both ends."""
    points, normals, triangles, joints = _ball((0, 0, 0), (radius, 1.0, radius), joint)
    axis = np.asarray(end) - np.asarray(start)
    length = np.linalg.norm(axis)
    y = axis / length
    x = np.cross(y, [0.0, 0.0, 1.0] if abs(y[2]) < 0.9 else [1.0, 0.0, 0.0])
    x /= np.linalg.norm(x)
    turn = np.stack([x, y, np.cross(x, y)], axis=1)
    half = length / 2 + radius / 2
    middle = (np.asarray(start) + np.asarray(end)) / 2
    placed = [middle + turn @ (p * [1.0, half, 1.0]) for p in points]
    turned = [turn @ (n * [1.0, 1.0 / half, 1.0]) for n in normals]
    return placed, [n / np.linalg.norm(n) for n in turned], triangles, joints


def _mesh(name, parts, material):
    points, normals, triangles, joints, first = [], [], [], [], 0
    for p, n, t, j in parts:
        points += p
        normals += n
        triangles += [(a + first, b + first, c + first) for a, b, c in t]
        joints += j
        first += len(p)
    count = len(points)
    uv = np.stack([np.linspace(0, 3, count), np.linspace(0, 5, count)], axis=1)
    rigid = np.zeros((count, 4))
    rigid[:, 0] = joints
    weights = np.zeros((count, 4))
    weights[:, 0] = 1.0
    return Mesh(
        name, np.array(points, np.float32), np.array(normals, np.float32), uv.astype(np.float32),
        np.array(triangles, np.int32), rigid.astype(np.uint16), weights.astype(np.float32), material,
    )  # fmt: skip


def capsule_character() -> Character:
    """A body of ellipsoids: a checked body, a plain head with a red face on its front (+Z)."""
    skeleton = dancer_skeleton()
    rest, index = skeleton.rest, skeleton.index
    texture = np.array([[[90, 120, 220, 255], [250, 250, 250, 255]], [[250, 250, 250, 255], [60, 80, 160, 255]]])
    body = [_tube(rest[index(a)], rest[index(b)], radius, index(a)) for a, b, radius in _BONES]
    skull = index("skullbase")
    head = rest[skull] + [0.0, 0.08, 0.0]
    inverse = np.tile(np.eye(4), (len(skeleton.names), 1, 1))
    inverse[:, :3, 3] = -rest
    return Character(
        "capsules",
        skeleton,
        (
            _mesh("body", body, Material("checks", (1.0, 1.0, 1.0, 1.0), texture.astype(np.uint8))),
            _mesh("head", [_ball(head, (0.09, 0.11, 0.09), skull)], Material("skin", (0.9, 0.75, 0.65, 1.0))),
            _mesh("face", [_ball(head + np.array([0, 0, 0.06]), (0.06, 0.07, 0.05), skull)], Material("face", FACE)),
        ),
        inverse,
    )


def pose(character: Character, kind: str = "stand"):
    """World matrices of the joints in a pose: stand, step (left foot on the left panel), jump, leap (in the air)."""
    skeleton = character.skeleton
    rotations = np.zeros((1, len(skeleton.names), 4))
    rotations[..., 0] = 1.0
    root = skeleton.rest[:1].copy()

    def turn(name, axis, degrees):
        half = math.radians(degrees) / 2
        rotations[0, skeleton.index(name)] = [math.cos(half), *(math.sin(half) * np.eye(3)["xyz".index(axis)])]

    if kind == "step":
        turn("l_hip", "z", 16)
        turn("r_hip", "x", -15)
        turn("r_knee", "x", 35)
        turn("r_shoulder", "z", -30)
        root[0, 1] -= 0.02
    if kind == "jump":
        root[0, 1] += 0.15
        for side, sign in (("l", 1), ("r", -1)):
            turn(f"{side}_hip", "z", 14 * sign)
            turn(f"{side}_shoulder", "z", 120 * sign)
    if kind == "leap":  # higher than she jumps (8 cm), arms wider than she holds them (wrists 0.45 m aside)
        root[0, 1] += 0.11
        for side, sign in (("l", 1), ("r", -1)):
            turn(f"{side}_hip", "z", 14 * sign)
            turn(f"{side}_shoulder", "z", 25 * sign)
    return joint_matrices(skeleton, rotations, root)[0]


def scene(steps_type: str = "dance-single") -> Scene:
    """The capsule character on a pad."""
    pad = load_pad(steps_type)
    assert pad is not None
    return Scene(capsule_character(), pad)


def state(the_scene: Scene, kind="stand", camera="back", size=SIZE, lit=None, by=None) -> FrameState:
    """One frame; lit and by as (column, level) and (column, limb) pairs."""
    level, limb = np.zeros(the_scene.panels), np.zeros(the_scene.panels, dtype=np.int64)
    for column, value in lit or ():
        level[column] = value
    for column, value in by or ():
        limb[column] = value
    joints = None if kind is None else pose(the_scene.character, kind)
    return FrameState(joints, the_scene.camera(camera, size), level, limb)


GOLDENS = {  # name: (steps type, quality, pose, camera, lit, by)
    "back_step": ("dance-single", "good", "step", "back", [(0, 1.0), (3, 0.4)], [(3, 1)]),
    "front_jump": ("dance-single", "good", "jump", "front", [(0, 0.7), (3, 0.7)], [(3, 1)]),
    "three_quarter_draft": ("dance-single", "draft", "stand", "three-quarter", [(1, 1.0)], [(1, 2)]),
    "double_best": ("dance-double", "best", "step", "back", [(4, 1.0)], []),
    "pump_top": ("pump-single", "good", "step", "top", [(2, 1.0)], [(2, 1)]),
}


def golden_frame(name: str):
    """The frame of one golden file, uint8 (90, 160, 3)."""
    from dancetutor_cli.film.scene.renderer import create

    steps_type, quality, kind, camera, lit, by = GOLDENS[name]
    the_scene = scene(steps_type)
    return create(the_scene, SIZE, quality, "cpu").frame(state(the_scene, kind, camera, SIZE, lit, by))


if __name__ == "__main__":
    from PIL import Image

    GOLDEN.mkdir(parents=True, exist_ok=True)
    for golden in GOLDENS:
        Image.fromarray(golden_frame(golden)).save(GOLDEN / f"frame_{golden}.png")
