"""A film: the drawing of any frame of its plan, and the things beside it: pictures, a poster, subtitles."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.chart.names import TICKS_PER_BEAT, TICKS_PER_MEASURE
from dancetutor_cli.film.clock import JointBlocks, Moments
from dancetutor_cli.film.layout import WIDE_PAD, PixelBox, lowered, overlap
from dancetutor_cli.film.notes import PanelLights, lighting
from dancetutor_cli.film.overlay import captions
from dancetutor_cli.film.overlay import marks as beside
from dancetutor_cli.film.overlay.announce import Calls, Runs
from dancetutor_cli.film.overlay.blit import Box
from dancetutor_cli.film.overlay.diagram import FeetDiagram, Lettering, NextRows, PadMap, PadView, below, name_sprite
from dancetutor_cli.film.overlay.header import Header, Lines, WordsRoom
from dancetutor_cli.film.overlay.highway import Highway, Score
from dancetutor_cli.film.overlay.marks import HighwayGeometry, lane_width_for_words
from dancetutor_cli.film.overlay.phrases import standing_tags
from dancetutor_cli.film.overlay.sprites import callout_words, highway_style
from dancetutor_cli.film.overlay.text import Typeface
from dancetutor_cli.film.picture import Frame, darkened
from dancetutor_cli.film.plan import FilmPlan, turned
from dancetutor_cli.film.scene.props import Television
from dancetutor_cli.film.scroll import parse_scroll
from dancetutor_cli.film.words import CALLS_OFF, CALLS_WIDE, LIMBS, Stay, calls_room, clear, dancing, moments, stay
from dancetutor_cli.run.errors import DancetutorError
from dancetutor_cli.run.files import encoded, write_atomic
from dancetutor_cli.run.languages import load_language
from dancetutor_cli.run.pictures import picture_bytes

if TYPE_CHECKING:
    from dancetutor_cli.film.scene.dancer import Dancer


# A film: the drawing of any one frame of its plan.

BACKGROUND = (12, 14, 26)
LANES, WIDE_LANES = 0.74, 0.78  # part of the highway's width that lanes may take, and lanes of wide pads
ALL_LANES = 0.87  # the same if there are no words, only numbers of measures
SQUARE = 2.5  # panel widths between the outer columns of a pad of one square, at most
LEGEND_OFF = 14.0  # pixels between the song's words and a legend below them


class Film:
    """Draws frames of a plan, in any order; the same frame always has the same bytes with the "cpu" renderer."""

    def __init__(self, plan: FilmPlan) -> None:
        self.plan = plan
        self.layout, self.size = plan.look.layout, plan.look.size
        self.columns = len(plan.directions)
        self.scale = self.layout.scale(self.size)
        self.face = Typeface(plan.look.font)
        self.language = load_language(plan.look.language)
        self._stays: dict[tuple[int, int], Stay] = {}
        self.style = highway_style()
        self.lights = PanelLights(lighting(plan.notes, plan.presses), self.columns, self.style.panel_seconds)
        self.base = np.zeros((self.size[1], self.size[0], 3), dtype=np.uint8)
        self.base[...] = BACKGROUND
        if (strip := self.layout.progress) is not None:  # up to the picture's edge, if the graph of it ends before that
            left, top, _, bottom = self._box("progress")
            captions.strip_ground(self.base[top:bottom, left:], self.scale * strip.text)
        self.highway = self._highway() if self.layout.highway else None
        if (screen := self.layout.screen_for(self._breadth)) is not None:
            width, height = screen.pixels
            self.screen_base = np.zeros((height, width, 3), dtype=np.uint8)
        if self.highway:
            self.highway.background(self.screen_base if self.layout.screen else self.base)

    def _highway(self) -> Highway:
        plan, part = self.plan, self.layout.highway
        assert part is not None
        box = self._box("highway")
        scale = 1.0 if self.layout.screen else self.scale
        usual = (LANES if self._breadth <= WIDE_PAD else WIDE_LANES) if part.tags else ALL_LANES
        share = self.layout.lanes(self._breadth) or usual
        lane = min(part.lane * scale, share * (box[2] - box[0]) / max(1, self.columns))
        down = part.down or plan.look.down
        share = 1 - part.receptor if down else part.receptor
        receptor = box[1] + share * (box[3] - box[1])
        tags = part.tags and beside.has_visible_callout(plan.callouts, plan.clock.passes)
        letters = beside.letters(scale)
        if tags:
            words = (*callout_words(self.language).values(), *standing_tags(self.language))
            texts = beside.callout_texts(plan.callouts, words)
            lane = lane_width_for_words(beside.room_for(texts, letters, self.face), lane, box, self.columns)
        geometry = HighwayGeometry(box, lane, receptor, self._directions, down, self.turned, tags, letters)
        scroll = plan.look.scroll or parse_scroll(part.scroll)
        score = Score(plan.notes, plan.presses, plan.lines, plan.callouts)
        return Highway(score, geometry, scroll, plan.scroll_bpm, self.face, self.language.film["facing-notes"])

    @cached_property
    def turned(self) -> bool:
        """Whether the dancer faces the viewer. Then all arrows turn with the pad, so that they agree with her steps."""
        return turned(self.plan.look)

    @property
    def _directions(self) -> tuple[float | None, ...]:
        turn = 180.0 if self.turned else 0.0
        return tuple(None if way is None else (way + turn) % 360.0 for way in self.plan.directions)

    def _box(self, name: str) -> PixelBox:
        return self.layout.box(name, self.size, self._breadth)

    @cached_property
    def _breadth(self) -> int:
        """The number of columns by which boxes are chosen: a pad of one square has the usual boxes, also with six
        panels.
        """
        pad = self.plan.pad
        square = pad is not None and float(np.ptp(np.asarray(pad.panels)[:, 0])) < SQUARE
        return min(self.columns, WIDE_PAD) if square else self.columns

    @cached_property
    def _header(self) -> Header | None:
        if (part := self.layout.header) is None:
            return None
        scale = self.scale * part.text
        room = WordsRoom(part.room, self._heads())
        return Header(self.plan.words, self._box("header"), scale, self.face, self.style, room)

    @cached_property
    def _legend(self) -> captions.Legend | None:
        if (part := self.layout.legend) is None:
            return None
        shown = sorted({0, 1} | beside.visible_limbs(self.plan.notes, self.plan.clock.passes))
        words, players = self.language.film, self.style.players if self.plan.notes.player.any() else ()
        box = self._below(self._box("legend"), LEGEND_OFF * self.scale * part.text)
        if (pads := self._feet_box) is not None and overlap(pads, box):
            under = lowered(box, pads[3] + LEGEND_OFF * self.scale)
            box = under if under[3] <= self.size[1] else box  # a user's own layout may leave no room there
        return captions.Legend(
            {limb: self.language.limbs[LIMBS[limb]] for limb in shown},
            box,
            self.scale * part.text,
            self.face,
            words["facing"] if self.turned and not self.layout.highway else "",
            [(words["player"].replace("{number}", str(n)), colour) for n, colour in enumerate(players, 1)],
        )

    def _below(self, box: PixelBox, off: float) -> PixelBox:
        """A box that keeps clear of the song's words, which may be many."""
        return box if self._header is None else self._header.clear(box, off)

    @cached_property
    def _feet_box(self) -> PixelBox | None:
        """Where the feet from above are; two dancers leave no room for them beside the dancers' own picture."""
        if (part := self.layout.feet) is None or not (part.wide or self._breadth <= WIDE_PAD):
            return None
        box = self._box("feet")
        taken = self.plan.dancers > 1 and overlap(box, self._box("dancer"))
        return None if taken else self._below(box, LEGEND_OFF * self.scale)

    @cached_property
    def _progress(self) -> captions.ProgressStrip | None:
        if (part := self.layout.progress) is None:
            return None
        return captions.ProgressStrip(
            self.plan.song, self._box("progress"), self.scale * part.text, self.face, self.style
        )

    @cached_property
    def _runs(self) -> Runs:
        """The label stands in its box, otherwise below the header, otherwise at the bottom of the picture."""
        box: tuple[float, ...] = 0, 0.84 * self.size[1], self.size[0], 0.93 * self.size[1]
        scale = self.scale
        if self.layout.runs is not None:
            box, scale = self._box("runs"), self.scale * self.layout.runs.text
        elif self._header is not None and self.layout.header is not None:
            scale = self.scale * self.layout.header.text
            box = self._box("header")[0], self._header.bottom + 9 * scale
        count = (0, 0, *self.size) if self.layout.count is None else self._box("count")
        return Runs(self.plan.clock, box, count, scale, self.face, self.language)

    @cached_property
    def _calls(self) -> Calls | None:
        """The calls shortly before moves, in their box, otherwise at the top right of the dancer's box.

        There they keep clear of the song's words, and of the dancer's head and feet, wherever she goes meanwhile.
        """
        if not self.layout.dancer or not self.plan.callouts:
            return None
        end = None if self._header is None else self._header.title_end
        room = calls_room(self.layout, self._box, self.scale, end)
        box = clear(room.box, self._heads_and_feet(), CALLS_WIDE * room.scale)
        return Calls(self.plan.callouts, box, room.scale, self.face, self.style, self.language)

    def _heads_and_feet(self) -> NDArray[np.float64]:
        """Where heads and feet are in the picture while moves are called out, (n, 4), a little larger."""
        if not self.plan.motions:
            return np.zeros((0, 4))
        return self._dancer_box(self._dancer.heads_and_feet(moments(self.plan.callouts, self.plan.clock.passes)))

    def _heads(self) -> NDArray[np.float64]:
        """The same for heads, all the time that she dances; feet are below the words there."""
        if not (self.layout.dancer and self.plan.motions):
            return np.zeros((0, 4))
        return self._dancer_box(self._dancer.heads_and_feet(dancing(self.plan.presses, self.plan.clock.passes)))

    def _dancer_box(self, seen: NDArray[np.float64]) -> NDArray[np.float64]:
        """Places of the dancer's box in the picture, with an edge around them."""
        left, top, _, _ = self._box("dancer")
        edge = CALLS_OFF * self.scale
        return np.asarray(seen + np.array([left - edge, top - edge, left + edge, top + edge]))

    @cached_property
    def _dancer(self) -> Dancer:
        """The renderer of the dancer's box; made in the process that draws."""
        from dancetutor_cli.film.scene import dancer

        plan, look = self.plan, self.plan.look
        left, top, right, bottom = self._box("dancer")
        assert self.layout.dancer is not None and plan.motions and plan.pad is not None
        camera = look.camera or self.layout.dancer.camera
        size = (right - left, bottom - top)
        shot = dancer.Shot(
            size,
            camera,
            look.quality,
            look.renderer,
            self.layout.region(self._breadth),
            stands=self.layout.screen is not None,
        )
        return dancer.Dancer(plan.motions, plan.pad, self.lights, shot, plan.character)

    @cached_property
    def _screen(self) -> Television | None:
        part = self.layout.screen_for(self._breadth)
        return None if part is None else Television(part.centre, part.size, self._dancer.camera, self._dancer.still())

    @cached_property
    def _diagrams(self) -> tuple[FeetDiagram | None, NextRows | None]:
        plan, feet, after = self.plan, self._feet_box, self.layout.next
        if plan.pad is None:
            return None, None
        large, small = None, None
        view = PadView(plan.pad, self._directions, self.turned)
        if feet:
            rims = self.style.players if plan.dancers > 1 else (captions.WHITE,)
            now = name_sprite(self.language.film["now"], self.face, self.scale) if after else None
            large = FeetDiagram(PadMap(view, below(feet, now)), self.lights, self.face, rims, now)
        if after and plan.rows is not None:
            box = self._box("next")
            small = NextRows(plan.rows, view, box, after.count, Lettering(self.face, self.scale, self.language.film))
        return large, small

    def frame(self, number: int) -> Frame:
        """Frame `number` of the film, uint8 (h, w, 3)."""
        second, run = self.plan.clock.at(number)
        beat = float(self.plan.beats[number])
        picture = self.base.copy()
        if self.layout.dancer and self.plan.motions:
            left, top, right, bottom = self._box("dancer")
            picture[top:bottom, left:right] = self._room(number, beat)
        if self.highway and not self.layout.screen:
            self.highway.draw(picture, second, beat, self._speed(number))
        large, small = self._diagrams
        if large:
            seen = self._stay(large, run).opacity(second)
            large.draw(picture, second, self._dancer.feet(self._joints.at(number)), seen)
        if small:
            small.draw(picture, second)
        for words in (*(self._header.parts if self._header else ()), self._legend):
            if words:
                words.draw(picture, self._stay(words, run).opacity(second))
        for moving in (self._progress, self._calls):
            if moving:
                moving.draw(picture, second)
        self._runs.draw(picture, second, run, self._stay(self._runs, run).opacity(second))
        return darkened(picture, BACKGROUND, self.plan.light(number))

    def _stay(self, words: Lines | captions.Legend | Runs | FeetDiagram, run: int) -> Stay:
        """When these words are in the picture: not while the dancer walks through them."""
        if (key := (id(words), run)) not in self._stays:
            self._stays[key] = self._stay_of_run(words.boxes, run)
        return self._stays[key]

    def _stay_of_run(self, boxes: list[Box], run: int) -> Stay:
        if not (self.layout.dancer and self.plan.motions and boxes):
            return Stay()
        left, top, right, bottom = self._box("dancer")
        inside = [(max(a, left), max(b, top), min(c, right), min(d, bottom)) for a, b, c, d in boxes]
        there = [(a - left, b - top, c - left, d - top) for a, b, c, d in inside if a < c and b < d]
        one = self.plan.clock.passes[run]
        return stay(
            one, self.plan.presses, lambda seconds, step: self._dancer.walks_behind(there, seconds, step, one.rate)
        )

    def _speed(self, number: int) -> float:
        return 1.0 if self.plan.speeds is None else float(self.plan.speeds[number])

    @cached_property
    def _joints(self) -> JointBlocks:
        return JointBlocks(self._dancer.joints, self.plan.clock)

    def _room(self, number: int, beat: float) -> Frame:
        """The dancer in her room, with the screen if the layout has one."""
        screen, moment = self._screen, self.plan.clock.moment(number)
        frame, second = self._dancer.frame(moment, self._joints.at(number)), moment.second
        if screen is not None and self.highway is not None:
            shown = self.screen_base.copy()
            self.highway.draw(shown, second, beat, self._speed(number))
            screen.draw(frame, shown)
        return frame

    def frames(self, first: int, last: int) -> Iterator[Frame]:
        """Frames first..last - 1."""
        for number in range(first, last):
            yield self.frame(number)


