"""Textures and framebuffers of the OpenGL renderer. Import only after `compat.load_pyrender`."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from OpenGL import GL

_FORMATS = {1: GL.GL_RED, 3: GL.GL_RGB, 4: GL.GL_RGBA}
_STORED = {
    (np.dtype(np.uint8), 3): GL.GL_RGB8,
    (np.dtype(np.uint8), 4): GL.GL_RGBA8,
    (np.dtype(np.float32), 3): GL.GL_RGB32F,
    (np.dtype(np.float32), 4): GL.GL_RGBA32F,
}


def texture(image: NDArray[Any]) -> int:
    """A texture of an image (h, w, 3 or 4) of uint8 or float32, its first row at v = 0, for reading single texels."""
    number = int(GL.glGenTextures(1))
    GL.glBindTexture(GL.GL_TEXTURE_2D, number)
    _parameters(GL.GL_NEAREST, GL.GL_NEAREST, GL.GL_REPEAT)
    refill(number, image)
    return number


def pyramid(images: tuple[NDArray[np.uint8], ...]) -> int:
    """A smooth texture of an image and its halvings."""
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


def smooth(number: int) -> None:
    """Let a texture be read between its texels."""
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
        """Draw into it from now on."""
        GL.glBindFramebuffer(GL.GL_FRAMEBUFFER, self.framebuffer)
        GL.glViewport(0, 0, *self.size)

    def copy_from(self, other: Target, box: tuple[int, int, int, int], to: tuple[int, int]) -> None:
        """Copy the pixels of `box` (x0, y0, x1, y1) of another target so that its first corner lies at `to`.

        Samples of a pixel become their mean.
        """
        GL.glBindFramebuffer(GL.GL_READ_FRAMEBUFFER, other.framebuffer)
        GL.glBindFramebuffer(GL.GL_DRAW_FRAMEBUFFER, self.framebuffer)
        x0, y0, x1, y1 = box
        end = to[0] + x1 - x0, to[1] + y1 - y0
        GL.glBlitFramebuffer(x0, y0, x1, y1, *to, *end, GL.GL_COLOR_BUFFER_BIT, GL.GL_NEAREST)

    def delete(self) -> None:
        """Give its memory back."""
        GL.glDeleteFramebuffers(1, [self.framebuffer])
        if self.texture:
            GL.glDeleteTextures([self.texture])
        if self._buffers:
            GL.glDeleteRenderbuffers(len(self._buffers), self._buffers)


def _shadow_texture(size: tuple[int, int]) -> int:
    """Depth that a sampler compares with, four neighbours weighted by the hardware."""
    number = int(GL.glGenTextures(1))
    GL.glBindTexture(GL.GL_TEXTURE_2D, number)
    _parameters(GL.GL_LINEAR, GL.GL_LINEAR, GL.GL_CLAMP_TO_EDGE)
    GL.glTexParameteri(GL.GL_TEXTURE_2D, GL.GL_TEXTURE_COMPARE_MODE, GL.GL_COMPARE_REF_TO_TEXTURE)
    GL.glTexParameteri(GL.GL_TEXTURE_2D, GL.GL_TEXTURE_COMPARE_FUNC, GL.GL_LEQUAL)
    GL.glTexImage2D(GL.GL_TEXTURE_2D, 0, GL.GL_DEPTH_COMPONENT24, *size, 0, GL.GL_DEPTH_COMPONENT, GL.GL_FLOAT, None)
    return number
