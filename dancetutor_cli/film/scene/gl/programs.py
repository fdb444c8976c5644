"""pyrender's shader programs and primitives with the project's shaders, and OpenGL's state around them."""

from __future__ import annotations

import ctypes
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from OpenGL import GL
from OpenGL.GL import shaders as gl_shaders
from pyrender.primitive import Primitive
from pyrender.shader_program import ShaderProgram, ShaderProgramCache

from dancetutor_cli.film.scene.geometry import PackedMeshes
from dancetutor_cli.film.scene.gl.available import SHADERS
from dancetutor_cli.film.scene.shared import DancerVisibility

# pyrender's shader programs with the project's shaders, with one look-up of each uniform, and with error checks.
#
# Import only after `available.load_pyrender`.


class Program(ShaderProgram):  # type: ignore[misc]
    """A shader program. Unlike in pyrender, a uniform that cannot be set is an error."""

    def __init__(self, vertex_shader: str, fragment_shader: str) -> None:
        super().__init__(vertex_shader, fragment_shader)
        self._places: dict[str, tuple[int, int]] = {}  # name: place and type

    def _add_to_context(self) -> None:
        """Compile and link the program.

        PyOpenGL's validation is left out, because samplers of different kinds get their units later.
        """
        self._vao_id = GL.glGenVertexArrays(1)
        parts = [
            gl_shaders.compileShader(self._load(self.vertex_shader), GL.GL_VERTEX_SHADER),
            gl_shaders.compileShader(self._load(self.fragment_shader), GL.GL_FRAGMENT_SHADER),
        ]
        program = GL.glCreateProgram()
        for part in parts:
            GL.glAttachShader(program, part)
        GL.glLinkProgram(program)
        if GL.glGetProgramiv(program, GL.GL_LINK_STATUS) != GL.GL_TRUE:
            raise RuntimeError(f"{Path(self.fragment_shader).name}: {GL.glGetProgramInfoLog(program)!r}")
        for part in parts:
            GL.glDeleteShader(part)
        self._program_id = program
        count = GL.glGetProgramiv(program, GL.GL_ACTIVE_UNIFORMS)
        for number in range(int(count)):
            name, _, kind = GL.glGetActiveUniform(program, number)
            text = (name if isinstance(name, bytes) else bytes(name)).decode("ascii").rstrip("\0").removesuffix("[0]")
            self._places[text] = (GL.glGetUniformLocation(program, text), int(kind))

    @property
    def number(self) -> int:
        """The number of the program in OpenGL."""
        return int(self._program_id)

    @property
    def empty_array(self) -> int:
        """A vertex array without attributes, for triangles that the shader creates."""
        return int(self._vao_id)

    def set_uniform(self, name: str, value: Any) -> None:
        """Set a uniform: int, float, a vector (n,), some vectors (k, n), or a matrix (4, 4).

        A uniform that the driver has optimised away, and that is not in the program, is ignored.
        """
        place, kind = self._places.get(name, (-1, 0))
        if place < 0:
            return
        if isinstance(value, int):
            GL.glUniform1i(place, value)
        elif isinstance(value, float):
            GL.glUniform1f(place, value)
        else:
            array = np.ascontiguousarray(value, dtype=np.float32)
            if kind == GL.GL_FLOAT_MAT4:
                GL.glUniformMatrix4fv(place, 1, GL.GL_TRUE, array)
            else:
                setters = {2: GL.glUniform2fv, 3: GL.glUniform3fv, 4: GL.glUniform4fv}
                setters[array.shape[-1]](place, 1 if array.ndim == 1 else len(array), array)

    def use(self, **uniforms: Any) -> None:
        """Make this the current program and set uniforms."""
        self._bind()
        for name, value in uniforms.items():
            self.set_uniform(name, value)


class ProgramCache(ShaderProgramCache):  # type: ignore[misc]
    """pyrender's cache, filled with `Program` from the project's own folder of shaders."""

    def __init__(self) -> None:
        super().__init__(str(SHADERS))

    def program(self, vertex: str, fragment: str) -> Program:
        """Return the program of two shader files, which is compiled once."""
        key = (vertex, fragment)
        if key not in self._program_cache:
            program = Program(str(SHADERS / vertex), str(SHADERS / fragment))
            program._add_to_context()
            self._program_cache[key] = program
        found = self._program_cache[key]
        assert isinstance(found, Program)
        return found


# The OpenGL state for the passes of the renderer. Import only after `available.load_pyrender`.


def set_state() -> None:
    """Set the state that all passes need.

    The picture's first row is y = 0, upside down for OpenGL, so that triangles are clockwise.
    """
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


def fill_scissor(program: Program) -> None:
    """Run the program's fragment shader for every pixel inside the scissor box."""
    GL.glBindVertexArray(program.empty_array)
    GL.glDisable(GL.GL_CULL_FACE)
    GL.glDrawArrays(GL.GL_TRIANGLES, 0, 3)
    GL.glEnable(GL.GL_CULL_FACE)


# pyrender's primitive with joints and weights in its vertex buffer, which pyrender leaves out.
#
# Import only after `available.load_pyrender`.

_FLOAT = 4  # bytes


class SkinnedPrimitive(Primitive):  # type: ignore[misc]
    """All triangles of one material, with attributes in the order of shaders/skinned.vert."""

    def __init__(self, mesh: PackedMeshes, material: int) -> None:
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

    def draw(self, part: DancerVisibility) -> None:
        """Draw the visible part of these triangles with the current program."""
        self._bind()
        count = {
            DancerVisibility.NOTHING: 0,
            DancerVisibility.FEET: 3 * self._feet,
            DancerVisibility.ALL: self._triangles.size,
        }[part]
        GL.glDrawElements(GL.GL_TRIANGLES, count, GL.GL_UNSIGNED_INT, ctypes.c_void_p(0))
