"""Textures and framebuffers of the OpenGL renderer, the still picture in them, and the redrawn parts of the floor."""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
from numpy.typing import NDArray
from OpenGL import GL

from dancetutor_cli.dance.units import Array
from dancetutor_cli.film.scene.camera import Camera
from dancetutor_cli.film.scene.cpu.standing import SEVERAL, TILE, GroundTiles, draw_background
from dancetutor_cli.film.scene.scene import Scene
from dancetutor_cli.film.scene.shared import GROUND, NEARNESS

# Textures and framebuffers of the OpenGL renderer. Import only after `available.load_pyrender`.

_FORMATS = {1: GL.GL_RED, 3: GL.GL_RGB, 4: GL.GL_RGBA}
_STORED = {
    (np.dtype(np.uint8), 3): GL.GL_RGB8,
    (np.dtype(np.uint8), 4): GL.GL_RGBA8,
    (np.dtype(np.float32), 3): GL.GL_RGB32F,
    (np.dtype(np.float32), 4): GL.GL_RGBA32F,
}


def texture(image: NDArray[Any]) -> int:
    """Create a texture of an image (h, w, 3 or 4) of uint8 or float32, for reads of single texels.

    The first row is at v = 0.
    """
    number = int(GL.glGenTextures(1))
    GL.glBindTexture(GL.GL_TEXTURE_2D, number)
    _parameters(GL.GL_NEAREST, GL.GL_NEAREST, GL.GL_REPEAT)
    refill(number, image)
    return number


def pyramid(images: tuple[NDArray[np.uint8], ...]) -> int:
    """Create a smooth texture of an image and its smaller copies."""
    number = int(GL.glGenTextures(1))
    GL.glBindTexture(GL.GL_TEXTURE_2D, number)
    _parameters(GL.GL_LINEAR_MIPMAP_NEAREST, GL.GL_LINEAR, GL.GL_REPEAT, len(images) - 1)
    for level, image in enumerate(images):
        refill(number, image, level)
    return number


def refill(number: int, image: NDArray[Any], level: int = 0) -> None:
    """Give a texture, or a level of its pyramid, another image."""
    data = np.ascontiguousarray(image)
    height, width, channels = data.shape
    GL.glBindTexture(GL.GL_TEXTURE_2D, number)
    GL.glPixelStorei(GL.GL_UNPACK_ALIGNMENT, 1)
    GL.glTexImage2D(
        GL.GL_TEXTURE_2D,
        level,
        _STORED[data.dtype, channels],
        width,
        height,
        0,
        _FORMATS[channels],
        GL.GL_UNSIGNED_BYTE if data.dtype == np.uint8 else GL.GL_FLOAT,
        data,
    )


def interpolate(number: int) -> None:
    """Allow interpolated reads between the texels of a texture."""
    GL.glBindTexture(GL.GL_TEXTURE_2D, number)
    _parameters(GL.GL_LINEAR, GL.GL_LINEAR, GL.GL_CLAMP_TO_EDGE)


def _parameters(small: int, large: int, wrap: int, levels: int = 0) -> None:
    for name, value in (
        (GL.GL_TEXTURE_MIN_FILTER, small),
        (GL.GL_TEXTURE_MAG_FILTER, large),
        (GL.GL_TEXTURE_WRAP_S, wrap),
        (GL.GL_TEXTURE_WRAP_T, wrap),
        (GL.GL_TEXTURE_MAX_LEVEL, levels),
    ):
        GL.glTexParameteri(GL.GL_TEXTURE_2D, name, value)


