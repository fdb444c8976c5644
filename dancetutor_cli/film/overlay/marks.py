"""The lanes of a highway, the marks on notes that show the limbs, and the words beside notes."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Kind
from dancetutor_cli.film.clock import Pass
from dancetutor_cli.film.notes import Callout, NoteTrack
from dancetutor_cli.film.overlay import sprites
from dancetutor_cli.film.overlay.blit import Sprite, draw_sprite
from dancetutor_cli.film.overlay.free_places import FreePlaces, LaneMark
from dancetutor_cli.film.overlay.sprites import FLAG_EDGE
from dancetutor_cli.film.overlay.text import Typeface, fit_text, narrowest_width
from dancetutor_cli.film.picture import Frame
from dancetutor_cli.film.words import short_words

# The place of a highway's lanes in the picture.

# The gap beside the number of a measure, and the width of three digits, in heights of the box.
NUMBER_EDGE, NUMBER_ROOM = 0.009, 0.045
NUMBERS = 0.26  # share of the free width on the left of the lanes, for the numbers of measures
NUMBER_OFF, EDGE = 0.2, 0.14  # lane widths from numbers to the first lane, and from the last lane to the frame
TAG_LEFT, TAG_EDGE = 3, 0.0105  # gap on the left of words beside the notes, pixels; on their right, heights of the box
LEAST_LANES = 0.7  # minimum share of their usual width that lanes keep beside wide words


@dataclass(frozen=True, slots=True)
class HighwayGeometry:
    """The place of the highway, in pixels: box (left, top, right, bottom), lane width, y of the receptors' middle.

    directions : for each column, degrees clockwise from up, None for a middle panel; down : notes fall instead of rise
    turned : the dancer faces the viewer; the order of the lanes is reversed, and `directions` are as the viewer sees
        them; facing : the words above the lanes that say so
    tags : words stand beside the notes; letters : size of their letters for which there is room, pixels
    """

    box: tuple[int, int, int, int]
    lane: float
    receptor: float
    directions: tuple[float | None, ...]
    down: bool = False
    turned: bool = False
    tags: bool = True
    letters: float = 10.0
    facing: str = ""

    def lane_of(self, column: int) -> int:
        """Return the lane of a column, counted from the left."""
        return len(self.directions) - 1 - column if self.turned else column

    @property
    def left(self) -> float:
        """The x coordinate of the first lane; words on the right have more room than measure numbers on the left."""
        spare = self.box[2] - self.box[0] - self.lane * len(self.directions)
        least = NUMBER_OFF * self.lane + NUMBER_ROOM * (self.box[3] - self.box[1])
        return self.box[0] + (min(max(NUMBERS * spare, least), 0.5 * spare) if self.tags else 0.5 * spare)

    @property
    def tags_left(self) -> float:
        """The x coordinate at which words beside the notes begin."""
        return self.left + self.lane * (len(self.directions) + EDGE) + TAG_LEFT

    @property
    def tags_room(self) -> float:
        """The greatest width of the words beside the notes, with their label, pixels."""
        return self.box[2] - self.tags_left - TAG_EDGE * (self.box[3] - self.box[1])

    def corner(self, column: int, y: float, size: float) -> tuple[float, float]:
        """Return the top left corner of a sprite of this size in the middle of a column's lane at `y`."""
        return self.left + (self.lane_of(column) + 0.5) * self.lane - size / 2, y - size / 2


def lane_width_for_words(words: float, lane: float, box: tuple[int, int, int, int], columns: int) -> float:
    """Return the width of lanes that leaves room for words of this width; the inverse of `tags_room`.

    words : width of the words, pixels; lane : width of a lane without words, pixels, which is the greatest result
    """
    width, height = box[2] - box[0], box[3] - box[1]
    free = width - words - TAG_LEFT - TAG_EDGE * height
    beside_numbers = (free - NUMBER_ROOM * height) / (columns + NUMBER_OFF + EDGE)
    beside_part = (free - NUMBERS * width) / ((1 - NUMBERS) * columns + EDGE)
    return max(LEAST_LANES * lane, min(lane, beside_numbers, beside_part))


# The marks that show the limb of each note: their size, their place on the arrow, and the choice of marks.
#
# A mark stands on the arrow's tail, so that the head shows the direction. If the arrows of a lane overlap, the mark
# stands where it covers least of the others, and is no higher than its arrow's visible strip. If marks would cover each
# other, they are smaller: the marks of the left foot stand on the left of the lane, the marks of the right foot on the
# right, and unreadable marks are left out. On diagonals, marks stay on the tail's side as long as possible. The cross
# of a note that is not played stays in the middle, where it covers neither side.

