"""The interface of both renderers, and the choice between them."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.film.choices import Quality, RendererKind
from dancetutor_cli.film.scene.scene import FrameState, Scene
from dancetutor_cli.run.errors import UsageError

MOST_JOINTS = 256  # size of the uniform block of gl's shaders


class Renderer(Protocol):
    """A renderer of frames of one scene in one size.

    Threads must not share a renderer. A worker process creates its own.
    """

    @property
    def name(self) -> str:
        """``cpu`` or ``gl``."""

    @property
    def description(self) -> str:
        """One line for people about the device and the method that draw."""

    def frame(self, state: FrameState) -> NDArray[np.uint8]:
        """Draw one frame: uint8 (h, w, 3), sRGB, top row first.

        The array belongs to the renderer and is overwritten by the next call; the caller may draw on it until then.
        """

    def close(self) -> None:
        """Free the resources of the renderer, which cannot draw after that."""


def create(
    scene: Scene, size: tuple[int, int] = (1280, 720), quality: Quality = "good", kind: RendererKind = "auto"
) -> Renderer:
    """Make a renderer.

    Parameters
    ----------
    scene : the scene to draw; size : (width, height) in pixels
    quality : ``draft`` one sample a pixel and no cast shadow, ``good`` 2x2 samples, ``best`` 4x4 samples
    kind : ``cpu`` needs nothing; ``gl`` needs OpenGL through EGL; ``auto`` takes ``gl`` if there is a real GPU,
        unless the character has too many joints for it

    Raises
    ------
    UsageError : an impossible size
    UnavailableError : ``gl`` without OpenGL
    """
    if not (16 <= size[0] <= 8192 and 16 <= size[1] <= 8192):
        raise UsageError(f"a picture of {size[0]}x{size[1]} pixels is not possible; 16 to 8192 each way")
    many = kind == "auto" and len(scene.character.skeleton.names) > MOST_JOINTS
    if not many and resolve_renderer(kind) == "gl":
        return _create_gl(scene, size, quality)
    from dancetutor_cli.film.scene.cpu.renderer import CpuRenderer

    return CpuRenderer(scene, size, quality)


def resolve_renderer(kind: RendererKind) -> RendererKind:
    """Return the renderer that "auto" means on this machine, or the named renderer."""
    if kind == "auto":
        return "gl" if _gpu() else "cpu"
    return kind


def _gpu() -> bool:
    from dancetutor_cli.film.scene.gl.available import gpu_device

    return gpu_device() is not None


def _create_gl(scene: Scene, size: tuple[int, int], quality: Quality) -> Renderer:
    from dancetutor_cli.film.scene.gl.available import load_pyrender

    load_pyrender()
    from dancetutor_cli.film.scene.gl.renderer import GlRenderer

    return GlRenderer(scene, size, quality)
