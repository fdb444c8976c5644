"""A film: everything that its frames need, as plain data that pickles, and the drawing of any one frame."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.video import overlay
from dancetutor_cli.video.blit import Frame
from dancetutor_cli.video.clock import Clock
from dancetutor_cli.video.film_look import FilmLook
from dancetutor_cli.video.highway import Highway, HighwayGeometry
from dancetutor_cli.video.layout import pixels
from dancetutor_cli.video.lights import PanelLights
from dancetutor_cli.video.notes import BeatLines, NoteTrack, Presses
from dancetutor_cli.video.scroll import parse_scroll
from dancetutor_cli.video.sprites import highway_style
from dancetutor_cli.video.text import Typeface

if TYPE_CHECKING:
    from dancetutor_cli.motion.model import Motion
    from dancetutor_cli.video.dancer import Dancer
    from dancetutor_cli.video.stage import PadLike


@dataclass(frozen=True, slots=True)
class FilmPlan:
    """All of a film before the first frame; worker processes get it pickled.

    beats : float64 (clock.frames,), the beat each frame shows, as drawn
    directions : per column, degrees clockwise from up, None for a middle panel
    motion : the dancer's, or None where the layout has none
    """

    look: FilmLook
    clock: Clock
    words: overlay.Words
    song: overlay.SongShape
    notes: NoteTrack
    presses: Presses
    lines: BeatLines
    beats: NDArray[np.float64]
    fastest_bpm: float
    directions: tuple[float | None, ...]
    motion: Motion | None
    pad: PadLike | None


class Film:
    """Draws frames of a plan, in any order; the same frame always has the same bytes with the "cpu" renderer."""

    def __init__(self, plan: FilmPlan) -> None:
        self.plan = plan
        look = plan.look
        width, height = look.size
        self.face = Typeface(look.font)
        self.base = np.zeros((height, width, 3), dtype=np.uint8)
        self.highway = self._highway() if look.layout.highway else None
        if self.highway:
            self.highway.background(self.base)

    @property
    def _scale(self) -> float:
        return self.plan.look.layout.scale(self.plan.look.size)

    def _highway(self) -> Highway:
        plan, part = self.plan, self.plan.look.layout.highway
        assert part is not None
        box = plan.look.layout.highway_box(plan.look.size, len(plan.directions))
        lane = min(part.lane * self._scale, 0.86 * (box[2] - box[0]) / max(1, len(plan.directions)))
        down = part.down or plan.look.down
        share = 1 - part.receptor if down else part.receptor
        receptor = box[1] + share * (box[3] - box[1])
        geometry = HighwayGeometry(box, lane, receptor, plan.directions, down)
        scroll = plan.look.scroll or parse_scroll(part.scroll)
        return Highway(plan.notes, plan.presses, plan.lines, geometry, scroll, plan.fastest_bpm, self.face)

    @cached_property
    def _overlays(self) -> tuple[overlay.Header | None, overlay.Legend | None, overlay.Progress | None]:
        plan, layout, style = self.plan, self.plan.look.layout, highway_style()
        size, scale, face = plan.look.size, self._scale, self.face
        header, legend, progress = layout.header, layout.legend, layout.progress
        limbs = {int(limb) for limb in np.unique(plan.notes.limb) if limb >= 0}
        return (
            overlay.Header(plan.words, pixels(header.box, size), scale * header.text, face, style) if header else None,
            overlay.Legend(limbs, pixels(legend.box, size), scale * legend.text, face) if legend else None,
            overlay.Progress(plan.song, pixels(progress.box, size), scale * progress.text, face, style)
            if progress
            else None,
        )

    @cached_property
    def _dancer(self) -> Dancer:
        """The renderer of the dancer's box; made in the process that draws."""
        from dancetutor_cli.video import dancer

        plan, look = self.plan, self.plan.look
        columns = len(plan.directions)
        left, top, right, bottom = look.layout.dancer_box(look.size, columns)
        assert look.layout.dancer is not None and plan.motion is not None and plan.pad is not None
        lights = PanelLights(plan.presses, columns, highway_style().panel_seconds)
        camera = look.camera or look.layout.dancer.camera
        size = (right - left, bottom - top)
        return dancer.Dancer(plan.motion, plan.pad, lights, size, camera, look.quality, look.renderer)

    def frame(self, number: int) -> Frame:
        """Frame `number` of the film, uint8 (h, w, 3)."""
        plan = self.plan
        second, _ = plan.clock.at(number)
        picture = self.base.copy()
        if plan.look.layout.dancer and plan.motion is not None:
            left, top, right, bottom = plan.look.layout.dancer_box(plan.look.size, len(plan.directions))
            picture[top:bottom, left:right] = self._dancer.frame(second)
        if self.highway:
            self.highway.draw(picture, second, float(plan.beats[number]))
        header, legend, progress = self._overlays
        if header:
            header.draw(picture)
        if legend:
            legend.draw(picture)
        if progress:
            progress.draw(picture, second)
        return picture

    def frames(self, first: int, last: int) -> Iterator[Frame]:
        """Frames first..last - 1."""
        for number in range(first, last):
            yield self.frame(number)