MARK_SHARE, MARK_MOST = 0.04, 0.58  # minimum size of an L or R, in heights of the box; maximum size, in lanes
READ, READ_MOST = 16, 0.5  # pixels of a mark with a letter 8 pixels high, also on diagonals; maximum size, in lanes
LEAST_SHARE, LEAST_MOST = 0.023, 0.36  # size of a mark among dense notes, in heights of the box; maximum, in lanes
# Distance of marks on one side of a lane from its middle, and their maximum size, in lanes.
SIDE_OFFSET, SIDE_MAX_SIZE = (
    0.25,
    0.46,
)
STEPS = 8  # number of spacings for each factor of two for which sizes are computed


class Places(NamedTuple):
    """The marks of all notes at one spacing, (n,) each.

    size : int16, pixels, 0 for no mark
    side : int16, -1 on the left of the lane, 1 on its right, 0 on the usual place of the arrow
    below : float64, pixels from the arrow's middle down to the mark's middle
    """

    size: NDArray[np.int16]
    side: NDArray[np.int16]
    below: NDArray[np.float64]


class Marks:
    """The marks of a chart's notes. by_time : distances between notes follow seconds, otherwise beats"""

    def __init__(
        self, notes: NoteTrack, geometry: HighwayGeometry, style: sprites.HighwayStyle, face: Typeface, by_time: bool
    ) -> None:
        self._notes, self.geometry, self._style, self._face = notes, geometry, style, face
        self._along = notes.second if by_time else notes.beat
        lane, high = geometry.lane, geometry.box[3] - geometry.box[1]
        self._arrow = sprites.arrow_size(lane, style)
        self._read = max(6, min(READ, round(READ_MOST * lane)))
        self.full = max(self._read, round(max(style.mark * lane, min(MARK_SHARE * high, MARK_MOST * lane))))
        self.least = min(self.full, max(6, round(min(LEAST_SHARE * high, LEAST_MOST * lane))))
        self._on_mine = notes.judged & (notes.kind == Kind.MINE) & (notes.limb >= 0)
        stepped = notes.judged & ~np.isin(notes.kind, (Kind.MINE, Kind.FAKE))
        self._marked = stepped & ((notes.limb >= 0) | bool((notes.limb >= 0).any()))
        self._sprite = lru_cache(maxsize=256)(self._draw_sprite)
        self._free = FreePlaces(self._arrow, geometry.down)
        self._places = lru_cache(maxsize=64)(self._find)

    def of(self, direction: float | None) -> int:
        """Return the size, pixels, of a mark with room around it on an arrow that points this way."""
        return self.full if direction is None else max(self._read, round(self._style.mark_tail * self.full))

    def behind(self, direction: float | None) -> tuple[float, float]:
        """Return the place of a mark with room around it, pixels to the right and down from its arrow's middle."""
        if direction is None:
            return 0.0, 0.0
        far = self._style.mark_aside[bool(direction % 90)] * self.geometry.lane
        way = math.radians(direction)
        return -far * math.sin(way), far * math.cos(way)

    def places(self, spacing: float) -> Places:
        """Return the places of all marks for a spacing in pixels per second or beat.

        The spacing is rounded down to one of `STEPS`, so that the marks never need more room than there is.
        """
        return self._places(math.floor(STEPS * math.log2(max(abs(spacing), 1e-3))))

    def draw(self, frame: Frame, i: int, y: float, places: Places, gone: bool = False) -> None:
        """Draw the mark of note `i`, whose arrow's middle is at `y`.

        A mine under a foot has a cross in its middle.

        gone : draw a cross, because nobody plays the note any more
        """
        if (size := int(places.size[i])) == 0:
            return
        column, side, mine = int(self._notes.column[i]), int(places.side[i]), bool(self._on_mine[i])
        direction = None if mine else self.geometry.directions[column]
        across = side * SIDE_OFFSET * self.geometry.lane if side else self.behind(direction)[0]
        badge = self._sprite(size, -1 if gone or mine else max(int(self._notes.limb[i]), -1))
        x, top = self.geometry.corner(column, y, badge.shape[0])
        draw_sprite(frame, badge, x + across, top + float(places.below[i]), 1.0, self.geometry.box[1::2])

    def _draw_sprite(self, size: int, limb: int) -> Sprite:
        """Draw a mark on a soft shade, which separates it from its arrow."""
        out, mark = sprites.shade(round(1.35 * size)).copy(), sprites.marker(size, limb, self._face, rim=True)
        sprites.centre(out, mark)
        return out

    def _find(self, spacing: int) -> Places:
        notes, apart = self._notes, 2.0 ** (spacing / STEPS)
        size, side = np.zeros(len(notes.second), np.int16), np.zeros(len(notes.second), np.int16)
        below = np.zeros(len(notes.second))
        size[self._on_mine] = self.of(0.0)  # no mark of a mine is left out, at any density
        for column in np.unique(notes.column[self._marked]).tolist():
            lane = np.flatnonzero(notes.column == column)
            lane = lane[np.argsort(self._along[lane], kind="stable")]
            # The visible part of an arrow that another arrow covers.
            strip = np.diff(self._along[lane] * apart, prepend=-np.inf)
            here, strip = lane[self._marked[lane]], strip[self._marked[lane]]
            direction = self.geometry.directions[column]
            usual = self.of(direction)
            size[here] = usual
            along = self._along[here] * apart
            gaps = np.diff(along, prepend=-np.inf, append=np.inf)
            near = np.minimum(gaps[:-1], gaps[1:])
            dense = near < usual
            crosses = dense & (notes.limb[here] < 0)
            size[here[crosses]] = 0
            for left in (True, False):
                one = dense & np.isin(notes.limb[here], (0, 2) if left else (1, 3))
                size[here[one]] = self._thinned(along[one], usual, along[crosses])
                side[here[one]] = -1 if left else 1
            on_tail = near >= self.least if direction is not None and direction % 90 else np.zeros(len(here), np.bool_)
            side[here[on_tail]] = 0
            size[here] = np.minimum(size[here], np.maximum(strip, self.least)).astype(np.int16)
            size[here] = self._with_crosses(along, size[here], crosses, usual)
            below[here] = self._below(direction, along, size[here], side[here], strip)
        return Places(size, side, below)

    def _below(
        self,
        direction: float | None,
        along: NDArray[np.float64],
        size: NDArray[np.int16],
        side: NDArray[np.int16],
        strip: NDArray[np.float64],
    ) -> NDArray[np.float64]:
        """Return how far the marks of a lane are below the middles of their arrows, pixels. strip : visible parts"""
        across, tail = self.behind(direction)
        lane = zip(
            along.tolist(),
            size.tolist(),
            np.where(side == 0, across, side * SIDE_OFFSET * self.geometry.lane).tolist(),
            np.where(side == 0, tail, 0.0).tolist(),
            strip.tolist(),
            [*strip[1:].tolist(), np.inf],
            strict=True,
        )
        out, shown = np.zeros(len(size)), size > 0
        out[shown] = self._free.below(direction, [mark for mark in map(LaneMark._make, lane) if mark.size > 0])
        return out

    def _thinned(self, along: NDArray[np.float64], most: int, crosses: NDArray[np.float64]) -> NDArray[np.int16]:
        """Return the sizes of the marks on one side of a lane, at most `most` pixels; 0 for a mark near the one before.

        Marks beside a cross are smaller, as far as they can still be read.

        along : places of the marks; crosses : places of the crosses
        """
        kept: list[int] = []
        for k, y in enumerate(along.tolist()):
            if not kept or y - along[kept[-1]] >= self.least:
                kept.append(k)
        gaps = np.diff(along[kept], prepend=-np.inf, append=np.inf)
        most = max(self.least, min(most, int(SIDE_MAX_SIZE * self.geometry.lane)))
        out = np.zeros(len(along), np.int16)
        room = np.minimum(gaps[:-1], gaps[1:])
        if len(crosses):
            room = np.minimum(room, np.abs(along[kept][:, None] - crosses).min(axis=1))
        out[kept] = np.clip(room, self.least, most)
        return out

    def _with_crosses(
        self, along: NDArray[np.float64], size: NDArray[np.int16], crosses: NDArray[np.bool_], most: int
    ) -> NDArray[np.int16]:
        """Return the sizes of all marks of a lane, with a cross if there is room between the marks of both sides."""
        for k in np.flatnonzero(crosses).tolist():
            first, last = np.searchsorted(along, (along[k] - most, along[k] + most), side="left").tolist()
            near = np.arange(first, last)[size[first:last] > 0]
            away = along[near] - along[k]
            room = np.min(-away[away <= 0], initial=most)  # marks stand as far as possible from the arrow before them
            size[k] = room if room >= self.least and (size[near] <= np.abs(away)).all() else 0
        return size