# What can be made besides a film: a picture for each row, a poster, subtitles.

INDEX = "poses.json"


def poses(plan: FilmPlan, label: str) -> FilmPlan:
    """The film of a plan, with one frame for each row with a step: what an editor shows while its user scrolls."""
    start, end = plan.clock.passes[0].start, plan.clock.passes[0].end
    rows = plan.rows
    times = () if rows is None else tuple(float(t) for t in rows.second if start <= t <= end)
    if not times:
        raise DancetutorError(f"{label}: there is no step here, so there is no pose to draw")
    clock = Moments(plan.clock.passes[:1], plan.clock.fps, times)
    beats = np.interp(times, plan.lines.second, plan.lines.beat) if len(plan.lines.second) else np.zeros(len(times))
    return replace(plan, clock=clock, beats=beats)


def write_pose_index(folder: Path, song: Song, chart: Chart, plan: FilmPlan) -> None:
    """Write which picture shows which row: an object with one entry for each picture."""
    assert isinstance(plan.clock, Moments)
    notes = chart.notes
    seconds = chart.timing.seconds(notes.tick)
    entries = []
    for number, time in enumerate(plan.clock.times):
        note = int(np.argmin(np.abs(seconds - time)))
        tick = int(notes.tick[note])
        entries.append(
            {
                "picture": f"frame_{number:06d}.png",
                "beat": tick / TICKS_PER_BEAT,
                "measure": tick // TICKS_PER_MEASURE,
                "second": round(time, 6),
                "line": int(notes.line[note]),
            }
        )
    data = {"schema": 1, "path": song.path.name, "chart": chart.label, "poses": entries}
    write_atomic(folder / INDEX, encoded(json.dumps(data, ensure_ascii=False, indent=1) + "\n"))


