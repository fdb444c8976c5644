"""Lanes, and what is on and beside notes: marks of the limb that steps a note, words."""

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
from dancetutor_cli.film.overlay.blit import Sprite, blit
from dancetutor_cli.film.overlay.sprites import FLAG_EDGE
from dancetutor_cli.film.overlay.text import Typeface, fitted, narrowest
from dancetutor_cli.film.picture import Frame
from dancetutor_cli.film.words import short_words

# Where the lanes of a highway lie in the picture.

# heights of the box beside the number of a measure, and heights that three digits take
NUMBER_EDGE, NUMBER_ROOM = 0.009, 0.045
NUMBERS = 0.26  # part of the free width that is on the left of the lanes, where numbers stand
NUMBER_OFF, EDGE = 0.2, 0.14  # lane widths from numbers to the first lane, and from the last one to its frame
TAG_LEFT, TAG_EDGE = 3, 0.0105  # pixels on the left of words beside the notes; heights of the box on their right
LEAST_LANES = 0.7  # part of their usual width that lanes keep at least, whatever words stand beside them


@dataclass(frozen=True, slots=True)
class HighwayGeometry:
    """Where the highway lies, in pixels: box (left, top, right, bottom); lane width; y of the receptors' middle.

    directions : per column, degrees clockwise from up, None for a middle panel; down : notes fall instead of rise
    turned : she faces who looks on; the lanes stand the other way round, and `directions` are as they are seen then
    tags : words stand beside the notes; letters : their size that room is left for, pixels
    """

    box: tuple[int, int, int, int]
    lane: float
    receptor: float
    directions: tuple[float | None, ...]
    down: bool = False
    turned: bool = False
    tags: bool = True
    letters: float = 10.0

    def lane_of(self, column: int) -> int:
        """The lane of a column, counted from the left."""
        return len(self.directions) - 1 - column if self.turned else column

    @property
    def left(self) -> float:
        """x of the first lane; where words stand, more room is left for them on the right than for measure numbers."""
        spare = self.box[2] - self.box[0] - self.lane * len(self.directions)
        least = NUMBER_OFF * self.lane + NUMBER_ROOM * (self.box[3] - self.box[1])
        return self.box[0] + (min(max(NUMBERS * spare, least), 0.5 * spare) if self.tags else 0.5 * spare)

    @property
    def tags_left(self) -> float:
        """x where words beside the notes begin."""
        return self.left + self.lane * (len(self.directions) + EDGE) + TAG_LEFT

    @property
    def tags_room(self) -> float:
        """Pixels that such words may be wide, with their label."""
        return self.box[2] - self.tags_left - TAG_EDGE * (self.box[3] - self.box[1])

    def corner(self, column: int, y: float, size: float) -> tuple[float, float]:
        """Top left corner of a sprite of this size, in the middle of a column's lane at `y`."""
        return self.left + (self.lane_of(column) + 0.5) * self.lane - size / 2, y - size / 2


def lane_width_for_words(words: float, lane: float, box: tuple[int, int, int, int], columns: int) -> float:
    """The width of lanes that leaves room for words of this width: `lane`, or less; the inverse of `tags_room`.

    words : pixels; lane : pixels that a lane has where there are none
    """
    width, height = box[2] - box[0], box[3] - box[1]
    free = width - words - TAG_LEFT - TAG_EDGE * height
    beside_numbers = (free - NUMBER_ROOM * height) / (columns + NUMBER_OFF + EDGE)
    beside_part = (free - NUMBERS * width) / ((1 - NUMBERS) * columns + EDGE)
    return max(LEAST_LANES * lane, min(lane, beside_numbers, beside_part))


# The marks that show which limb steps a note: their size, their place on the arrow, and which are left out.
#
# A mark stands on the arrow's tail, so that the head shows the direction. If the arrows of a lane overlap, it stands on
# the visible strip of its arrow, and is no higher than that. If marks would cover each other, they are smaller; those
# of the left foot stand on the left of the lane and those of the right foot on the right, and of one foot only as many
# are drawn as can be read. On diagonals they stay on the tail's side as long as possible. The cross of a note that is
# not played stays in the middle, where it covers neither side.