# Words beside the notes: the size of their letters, the room that they need, and their lines.

LETTERS, LEAST = 15.0, 10.4  # size of the letters at a layout's default size, and at least at any size, pixels
LINES, MOST_LINES = 2, 4  # maximum lines of a phrase, and of all phrases between commas
LEAD_SECONDS = 4.0  # seconds for which a tag or a note may be in the picture before its row
# Tags with more letters than this stand at least this many seconds apart: brackets would be a wall of small letters.
LONG, LONG_APART = (
    20,
    1.2,
)
LABEL = 4  # pixels left and right of the words in their label, in addition to FLAG_EDGE
NEAR = 0.95  # share of the letters' size that counts as the whole size, because sizes are tried in steps
FEWER = 0.85  # down to this share, smaller letters are better than more lines, unless they are below `LEAST`


def letters(scale: float) -> float:
    """Return the size of letters for which there is room, pixels; scale : scale of the layout."""
    return max(LETTERS * scale, LEAST)


def has_visible_callout(callouts: Iterable[Callout], passes: Iterable[Pass]) -> bool:
    """Whether any of these callouts stands beside the notes in one of these runs."""
    begins = np.array([callout.second for callout in callouts])
    return any(((one.start <= begins) & (begins <= one.end + LEAD_SECONDS)).any() for one in passes)


