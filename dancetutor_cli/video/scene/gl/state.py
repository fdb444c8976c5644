"""OpenGL's state that the passes of the renderer set. Import only after `compat.load_pyrender`."""

from __future__ import annotations

from typing import Any

from numpy.typing import NDArray
from OpenGL import GL

from dancetutor_cli.video.scene.gl.programs import Program


def set_state() -> None:
    """What all passes rely on. The picture's first row is y = 0, upside down for OpenGL: triangles turn clockwise."""
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


def bind_texture(unit: int, number: int) -> None:
    GL.glActiveTexture(GL.GL_TEXTURE0 + unit)
    GL.glBindTexture(GL.GL_TEXTURE_2D, number)


def scissor(box: NDArray[Any]) -> None:
    x0, y0, x1, y1 = (int(v) for v in box)
    GL.glEnable(GL.GL_SCISSOR_TEST)
    GL.glScissor(x0, y0, max(x1 - x0, 0), max(y1 - y0, 0))


def cover(program: Program) -> None:
    """Run the program's fragment shader for every pixel that the scissor leaves."""
    GL.glBindVertexArray(program.empty_array)
    GL.glDisable(GL.GL_CULL_FACE)
    GL.glDrawArrays(GL.GL_TRIANGLES, 0, 3)
    GL.glEnable(GL.GL_CULL_FACE)
