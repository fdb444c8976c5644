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
from dancetutor_cli.video.diagram import FeetDiagram, NextRows, PadMap, StepRows
from dancetutor_cli.video.film_look import FilmLook
from dancetutor_cli.video.highway import Highway, HighwayGeometry
from dancetutor_cli.video.layout import pixels
from dancetutor_cli.video.lights import PanelLights
from dancetutor_cli.video.notes import BeatLines, Callout, NoteTrack, Presses
from dancetutor_cli.video.scroll import parse_scroll
from dancetutor_cli.video.sprites import highway_style
from dancetutor_cli.video.television import Television
from dancetutor_cli.video.text import Typeface

if TYPE_CHECKING:
    from dancetutor_cli.character.model import Character
    from dancetutor_cli.motion.model import Motion
    from dancetutor_cli.video.dancer import Dancer
    from dancetutor_cli.video.stage import PadLike

BACKGROUND = (11, 12, 22)
BLOCK = 64  # frames whose joints are made at once


@dataclass(frozen=True, slots=True)
class FilmPlan:
    """All of a film before the first frame; worker processes get it pickled.

    beats : float64 (clock.frames,), the beat each frame shows, as drawn
    directions : per column, degrees clockwise from up, None for a middle panel
    character : who dances, the motion is for its skeleton; None for the project's own dancer
    motion : the dancer's, or None where the layout has none; rows : the play's, for the next rows' pads
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
    rows: StepRows | None = None
    callouts: tuple[Callout, ...] = ()
    character: Character | None = None


class Film:
    """Draws frames of a plan, in any order; the same frame always has the same bytes with the "cpu" renderer."""

    def __init__(self, plan: FilmPlan) -> None:
        self.plan = plan
        self.layout, self.size = plan.look.layout, plan.look.size
        self.columns = len(plan.directions)
        self.scale = self.layout.scale(self.size)
        self.face = Typeface(plan.look.font)
        self._block, self._block_joints = -1, np.zeros((0, 0, 4, 4))
        self.style = highway_style()
        self.lights = PanelLights(plan.presses, self.columns, self.style.panel_seconds)
        self.base = np.zeros((self.size[1], self.size[0], 3), dtype=np.uint8)
        self.base[...] = BACKGROUND
        self.highway = self._highway() if self.layout.highway else None
        if self.layout.screen:
            width, height = self.layout.screen.pixels
            self.screen_base = np.zeros((height, width, 3), dtype=np.uint8)
        if self.highway:
            self.highway.background(self.screen_base if self.layout.screen else self.base)

    def _highway(self) -> Highway:
        plan, part = self.plan, self.layout.highway
        assert part is not None
        box = self.layout.box("highway", self.size, self.columns)
        scale = 1.0 if self.layout.screen else self.scale
        lane = min(part.lane * scale, 0.8 * (box[2] - box[0]) / max(1, self.columns))
        down = part.down or plan.look.down
        share = 1 - part.receptor if down else part.receptor
        receptor = box[1] + share * (box[3] - box[1])
        geometry = HighwayGeometry(box, lane, receptor, plan.directions, down)
        scroll = plan.look.scroll or parse_scroll(part.scroll)
        return Highway(
            plan.notes, plan.presses, plan.lines, geometry, scroll, plan.fastest_bpm, self.face, plan.callouts
        )

    @cached_property
    def _words(self) -> list[overlay.Header | overlay.Legend]:
        """What is written and never changes."""
        out: list[overlay.Header | overlay.Legend] = []
        if part := self.layout.header:
            box = pixels(part.box, self.size)
            out.append(overlay.Header(self.plan.words, box, self.scale * part.text, self.face, self.style))
        if part := self.layout.legend:
            limbs = {int(limb) for limb in np.unique(self.plan.notes.limb) if limb >= 0}
            out.append(overlay.Legend(limbs, pixels(part.box, self.size), self.scale * part.text, self.face))
        return out

    @cached_property
    def _moving(self) -> tuple[overlay.Progress | None, overlay.Runs | None]:
        """What is written and changes."""
        progress, header = self.layout.progress, self.layout.header
        runs = overlay.Runs(self.plan.clock, self.size, self.scale * (header.text if header else 1.0), self.face)
        if not progress:
            return None, runs
        box = pixels(progress.box, self.size)
        return overlay.Progress(self.plan.song, box, self.scale * progress.text, self.face, self.style), runs

    @cached_property
    def _calls(self) -> overlay.Calls | None:
        """What is called out over the dancer shortly before it comes."""
        if not self.layout.dancer or not self.plan.callouts:
            return None
        box = self.layout.box("dancer", self.size, self.columns)
        return overlay.Calls(self.plan.callouts, box, self.scale, self.face, self.style)

    @cached_property
    def _dancer(self) -> Dancer:
        """The renderer of the dancer's box; made in the process that draws."""
        from dancetutor_cli.video import dancer

        plan, look = self.plan, self.plan.look
        left, top, right, bottom = self.layout.box("dancer", self.size, self.columns)
        assert self.layout.dancer is not None and plan.motion is not None and plan.pad is not None
        camera = look.camera or self.layout.dancer.camera
        size = (right - left, bottom - top)
        return dancer.Dancer(
            plan.motion, plan.pad, self.lights, size, camera, look.quality, look.renderer, plan.character,
            stands=self.layout.screen is not None,
        )  # fmt: skip

    @cached_property
    def _screen(self) -> Television | None:
        part = self.layout.screen
        return None if part is None else Television(part.centre, part.size, self._dancer.camera, self._dancer.still())

    @cached_property
    def _diagrams(self) -> tuple[FeetDiagram | None, NextRows | None]:
        plan, feet, after = self.plan, self.layout.feet, self.layout.next
        if plan.pad is None:
            return None, None
        large, small = None, None
        if feet:
            pads = PadMap(plan.pad, plan.directions, self.layout.box("feet", self.size, self.columns))
            large = FeetDiagram(pads, self.lights, self.face)
        if after and plan.rows is not None:
            box = self.layout.box("next", self.size, self.columns)
            small = NextRows(plan.rows, plan.pad, plan.directions, box, after.count, self.face)
        return large, small

    def frame(self, number: int) -> Frame:
        """Frame `number` of the film, uint8 (h, w, 3)."""
        second, run = self.plan.clock.at(number)
        beat = float(self.plan.beats[number])
        picture = self.base.copy()
        if self.layout.dancer and self.plan.motion is not None:
            left, top, right, bottom = self.layout.box("dancer", self.size, self.columns)
            picture[top:bottom, left:right] = self._room(number, second, beat)
        if self.highway and not self.layout.screen:
            self.highway.draw(picture, second, beat)
        large, small = self._diagrams
        if large:
            large.draw(picture, second, self._dancer.feet(self._joints(number)))
        if small:
            small.draw(picture, second)
        for words in self._words:
            words.draw(picture)
        progress, runs = self._moving
        if progress:
            progress.draw(picture, second)
        if self._calls:
            self._calls.draw(picture, second)
        if runs:
            runs.draw(picture, second, run)
        return picture

    def _joints(self, number: int) -> NDArray[np.float64]:
        """The dancer's joints in one frame. They are made in blocks, which is quick; always the same blocks, so that

        no bit of a frame depends on which frames were drawn before it.
        """
        block = number // BLOCK
        if block != self._block:
            frames = range(block * BLOCK, min((block + 1) * BLOCK, self.plan.clock.frames))
            self._block_joints = self._dancer.joints(np.array([self.plan.clock.at(k)[0] for k in frames]))
            self._block = block
        joints: NDArray[np.float64] = self._block_joints[number - block * BLOCK]
        return joints

    def _room(self, number: int, second: float, beat: float) -> Frame:
        """The dancer in her room, with the screen if the layout has one."""
        screen = self._screen
        frame = self._dancer.frame(second, self._joints(number))
        if screen is not None and self.highway is not None:
            shown = self.screen_base.copy()
            self.highway.draw(shown, second, beat)
            screen.draw(frame, shown)
        return frame

    def frames(self, first: int, last: int) -> Iterator[Frame]:
        """Frames first..last - 1."""
        for number in range(first, last):
            yield self.frame(number)
