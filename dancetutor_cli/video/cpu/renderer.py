"""The software renderer: one frame from the cached stage, the live floor and the dancer."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.video.camera import NEAR, Camera
from dancetutor_cli.video.cpu.background import Background, draw_background
from dancetutor_cli.video.cpu.ground import blur, draw_ground, occupied
from dancetutor_cli.video.cpu.raster import (
    BACK,
    FRONT,
    clear,
    fill,
    fill_depth,
    project,
    project_hull,
    project_light,
    skin,
)
from dancetutor_cli.video.cpu.shade import light_vertices, resolve, toon_numbers
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
_MARK_REACH = 0.1  # metres around a foot that its mark and its contact shadow may reach
SHADOW_REACH = 2.5  # metres of the world that the shadow map shows, around the dancer's root


class CpuRenderer:
    """Draws with numba kernels on one core. See `video.renderer.Renderer`."""

    name = "cpu"

    def __init__(self, scene: Scene, size: tuple[int, int], quality: Quality) -> None:
        self._scene, self._size = scene, size
        self._samples = SAMPLES[quality]
        self._map = SHADOW_MAP[quality]
        self._mesh = pack(scene.character)
        self._toon = toon_numbers(scene.look.toon, self._map > 0)
        count = len(self._mesh.positions)
        self._world, self._vertex = np.empty((count, 9)), np.zeros((count, 16), np.float32)
        self._points, self._hull, self._light_points = (np.empty((count, 3)) for _ in range(3))
        width, height = size
        shape = (height * self._samples, width * self._samples)
        self._depth, self._ids = np.zeros(shape, np.float32), np.full(shape, -1, np.int32)
        self._spans = np.tile(np.array([shape[1], 0], np.int64), (shape[0], 1))
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
        self._dancer(camera, axes, origin, scale)
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
            self._out, self._ground_box(state, axes), shift, background.colour, background.ground,
            background.takes, background.panel, background.glow, background.white, background.footprint,
            self._mask, axes, origin, scale, look.light.shadow if scale else 0.0,
            lit, colours[np.clip(np.asarray(state.lit_by, dtype=np.int64), 0, 3)], feet, numbers,
        )  # fmt: skip

    def _ground_box(self, state: FrameState, axes: Array) -> NDArray[np.int64]:
        """The part of the picture, in pixels, that holds the pad and all that falls on the floor."""
        low, high = self._scene.extent
        ground = -self._scene.look.stage.pad_height
        points = [(x, y, z) for x in (low[0], high[0]) for y in (0.0, ground) for z in (low[2], high[2])]
        least, most = self._world[:, :3].min(0) - _MARK_REACH, self._world[:, :3].max(0) + _MARK_REACH
        points += [(x, ground, z) for x in (least[0], most[0]) for z in (least[2], most[2])]
        if self._map:  # the corners of her box, cast on the floor
            slope = axes[2] / axes[2][1]
            for x, z in [p[::2] for p in points[-4:]]:
                for y in (least[1] - ground, most[1] - ground):
                    points.append((x - slope[0] * y, ground, z - slope[2] * y))
        return _pixel_box(state.camera, np.array(points, dtype=np.float64), self._size)

    def _dancer(self, camera: Camera, axes: Array, origin: Array, scale: float) -> None:
        samples, mesh = self._samples, self._mesh
        matrix = camera.matrix(self._size)
        focal = camera.focal * self._size[1]
        outline = self._scene.look.toon.outline_width * self._size[1] / 720.0
        project(self._world, matrix, float(samples), NEAR, self._points)
        project_hull(self._world, matrix, float(samples), NEAR, outline, focal, self._hull)
        clear(self._depth, self._ids, self._spans)
        count = len(mesh.triangles)
        fill(self._points, mesh.triangles, FRONT, 0, self._depth, self._ids, self._spans)
        fill(self._hull, mesh.triangles, BACK, count, self._depth, self._ids, self._spans)
        light_vertices(
            self._world,
            self._points,
            mesh.uv,
            mesh.material,
            np.array(camera.position),
            axes,
            origin,
            scale,
            self._vertex,
        )
        resolve(
            self._out, samples, self._ids, self._depth, self._spans, count, mesh.triangles, mesh.patch, self._vertex,
            mesh.texels, mesh.textures, self._shadow, self._toon,
        )  # fmt: skip


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


def _pixel_box(camera: Camera, points: Array, size: tuple[int, int]) -> NDArray[np.int64]:
    """Bounds of world points on the picture, x0, y0, x1, y1; everything if one of them is behind the camera."""
    places = camera.project(points, size)
    width, height = size
    if (places[:, 2] < NEAR).any():
        return np.array([0, 0, width, height])
    low, high = np.floor(places[:, :2].min(0)) - 2, np.ceil(places[:, :2].max(0)) + 3
    return np.concatenate([np.clip(low, 0, size), np.clip(high, 0, size)]).astype(np.int64)
