"""pyrender's primitive with joints and weights in its vertex buffer, which pyrender leaves out.

Import only after `compat.load_pyrender`.
"""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
from numpy.typing import NDArray
from OpenGL import GL
from pyrender.primitive import Primitive

from dancetutor_cli.video.scene.geometry import Packed
from dancetutor_cli.video.scene.prepare import Shown

_FLOAT = 4  # bytes


class SkinnedPrimitive(Primitive):  # type: ignore[misc]
    """All triangles of one material; attributes in the order of shaders/skinned.vert."""

    def __init__(self, mesh: Packed, material: int) -> None:
        super().__init__(mesh.positions, normals=mesh.normals, texcoord_0=mesh.uv)
        ours = mesh.material[mesh.triangles[:, 0]] == material
        self._triangles = np.ascontiguousarray(mesh.triangles[ours], dtype=np.uint32)
        self._feet = int(ours[: mesh.feet].sum())
        self._columns: tuple[NDArray[Any], ...] = (
            mesh.positions,
            mesh.normals,
            mesh.hull,
            mesh.uv,
            mesh.joints.astype(np.float32),
            mesh.weights,
            mesh.above[:, None],
        )

    def _add_to_context(self) -> None:
        self._vaid = GL.glGenVertexArrays(1)
        GL.glBindVertexArray(self._vaid)
        data = np.ascontiguousarray(np.hstack(self._columns), dtype=np.float32)
        self._buffers = [GL.glGenBuffers(1), GL.glGenBuffers(1)]
        GL.glBindBuffer(GL.GL_ARRAY_BUFFER, self._buffers[0])
        GL.glBufferData(GL.GL_ARRAY_BUFFER, data.nbytes, data, GL.GL_STATIC_DRAW)
        offset = 0
        for number, column in enumerate(self._columns):
            width = column.shape[1]
            GL.glEnableVertexAttribArray(number)
            GL.glVertexAttribPointer(
                number, width, GL.GL_FLOAT, GL.GL_FALSE, data.shape[1] * _FLOAT, ctypes.c_void_p(offset * _FLOAT)
            )
            offset += width
        GL.glBindBuffer(GL.GL_ELEMENT_ARRAY_BUFFER, self._buffers[1])
        GL.glBufferData(GL.GL_ELEMENT_ARRAY_BUFFER, self._triangles.nbytes, self._triangles, GL.GL_STATIC_DRAW)
        GL.glBindVertexArray(0)

    def draw(self, part: Shown) -> None:
        """Draw it, or the part of it that is shown, with the current program."""
        self._bind()
        count = {Shown.NOTHING: 0, Shown.FEET: 3 * self._feet, Shown.ALL: self._triangles.size}[part]
        GL.glDrawElements(GL.GL_TRIANGLES, count, GL.GL_UNSIGNED_INT, ctypes.c_void_p(0))
