"""What stands on the stage with the dancer: the bar behind the pad, drawn with her so that either hides the other."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.mesh import Character, Material, Mesh

if TYPE_CHECKING:
    from dancetutor_cli.motion.baked import Bar

Array = NDArray[np.float64]
JOINT = "bar"  # name of the joint that the bar hangs on; it never moves
STEEL = (0.62, 0.66, 0.74, 1.0)
SIDES, CORNER = 12, 6  # of the tube; pieces of a rounded corner
ROUND = 0.10  # metres, radius of the corners


def with_bar(character: Character, bar: Bar | None, floor: float) -> Character:
    """The character and, on a joint of its own, the bar, down to the height `floor` in metres; without a bar as it was.

    The joint's place in the world is `bar_matrix`, whatever the dancer does.
    """
    if bar is None:
        return character
    skeleton, joint = character.skeleton, len(character.skeleton.names)
    grown = replace(
        skeleton,
        names=(*skeleton.names, JOINT),
        parents=np.append(skeleton.parents, 0).astype(skeleton.parents.dtype),
        offsets=np.vstack((skeleton.offsets, [_middle(bar) - skeleton.rest[0]])),
    )
    inverse = np.linalg.inv(bar_matrix(bar))[None]
    meshes = tuple(_tube(middle_line(bar, span, floor), bar.radius, joint, k) for k, span in enumerate(bar.spans))
    return replace(
        character,
        skeleton=grown,
        meshes=(*character.meshes, *meshes),
        inverse_bind=np.concatenate((character.inverse_bind, inverse)),
    )


def bar_matrix(bar: Bar) -> Array:
    """Joint to world (4, 4) of the bar: the middle of all rails, not turned."""
    out = np.eye(4)
    out[:3, 3] = _middle(bar)
    return out


def _middle(bar: Bar) -> Array:
    return np.array([np.mean(bar.spans), bar.height, bar.behind])


def middle_line(bar: Bar, span: tuple[float, float], floor: float) -> Array:
    """The middle line (n, 3) of one piece: up a post, along the rail, down the other post."""
    turn = np.linspace(0.0, np.pi / 2, CORNER + 1)
    x0, x1 = span
    left = np.column_stack((x0 + ROUND * (1 - np.cos(turn)), bar.height - ROUND * (1 - np.sin(turn))))
    right = np.column_stack((x1 - (left[::-1, 0] - x0), left[::-1, 1]))
    flat = np.vstack(([x0, floor], left, right, [x1, floor]))
    return np.column_stack((flat, np.full(len(flat), bar.behind)))


def _tube(line: Array, radius: float, joint: int, number: int) -> Mesh:
    """A round tube along a line in a plane of one z."""
    along = np.gradient(line, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    across = np.array([0.0, 0.0, 1.0])
    outward = np.cross(along, across)
    angle = 2 * np.pi * np.arange(SIDES) / SIDES
    normals = np.cos(angle)[None, :, None] * across + np.sin(angle)[None, :, None] * outward[:, None]
    places = line[:, None] + radius * normals
    a = np.arange((len(line) - 1) * SIDES)
    b = a // SIDES * SIDES + (a + 1) % SIDES
    triangles = np.concatenate((np.column_stack((a, b, a + SIDES)), np.column_stack((b, b + SIDES, a + SIDES))))
    count = len(line) * SIDES
    joints = np.zeros((count, 4), dtype=np.uint16)
    joints[:, 0] = joint
    return Mesh(
        f"bar{number}",
        places.reshape(-1, 3).astype(np.float32),
        normals.reshape(-1, 3).astype(np.float32),
        np.zeros((count, 2), dtype=np.float32),
        triangles.astype(np.int32),
        joints,
        np.tile(np.array([1.0, 0.0, 0.0, 0.0], dtype=np.float32), (count, 1)),
        Material("bar", STEEL),
    )
