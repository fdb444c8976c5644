"""A foot that a leg hides: its shoe is outlined over that leg, for which foot stands where is what is to be seen.

What is hidden is found from the joints alone, legs as tapered tubes, so that both renderers show the same.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.partner import PREFIX
from dancetutor_cli.video.picture import Frame
from dancetutor_cli.video.scene.camera import NEAR, Camera
from dancetutor_cli.video.scene.scene import SOLE_RADIUS, FootMark, Scene, foot_marks

Array = NDArray[np.float64]
_LEG = ("knee", "talocrural", "metatarsal")  # what is above the knee hides no foot
_RADII = (0.062, 0.05, 0.045)  # metres, of a leg at these joints
_SHOE = 0.035  # metres above its sole at which a foot is looked for
HIDDEN = (0.3, 0.6)  # share of a foot that is hidden where it begins to be drawn, and where it is as strong as ever
SHOE = (0.046, 0.040)  # metres, how far a shoe reaches around the line between heel and toe, at either end
LINE = 0.004  # metres, half its outline's width
LOW = 0.12  # metres over the ground over which a foot in the air is not drawn


@dataclass(frozen=True, slots=True)
class _Legs:
    """Parts of a leg in the picture. ends : (p, 2, 3) places and depths, pixels and metres; radii : (p, 2) pixels"""

    ends: Array
    radii: Array

    @property
    def box(self) -> tuple[Array, Array]:
        """Left and top, right and bottom of all of them, pixels."""
        places, around = self.ends[..., :2], self.radii[..., None]
        return (places - around).min((0, 1)), (places + around).max((0, 1))

    def cover(self, place: Array, soft: float = 1.0) -> Array:
        """How much of what is at places (..., 3), `soft` pixels large, is behind them, 0 to 1."""
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
    """Draw the shoes of feet behind another leg over the picture of them. joints : world matrices (j, 4, 4)."""
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
    """The joints of each leg, left and right, of the second dancer too, (l, 3); None for who has no such legs."""
    whose = ("", PREFIX) if any(name.startswith(PREFIX) for name in names) else ("",)
    needed = [f"{one}{side}_{joint}" for one in whose for side in "lr" for joint in _LEG]
    if not set(needed) <= set(names):
        return None
    return np.array([names.index(name) for name in needed]).reshape(-1, len(_LEG))


def _share(mark: FootMark, before: _Legs, camera: Camera, size: tuple[int, int]) -> float:
    """How strongly a foot is drawn, 0 to 1, by how much of it is hidden."""
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
    """Draw the outline of what of a shoe is behind a leg. ink : (4,), red, green, blue 0..255, and how strong 0..1

    Not its ring again: that lies on the floor, and over a leg it would be seen as a noose around it. And not filled: a
    patch on a leg looked like a bandage.
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
