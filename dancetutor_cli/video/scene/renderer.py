"""The one interface of both renderers, and the choice between them."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.errors import UsageError
from dancetutor_cli.video.choices import QUALITIES, RENDERERS, Quality, RendererKind
from dancetutor_cli.video.scene.scene import FrameState, Scene

MOST_JOINTS = 256  # what the uniform block of gl's shaders holds


class Renderer(Protocol):
    """Draws frames of one scene in one size. Not to be shared between threads; made after a process has started."""

    @property
    def name(self) -> str:
        """``cpu`` or ``gl``."""

    @property
    def description(self) -> str:
        """One line for people: what draws, and how."""

    def frame(self, state: FrameState) -> NDArray[np.uint8]:
        """Draw one frame: uint8 (h, w, 3), sRGB, top row first.

        The array belongs to the renderer and is overwritten by the next call; the caller may draw on it until then.
        """

    def close(self) -> None:
        """Give back what the renderer holds. It cannot draw after that."""


def create(
    scene: Scene, size: tuple[int, int] = (1280, 720), quality: Quality = "good", kind: RendererKind = "auto"
) -> Renderer:
    """Make a renderer.

    Parameters
    ----------
    scene : what to draw; size : (width, height) in pixels
    quality : ``draft`` one sample a pixel and no cast shadow, ``good`` 2x2 samples, ``best`` 4x4 samples
    kind : ``cpu`` needs nothing; ``gl`` needs OpenGL through EGL; ``auto`` takes ``gl`` where it is a real GPU,
        unless the character has too many joints for it

    Raises
    ------
    UsageError : unknown quality or kind, or a size that no picture can have
    UnavailableError : ``gl`` was asked for and there is no OpenGL
    """
    if quality not in QUALITIES:
        raise UsageError(f"no quality '{quality}'; there are: {', '.join(QUALITIES)}")
    if kind not in RENDERERS:
        raise UsageError(f"no renderer '{kind}'; there are: {', '.join(RENDERERS)}")
    if not (16 <= size[0] <= 8192 and 16 <= size[1] <= 8192):
        raise UsageError(f"a picture of {size[0]}x{size[1]} pixels is not possible; 16 to 8192 each way")
    many = kind == "auto" and len(scene.character.skeleton.names) > MOST_JOINTS
    if not many and chosen(kind) == "gl":
        return _create_gl(scene, size, quality)
    from dancetutor_cli.video.scene.cpu.renderer import CpuRenderer

    return CpuRenderer(scene, size, quality)


def chosen(kind: RendererKind) -> RendererKind:
    """The renderer that "auto" stands for here, or the one that is named."""
    if kind == "auto":
        return "gl" if _gpu() else "cpu"
    return kind


def _gpu() -> bool:
    from dancetutor_cli.video.scene.gl.available import gpu_device

    return gpu_device() is not None


def _create_gl(scene: Scene, size: tuple[int, int], quality: Quality) -> Renderer:
    from dancetutor_cli.video.scene.gl.compat import load_pyrender

    load_pyrender()
    from dancetutor_cli.video.scene.gl.renderer import GlRenderer

    return GlRenderer(scene, size, quality)