def visible_limbs(notes: NoteTrack, passes: Iterable[Pass]) -> set[int]:
    """Return the limbs, `feet.limbs.Limb`, whose notes are in the picture in these runs.

    A section may have fewer limbs than the song.
    """
    here = np.zeros(len(notes.second), dtype=np.bool_)
    for one in passes:
        here |= (one.start <= notes.end_second) & (notes.second <= one.end + LEAD_SECONDS)
    return {int(limb) for limb in np.unique(notes.limb[here]) if limb >= 0}


class RowTag(NamedTuple):
    """Words beside a row. second : second of the music; beat : beat as drawn; severity : as in `Callout`"""

    second: float
    beat: float
    words: str
    severity: str


def row_tags(callouts: Iterable[Callout]) -> list[RowTag]:
    """Return the tags of each passage's first and later moves, in order of time.

    Of long tags that follow each other quickly, such as tags of brackets, only the first is kept. The calls beside the
    dancer name the others.
    """
    found = [
        RowTag(*one, call.severity) for call in callouts for one in ((call.second, call.beat, call.tag), *call.further)
    ]
    kept, last = [], -np.inf
    for one in sorted(found, key=lambda one: one.second):
        if len(one.words) > LONG:
            if one.second - last < LONG_APART:
                continue
            last = one.second
        kept.append(one)
    return kept


def callout_texts(callouts: Iterable[Callout], words: Iterable[str]) -> set[str]:
    """Return the possible words beside the notes: the tags of this film, and the tags that all films share.

    The shared tags make the lanes of most films alike.

    words : the words of moves, some with {who} and {places} to be filled in
    """
    tags = {tag for one in callouts for tag in (one.tag, *(tag for *_, tag in one.further))}
    return tags | {short_words(text) for text in words if "{" not in text}


def room_for(tags: Iterable[str], size: float, face: Typeface) -> float:
    """Return the width of the widest tag with its label, pixels, with each phrase in at most two lines.

    size : size of the letters
    """
    phrases = {phrase for tag in tags for phrase in tag.split(", ")}
    widest = max((narrowest_width(phrase, size, face, LINES) for phrase in phrases), default=0.0)
    return widest + FLAG_EDGE * size + LABEL


def lay_out_tag(tag: str, size: float, least: float, room: float, face: Typeface) -> tuple[list[str], float]:
    """Return the lines of a tag and the size of its letters, without cutting words off.

    size, least : greatest size, and smallest size if possible; room : pixels for the label
    """
    enough = NEAR * max(FEWER * least, min(least, LEAST))
    for most in range(LINES, MOST_LINES + 1):
        lines, fits = fit_text(tag, size, room - FLAG_EDGE * size - LABEL, face, most)
        if fits >= enough:
            break
    return lines, fits
