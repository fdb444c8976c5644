"""The OpenGL renderer: the same picture as cpu/, with skinning, shadow, outline and light in shaders.

Import only after `available.load_pyrender`. Create a renderer in the process that uses it, because a context does not
survive a fork.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from OpenGL import GL
from pyrender.platforms.egl import EGLPlatform, query_devices
from pyrender.renderer import Renderer as PyrenderRenderer

from dancetutor_cli.dance.units import Array
from dancetutor_cli.film.choices import Quality
from dancetutor_cli.film.scene.camera import Camera
from dancetutor_cli.film.scene.geometry import pack
from dancetutor_cli.film.scene.gl.available import gpu_device
from dancetutor_cli.film.scene.gl.framebuffers import (
    Patches,
    StandingTarget,
    Target,
    foot_tiles,
    interpolate,
    is_lit,
    pyramid,
    rectangles,
    refill,
    shaded_tiles,
    texture,
)
from dancetutor_cli.film.scene.gl.programs import (
    Program,
    ProgramCache,
    SkinnedPrimitive,
    bind_texture,
    fill_scissor,
    scissor,
    set_state,
)
from dancetutor_cli.film.scene.look import LightLook
from dancetutor_cli.film.scene.renderer import MOST_JOINTS
from dancetutor_cli.film.scene.scene import SOLE_RADIUS, FrameState, Scene, check_state
from dancetutor_cli.film.scene.shared import (
    BLUE,
    GROUND,
    NEARNESS,
    PRESSED,
    RED,
    RING_SHARE,
    SAMPLES,
    SHADOW_FADE,
    SHADOW_MAP,
    STRENGTH,
    Cast,
    DancerVisibility,
    camera_matrix,
    dancer_visibility,
    feet_on_floor,
    hull_points,
    joint_boxes,
    joints_of,
    light_matrix,
    panel_lights,
    pixel_box,
    pixels_per_metre,
    place_cast,
    shadow_middles,
    shadow_part,
    skin_matrices,
)
from dancetutor_cli.run.errors import UnavailableError, UsageError

_OFF_SURFACE = (0.012, 0.006)
_RING = 0.032  # greatest distance of a ring of ground.frag from a sole, metres
_SHADOW_UNIT, _SKIN_UNIT, _FIRST_UNIT = 4, 5, 0


class _DancerInFrame(NamedTuple):
    """The dancer in one frame. part : her visible part; joints : (j, 4, 4)

    places : `film.scene.shared.hull_points`; cast, light : the place of her shadow map, and its matrix (4, 4)
    """

    part: DancerVisibility
    joints: Array
    places: Array
    cast: Cast
    light: Array


class GlRenderer(PyrenderRenderer):  # type: ignore[misc]
    """A renderer through EGL. See `film.scene.renderer.Renderer`."""

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
        # Draw two by two pixels for each pixel of the picture, which is faster than four samples if a processor draws.
        # More samples are samples of these pixels.
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
        self._held = joint_boxes(mesh.positions, mesh.joints, mesh.weights)
        self._map = Target((SHADOW_MAP[quality] or 1,) * 2, colour=False)
        fine = (self._fine * self._size[0], self._fine * self._size[1])
        self._drawn = Target(fine, self._samples, depth=True)
        self._whole = Target(fine) if self._samples else self._drawn
        interpolate(self._whole.texture)
        self._picture = Target(self._size)
        self._standing: tuple[Camera, StandingTarget] | None = None
        self._patches = Patches()
        self._lights = texture(np.zeros((1, max(scene.panels, 1), 4), np.float32))
        self._joints = int(GL.glGenBuffers(1))
        self._bytes = np.empty((self._size[1], self._size[0], 3), np.uint8)
        GL.glBindBuffer(GL.GL_UNIFORM_BUFFER, self._joints)
        GL.glBufferData(GL.GL_UNIFORM_BUFFER, MOST_JOINTS * 48, None, GL.GL_DYNAMIC_DRAW)

    def frame(self, state: FrameState) -> NDArray[np.uint8]:
        """See `film.scene.renderer.Renderer.frame`."""
        check_state(self._scene, state)
        self._platform.make_current()
        camera = state.camera
        standing = self._stage(camera)
        shift = standing.left - camera.pan_pixels(self._size[0])
        joints = joints_of(self._scene, state)
        cast = place_cast(self._scene, camera, joints, SHADOW_MAP[self._quality])
        skin = skin_matrices(self._scene, joints)
        places = hull_points(self._held, skin)
        dancer = _DancerInFrame(dancer_visibility(state), joints, places, cast, light_matrix(cast))
        matrices = np.zeros((MOST_JOINTS, 3, 4), np.float32)
        matrices[: len(joints)] = skin
        GL.glBindBuffer(GL.GL_UNIFORM_BUFFER, self._joints)
        GL.glBufferSubData(GL.GL_UNIFORM_BUFFER, 0, matrices.nbytes, matrices)
        GL.glBindBufferBase(GL.GL_UNIFORM_BUFFER, 0, self._joints)
        set_state()
        self._draw_shadow(dancer)
        self._picture.copy_from(standing.target, (shift, 0, shift + self._size[0], self._size[1]), (0, 0))
        self._draw_ground(state, standing, shift, dancer)
        self._draw_dancer(camera, dancer)
        return self._read()

    def close(self) -> None:
        """Free the context and everything in it."""
        if self._platform is not None:
            self._platform.make_current()
            for primitive, *_ in self._primitives:
                primitive.delete()
            self._patches.delete()
            self.delete()
            self._platform.delete_context()
            self._platform = None

    def _stage(self, camera: Camera) -> StandingTarget:
        key = replace(camera, pan=0.0)
        if self._standing is None or self._standing[0] != key:
            if self._standing is not None:
                self._standing[1].delete()
            self._standing = (key, StandingTarget(self._scene, key, self._size, max(2, SAMPLES[self._quality])))
        return self._standing[1]

    def _draw_shadow(self, dancer: _DancerInFrame) -> None:
        self._map.bind()
        GL.glDisable(GL.GL_SCISSOR_TEST)
        GL.glClear(GL.GL_DEPTH_BUFFER_BIT)
        if dancer.cast.scale:
            self._use_skinned("depth.frag", dancer, to_map=1.0)
            GL.glCullFace(GL.GL_BACK)
            for primitive, *_ in self._primitives:
                primitive.draw(dancer.part)

    def _use_skinned(self, fragment: str, dancer: _DancerInFrame, **more: Any) -> Program:
        program: Program = self._program_cache.program("skinned.vert", fragment)
        sun = {"light": dancer.light, "sun": dancer.cast.axes[2], "off_surface": np.array(_OFF_SURFACE)}
        program.use(**{**sun, "to_map": 0.0, "outline": 0.0, **more})
        GL.glUniformBlockBinding(program.number, GL.glGetUniformBlockIndex(program.number, "Joints"), 0)
        return program

    def _draw_ground(self, state: FrameState, standing: StandingTarget, shift: int, dancer: _DancerInFrame) -> None:
        look = self._scene.look
        lit, colour = panel_lights(self._scene, state)
        refill(self._lights, np.column_stack([colour / 255.0, lit]).astype(np.float32)[None])
        feet = feet_on_floor(self._scene, state)
        cast, part = dancer.cast, shadow_part(dancer.light, dancer.places)
        spread = float(max(1, round(look.light.shadow_soft * cast.scale / 2)) * 1.35 / self._map.size[0])
        under = foot_tiles(standing.tiles, feet, _foot_reach(look.light)) & standing.has_ground
        touched = is_lit(standing.tiles, lit)
        if cast.scale:
            touched |= shaded_tiles(standing.tiles, dancer.light, part, spread)
        program: Program = self._program_cache.program("patches.vert", "ground.frag")
        units = {"standing": standing.colour, "ground": standing.ground, "panels": standing.panels}
        units |= {"lights": self._lights}
        program.use(
            shift=shift,
            light=dancer.light,
            dark=float(look.light.shadow if cast.scale else 0.0),
            within=part,
            spread=spread,
            middles=shadow_middles(self._scene, dancer.joints),
            fade=np.array([*SHADOW_FADE, look.light.shadow_far]),
            contact=np.array([look.light.contact, look.light.contact_soft, look.stage.glow]),
            radius=SOLE_RADIUS,
            foot=feet[:, :GROUND],
            foot_state=feet[:, [GROUND, NEARNESS, STRENGTH, PRESSED]],
            beside=RING_SHARE,
            foot_colour=feet[:, RED : BLUE + 1] / 255.0,
            shadow=_SHADOW_UNIT,
            **{name: unit for unit, name in enumerate(units)},
        )
        for unit, number in enumerate(units.values()):
            bind_texture(unit, number)
        bind_texture(_SHADOW_UNIT, self._map.texture)
        self._picture.bind()
        GL.glDisable(GL.GL_DEPTH_TEST)
        GL.glDisable(GL.GL_SCISSOR_TEST)
        for tiles, count in ((touched & standing.has_ground & ~under, 0), (under, len(feet))):
            program.set_uniform("feet", count)
            self._patches.draw(rectangles(tiles) - [shift, 0, shift, 0], self._size)

    def _draw_dancer(self, camera: Camera, dancer: _DancerInFrame) -> None:
        look, (width, height) = self._scene.look.toon, self._size
        wide = look.outline_width * pixels_per_metre(camera, dancer.joints, self._size)
        box = pixel_box(camera, dancer.places, self._size)
        around = math.ceil(wide)  # width of the outline around the dancer
        box = np.clip(box + np.array([-around, -around, around, around]), 0, [width, height, width, height])
        if box[0] >= box[2] or box[1] >= box[3]:
            return
        self._drawn.bind()
        GL.glDisable(GL.GL_SCISSOR_TEST)  # if a processor draws, it clears the whole target faster than a part
        GL.glClear(GL.GL_COLOR_BUFFER_BIT | GL.GL_DEPTH_BUFFER_BIT)
        scissor(self._fine * box)
        GL.glEnable(GL.GL_DEPTH_TEST)
        view = {
            "camera": camera_matrix(camera, self._size),
            "eye": np.array(camera.position),
            "pixels": np.array([width / 2, height / 2]),
            "focal": float(camera.focal * height),
        }
        self._draw_skin(dancer, view)
        # The outline has its own shader, so that a processor does not compute the dancer's light for its pixels.
        self._use_skinned("outline.frag", dancer, outline=float(wide), line=np.array(look.outline) / 255.0, **view)
        GL.glCullFace(GL.GL_FRONT)
        for primitive, *_ in self._primitives:
            primitive.draw(dancer.part)
        self._lay_over(box)

    def _draw_skin(self, dancer: _DancerInFrame, view: dict[str, Any]) -> None:
        """Draw the dancer without the outline. view : the uniforms of the camera"""
        look = self._scene.look.toon
        program = self._use_skinned(
            "dancer.frag",
            dancer,
            bands=np.array([*look.bands, look.soft]),
            levels=np.array(look.levels),
            rim=np.array([look.rim, look.rim_from]),
            shade=np.array(look.shade) / 255.0,
            has_shadow=1.0 if dancer.cast.scale else 0.0,
            shadow=_SHADOW_UNIT,
            skin=_SKIN_UNIT,
            **view,
        )
        bind_texture(_SHADOW_UNIT, self._map.texture)
        GL.glCullFace(GL.GL_BACK)
        for primitive, skin, tint, least in self._primitives:
            bind_texture(_SKIN_UNIT, skin)
            program.set_uniform("tint", tint)
            program.set_uniform("least", least)
            primitive.draw(dancer.part)

    def _lay_over(self, box: NDArray[Any]) -> None:
        """Draw the dancer over the picture: each pixel is the mean of its fine pixels and samples."""
        if self._samples:
            GL.glDisable(GL.GL_SCISSOR_TEST)
            x0, y0, x1, y1 = (int(v) for v in self._fine * box)
            self._whole.copy_from(self._drawn, (x0, y0, x1, y1), (x0, y0))
        self._picture.bind()
        scissor(box)
        GL.glDisable(GL.GL_DEPTH_TEST)
        GL.glEnable(GL.GL_BLEND)
        GL.glBlendFunc(GL.GL_ONE, GL.GL_ONE_MINUS_SRC_ALPHA)
        over: Program = self._program_cache.program("screen.vert", "over.frag")
        over.use(drawn=_FIRST_UNIT, size=np.array(self._size))
        bind_texture(_FIRST_UNIT, self._whole.texture)
        fill_scissor(over)
        GL.glDisable(GL.GL_BLEND)

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
    """Return the reach of marks and contact shadows from the line between heel and toe, without the size of pixels."""
    return SOLE_RADIUS + max(1.6 * light.contact_soft, _RING)


def _start(size: tuple[int, int]) -> EGLPlatform:
    """Start a context on the GPU if there is one, else on the first device, which is Mesa's software driver."""
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
