"""The OpenGL renderer: the same picture as cpu/, with skinning, shadow, outline and light in shaders.

Import only after `compat.load_pyrender`. Made in the process that uses it, after a spawn: contexts survive no fork.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from OpenGL import GL
from pyrender.platforms.egl import EGLPlatform, query_devices
from pyrender.renderer import Renderer as PyrenderRenderer

from dancetutor_cli.errors import UnavailableError, UsageError
from dancetutor_cli.video.choices import Quality
from dancetutor_cli.video.scene.camera import Camera
from dancetutor_cli.video.scene.geometry import pack
from dancetutor_cli.video.scene.gl.available import gpu_device
from dancetutor_cli.video.scene.gl.framebuffers import Target, pyramid, refill, texture
from dancetutor_cli.video.scene.gl.matrices import bounds_of, camera_matrix, light_matrix, reach, within
from dancetutor_cli.video.scene.gl.patches import Patches, is_lit, rectangles, shaded, trodden
from dancetutor_cli.video.scene.gl.primitive import SkinnedPrimitive
from dancetutor_cli.video.scene.gl.programs import Program, ProgramCache
from dancetutor_cli.video.scene.gl.standing import Standing
from dancetutor_cli.video.scene.look import LightLook
from dancetutor_cli.video.scene.prepare import (
    SAMPLES,
    SHADOW_MAP,
    Cast,
    Shown,
    feet_on_floor,
    joints_of,
    panel_lights,
    pixel_box,
    pixels_per_metre,
    place_cast,
    shown,
    skin_matrices,
)
from dancetutor_cli.video.scene.renderer import MOST_JOINTS
from dancetutor_cli.video.scene.scene import SOLE_RADIUS, FrameState, Scene, check_state

Array = NDArray[np.float64]
_OFF_SURFACE = (0.012, 0.006)
_RING = 0.032  # metres from a sole: no ring of ground.frag is farther out
_SHADOW_UNIT, _SKIN_UNIT, _FIRST_UNIT = 4, 5, 0


class GlRenderer(PyrenderRenderer):  # type: ignore[misc]
    """Draws through EGL. See `video.scene.renderer.Renderer`."""

    name = "gl"

    def __init__(self, scene: Scene, size: tuple[int, int], quality: Quality) -> None:
        if len(scene.character.skeleton.names) > MOST_JOINTS:
            raise UsageError(f"the gl renderer draws at most {MOST_JOINTS} joints; use --renderer cpu")
        self._scene, self._size, self._quality = scene, size, quality
        self._platform = _start(size)
        super().__init__(*size)
        self._program_cache = ProgramCache()
        device = bytes(GL.glGetString(GL.GL_RENDERER)).decode("utf-8", "replace")
        most = int(GL.glGetIntegerv(GL.GL_MAX_SAMPLES))
        # Two by two pixels for each of the picture's: cheaper than as many samples where a processor draws. The rest of
        # the samples, if there are to be more, are samples of these pixels.
        self._fine = min(SAMPLES[quality], 2)
        inner = min((SAMPLES[quality] // self._fine) ** 2, most)
        self._samples = inner if inner > 1 else 0
        self.description = f"gl: {device} through EGL, {self._fine**2 * inner} samples a pixel"
        self._build()

    def _build(self) -> None:
        scene, quality = self._scene, self._quality
        mesh = pack(scene.character)
        self._skins = [pyramid(images) for images in mesh.skins.pyramids]
        self._primitives: list[tuple[SkinnedPrimitive, int, Array, float]] = []
        skins, limbs = mesh.skins, self._scene.look.toon.limbs
        for number, (skin, tint, limb) in enumerate(zip(skins.of_mesh, skins.tint, skins.limb, strict=True)):
            primitive = SkinnedPrimitive(mesh, number)
            primitive._add_to_context()
            self._primitives.append((primitive, self._skins[skin], tint, limbs if limb else 0.0))
        self._reach = reach(scene, mesh.positions, mesh.joints, mesh.weights)
        self._map = Target((SHADOW_MAP[quality] or 1,) * 2, colour=False)
        fine = (self._fine * self._size[0], self._fine * self._size[1])
        self._drawn = Target(fine, self._samples, depth=True)
        self._whole = Target(fine) if self._samples else self._drawn
        self._resolved = Target(self._size)
        self._picture = Target(self._size)
        self._standing: tuple[Camera, Standing] | None = None
        self._patches = Patches()
        self._lights = texture(np.zeros((1, max(scene.panels, 1), 4), np.float32))
        self._joints = int(GL.glGenBuffers(1))
        self._bytes = np.empty((self._size[1], self._size[0], 3), np.uint8)
        GL.glBindBuffer(GL.GL_UNIFORM_BUFFER, self._joints)
        GL.glBufferData(GL.GL_UNIFORM_BUFFER, MOST_JOINTS * 48, None, GL.GL_DYNAMIC_DRAW)

    def frame(self, state: FrameState) -> NDArray[np.uint8]:
        """See `video.scene.renderer.Renderer.frame`."""
        check_state(self._scene, state)
        self._platform.make_current()
        camera = state.camera
        standing = self._stage(camera)
        shift = standing.left - camera.pan_pixels(self._size[0])
        joints, part = joints_of(self._scene, state), shown(state)
        cast = place_cast(self._scene, camera, joints, SHADOW_MAP[self._quality])
        bounds = bounds_of(joints, self._reach)
        matrices = np.zeros((MOST_JOINTS, 3, 4), np.float32)
        matrices[: len(joints)] = skin_matrices(self._scene, joints)
        GL.glBindBuffer(GL.GL_UNIFORM_BUFFER, self._joints)
        GL.glBufferSubData(GL.GL_UNIFORM_BUFFER, 0, matrices.nbytes, matrices)
        GL.glBindBufferBase(GL.GL_UNIFORM_BUFFER, 0, self._joints)
        _set_state()
        light = light_matrix(cast)
        self._draw_shadow(light, cast, part)
        self._picture.copy_from(standing.target, (shift, 0, shift + self._size[0], self._size[1]), (0, 0))
        self._draw_ground(state, standing, shift, cast, light)
        self._draw_dancer(part, joints, camera, cast, light, bounds)
        return self._read()

    def close(self) -> None:
        """Free the context and all that is in it."""
        if self._platform is not None:
            self._platform.make_current()
            for primitive, *_ in self._primitives:
                primitive.delete()
            self._patches.delete()
            self.delete()
            self._platform.delete_context()
            self._platform = None

    def _stage(self, camera: Camera) -> Standing:
        key = replace(camera, pan=0.0)
        if self._standing is None or self._standing[0] != key:
            if self._standing is not None:
                self._standing[1].delete()
            self._standing = (key, Standing(self._scene, key, self._size, max(2, SAMPLES[self._quality])))
        return self._standing[1]

    def _draw_shadow(self, light: Array, cast: Cast, part: Shown) -> None:
        self._map.bind()
        GL.glDisable(GL.GL_SCISSOR_TEST)
        GL.glClear(GL.GL_DEPTH_BUFFER_BIT)
        if cast.scale:
            self._use_skinned("depth.frag", light, cast, to_map=1.0)
            GL.glCullFace(GL.GL_BACK)
            for primitive, *_ in self._primitives:
                primitive.draw(part)

    def _use_skinned(self, fragment: str, light: Array, cast: Cast, **more: Any) -> Program:
        program: Program = self._program_cache.program("skinned.vert", fragment)
        program.use(light=light, sun=cast.axes[2], off_surface=np.array(_OFF_SURFACE), **{"to_map": 0.0, **more})
        GL.glUniformBlockBinding(program.number, GL.glGetUniformBlockIndex(program.number, "Joints"), 0)
        return program

    def _draw_ground(self, state: FrameState, standing: Standing, shift: int, cast: Cast, light: Array) -> None:
        look = self._scene.look
        lit, colour = panel_lights(self._scene, state)
        refill(self._lights, np.column_stack([colour / 255.0, lit]).astype(np.float32)[None])
        feet = feet_on_floor(self._scene, state)
        part = within(light, joints_of(self._scene, state), self._reach)
        spread = float(max(1, round(look.light.shadow_soft * cast.scale / 2)) * 1.35 / self._map.size[0])
        touched = is_lit(standing.tiles, lit) | trodden(standing.tiles, feet, _foot_reach(look.light))
        if cast.scale:
            touched |= shaded(standing.tiles, light, part, spread)
        program: Program = self._program_cache.program("patches.vert", "ground.frag")
        units = {"standing": standing.colour, "ground": standing.ground, "panels": standing.panels}
        units |= {"lights": self._lights}
        program.use(
            shift=shift,
            light=light,
            dark=float(look.light.shadow if cast.scale else 0.0),
            within=part,
            spread=spread,
            contact=np.array([look.light.contact, look.light.contact_soft, look.stage.glow]),
            radius=SOLE_RADIUS,
            foot=feet[:, :4],
            foot_state=feet[:, [4, 5, 9]],
            foot_colour=feet[:, 6:9] / 255.0,
            shadow=_SHADOW_UNIT,
            **{name: unit for unit, name in enumerate(units)},
        )
        for unit, number in enumerate(units.values()):
            _bind_texture(unit, number)
        _bind_texture(_SHADOW_UNIT, self._map.texture)
        self._picture.bind()
        GL.glDisable(GL.GL_DEPTH_TEST)
        GL.glDisable(GL.GL_SCISSOR_TEST)
        touched &= standing.has_ground
        self._patches.draw(rectangles(touched) - [shift, 0, shift, 0], self._size)

    def _draw_dancer(
        self, part: Shown, joints: Array, camera: Camera, cast: Cast, light: Array, bounds: tuple[Array, Array]
    ) -> None:
        corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
        box = pixel_box(camera, bounds[0] + corners * (bounds[1] - bounds[0]), self._size)
        if box[0] >= box[2] or box[1] >= box[3]:
            return
        look, (width, height) = self._scene.look.toon, self._size
        self._drawn.bind()
        GL.glDisable(GL.GL_SCISSOR_TEST)  # to clear all of it is quicker than a part where a processor draws
        GL.glClear(GL.GL_COLOR_BUFFER_BIT | GL.GL_DEPTH_BUFFER_BIT)
        _scissor(self._fine * box)
        GL.glEnable(GL.GL_DEPTH_TEST)
        program = self._use_skinned(
            "dancer.frag",
            light,
            cast,
            camera=camera_matrix(camera, self._size),
            eye=np.array(camera.position),
            pixels=np.array([width / 2, height / 2]),
            focal=float(camera.focal * height),
            bands=np.array([*look.bands, look.soft]),
            levels=np.array(look.levels),
            rim=np.array([look.rim, look.rim_from]),
            shade=np.array(look.shade) / 255.0,
            outline_colour=np.array(look.outline) / 255.0,
            has_shadow=1.0 if cast.scale else 0.0,
            shadow=_SHADOW_UNIT,
            skin=_SKIN_UNIT,
        )
        _bind_texture(_SHADOW_UNIT, self._map.texture)
        wide = look.outline_width * pixels_per_metre(camera, joints, self._size)
        for outline, culled in ((0.0, GL.GL_BACK), (wide, GL.GL_FRONT)):
            program.set_uniform("outline", float(outline))
            GL.glCullFace(culled)
            for primitive, skin, tint, least in self._primitives:
                _bind_texture(_SKIN_UNIT, skin)
                program.set_uniform("tint", tint)
                program.set_uniform("least", least)
                primitive.draw(part)
        self._resolve(box)
        self._picture.bind()
        GL.glDisable(GL.GL_DEPTH_TEST)
        GL.glEnable(GL.GL_BLEND)
        GL.glBlendFunc(GL.GL_ONE, GL.GL_ONE_MINUS_SRC_ALPHA)
        copy: Program = self._program_cache.program("screen.vert", "copy.frag")
        copy.use(picture=_FIRST_UNIT)
        _bind_texture(_FIRST_UNIT, self._resolved.texture)
        _cover(copy)
        GL.glDisable(GL.GL_BLEND)

    def _resolve(self, box: NDArray[Any]) -> None:
        """The dancer's pixels from all that was drawn for each of them."""
        GL.glDisable(GL.GL_SCISSOR_TEST)
        x0, y0, x1, y1 = (int(v) for v in self._fine * box)
        if self._samples:
            self._whole.copy_from(self._drawn, (x0, y0, x1, y1), (x0, y0))
        self._resolved.copy_from(self._whole, (x0, y0, x1, y1), (int(box[0]), int(box[1])), self._fine)
        _scissor(box)

    def _read(self) -> NDArray[np.uint8]:
        GL.glDisable(GL.GL_SCISSOR_TEST)
        GL.glBindFramebuffer(GL.GL_READ_FRAMEBUFFER, self._picture.framebuffer)
        GL.glPixelStorei(GL.GL_PACK_ALIGNMENT, 1)
        width, height = self._size
        GL.glReadPixels(0, 0, width, height, GL.GL_RGB, GL.GL_UNSIGNED_BYTE, self._bytes)
        error = GL.glGetError()
        if error != GL.GL_NO_ERROR:
            raise UnavailableError(f"OpenGL failed with error {int(error):#06x} while drawing; use --renderer cpu")
        return self._bytes