def write_poster(path: Path, plan: FilmPlan) -> None:
    """A picture for a title page: the first called-out move, or a note a third into the film."""
    one = plan.clock.passes[-1]
    first = max(one.start, one.sound_from) + 1.0
    calls = [call.second for call in plan.callouts if first <= call.second <= one.end]
    steps = plan.presses.start
    aim = one.start + (one.end - one.start) / 3
    moment = calls[0] if calls else float(steps[np.argmin(np.abs(steps - aim))]) if len(steps) else aim
    before = sum(other.seconds for other in plan.clock.passes[:-1])
    number = round((before + one.film_seconds(moment)) * plan.clock.fps + 0.5)
    picture = Film(plan).frame(min(number, plan.clock.frames - 1))
    write_atomic(path, picture_bytes(picture))


def write_subtitles(path: Path, plan: FilmPlan) -> str | None:
    """Subtitles that name the moves, beside the film. Returns a warning if there is nothing to name, so no file."""
    from dancetutor_cli.film.media.subtitles import subtitle_style, subtitles

    text = subtitles(plan.cues, plan.clock, subtitle_style())
    if not text:
        path.unlink(missing_ok=True)  # one of an earlier film would lie
        return f"no move of this film has a name, so there is no {path.name}; configs/subtitles.yaml says what is named"
    write_atomic(path, text.encode())
    return None
