"""pyrender's shader programs with the project's shaders, uniforms that are found once, and errors that are heard.

Import only after `compat.load_pyrender`.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from OpenGL import GL
from OpenGL.GL import shaders as gl_shaders
from pyrender.shader_program import ShaderProgram, ShaderProgramCache

from dancetutor_cli.video.scene.gl.sources import SHADERS


class Program(ShaderProgram):  # type: ignore[misc]
    """A shader program. Unlike pyrender's, a uniform that cannot be set is an error, not silence."""

    def __init__(self, vertex_shader: str, fragment_shader: str) -> None:
        super().__init__(vertex_shader, fragment_shader)
        self._places: dict[str, tuple[int, int]] = {}  # name: place and type

    def _add_to_context(self) -> None:
        """Compile and link. Not validated as PyOpenGL does: samplers of different kinds get their units later."""
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
        """OpenGL's name of the program."""
        return int(self._program_id)

    @property
    def empty_array(self) -> int:
        """A vertex array without attributes, for triangles that the shader makes."""
        return int(self._vao_id)

    def set_uniform(self, name: str, value: Any, unsigned: bool = False) -> None:
        """Set a uniform: int, float, a vector (n,), some vectors (k, n), or a matrix (4, 4).

        One that the driver has optimised away is no error: it is not in the program then.
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
        """Make it the current program and set uniforms."""
        self._bind()
        for name, value in uniforms.items():
            self.set_uniform(name, value)


class ProgramCache(ShaderProgramCache):  # type: ignore[misc]
    """pyrender's cache, filled with `Program` from the project's own folder of shaders."""

    def __init__(self) -> None:
        super().__init__(str(SHADERS))

    def program(self, vertex: str, fragment: str) -> Program:
        """The program of two shader files, compiled once."""
        key = (vertex, fragment)
        if key not in self._program_cache:
            program = Program(str(SHADERS / vertex), str(SHADERS / fragment))
            program._add_to_context()
            self._program_cache[key] = program
        found = self._program_cache[key]
        assert isinstance(found, Program)
        return found
