"""The software renderer, which makes a frame from the cached stage, the moving parts of the floor and the dancer."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.units import Array
from dancetutor_cli.film.choices import Quality
from dancetutor_cli.film.scene.camera import NEAR, Camera
from dancetutor_cli.film.scene.cpu.floor import Live, Shadow, blur, draw_ground, mark_occupied
from dancetutor_cli.film.scene.cpu.fragments import PER_METRE, Light, Surface, toon_numbers
from dancetutor_cli.film.scene.cpu.raster import (
    BACK,
    FRONT,
    SkinnedVertices,
    View,
    empty_canvas,
    extent,
    fill_depth,
    fill_triangles,
    note_least,
    project,
    project_hull,
    project_light,
    skin_vertices,
)
from dancetutor_cli.film.scene.cpu.shade import RasterResult, empty_room, light_vertices, resolve
from dancetutor_cli.film.scene.cpu.standing import Background, draw_background
from dancetutor_cli.film.scene.geometry import pack
from dancetutor_cli.film.scene.scene import SOLE_RADIUS, FrameState, Scene, check_state
from dancetutor_cli.film.scene.shared import (
    SAMPLES,
    SHADOW_MAP,
    Cast,
    DancerVisibility,
    dancer_visibility,
    feet_on_floor,
    ground_box,
    joints_of,
    panel_lights,
    pixels_per_metre,
    place_cast,
    shadow_middles,
    skin_matrices,
)


class CpuRenderer:
    """A renderer with numba kernels on one core. See `film.scene.renderer.Renderer`."""

    name = "cpu"

    def __init__(self, scene: Scene, size: tuple[int, int], quality: Quality) -> None:
        self._scene, self._size = scene, size
        self._samples = SAMPLES[quality]
        self._map = SHADOW_MAP[quality]
        self._mesh = pack(scene.character)
        mesh = self._mesh
        self._bound = SkinnedVertices(mesh.positions, mesh.normals, mesh.hull, mesh.joints, mesh.weights)
        self._surface = Surface(mesh.uv, mesh.above, mesh.material, mesh.patch, mesh.density, *mesh.skins.flat())
        self._toon = toon_numbers(scene.look.toon, self._map > 0)
        count = len(self._mesh.positions)
        self._world, self._vertex = np.empty((count, 9)), np.zeros((count, 16), np.float32)
        self._points, self._light_points, self._hull = (np.empty((count, n)) for n in (3, 3, 4))
        width, height = size
        shape = (height * self._samples, width * self._samples)
        self._canvas = empty_canvas(*shape)
        self._shadow = np.zeros((max(self._map, 1),) * 2, np.float32)
        self._room = empty_room(self._samples)
        self._mask, self._spare = np.zeros_like(self._shadow), np.zeros_like(self._shadow)
        self._out = np.empty((height, width, 3), np.uint8)
        self._background: tuple[Camera, Background] | None = None
        self.description = f"cpu: numba rasteriser, {self._samples}x{self._samples} samples, one core"

    def frame(self, state: FrameState) -> NDArray[np.uint8]:
        """See `film.scene.renderer.Renderer.frame`."""
        check_state(self._scene, state)
        camera = state.camera
        background = self._standing(camera)
        shift = background.left - camera.pan_pixels(self._size[0])
        np.copyto(self._out, background.picture[:, shift : shift + self._size[0]])
        mesh = self._mesh
        joints = joints_of(self._scene, state)
        matrices = skin_matrices(self._scene, joints)
        skin_vertices(self._bound, matrices, self._world)
        cast = place_cast(self._scene, camera, joints, self._map)
        count = {
            DancerVisibility.NOTHING: 0,
            DancerVisibility.FEET: mesh.feet,
            DancerVisibility.ALL: len(mesh.triangles),
        }[dancer_visibility(state)]
        triangles = mesh.triangles[:count]
        shadow = self._draw_shadow(triangles, cast, shadow_middles(self._scene, joints))
        self._draw_ground(state, background, shift, shadow)
        self._draw_dancer(triangles, joints, camera, cast)
        return self._out

    def close(self) -> None:
        """Do nothing, because there are no resources to free."""

    def _standing(self, camera: Camera) -> Background:
        key = replace(camera, pan=0.0)
        if self._background is None or self._background[0] != key:
            self._background = None  # free the old background first
            drawn = draw_background(self._scene.stage, self._scene.look, key, self._size, max(2, self._samples))
            self._background = (key, drawn)
        return self._background[1]

    def _draw_shadow(self, triangles: NDArray[np.int32], cast: Cast, middles: Array) -> Shadow:
        light = self._scene.look.light
        if not self._map:
            return Shadow(self._mask, (0, 0, 0, 0), cast, 0.0, middles, 1.0)
        self._shadow[:] = 0.0
        project_light(self._world, cast.axes, cast.origin, cast.scale, self._light_points)
        fill_depth(self._light_points, triangles, self._shadow)
        left, top, right, bottom = mark_occupied(self._shadow, self._mask)
        radius = max(1, round(light.shadow_soft * cast.scale / 2))
        reach = 2 * radius + 1  # greatest reach of the blur; texels beyond it stay 0
        box = max(0, left - reach), max(0, top - reach), right + reach, bottom + reach
        for _ in range(2):
            blur(self._mask, box, radius, self._spare)
        return Shadow(self._mask, box, cast, light.shadow, middles, light.shadow_far)

    def _draw_ground(self, state: FrameState, background: Background, shift: int, shade: Shadow) -> None:
        look, cast = self._scene.look, shade.cast
        bounds = extent(self._world)
        box = ground_box(self._scene, state.camera, self._size, bounds, cast)
        lit, lit_colour = panel_lights(self._scene, state)
        numbers = np.array([look.light.contact, look.light.contact_soft, look.stage.glow, SOLE_RADIUS])
        live = Live(lit, lit_colour, feet_on_floor(self._scene, state), numbers)
        draw_ground(self._out, box, shift, background, shade, live)

    def _draw_dancer(self, triangles: NDArray[np.int32], joints: Array, camera: Camera, cast: Cast) -> None:
        eye = np.array(camera.position)
        view = View(camera.matrix(self._size), eye, float(self._samples), NEAR, camera.focal * self._size[1])
        per_metre = pixels_per_metre(camera, joints, self._size)
        outline = self._scene.look.toon.outline_width * per_metre
        project(self._world, view, self._points)
        project_hull(self._world, view, outline, self._hull)
        fill_triangles(self._points, triangles, FRONT, 0, self._canvas)
        note_least(self._canvas)
        fill_triangles(self._hull, triangles, BACK, len(triangles), self._canvas)
        light_vertices(self._world, self._points, self._surface, eye, cast, self._vertex)
        self._toon[PER_METRE] = per_metre
        drawn, light = RasterResult(self._canvas, triangles), Light(self._vertex, self._shadow, self._toon)
        resolve(self._out, self._samples, drawn, self._surface, light, self._room)