class Target:
    """A framebuffer to draw into: a colour texture, a multisampled colour buffer with depth, or a shadow map."""

    def __init__(self, size: tuple[int, int], samples: int = 0, depth: bool = False, colour: bool = True) -> None:
        width, height = self.size = size
        self.framebuffer = int(GL.glGenFramebuffers(1))
        self.texture = 0
        self._buffers: list[int] = []
        GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, self.framebuffer)
        if samples > 0:
            self._add_buffer(GL.GL_COLOR_ATTACHMENT0, GL.GL_RGBA8, samples)
        elif colour:
            self.texture = texture(np.zeros((height, width, 4), np.uint8))
            self._attach(GL.GL_COLOR_ATTACHMENT0)
        else:
            self.texture = _shadow_texture(size)
            self._attach(GL.GL_DEPTH_ATTACHMENT)
            GL.glDrawBuffer(GL.GL_NONE)
            GL.glReadBuffer(GL.GL_NONE)
        if depth:
            self._add_buffer(GL.GL_DEPTH_ATTACHMENT, GL.GL_DEPTH_COMPONENT24, samples)
        if GL.glCheckFramebufferStatus(GL.GL_FRAMEBUFFER) != GL.GL_FRAMEBUFFER_COMPLETE:
            raise RuntimeError(f"OpenGL makes no framebuffer of {width}x{height} pixels and {samples} samples")

    def _attach(self, place: int) -> None:
        GL.glFramebufferTexture2D(GL.GL_FRAMEBUFFER, place, GL.GL_TEXTURE_2D, self.texture, 0)

    def _add_buffer(self, place: int, kind: int, samples: int) -> None:
        buffer = int(GL.glGenRenderbuffers(1))
        self._buffers.append(buffer)
        GL.glBindRenderbuffer(GL.GL_RENDERBUFFER, buffer)
        GL.glRenderbufferStorageMultisample(GL.GL_RENDERBUFFER, samples, kind, *self.size)
        GL.glFramebufferRenderbuffer(GL.GL_FRAMEBUFFER, place, GL.GL_RENDERBUFFER, buffer)

    def bind(self) -> None:
        """Make this the target of all later drawing."""
        GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, self.framebuffer)
        GL.glViewport(0, 0, *self.size)

    def copy_from(self, other: Target, box: tuple[int, int, int, int], to: tuple[int, int]) -> None:
        """Copy the pixels of `box` (x0, y0, x1, y1) of another target, with the box's first corner at `to`.

        Samples of a pixel become their mean.
        """
        GL.glBindFramebuffer(GL.GL_READ_FRAMEBUFFER, other.framebuffer)
        GL.glBindFramebuffer(GL.GL_DRAW_FRAMEBUFFER, self.framebuffer)
        x0, y0, x1, y1 = box
        end = to[0] + x1 - x0, to[1] + y1 - y0
        GL.glBlitFramebuffer(x0, y0, x1, y1, *to, *end, GL.GL_COLOR_BUFFER_BIT, GL.GL_NEAREST)

    def delete(self) -> None:
        """Free the memory."""
        GL.glDeleteFramebuffers(1, [self.framebuffer])
        if self.texture:
            GL.glDeleteTextures([self.texture])
        if self._buffers:
            GL.glDeleteRenderbuffers(len(self._buffers), self._buffers)


def _shadow_texture(size: tuple[int, int]) -> int:
    """Create a depth texture for comparisons by a sampler, with four neighbours weighted by the hardware."""
    number = int(GL.glGenTextures(1))
    GL.glBindTexture(GL.GL_TEXTURE_2D, number)
    _parameters(GL.GL_LINEAR, GL.GL_LINEAR, GL.GL_CLAMP_TO_EDGE)
    GL.glTexParameteri(GL.GL_TEXTURE_2D, GL.GL_TEXTURE_COMPARE_MODE, GL.GL_COMPARE_REF_TO_TEXTURE)
    GL.glTexParameteri(GL.GL_TEXTURE_2D, GL.GL_TEXTURE_COMPARE_FUNC, GL.GL_LEQUAL)
    GL.glTexImage2D(GL.GL_TEXTURE_2D, 0, GL.GL_DEPTH_COMPONENT24, *size, 0, GL.GL_DEPTH_COMPONENT, GL.GL_FLOAT, None)
    return number


# The parts of the floor with light, shadow or marks, which alone are drawn again.
#
# They are found tile by tile, as in cpu/floor.py. Import only after `available.load_pyrender`.

_NEAR = 0.03  # metres above or below the ground under a foot within which the ground has its marks


def has_ground(tiles: GroundTiles) -> NDArray[np.bool_]:
    """Return whether each tile (t, u) has ground; the values of the other tiles have no meaning."""
    return tiles.low[..., 0] <= tiles.high[..., 0]


def shaded_tiles(tiles: GroundTiles, light: Array, part: Array, spread: float) -> NDArray[np.bool_]:
    """Return whether the shadow may fall on each tile (t, u). light : `film.scene.shared.light_matrix`

    part : `film.scene.shared.shadow_part`; spread : distance of the shadow's taps, as a share of the map
    """
    out = np.ones(tiles.panel.shape, dtype=bool)
    for axis in (0, 1):
        row = light[axis] * 0.5
        ends = [(tiles.low[..., k] * row[k], tiles.high[..., k] * row[k]) for k in range(3)]
        middle = row[3] + 0.5
        least, most = (
            np.sum([extreme(a, b) for a, b in ends], axis=0) + middle for extreme in (np.minimum, np.maximum)
        )
        out &= (most >= part[axis] - 2.0 * spread) & (least <= part[axis + 2] + 2.0 * spread)
    return out


