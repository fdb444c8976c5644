"""The visible parts of the dancer: feet under a cape, a foot behind a leg, the dancer's place in the picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.mesh import PREFIX, Character, on_foot, rest_vertices
from dancetutor_cli.dance.units import Array
from dancetutor_cli.film.picture import Frame
from dancetutor_cli.film.scene.camera import NEAR, Camera
from dancetutor_cli.film.scene.scene import SOLE_RADIUS, FootMark, Scene, foot_marks

# The visibility of a character's feet from a camera. A cape or a large head may hide them from behind.

LEAST = 0.2  # smallest share of the feet's vertices that is visible at rest; below it, the feet count as hidden
_LOOKED_AT = 160  # maximum number of the feet's vertices that are checked


def feet_hidden(character: Character, camera: Camera, size: tuple[int, int]) -> bool:
    """Whether the rest of the body covers the feet of a standing dancer; False for a character without feet."""
    feet = np.concatenate([on_foot(character, m, "l") | on_foot(character, m, "r") for m in character.meshes])
    if not feet.any():
        return False
    first = np.cumsum([0, *(len(mesh.positions) for mesh in character.meshes)])
    triangles = np.concatenate([m.triangles + f for m, f in zip(character.meshes, first, strict=False)])
    others = triangles[~feet[triangles].any(axis=1)]
    places = camera.project(rest_vertices(character), size)
    looked = np.flatnonzero(feet)
    looked = looked[:: max(1, len(looked) // _LOOKED_AT)]
    covered = np.array([_covered(places[v], places[others]) for v in looked])
    return bool(1.0 - covered.mean() < LEAST)


def _covered(place: Array, corners: Array) -> bool:
    """Whether a place (x, y, depth) is behind one of the triangles, corners (t, 3, 3)."""
    a, b, c = (corners[:, k, :2] for k in range(3))
    p = place[:2]

    def side(u: Array, v: Array) -> Array:
        return np.asarray((v[:, 0] - u[:, 0]) * (p[1] - u[:, 1]) - (v[:, 1] - u[:, 1]) * (p[0] - u[:, 0]))

    s, t, r = side(a, b), side(b, c), side(c, a)
    inside = ((s >= 0) & (t >= 0) & (r >= 0)) | ((s <= 0) & (t <= 0) & (r <= 0))
    return bool((corners[inside, :, 2].max(axis=1) < place[2] - 0.01).any())


# The dancer's place in the picture, found from her joints alone, and the words that she would stand behind.

FACE_AND_FEET = ("skullbase", "_talocrural", "_metatarsal")  # endings of the joints of heads and feet of all dancers
_SIGNS = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=bool)


class Silhouette:
    """A box around the vertices that follow each joint most, in the joint's own axes, which is valid in every pose.

    named : indices of the boxes of heads and feet
    """

    def __init__(self, character: Character) -> None:
        places, owners = [], []
        for mesh in character.meshes:
            owner = mesh.joints[np.arange(len(mesh.joints)), mesh.weights.argmax(1)]
            bind = character.inverse_bind[owner]
            places.append(np.einsum("vij,vj->vi", bind[:, :3, :3], mesh.positions) + bind[:, :3, 3])
            owners.append(owner)
        place, owner = np.concatenate(places), np.concatenate(owners)
        self.joints = np.unique(owner)
        parts = [place[owner == joint] for joint in self.joints]
        corners = [np.where(_SIGNS, part.max(0), part.min(0)) for part in parts]
        self.corners = np.array(corners).reshape(len(self.joints), 8, 3)
        names = [character.skeleton.names[joint] for joint in self.joints]
        self.named = np.array([k for k, name in enumerate(names) if name.endswith(FACE_AND_FEET)], dtype=np.int64)

    def behind(
        self, boxes: Sequence[tuple[float, float, float, float]], joints: Array, camera: Camera, size: tuple[int, int]
    ) -> bool:
        """Whether any part of the dancer reaches into one of `boxes` (left, top, right, bottom; pixels).

        joints : world matrices (j, 4, 4); size : (width, height) of the picture in pixels
        """
        parts = self._picture_boxes(np.arange(len(self.joints)), joints, camera, size)
        return any(
            bool(((parts[:, 0] < b[2]) & (parts[:, 2] > b[0]) & (parts[:, 1] < b[3]) & (parts[:, 3] > b[1])).any())
            for b in boxes
        )

    def heads_and_feet(self, joints: Array, camera: Camera, size: tuple[int, int]) -> Array:
        """Return left, top, right and bottom of each head and foot before the camera, (n, 4), pixels."""
        return self._picture_boxes(self.named, joints, camera, size)

    def _picture_boxes(self, parts: NDArray[np.int64], joints: Array, camera: Camera, size: tuple[int, int]) -> Array:
        """Return the boxes in the picture around `parts`, indices of `self.joints`."""
        world = joints[self.joints[parts]]
        points = np.einsum("pij,pkj->pki", world[:, :3, :3], self.corners[parts]) + world[:, None, :3, 3]
        seen = camera.project(points.reshape(-1, 3), size).reshape(points.shape)
        seen = seen[(seen[..., 2] > NEAR).all(1), :, :2]
        return np.concatenate([seen.min(1), seen.max(1)], axis=1)


# A foot behind a leg. Its shoe is outlined over the leg, because the places of the feet must stay visible.
#
# The hidden parts follow from the joints alone, with legs as tapered tubes, so that both renderers show the same.

_LEG = ("knee", "talocrural", "metatarsal")  # the parts above the knee hide no foot
_RADII = (0.062, 0.05, 0.045)  # radius of a leg at these joints, metres
_SHOE = 0.035  # height above the sole of the points that are checked, metres
HIDDEN = (0.3, 0.6)  # hidden share of a foot at which the outline begins, and at which it has its full strength
SHOE = (0.046, 0.040)  # radius of a shoe around the line between heel and toe, at either end, metres
LINE = 0.004  # half the width of the outline, metres
LOW = 0.12  # height over the ground from which a foot in the air has no outline, metres


@dataclass(frozen=True, slots=True)
class _Legs:
    """The parts of legs in the picture. ends : (p, 2, 3) places and depths, pixels and metres; radii : (p, 2) pixels"""

    ends: Array
    radii: Array

    @property
    def box(self) -> tuple[Array, Array]:
        """Left and top, right and bottom of all parts, pixels."""
        places, around = self.ends[..., :2], self.radii[..., None]
        return (places - around).min((0, 1)), (places + around).max((0, 1))

    def cover(self, place: Array, soft: float = 1.0) -> Array:
        """Return the share, 0 to 1, of discs at places (..., 3), `soft` pixels large, that is behind the legs."""
        out = np.zeros(place.shape[:-1])
        for (a, b), (first, last) in zip(self.ends, self.radii, strict=True):
            along = b[:2] - a[:2]
            t = np.clip(((place[..., :2] - a[:2]) @ along) / max(float(along @ along), 1e-9), 0.0, 1.0)
            off = place[..., :2] - a[:2] - t[..., None] * along
            inside = first + t * (last - first) - np.hypot(off[..., 0], off[..., 1])
            before = a[2] + t * (b[2] - a[2]) < place[..., 2]
            out = np.maximum(out, np.where(before, np.clip(inside / soft + 0.5, 0.0, 1.0), 0.0))
        return out


def draw_hidden_feet(frame: Frame, scene: Scene, joints: Array, camera: Camera) -> None:
    """Draw the outlines of shoes behind another leg over the picture. joints : world matrices (j, 4, 4)"""
    found = _leg_joints(scene.character.skeleton.names)
    if camera.feet_only or found is None:
        return
    size = frame.shape[1], frame.shape[0]
    places = camera.project(joints[found.ravel(), :3, 3], size).reshape(*found.shape, 3)
    if (places[..., 2] < NEAR).any():
        return
    radii = np.array(_RADII) * camera.focal * size[1] / places[..., 2]
    low, high = (places[..., :2] - radii[..., None]).min(1), (places[..., :2] + radii[..., None]).max(1)
    for limb, foot in enumerate(places[:, 1:]):
        near = (low < foot[:, :2].max(0)).all(1) & (high > foot[:, :2].min(0)).all(1)
        near &= places[..., 2].min(1) < foot[:, 2].max()
        near[limb] = False
        if not near.any():
            continue
        mark = foot_marks(scene, joints, ("", PREFIX)[limb // 2])[limb % 2]
        if mark is None or mark.height > LOW:
            continue
        ends = np.stack([places[near, :-1], places[near, 1:]], axis=2).reshape(-1, 2, 3)
        before = _Legs(ends, np.stack([radii[near, :-1], radii[near, 1:]], axis=2).reshape(-1, 2))
        shown = _share(mark, before, camera, size) * (1.0 - mark.height / LOW)
        if shown > 0.0:
            _shoe(frame, mark, before, camera, np.array([*scene.colours.by_limb[limb % 2], shown]))


@lru_cache(maxsize=4)
def _leg_joints(names: tuple[str, ...]) -> NDArray[np.intp] | None:
    """Return the joints of each leg, left and right, also of a second dancer, (l, 3); None without these joints."""
    whose = ("", PREFIX) if any(name.startswith(PREFIX) for name in names) else ("",)
    needed = [f"{one}{side}_{joint}" for one in whose for side in "lr" for joint in _LEG]
    if not set(needed) <= set(names):
        return None
    return np.array([names.index(name) for name in needed]).reshape(-1, len(_LEG))


def _share(mark: FootMark, before: _Legs, camera: Camera, size: tuple[int, int]) -> float:
    """Return the strength of a foot's outline, 0 to 1, which depends on the hidden share of the foot."""
    t = np.linspace(-0.2, 1.2, 9)[:, None]
    flat = np.array(mark.heel) + t * (np.array(mark.toe) - np.array(mark.heel))
    points = np.column_stack([flat[:, 0], np.full(len(t), mark.ground + mark.height + _SHOE), flat[:, 1]])
    places = camera.project(points, size)
    if (places[:, 2] < NEAR).any():
        return 0.0
    wide = 2.0 * SOLE_RADIUS * camera.focal * size[1] / float(places[:, 2].mean())
    share = (float(before.cover(places, wide).mean()) - HIDDEN[0]) / (HIDDEN[1] - HIDDEN[0])
    share = min(1.0, max(0.0, share))
    return share * share * (3.0 - 2.0 * share)


