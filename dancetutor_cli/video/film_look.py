"""How a film is to look, as asked for on the command line; light, so that wrong wishes are refused at once."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from dancetutor_cli.video.ahead import Ahead
from dancetutor_cli.video.choices import Quality, RendererKind
from dancetutor_cli.video.layout import Layout
from dancetutor_cli.video.scroll import Scroll


@dataclass(frozen=True, slots=True)
class FilmLook:
    """What does not change in a film. size : (width, height), even.

    camera, scroll : None for the layout's; down : notes fall; font : a font file, None for the built-in one
    ahead : how long before a move it is called out, None as configured; findings : call out the linter's, too
    """

    layout: Layout
    size: tuple[int, int]
    quality: Quality = "good"
    renderer: RendererKind = "auto"
    camera: str | None = None
    scroll: Scroll | None = None
    down: bool = False
    font: Path | None = None
    ahead: Ahead | None = None
    findings: bool = False
