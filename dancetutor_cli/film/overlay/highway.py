"""The highway: notes that scroll to their receptors, with L/R markers, holds, mines, beat lines and flashes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Kind
from dancetutor_cli.feet.limbs import limb_colours
from dancetutor_cli.film.notes import QUANTISATIONS, BeatLines, Callout, NoteTrack, PanelLights, Presses, lighting
from dancetutor_cli.film.overlay import marks, sprites
from dancetutor_cli.film.overlay.blit import Ink, Run, Sprite, draw_rectangle, draw_sprite, fill_run
from dancetutor_cli.film.overlay.marks import EDGE, NUMBER_EDGE, NUMBER_OFF, HighwayGeometry, Marks
from dancetutor_cli.film.overlay.text import Typeface, fit_text
from dancetutor_cli.film.picture import Frame
from dancetutor_cli.film.scroll import Scroll
from dancetutor_cli.run.schema import RGB

BEATS_PER_MEASURE = 4
NUMBER_SHARE = 0.019  # minimum height of a measure's number, as a share of the box's height
LET_GO = 0.25  # opacity of the part of a hold or roll that nobody plays
TAGS_APART = 2.0  # pixels between two tags
# Minimum size of a label's letters: pixels, because smaller letters cannot be read; share of the box's height.
FLAG_LEAST, FLAG_SHARE = 10.0, 0.026


@dataclass(frozen=True, slots=True)
class _Now:
    """A moment. second : second of the music; beat : beat as drawn

    spacing : pixels per beat, or per second with C mods
    """

    second: float
    beat: float
    spacing: float


class Score(NamedTuple):
    """The parts of a chart that a highway shows."""

    notes: NoteTrack
    presses: Presses
    lines: BeatLines
    callouts: tuple[Callout, ...] = ()


class Highway:
    """The highway of one chart. It has no state that changes between frames: any frame may be drawn at any time."""

    def __init__(
        self, score: Score, geometry: HighwayGeometry, scroll: Scroll, scroll_bpm: float, face: Typeface
    ) -> None:
        self.notes, self.presses, self.lines, self.callouts = score
        self.geometry, self.face = geometry, face
        self._tags = marks.row_tags(self.callouts)
        self._tag_seconds = np.array([tag.second for tag in self._tags])
        self._tag_beats = np.array([tag.beat for tag in self._tags])
        self.by_time = scroll.mode == "C"
        self.spacing = scroll.factor(scroll_bpm) * geometry.lane * (-1 if geometry.down else 1)
        self.style = sprites.highway_style()
        self.size = sprites.arrow_size(geometry.lane, self.style)
        # The colour of a note shows its quantisation or, in a chart for two, its player.
        self.colours = (*(self.style.quantisation[q] for q in QUANTISATIONS), *self.style.players)
        whose = len(QUANTISATIONS) + self.notes.player.astype(np.int64) - 1
        self.colour = np.where(self.notes.player > 0, whose, self.notes.quantisation)
        self.limb_colours = limb_colours().by_limb
        self.lights = PanelLights(
            lighting(self.notes, self.presses), len(geometry.directions), self.style.flash_seconds
        )
        self._number = lru_cache(maxsize=256)(self._draw_number)
        self._flag = lru_cache(maxsize=64)(self._draw_flag)
        self._make_sprites()

    def _make_sprites(self) -> None:
        style, size, directions = self.style, self.size, self.geometry.directions
        kinds = set(directions)
        is_lift = self.notes.kind == Kind.LIFT
        self.arrows, self.lifts = self._arrows(~is_lift, hollow=False), self._arrows(is_lift, hollow=True)
        self.fakes = {d: sprites.arrow(size, d, style.fake) for d in kinds}
        self.receptors = {d: sprites.receptor(size, d, style.receptor) for d in kinds}
        glows = dict(enumerate((*self.limb_colours, style.receptor)))
        used = {int(limb) for limb in np.unique(self.lights.presses.limb)}
        self.glows = {(d, i): sprites.glow(size, d, c) for d in kinds for i, c in glows.items() if i in used or i == 4}
        self.mine = sprites.mine(size, style.mine)
        body = max(4, round(0.62 * size))
        self.bodies = {k: sprites.hold_body(body, c, k[0] == Kind.ROLL) for k, c in self._hold_colours()}
        self.tails = {k: sprites.hold_tail(body, c) for k, c in self._hold_colours()}
        self.marks = Marks(self.notes, self.geometry, style, self.face, self.by_time)

    def _arrows(self, which: NDArray[np.bool_], hollow: bool) -> dict[tuple[float | None, int], Sprite]:
        """Draw the sprites of the notes `which`, by direction and index of the colour, as far as the chart has them."""
        pairs = {(int(c), int(q)) for c, q in zip(self.notes.column[which], self.colour[which], strict=True)}
        wanted = {(self.geometry.directions[c], q) for c, q in pairs}
        return {(d, q): sprites.arrow(self.size, d, self.colours[q], hollow) for d, q in wanted}

    def _hold_colours(self) -> Iterator[tuple[tuple[Kind, int], RGB]]:
        """Return the colours of holds and rolls, by player."""
        for player in range(int(self.notes.player.max(initial=0)) + 1):
            for kind, colour in ((Kind.HOLD, self.style.hold), (Kind.ROLL, self.style.roll)):
                yield (kind, player), self.style.players[player - 1] if player else colour

    def background(self, frame: Frame) -> None:
        """Draw the still part, panel and lanes, which is needed only once."""
        _, top, _, bottom = self.geometry.box
        draw_rectangle(frame, self.geometry.box, self.style.background, 0.82)
        lane, x0 = self.geometry.lane, self.geometry.left
        edge = EDGE * lane
        x1 = x0 + lane * len(self.geometry.directions)
        draw_rectangle(frame, (x0 - edge, top, x1 + edge, bottom), (0, 0, 0), 0.35)
        for x in (x0 - edge, x1 + edge):
            draw_rectangle(frame, (x - 1, top, x + 1, bottom), self.style.lane_line, 0.3)
        for i in range(1, len(self.geometry.directions)):
            draw_rectangle(frame, (x0 + i * lane - 0.5, top, x0 + i * lane + 0.5, bottom), self.style.lane_line, 0.08)

    def draw(self, frame: Frame, second: float, beat: float, speed: float = 1.0) -> None:
        """Draw everything that moves at `second` of the music.

        beat : beat as drawn (scroll segments applied); speed : factor of the speed segments, which C mods ignore
        """
        now = _Now(second, beat, self.spacing * (1.0 if self.by_time else speed))
        self._draw_lines(frame, now)
        self._draw_receptors(frame, second, beat)
        self._draw_notes(frame, now)
        self._draw_callouts(frame, now)
        if self.geometry.turned:
            self._draw_turned(frame)

    def _y(self, seconds: NDArray[np.float64], beats: NDArray[np.float64], now: _Now) -> NDArray[np.float64]:
        """Return the y coordinates of the middles of notes or lines at `seconds` and `beats`, pixels."""
        away = seconds - now.second if self.by_time else beats - now.beat
        result: NDArray[np.float64] = self.geometry.receptor + away * now.spacing
        return result

    def _visible(self, y: NDArray[np.float64], margin: float) -> NDArray[np.bool_]:
        _, top, _, bottom = self.geometry.box
        return (y > top - margin) & (y < bottom + margin)

    def _draw_lines(self, frame: Frame, now: _Now) -> None:
        y = self._y(self.lines.second, self.lines.beat, now)
        lane = self.geometry.lane
        shown = np.flatnonzero(self._visible(y, 2))
        if len(shown) > 400:  # at this density the lines would form a wall
            shown = shown[shown % BEATS_PER_MEASURE == 0][:400]
        x0 = self.geometry.left - EDGE * lane
        x1 = self.geometry.left + lane * (len(self.geometry.directions) + EDGE)
        last_label = -1e9
        for i in shown:
            strong = i % BEATS_PER_MEASURE == 0
            half = (1.25 if strong else 0.6) * lane / 84
            draw_rectangle(frame, (x0, y[i] - half, x1, y[i] + half), self.style.lane_line, 0.42 if strong else 0.13)
            if strong and abs(y[i] - last_label) > 0.3 * lane:
                last_label = y[i]
                number = self._number(int(i) // BEATS_PER_MEASURE)
                x = x0 - number.shape[1] - 0.06 * lane
                draw_sprite(frame, number, x, y[i] - number.shape[0] / 2, 0.75, self._rows)

    @property
    def _rows(self) -> tuple[int, int]:
        return self.geometry.box[1], self.geometry.box[3]

    def _draw_number(self, measure: int) -> Sprite:
        size = max(0.21 * self.geometry.lane, NUMBER_SHARE * (self.geometry.box[3] - self.geometry.box[1]))
        left, top, _, bottom = self.geometry.box
        room = self.geometry.left - NUMBER_OFF * self.geometry.lane - left - NUMBER_EDGE * (bottom - top)
        (text,), size = fit_text(str(measure), size, room, self.face, most=1)
        return self.face.sprite(text, size, (190, 196, 220))

    def _draw_callouts(self, frame: Frame, now: _Now) -> None:
        """Draw words beside their rows, on the right of the lanes.

        If several words are near each other, the later ones move away, so that none covers another.
        """
        if not self.geometry.tags:
            return
        y = self._y(self._tag_seconds, self._tag_beats, now)
        x = self.geometry.tags_left
        way, free = 1.0 if now.spacing >= 0 else -1.0, -np.inf
        shown = np.flatnonzero(self._visible(y, self.size))
        for i in shown[np.argsort(way * y[shown], kind="stable")]:
            flag = self._flag(self._tags[i].words, self._tags[i].severity)
            middle = max(way * y[i], free + flag.shape[0] / 2)
            free = middle + flag.shape[0] / 2 + TAGS_APART
            at, (top, bottom) = way * middle - flag.shape[0] / 2, self._rows
            # A label is drawn whole or not at all.
            if self._tag_seconds[i] > now.second and top <= at and at + flag.shape[0] <= bottom:
                draw_sprite(frame, flag, x, at, 1.0, self._rows)

    def _draw_flag(self, text: str, severity: str) -> Sprite:
        geometry = self.geometry
        size = max(0.24 * geometry.lane, FLAG_SHARE * (geometry.box[3] - geometry.box[1]), geometry.letters)
        lines, size = marks.lay_out_tag(text, size, geometry.letters, geometry.tags_room, self.face)
        return sprites.flag(lines, size, self.style.callout[severity], self.face)

    def _draw_turned(self, frame: Frame) -> None:
        """Draw the words that say that the arrows are turned, in the gap that notes do not pass."""
        geometry, words = self.geometry, self._turned
        _, top, _, bottom = geometry.box
        edge, half = (bottom, 0.5 * self.size) if geometry.down else (top, -0.5 * self.size)
        x = geometry.left + (geometry.lane * len(geometry.directions) - words.shape[1]) / 2
        draw_sprite(frame, words, x, round((edge + geometry.receptor + half - words.shape[0]) / 2), 1.0, self._rows)

    @cached_property
    def _turned(self) -> Sprite:
        geometry = self.geometry
        gap = min(abs(geometry.receptor - edge) for edge in geometry.box[1::2]) - 0.5 * self.size
        size = max(FLAG_LEAST, min(0.4 * gap, 0.33 * geometry.lane))
        (line,), size = fit_text(geometry.facing, size, geometry.lane * len(geometry.directions) - 5, self.face, most=1)
        return self.face.sprite(line, size, self.style.callout["move"], weight=0.012 * size)

    def _draw_receptors(self, frame: Frame, second: float, beat: float) -> None:
        pulse = 1.0 + 0.35 * max(0.0, 1.0 - 3.0 * (beat % 1.0)) if beat >= 0 else 1.0
        for column, direction in enumerate(self.geometry.directions):
            x, y = self.geometry.corner(column, self.geometry.receptor, self.size)
            draw_sprite(frame, self.receptors[direction], x, y, Ink(0.95, pulse), self._rows)
            light, limb = self.lights.at(column, second)
            if light > 0:
                glow = self.glows[direction, limb if limb >= 0 else 4]
                gx, gy = self.geometry.corner(column, self.geometry.receptor, glow.shape[0])
                draw_sprite(frame, glow, gx, gy, light, self._rows)

    def _draw_notes(self, frame: Frame, now: _Now) -> None:
        notes, second = self.notes, now.second
        y = self._y(notes.second, notes.beat, now)
        tail = self._y(notes.end_second, notes.end_beat, now)
        gone = (notes.end_second <= second + 1e-6) & notes.judged & (notes.kind != Kind.MINE)
        low, high = np.minimum(y, tail), np.maximum(y, tail)
        _, top, _, bottom = self.geometry.box
        shown = np.flatnonzero(~gone & (high > top - self.size) & (low < bottom + self.size))
        if len(shown) > 3000:
            shown = shown[:3000]  # more notes are unreadable; the limit bounds the work of hostile charts
        held = (notes.second <= second + 1e-6) & notes.judged
        holds = np.isin(notes.kind[shown], (Kind.HOLD, Kind.ROLL))
        released = self._y(notes.gone_second, notes.gone_beat, now)
        for i in shown[holds]:
            head = self.geometry.receptor if held[i] else y[i]
            if np.isfinite(notes.gone_second[i]):  # bright while it is played, and dim after that
                at = min(max(released[i], min(head, tail[i])), max(head, tail[i]))
                self._draw_hold(frame, int(i), Run(at, tail[i], y[i]), LET_GO)
                self._draw_body(frame, int(i), Run(min(head, at), max(head, at), y[i]), 1.0 if held[i] else 0.78)
            else:
                self._draw_hold(frame, int(i), Run(head, tail[i], y[i]), 1.0 if held[i] else 0.78)
        heads = np.where(held & (notes.kind != Kind.MINE), self.geometry.receptor, y)
        places = self.marks.places(now.spacing)
        for i in shown[::-1]:  # the nearest note on top
            self._draw_head(frame, int(i), heads[i], second)
        for i in shown[::-1]:  # no arrow covers a mark
            self.marks.draw(frame, int(i), heads[i], places, bool(notes.gone_second[i] <= second + 1e-6))

    def _draw_body(self, frame: Frame, i: int, run: Run, opacity: float) -> None:
        tile = self.bodies[Kind(int(self.notes.kind[i])), int(self.notes.player[i])]
        x, _ = self.geometry.corner(int(self.notes.column[i]), 0, tile.shape[1])
        fill_run(frame, tile, x, run, opacity, self._rows)

    def _draw_hold(self, frame: Frame, i: int, run: Run, opacity: float) -> None:
        """Draw a hold. run : head, tail and phase; either end may be the higher one"""
        head, tail, phase = run
        self._draw_body(frame, i, Run(min(head, tail), max(head, tail), phase), opacity)
        end = self.tails[Kind(int(self.notes.kind[i])), int(self.notes.player[i])]
        x, _ = self.geometry.corner(int(self.notes.column[i]), 0, end.shape[1])
        if tail >= head:
            draw_sprite(frame, end, x, tail, opacity, self._rows)
        else:
            draw_sprite(frame, np.ascontiguousarray(end[::-1]), x, tail - end.shape[0], opacity, self._rows)

    def _draw_head(self, frame: Frame, i: int, y: float, second: float) -> None:
        notes = self.notes
        column, kind = int(notes.column[i]), Kind(int(notes.kind[i]))
        direction, q = self.geometry.directions[column], int(self.colour[i])
        if kind == Kind.MINE:
            sprite = self.mine
        elif kind == Kind.FAKE or not notes.judged[i]:
            sprite = self.fakes[direction]
        else:
            sprite = (self.lifts if kind == Kind.LIFT else self.arrows)[direction, q]
        x, top = self.geometry.corner(column, y, self.size)
        dim = LET_GO if kind in (Kind.HOLD, Kind.ROLL) and notes.gone_second[i] <= second + 1e-6 else 1.0
        draw_sprite(frame, sprite, x, top, dim if notes.judged[i] else 0.55, self._rows)