def _shoe(frame: Frame, mark: FootMark, before: _Legs, camera: Camera, ink: Array) -> None:
    """Draw the outline of the part of a shoe that is behind a leg.

    The ring on the floor is not drawn over the leg, because it would look like a noose around it. The outline is not
    filled, because a patch on a leg looked like a bandage.

    ink : (4,), red, green, blue 0..255, and strength 0..1
    """
    size = frame.shape[1], frame.shape[0]
    height = mark.ground + mark.height + float(np.mean(SHOE))
    heel, toe = camera.project(np.array([[x, height, z] for x, z in (mark.heel, mark.toe)]), size)
    metre = camera.focal * size[1] / np.array([heel[2], toe[2]])  # pixels
    radii = np.array(SHOE) * metre
    around = (radii + LINE * metre)[:, None]
    ends, (low, high) = np.array([heel[:2], toe[:2]]), before.box
    left, top = np.maximum(np.floor(np.maximum((ends - around).min(0), low)).astype(int) - 1, 0)
    right, bottom = np.minimum(np.ceil(np.minimum((ends + around).max(0), high)).astype(int) + 2, size)
    if left >= right or top >= bottom:
        return
    y, x = np.mgrid[top:bottom, left:right] + 0.5
    place, along = np.stack([x, y], axis=-1), toe[:2] - heel[:2]
    t = np.clip(((place - heel[:2]) @ along) / max(float(along @ along), 1e-9), 0.0, 1.0)
    away = place - heel[:2] - t[..., None] * along
    off = np.hypot(away[..., 0], away[..., 1]) - (radii[0] + t * (radii[1] - radii[0]))
    wide = metre[0] + t * (metre[1] - metre[0])
    depth = heel[2] + t * (toe[2] - heel[2])
    hidden = before.cover(np.stack([x, y, depth], axis=-1)) * ink[3]
    part = frame[top:bottom, left:right]
    line = np.clip(LINE * wide - np.abs(off) + 0.5, 0.0, 1.0)
    alpha = (hidden * line)[..., None]
    part[...] = np.rint(part + (ink[:3] - part) * alpha)
