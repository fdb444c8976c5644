"""The software renderer: one frame from the cached stage, the live floor and the dancer."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.video.camera import NEAR, Camera
from dancetutor_cli.video.cpu.background import Background, draw_background
from dancetutor_cli.video.cpu.ground import blur, draw_ground, occupied
from dancetutor_cli.video.cpu.raster import BACK, FRONT, fill, fill_depth, project, project_hull, project_light, skin
from dancetutor_cli.video.cpu.shade import resolve
from dancetutor_cli.video.geometry import pack
from dancetutor_cli.video.renderer import Quality
from dancetutor_cli.video.scene import (
    SOLE_RADIUS,
    FootMark,
    FrameState,
    Scene,
    check_state,
    foot_marks,
    light_direction,
    shadow_axes,
)

Array = NDArray[np.float64]
SAMPLES: dict[Quality, int] = {"draft": 1, "good": 2, "best": 4}
SHADOW_MAP: dict[Quality, int] = {"draft": 0, "good": 512, "best": 1024}
SHADOW_REACH = 2.5  # metres of the world that the shadow map shows, around the dancer's root


class CpuRenderer:
    """Draws with numba kernels on one core. See `video.renderer.Renderer`."""

    name = "cpu"

    def __init__(self, scene: Scene, size: tuple[int, int], quality: Quality) -> None:
        self._scene, self._size = scene, size
        self._samples = SAMPLES[quality]
        self._map = SHADOW_MAP[quality]
        self._mesh = pack(scene.character)
        self._toon = _toon(scene)
        count = len(self._mesh.positions)
        self._world, self._points = np.empty((count, 9)), np.empty((count, 3))
        self._hull, self._light_points = np.empty((count, 3)), np.empty((count, 3))
        width, height = size
        shape = (height * self._samples, width * self._samples)
        self._depth, self._ids = np.zeros(shape, np.float32), np.full(shape, -1, np.int32)
        self._shadow = np.zeros((max(self._map, 1),) * 2, np.float32)
        self._mask, self._spare = np.zeros_like(self._shadow), np.zeros_like(self._shadow)
        self._out = np.empty((height, width, 3), np.uint8)
        self._background: tuple[Camera, Background] | None = None
        self.description = f"cpu: numba rasteriser, {self._samples}x{self._samples} samples, one core"

    def frame(self, state: FrameState) -> NDArray[np.uint8]:
        """See `video.renderer.Renderer.frame`."""
        check_state(self._scene, state)
        camera = state.camera
        background = self._standing(camera)
        shift = background.left - camera.pan_pixels(self._size[0])
        np.copyto(self._out, background.picture[:, shift : shift + self._size[0]])
        mesh = self._mesh
        matrices = np.ascontiguousarray(_product(state.joints, self._scene.character.inverse_bind))
        skin(mesh.positions, mesh.normals, mesh.hull, mesh.joints, mesh.weights, matrices, self._world)
        light = light_direction(self._scene.look, camera)
        axes, origin, scale = self._cast(light, state)
        self._ground(state, background, shift, axes, origin, scale)
        self._dancer(camera, light, axes, origin, scale)
        return self._out

    def close(self) -> None:
        """Nothing to give back."""

    def _standing(self, camera: Camera) -> Background:
        key = replace(camera, pan=0.0)
        if self._background is None or self._background[0] != key:
            self._background = None  # free the old one first
            drawn = draw_background(self._scene.stage, self._scene.look, key, self._size, max(2, self._samples))
            self._background = (key, drawn)
        return self._background[1]

    def _cast(self, light: Array, state: FrameState) -> tuple[Array, Array, float]:
        """Draw the shadow map. Axes of the light's view, the place of the map's corner in it, texels a metre."""
        axes = shadow_axes(light)
        if not self._map:
            return axes, np.zeros(2), 0.0
        scale = self._map / SHADOW_REACH
        middle = state.joints[0, :3, 3]
        # On the texel grid of the world, so that the shadow's edge does not crawl as she moves.
        origin = np.array([np.floor((axes[k] * middle).sum() * scale) / scale - SHADOW_REACH / 2 for k in (0, 1)])
        self._shadow[:] = 0.0
        project_light(self._world, axes, origin, scale, self._light_points)
        fill_depth(self._light_points, self._mesh.triangles, self._shadow)
        occupied(self._shadow, self._mask)
        radius = max(1, round(self._scene.look.light.shadow_soft * scale / 2))
        blur(self._mask, radius, self._spare)
        blur(self._mask, radius, self._spare)
        return axes, origin, scale

    def _ground(
        self, state: FrameState, background: Background, shift: int, axes: Array, origin: Array, scale: float
    ) -> None:
        look = self._scene.look
        feet = _feet(self._scene, foot_marks(self._scene, state.joints))
        colours = np.array(self._scene.colours.by_limb, dtype=np.float64)
        lit = np.clip(np.asarray(state.lit, dtype=np.float64), 0.0, 1.0)
        numbers = np.array([look.light.contact, look.light.contact_soft, look.stage.mark, look.stage.glow, SOLE_RADIUS])
        draw_ground(
            self._out, self._ground_box(state, axes, origin), shift, background.colour, background.ground,
            background.takes, background.panel, background.glow, background.white, background.footprint,
            self._mask, axes, origin, scale, look.light.shadow if scale else 0.0,
            lit, colours[np.clip(np.asarray(state.lit_by, dtype=np.int64), 0, 3)], feet, numbers,
        )  # fmt: skip

    def _ground_box(self, state: FrameState, axes: Array, origin: Array) -> NDArray[np.int64]:
        """The part of the picture, in pixels, that holds the pad and all that falls on the floor."""
        low, high = self._scene.extent
        ground = -self._scene.look.stage.pad_height
        points = [(x, y, z) for x in (low[0], high[0]) for y in (0.0, ground) for z in (low[2], high[2])]
        middle = state.joints[0, :3, 3]
        # All of the dancer lies within this of her root; her shadow within what the map shows, laid on the floor.
        points += [(middle[0] + a, ground, middle[2] + b) for a in (-0.7, 0.7) for b in (-0.7, 0.7)]
        for u in (0.0, SHADOW_REACH):
            for v in (0.0, SHADOW_REACH):
                place = axes[0] * (origin[0] + u) + axes[1] * (origin[1] + v)
                points.append(tuple(place + axes[2] * ((ground - place[1]) / axes[2][1])))
        return _pixel_box(state.camera, np.array(points, dtype=np.float64), self._size)

    def _dancer(self, camera: Camera, light: Array, axes: Array, origin: Array, scale: float) -> None:
        samples, mesh = self._samples, self._mesh
        matrix = camera.matrix(self._size)
        focal = camera.focal * self._size[1]
        outline = self._scene.look.toon.outline_width * self._size[1] / 720.0
        project(self._world, matrix, float(samples), NEAR, self._points)
        project_hull(self._world, matrix, float(samples), NEAR, outline, focal, self._hull)
        box = self._dancer_box()
        if box[0] >= box[2] or box[1] >= box[3]:
            return
        inner = box * samples
        part = np.s_[inner[1] : inner[3], inner[0] : inner[2]]
        self._depth[part] = 0.0
        self._ids[part] = -1
        count = len(mesh.triangles)
        fill(self._points, mesh.triangles, FRONT, 0, self._depth, self._ids, inner)
        fill(self._hull, mesh.triangles, BACK, count, self._depth, self._ids, inner)
        resolve(
            self._out, box, samples, self._ids, count, mesh.triangles, self._points, self._world, mesh.uv, mesh.material,
            mesh.texels, mesh.textures, np.array(camera.position), light, self._shadow, axes, origin, scale, self._toon,
        )  # fmt: skip

    def _dancer_box(self) -> NDArray[np.int64]:
        """The pixels that the outlined dancer may touch: x0, y0, x1, y1."""
        seen = self._hull[self._hull[:, 2] > 0.0, :2]
        if not len(seen):
            return np.zeros(4, np.int64)
        low, high = seen.min(0) / self._samples - 1, seen.max(0) / self._samples + 2
        limit = np.array(self._size)
        return np.concatenate([np.clip(low, 0, limit), np.clip(high, 0, limit)]).astype(np.int64)


def _product(joints: Array, inverse_bind: Array) -> Array:
    """joints @ inverse_bind as (j, 3, 4), in a fixed order of additions: matrix libraries differ in the last bit."""
    out = joints[:, :3, 0, None] * inverse_bind[:, None, 0, :]
    for k in (1, 2, 3):
        out = out + joints[:, :3, k, None] * inverse_bind[:, None, k, :]
    return np.asarray(out)


def _feet(scene: Scene, marks: tuple[FootMark | None, FootMark | None]) -> Array:
    rows = []
    for mark, colour in zip(marks, scene.colours.by_limb[:2], strict=True):
        if mark is not None:
            near = max(0.0, 1.0 - mark.height / scene.look.light.contact_height)
            rows.append((*mark.heel, *mark.toe, mark.ground, near, *colour))
    return np.array(rows, dtype=np.float64).reshape(-1, 9)


def _toon(scene: Scene) -> Array:
    """The numbers of the toon shading in the order `shade` reads them."""
    toon = scene.look.toon
    shade, outline = np.array(toon.shade) / 255.0, np.array(toon.outline) / 255.0
    return np.array([*toon.bands, toon.soft, *toon.levels, toon.rim, toon.rim_from, *shade, *outline])


def _pixel_box(camera: Camera, points: Array, size: tuple[int, int]) -> NDArray[np.int64]:
    """Bounds of world points on the picture, x0, y0, x1, y1; everything if one of them is behind the camera."""
    places = camera.project(points, size)
    width, height = size
    if (places[:, 2] < NEAR).any():
        return np.array([0, 0, width, height])
    low, high = np.floor(places[:, :2].min(0)) - 2, np.ceil(places[:, :2].max(0)) + 3
    return np.concatenate([np.clip(low, 0, size), np.clip(high, 0, size)]).astype(np.int64)