MARK_SHARE, MARK_MOST = 0.04, 0.58  # an L or R is at least this many heights of the box, but at most this many lanes
READ, READ_MOST = 16, 0.5  # pixels of a mark whose letter is 8 high, also on diagonal arrows; at most this many lanes
LEAST_SHARE, LEAST_MOST = 0.023, 0.36  # the same where notes are dense
SIDE_OFFSET, SIDE_MAX_SIZE = (
    0.25,
    0.46,
)  # lanes from the middle at which the marks then stand, and their largest size
STEPS = 8  # number of spacings in each doubling for which sizes are computed


class Places(NamedTuple):
    """The marks of all notes at some spacing, (n,) each.

    size : int16, pixels, 0 for none; side : int16, -1 on the left of the lane, 1 on its right, 0 where it stands by
    itself; below : float64, pixels from the arrow's middle down to the mark's
    """

    size: NDArray[np.int16]
    side: NDArray[np.int16]
    below: NDArray[np.float64]


class Marks:
    """Draws the marks of a chart's notes. by_time : notes are as far apart as their seconds are, else their beats."""

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
        self._places = lru_cache(maxsize=64)(self._find)

    def of(self, direction: float | None) -> int:
        """Pixels of a mark with room around it, on an arrow that points this way."""
        return self.full if direction is None else max(self._read, round(self._style.mark_tail * self.full))

    def behind(self, direction: float | None) -> tuple[float, float]:
        """Where such a mark stands on its arrow, pixels from the middle."""
        if direction is None:
            return 0.0, 0.0
        far = self._style.mark_aside[bool(direction % 90)] * self.geometry.lane
        way = math.radians(direction)
        return -far * math.sin(way), far * math.cos(way)

    def places(self, spacing: float) -> Places:
        """The places of all marks if notes are so many pixels apart for each second or beat, but never for more room
        than that.
        """
        return self._places(math.floor(STEPS * math.log2(max(abs(spacing), 1e-3))))

    def draw(self, frame: Frame, i: int, y: float, places: Places, gone: bool = False) -> None:
        """Draw the mark of note `i`, whose arrow's middle is at `y`; gone : a cross, for it is not played.

        A mine under a foot has a cross in its middle, too.
        """
        if (size := int(places.size[i])) == 0:
            return
        column, side, mine = int(self._notes.column[i]), int(places.side[i]), bool(self._on_mine[i])
        direction = None if mine else self.geometry.directions[column]
        across = side * SIDE_OFFSET * self.geometry.lane if side else self.behind(direction)[0]
        badge = self._sprite(size, -1 if gone or mine else max(int(self._notes.limb[i]), -1))
        x, top = self.geometry.corner(column, y, badge.shape[0])
        blit(frame, badge, x + across, top + float(places.below[i]), 1.0, self.geometry.box[1::2])

    def _draw_sprite(self, size: int, limb: int) -> Sprite:
        """A mark on the soft shade that lifts it off its arrow."""
        out, mark = sprites.shade(round(1.35 * size)).copy(), sprites.marker(size, limb, self._face, rim=True)
        sprites.centre(out, mark)
        return out

    def _find(self, spacing: int) -> Places:
        notes, apart = self._notes, 2.0 ** (spacing / STEPS)
        size, side = np.zeros(len(notes.second), np.int16), np.zeros(len(notes.second), np.int16)
        below = np.zeros(len(notes.second))
        size[self._on_mine] = self.of(0.0)  # none is left out, however dense
        for column in np.unique(notes.column[self._marked]).tolist():
            lane = np.flatnonzero(notes.column == column)
            lane = lane[np.argsort(self._along[lane], kind="stable")]
            # the visible part of an arrow that another arrow covers
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
            tail = np.where(side[here] == 0, self.behind(direction)[1], 0.0)
            below[here] = self._seen(tail, size[here], strip)
        return Places(size, side, below)

    def _seen(
        self, tail: NDArray[np.float64], size: NDArray[np.int16], strip: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """The places of marks at which they cover no arrow that comes sooner: `tail`, or farther from that arrow.

        tail : pixels down from the arrows' middles; size : of the marks; strip : what is seen of their arrows
        """
        way = -1.0 if self.geometry.down else 1.0
        half = self._arrow / 2
        least = half - np.minimum(strip, self._arrow) + size / 2
        return np.asarray(way * np.where(size > 0, np.maximum(way * tail, np.minimum(least, half - size / 2)), 0.0))

    def _thinned(self, along: NDArray[np.float64], most: int, crosses: NDArray[np.float64]) -> NDArray[np.int16]:
        """Sizes of marks of one side of a lane at these places, at most `most` pixels: 0 where the last is near.

        Beside `crosses` they are smaller, as far as they can still be read.
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
        """Sizes of all marks of a lane: a cross where there is room for one between those of both sides."""
        for k in np.flatnonzero(crosses).tolist():
            first, last = np.searchsorted(along, (along[k] - most, along[k] + most), side="left").tolist()
            near = np.arange(first, last)[size[first:last] > 0]
            away = along[near] - along[k]
            room = np.min(-away[away <= 0], initial=most)  # marks stand as far from what comes sooner as they can
            size[k] = room if room >= self.least and (size[near] <= np.abs(away)).all() else 0
        return size


# Words beside the notes: how large their letters are, how much room they need, in how many lines they stand.

LETTERS, LEAST = 15.0, 10.4  # pixels of letters for which room is left: at a layout's default size, and at any size
LINES, MOST_LINES = 2, 4  # lines of a phrase; of all phrases, if there are commas
LEAD_SECONDS = 4.0  # seconds before its row that a tag, or a note, may be in the picture
LONG, LONG_APART = (
    20,
    1.2,
)  # letters of tags that stand at least so many seconds apart; before, brackets were a wall of small letters
LABEL = 4  # pixels left and right of the words in their label, beside FLAG_EDGE
NEAR = 0.95  # part of the letters' size that counts as the whole size, because sizes are tried in steps
FEWER = 0.85  # down to this part, smaller letters are better than more lines, if they are not below `LEAST`


def letters(scale: float) -> float:
    """The size of letters that room is left for, pixels; scale : of the layout."""
    return max(LETTERS * scale, LEAST)


def has_visible_callout(callouts: Iterable[Callout], passes: Iterable[Pass]) -> bool:
    """Whether any of these stands beside the notes in one of these runs."""
    begins = np.array([callout.second for callout in callouts])
    return any(((one.start <= begins) & (begins <= one.end + LEAD_SECONDS)).any() for one in passes)


def visible_limbs(notes: NoteTrack, passes: Iterable[Pass]) -> set[int]:
    """The limbs, `feet.limbs.Limb`, whose notes are in the picture in these runs; a section may have fewer than the
    song.
    """
    here = np.zeros(len(notes.second), dtype=np.bool_)
    for one in passes:
        here |= (one.start <= notes.end_second) & (notes.second <= one.end + LEAD_SECONDS)
    return {int(limb) for limb in np.unique(notes.limb[here]) if limb >= 0}


class RowTag(NamedTuple):
    """Words beside a row. second : of the music; beat : the same as drawn; severity : as of `Callout`"""

    second: float
    beat: float
    words: str
    severity: str


def row_tags(callouts: Iterable[Callout]) -> list[RowTag]:
    """Each passage's tag where it begins, and those of its other moves, in order of time.

    Of long tags that follow each other quickly, such as those of brackets, it has the first; the calls beside the
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
    """The possible words beside the notes: those of this film, and those that are the same in all films, so that lanes
    of most films are alike.

    words : of moves, some with {who} and {places} to be filled in
    """
    tags = {tag for one in callouts for tag in (one.tag, *(tag for *_, tag in one.further))}
    return tags | {short_words(text) for text in words if "{" not in text}


def room_for(tags: Iterable[str], size: float, face: Typeface) -> float:
    """Pixels that the widest of these words need with their label, at this size; each phrase in two lines at most."""
    phrases = {phrase for tag in tags for phrase in tag.split(", ")}
    widest = max((narrowest(phrase, size, face, LINES) for phrase in phrases), default=0.0)
    return widest + FLAG_EDGE * size + LABEL


def lay_out_tag(tag: str, size: float, least: float, room: float, face: Typeface) -> tuple[list[str], float]:
    """The lines of a tag, and the size of its letters: at most `size`, at least `least` if they can be; none is cut.

    room : pixels for the label
    """
    enough = NEAR * max(FEWER * least, min(least, LEAST))
    for most in range(LINES, MOST_LINES + 1):
        lines, fits = fitted(tag, size, room - FLAG_EDGE * size - LABEL, face, most)
        if fits >= enough:
            break
    return lines, fits