def foot_tiles(tiles: GroundTiles, feet: Array, far: float) -> NDArray[np.bool_]:
    """Return whether the marks of a foot may fall on each tile.

    feet : `shared.feet_on_floor`; far : reach from the line between heel and toe, metres, without the size of pixels
    """
    out = np.zeros(tiles.panel.shape, dtype=bool)
    reach = far + tiles.coarse
    for heel_x, heel_z, toe_x, toe_z, ground in feet[feet[:, NEARNESS] >= 0.0, : GROUND + 1]:
        here = (tiles.low[..., 1] - _NEAR <= ground) & (tiles.high[..., 1] + _NEAR >= ground)
        for k, a, b in ((0, heel_x, toe_x), (2, heel_z, toe_z)):
            here &= (tiles.low[..., k] <= max(a, b) + reach) & (tiles.high[..., k] >= min(a, b) - reach)
        out |= here
    return out


def is_lit(tiles: GroundTiles, lit: Array) -> NDArray[np.bool_]:
    """Return whether each tile has a pixel of a lit panel. lit : (panels,)"""
    some = np.append(lit > 0.0, False)  # the last entry is for -1, no panel
    return np.where(tiles.panel == SEVERAL, bool(some.any()), some[np.maximum(tiles.panel, -1)])


def rectangles(touched: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return rectangles of neighbouring tiles in a row: x0, y0, x1, y1 in pixels of the still picture, (n, 4)."""
    edges = np.diff(np.pad(touched.astype(np.int8), ((0, 0), (1, 1))), axis=1)
    row, first = np.nonzero(edges == 1)
    last = np.nonzero(edges == -1)[1]
    return TILE * np.column_stack([first, row, last, row + 1]).astype(np.int64)


class Patches:
    """Rectangles that are drawn with the current program, which is made of patches.vert."""

    def __init__(self) -> None:
        self._array, self._buffer = int(GL.glGenVertexArrays(1)), int(GL.glGenBuffers(1))
        GL.glBindVertexArray(self._array)
        GL.glBindBuffer(GL.GL_ARRAY_BUFFER, self._buffer)
        GL.glEnableVertexAttribArray(0)
        GL.glVertexAttribPointer(0, 2, GL.GL_FLOAT, GL.GL_FALSE, 0, ctypes.c_void_p(0))
        GL.glBindVertexArray(0)

    def draw(self, boxes: NDArray[Any], size: tuple[int, int]) -> None:
        """Draw rectangles. boxes : x0, y0, x1, y1 in pixels of a target of that size, (n, 4)"""
        if not len(boxes):
            return
        ends = boxes / np.array([*size, *size]) * 2.0 - 1.0
        corners = ends[:, [0, 1, 2, 1, 0, 3, 0, 3, 2, 1, 2, 3]].astype(np.float32)
        GL.glBindVertexArray(self._array)
        GL.glBindBuffer(GL.GL_ARRAY_BUFFER, self._buffer)
        GL.glBufferData(GL.GL_ARRAY_BUFFER, corners.nbytes, corners, GL.GL_STREAM_DRAW)
        GL.glDisable(GL.GL_CULL_FACE)
        GL.glDrawArrays(GL.GL_TRIANGLES, 0, 6 * len(boxes))
        GL.glEnable(GL.GL_CULL_FACE)
        GL.glBindVertexArray(0)

    def delete(self) -> None:
        """Free the memory."""
        GL.glDeleteVertexArrays(1, [self._array])
        GL.glDeleteBuffers(1, [self._buffer])


# The still part of the picture as textures. cpu/standing.py draws it for both renderers, once for each camera.
#
# Import only after `available.load_pyrender`.


class StandingTarget:
    """The data of `cpu.standing.Background` for the shader ground.frag; `target` has the picture to copy.

    tiles : the ground in squares of pixels, for patches.vert; has_ground : bool (t, u), whether each tile has ground
    """

    def __init__(self, scene: Scene, camera: Camera, size: tuple[int, int], samples: int) -> None:
        drawn = draw_background(scene.stage, scene.look, camera, size, samples)
        height, width = drawn.takes.shape
        self.left = drawn.left
        self.has_ground = has_ground(drawn.tiles)
        self.tiles = drawn.tiles._replace(
            low=np.where(self.has_ground[..., None], drawn.tiles.low, 0.0),
            high=np.where(self.has_ground[..., None], drawn.tiles.high, 0.0),
        )
        self.target = Target((width, height))
        opaque = np.full((height, width, 1), 255, np.uint8)
        refill(self.target.texture, np.dstack([drawn.picture, opaque]))
        self.colour = texture(np.dstack([drawn.colour / np.float32(255.0), drawn.takes]))
        self.ground = texture(np.dstack([drawn.ground, drawn.footprint]))
        info = (drawn.panel.astype(np.float32), drawn.glow, drawn.white, np.zeros_like(drawn.glow))
        self.panels = texture(np.dstack(info))

    def delete(self) -> None:
        """Free the memory."""
        self.target.delete()
        GL.glDeleteTextures([self.colour, self.ground, self.panels])
