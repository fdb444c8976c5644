"""A film, which draws any frame of its plan."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.film.clock import JointBlocks
from dancetutor_cli.film.layout import WIDE_PAD
from dancetutor_cli.film.notes import PanelLights, lighting
from dancetutor_cli.film.overlay import footer, marks, sprites
from dancetutor_cli.film.overlay.announce import Runs
from dancetutor_cli.film.overlay.blit import Box
from dancetutor_cli.film.overlay.diagram import (
    FeetDiagram,
    Lettering,
    NextRows,
    PadMap,
    PadView,
    box_below,
    name_sprite,
)
from dancetutor_cli.film.overlay.header import Lines
from dancetutor_cli.film.overlay.highway import Highway, Score
from dancetutor_cli.film.overlay.marks import HighwayGeometry, lane_width_for_words
from dancetutor_cli.film.overlay.sprites import WordStyle, callout_words, highway_style
from dancetutor_cli.film.overlay.text import Typeface
from dancetutor_cli.film.picture import Frame, darkened
from dancetutor_cli.film.placement import PartBoxes, Placement, Stay, place_words, stay_of
from dancetutor_cli.film.plan import FilmPlan, faces_viewer
from dancetutor_cli.film.scene.props import Television
from dancetutor_cli.film.scroll import parse_scroll
from dancetutor_cli.film.words import standing_tags
from dancetutor_cli.run.languages import load_language

if TYPE_CHECKING:
    from dancetutor_cli.film.overlay.footer import Legend
    from dancetutor_cli.film.scene.dancer import Dancer

    MakesWay = Lines | Legend | Runs | FeetDiagram

BACKGROUND = (12, 14, 26)
LANES, WIDE_LANES = 0.74, 0.78  # the greatest share of the highway's width for the lanes, of usual and of wide pads
ALL_LANES = 0.87  # the same share for a highway with measure numbers but without words


class Film:
    """A film that draws the frames of a plan in any order.

    With the "cpu" renderer, the same frame always has the same bytes.
    """

    def __init__(self, plan: FilmPlan) -> None:
        self.plan = plan
        self.layout, self.size = plan.look.layout, plan.look.size
        self.columns = len(plan.directions)
        self.boxes = PartBoxes.of(plan)
        self.scale = self.boxes.scale
        self.face = Typeface(plan.look.font)
        self.language = load_language(plan.look.language)
        self._stays: dict[tuple[MakesWay, int], Stay] = {}
        self.style = highway_style()
        self.lights = PanelLights(lighting(plan.notes, plan.presses), self.columns, self.style.panel_seconds)
        self.base = np.zeros((self.size[1], self.size[0], 3), dtype=np.uint8)
        self.base[...] = BACKGROUND
        if (strip := self.layout.progress) is not None:  # the ground reaches the picture's edge, the graph may not
            left, top, _, bottom = self.boxes.box("progress")
            footer.strip_ground(self.base[top:bottom, left:], self.scale * strip.text)
        self.highway = self._highway() if self.layout.highway else None
        if (screen := self.layout.screen_for(self.boxes.breadth)) is not None:
            width, height = screen.pixels
            self.screen_base = np.zeros((height, width, 3), dtype=np.uint8)
        if self.highway:
            self.highway.background(self.screen_base if self.layout.screen else self.base)

    def _highway(self) -> Highway:
        plan, part = self.plan, self.layout.highway
        assert part is not None
        box = self.boxes.box("highway")
        scale = 1.0 if self.layout.screen else self.scale
        usual = (LANES if self.boxes.breadth <= WIDE_PAD else WIDE_LANES) if part.tags else ALL_LANES
        share = self.layout.lanes(self.boxes.breadth) or usual
        lane = min(part.lane * scale, share * (box[2] - box[0]) / max(1, self.columns))
        down = part.down or plan.look.down
        share = 1 - part.receptor if down else part.receptor
        receptor = box[1] + share * (box[3] - box[1])
        tags = part.tags and marks.has_visible_callout(plan.callouts, plan.clock.passes)
        letters = marks.letters(scale)
        if tags:
            words = (*callout_words(self.language).values(), *standing_tags(self.language))
            texts = marks.callout_texts(plan.callouts, words)
            lane = lane_width_for_words(marks.room_for(texts, letters, self.face), lane, box, self.columns)
        facing = self.language.film["facing-notes"]
        geometry = HighwayGeometry(
            box, lane, receptor, self._directions, down, self.faces_viewer, tags, letters, facing
        )
        scroll = plan.look.scroll or parse_scroll(part.scroll)
        score = Score(plan.notes, plan.presses, plan.lines, plan.callouts)
        return Highway(score, geometry, scroll, plan.scroll_bpm, self.face)

    @cached_property
    def faces_viewer(self) -> bool:
        """Whether the dancer faces the viewer. Then all arrows turn with the pad, so that they agree with her steps."""
        return faces_viewer(self.plan.look)

    @property
    def _directions(self) -> tuple[float | None, ...]:
        turn = 180.0 if self.faces_viewer else 0.0
        return tuple(None if way is None else (way + turn) % 360.0 for way in self.plan.directions)

    @cached_property
    def placement(self) -> Placement:
        """The places of the words, for all frames."""
        dancer = self._dancer.heads_and_feet if self.layout.dancer and self.plan.motions else None
        lettering = WordStyle(self.face, self.style, self.language)
        return place_words(self.plan, self.boxes, lettering, dancer, self.faces_viewer)

    @cached_property
    def _progress(self) -> footer.ProgressStrip | None:
        if (part := self.layout.progress) is None:
            return None
        return footer.ProgressStrip(
            self.plan.song, self.boxes.box("progress"), self.scale * part.text, self.face, self.style
        )

    @cached_property
    def _dancer(self) -> Dancer:
        """The renderer of the dancer's box, which is created in the process that draws."""
        from dancetutor_cli.film.scene import dancer

        plan, look = self.plan, self.plan.look
        left, top, right, bottom = self.boxes.box("dancer")
        assert self.layout.dancer is not None and plan.motions and plan.pad is not None
        camera = look.camera or self.layout.dancer.camera
        size = (right - left, bottom - top)
        shot = dancer.Shot(
            size,
            camera,
            look.quality,
            look.renderer,
            self.layout.region(self.boxes.breadth),
            stands=self.layout.screen is not None,
        )
        return dancer.Dancer(plan.motions, plan.pad, self.lights, shot, plan.character)

    @cached_property
    def _screen(self) -> Television | None:
        part = self.layout.screen_for(self.boxes.breadth)
        return None if part is None else Television(part.centre, part.size, self._dancer.camera, self._dancer.still())

    @cached_property
    def _diagrams(self) -> tuple[FeetDiagram | None, NextRows | None]:
        plan, feet, after = self.plan, self.placement.feet, self.layout.next
        if plan.pad is None:
            return None, None
        large, small = None, None
        view = PadView(plan.pad, self._directions, self.faces_viewer)
        if feet:
            rims = self.style.players if plan.dancers > 1 else (sprites.WHITE,)
            now = name_sprite(self.language.film["now"], self.face, self.scale) if after else None
            large = FeetDiagram(PadMap(view, box_below(feet, now)), self.lights, self.face, rims, now)
        if after and plan.rows is not None:
            box = self.boxes.box("next")
            small = NextRows(plan.rows, view, box, after.count, Lettering(self.face, self.scale, self.language.film))
        return large, small

    def frame(self, number: int) -> Frame:
        """Draw frame `number` of the film, uint8 (h, w, 3)."""
        second, pass_number = self.plan.clock.at(number)
        beat = float(self.plan.beats[number])
        picture = self.base.copy()
        if self.layout.dancer and self.plan.motions:
            left, top, right, bottom = self.boxes.box("dancer")
            picture[top:bottom, left:right] = self._room(number, beat)
        if self.highway and not self.layout.screen:
            self.highway.draw(picture, second, beat, self._speed(number))
        large, small = self._diagrams
        if large:
            seen = self._stay(large, pass_number).opacity(second)
            large.draw(picture, second, self._dancer.feet(self._joints.at(number)), seen)
        if small:
            small.draw(picture, second)
        place = self.placement
        for words in (*(place.header.parts if place.header else ()), place.legend):
            if words:
                words.draw(picture, self._stay(words, pass_number).opacity(second))
        for moving in (self._progress, place.calls):
            if moving:
                moving.draw(picture, second)
        place.runs.draw(picture, second, pass_number, self._stay(place.runs, pass_number).opacity(second))
        return darkened(picture, BACKGROUND, self.plan.light(number))

    def _stay(self, words: MakesWay, pass_number: int) -> Stay:
        """Return the time in which these words are in the picture: they are hidden while the dancer walks past them."""
        if (words, pass_number) not in self._stays:
            self._stays[words, pass_number] = self._stay_in_pass(words.boxes, pass_number)
        return self._stays[words, pass_number]

    def _stay_in_pass(self, boxes: list[Box], pass_number: int) -> Stay:
        if not (self.layout.dancer and self.plan.motions and boxes):
            return Stay()
        left, top, right, bottom = self.boxes.box("dancer")
        inside = [(max(a, left), max(b, top), min(c, right), min(d, bottom)) for a, b, c, d in boxes]
        there = [(a - left, b - top, c - left, d - top) for a, b, c, d in inside if a < c and b < d]
        one = self.plan.clock.passes[pass_number]
        return stay_of(
            one, self.plan.presses, lambda seconds, step: self._dancer.walks_behind(there, seconds, step, one.rate)
        )

    def _speed(self, number: int) -> float:
        return 1.0 if self.plan.speeds is None else float(self.plan.speeds[number])

    @cached_property
    def _joints(self) -> JointBlocks:
        return JointBlocks(self._dancer.joints, self.plan.clock)

    def _room(self, number: int, beat: float) -> Frame:
        """Draw the dancer in her room, with the screen if the layout has one."""
        screen, moment = self._screen, self.plan.clock.moment(number)
        frame, second = self._dancer.frame(moment, self._joints.at(number)), moment.second
        if screen is not None and self.highway is not None:
            shown = self.screen_base.copy()
            self.highway.draw(shown, second, beat, self._speed(number))
            screen.draw(frame, shown)
        return frame

    def frames(self, first: int, last: int) -> Iterator[Frame]:
        """Draw the frames from `first` to `last` - 1."""
        for number in range(first, last):
            yield self.frame(number)