def _foot_reach(light: LightLook) -> float:
    """Metres from the line between heel and toe that marks and contact shadows reach, pixels apart."""
    return SOLE_RADIUS + max(1.6 * light.contact_soft, _RING)


def _start(size: tuple[int, int]) -> EGLPlatform:
    """A context on the GPU if there is one, else on the first device: Mesa's software driver."""
    try:
        devices = query_devices()
        number = gpu_device() or 0
        platform = EGLPlatform(*size, device=devices[number] if devices else None)
        platform.init_context()
        platform.make_current()
    except Exception as error:  # PyOpenGL raises its own kinds, AssertionError, AttributeError, ...
        reason = " ".join(str(error).split()) or type(error).__name__
        raise UnavailableError(f"OpenGL does not start ({reason}); use --renderer cpu") from error
    return platform


def _set_state() -> None:
    """What the passes rely on. The picture's first row is y = 0, upside down for OpenGL: triangles turn clockwise."""
    GL.glEnable(GL.GL_CULL_FACE)
    GL.glFrontFace(GL.GL_CW)
    GL.glEnable(GL.GL_DEPTH_TEST)
    GL.glDepthMask(GL.GL_TRUE)
    GL.glDepthFunc(GL.GL_LESS)
    GL.glDisable(GL.GL_BLEND)
    GL.glEnable(GL.GL_MULTISAMPLE)
    GL.glClearColor(0.0, 0.0, 0.0, 0.0)
    GL.glClearDepth(1.0)
    GL.glPolygonMode(GL.GL_FRONT_AND_BACK, GL.GL_FILL)


def _bind_texture(unit: int, number: int) -> None:
    GL.glActiveTexture(GL.GL_TEXTURE0 + unit)
    GL.glBindTexture(GL.GL_TEXTURE_2D, number)


def _scissor(box: NDArray[Any]) -> None:
    x0, y0, x1, y1 = (int(v) for v in box)
    GL.glEnable(GL.GL_SCISSOR_TEST)
    GL.glScissor(x0, y0, max(x1 - x0, 0), max(y1 - y0, 0))


def _cover(program: Program) -> None:
    """Run the program's fragment shader for every pixel that the scissor leaves."""
    GL.glBindVertexArray(program.empty_array)
    GL.glDisable(GL.GL_CULL_FACE)
    GL.glDrawArrays(GL.GL_TRIANGLES, 0, 3)
    GL.glEnable(GL.GL_CULL_FACE)
