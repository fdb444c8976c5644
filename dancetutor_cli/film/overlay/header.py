"""The song's words at the top left of the picture: title, artist, difficulty, author of the steps."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.density import bpm_text
from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.film.layout import PixelBox, lowered
from dancetutor_cli.film.overlay.blit import Box, Sprite, draw_sprite
from dancetutor_cli.film.overlay.sprites import SOFT, WHITE, WordStyle, box_of, plate
from dancetutor_cli.film.overlay.text import LONGEST, Typeface, clean, fit_text, lay_in_lines
from dancetutor_cli.film.picture import Frame
from dancetutor_cli.run.languages import Language

SHOULDER_SHARE = 0.75  # greatest share of the room for a lower line: the dancer's shoulders are wider than her head
LINE = 1.25  # height of a line, in sizes of its letters
# Minimum width of lines, wherever the dancer is: a share of the room, or a share of the box if that is less.
NARROWEST, LEAST = 0.45, 0.2
SUBTITLE = 0.68  # size of a subtitle below its title, in sizes of the title
TIGHT = 0.2  # reduction of the distance between the lines of a title, in sizes of the letters
_BRACKETED = re.compile(r"(.*?\S)(?:\s+(?=[(\[~～〜])|\s*(?=[（【「]))(.*[)\]~～〜）】」])")
# Smallest size and greatest number of lines of a title; the first pair that fits is used.
TITLE_FITS = ((0.8, 1), (0.7, 2), (0.7, 3), (0.55, 4))
SUBTITLE_FITS = ((0.78, 1), (0.75, 2))
ARTIST_FITS = ((0.85, 1), (0.675, 2))


@dataclass(frozen=True, slots=True)
class Words:
    """The words of the header. badge : difficulty and meter; detail : the words beside the badge

    subtitle : stands behind the title if both fit in a line, else below the title in smaller letters
    """

    title: str
    artist: str
    badge: str
    difficulty: str
    detail: str
    credit: str = ""
    subtitle: str = ""


class WordsRoom(NamedTuple):
    """The part of a header's box that its words may take. share : share of the width, beside the dancer's head

    taken : float64 (n, 4), the boxes of heads during the dance, before which lines end: left, top, right and bottom,
        pixels
    """

    share: float = 1.0
    taken: NDArray[np.float64] = np.zeros((0, 4))


ALL = WordsRoom()


@dataclass(frozen=True, slots=True, eq=False)
class Lines:
    """Words that appear and disappear together. lines : sprites with their left top corners, pixels

    boxes : the boxes of the lines that make way for the dancer: left, top, right, bottom
    """

    lines: list[tuple[Sprite, float, float]]
    boxes: list[Box]

    def draw(self, frame: Frame, opacity: float = 1.0) -> None:
        """Draw the words over the picture."""
        for sprite, x, y in self.lines:
            draw_sprite(frame, sprite, x, round(y), opacity)


class Header:
    """Title, artist and badge at the top left of a box, drawn once.

    A long title has smaller letters and up to four lines, a long artist two lines. Words that still do not fit end with
    an ellipsis. The credit is left out if it has no room in the box.

    bottom : y below the last line; title_end : right and bottom of the title, pixels
    """

    def __init__(self, words: Words, box: PixelBox, scale: float, style: WordStyle, room: WordsRoom = ALL) -> None:
        self.lines: list[tuple[Sprite, float, float]] = []
        face, colours = style.face, style.highway.difficulty
        self._scale, self._face, self._taken = scale, face, room.taken
        self._left, self._right = box[0], box[0] + room.share * (box[2] - box[0])
        self._least = min(NARROWEST * room.share, LEAST) * (box[2] - box[0])
        title_size, small = 33 * scale, 19 * scale
        self.bottom = float(box[1])
        self._title(words, title_size)
        self._titled = len(self.lines)
        self.title_end = (max(x + ink.shape[1] for ink, x, _ in self.lines), self.bottom)
        if words.artist:
            self._artist(words.artist, small)
        badge = plate([words.badge], small * 0.95, colours.get(words.difficulty, colours["Edit"]), face)
        top = self.bottom + 6 * scale
        self._add(badge, box[0] + 2 * scale, 6 * scale)
        if words.detail:
            x, size = box[0] + badge.shape[1] + 10 * scale, small * 0.85
            end = self._right if room.share == 1 else box[0] + SHOULDER_SHARE * (self._right - box[0])
            end = min(end, self._left + self._width(-badge.shape[0]))
            if face.width(words.detail, size) <= end - x:
                ink = face.sprite(words.detail, size, SOFT, shadow=1.5 * scale)
                self.lines.append((ink, x, top + (badge.shape[0] - ink.shape[0]) / 2))
            else:
                self._detail(words.detail, size)
        if words.credit and self.bottom + 3 * scale + 1.3 * 0.85 * small <= box[3]:
            self._line(words.credit, small * 0.85, 3 * scale)

    def _add(self, sprite: Sprite, x: float, gap: float) -> None:
        self.lines.append((sprite, x, self.bottom + gap))
        self.bottom += gap + sprite.shape[0]

    def _width(self, height: float) -> float:
        """Return the greatest width, pixels, of lines in the next `height` pixels below the last line; less beside
        heads.

        A negative height means the pixels above the last line's end.
        """
        low, high = sorted((self.bottom, self.bottom + height))
        here = self._taken[(self._taken[:, 1] < high) & (self._taken[:, 3] > low)]
        room = self._right - self._left
        return float(max(self._least, min(room, here[:, 0].min(initial=np.inf) - self._left)))

    def _title(self, words: Words, size: float) -> None:
        """Add title and subtitle in one line, or the title and below it, smaller, the subtitle or words in brackets."""
        face, name, rest, width = self._face, words.title, words.subtitle, 0.97 * self._width(LINE * size)
        lines, fits = _fits(f"{name} {rest}".strip(), size, width, face, TITLE_FITS)
        if len(lines) > 1 and (found := _BRACKETED.fullmatch(name[:LONGEST])) and not rest:
            name, rest = found[1], found[2]
        if len(lines) > 1 and rest:
            lines, fits = _fits(name, size, width, face, TITLE_FITS)
        else:
            rest = ""
        lower = 0.97 * self._width(len(lines) * LINE * fits)
        if len(lines) > 1 and lower < width:  # the lower lines are beside the dancer's head
            lines, fits = _fits(name, size, lower, face, TITLE_FITS)
        for number, line in enumerate(lines):
            ink = face.sprite(line, fits, WHITE, weight=fits / 60, shadow=2 * self._scale)
            self._add(ink, self._left, -TIGHT * fits if number else 0)
        if rest:
            width = 0.97 * self._width(LINE * SUBTITLE * size)
            lines, fits = _fits(rest, SUBTITLE * size, width, face, SUBTITLE_FITS)
            for line in lines:
                ink = face.sprite(line, fits, WHITE, weight=fits / 80, shadow=1.5 * self._scale)
                self._add(ink, self._left, -TIGHT * fits)

    def _artist(self, text: str, size: float) -> None:
        """Add the artist in one line, a little smaller if necessary, or in two lines."""
        lines, size = _fits(text, size, self._width(LINE * size), self._face, ARTIST_FITS)
        for number, line in enumerate(lines):
            self._line(line, size, -0.1 * size if number else self._scale, weight=0.25)

    def _detail(self, text: str, size: float) -> None:
        """Add the detail in one line, or divided at a "·" if the dancer leaves too little room."""
        width, gap = self._width(2 * LINE * size), 3 * self._scale
        parts = text.split(" · ") if 0.8 * self._face.width(text[:LONGEST], size) > width else [text]
        for number, part in enumerate(parts):
            self._line(part, size, -0.1 * size if number else gap)

    def _line(self, text: str, size: float, gap: float, weight: float = 0.0) -> None:
        text, size = self._face.shrink(text, size, self._width(LINE * size))
        ink = self._face.sprite(text, size, SOFT, weight * self._scale, shadow=1.5 * self._scale)
        self._add(ink, self._left, gap)

    @property
    def top(self) -> float:
        """The y coordinate of the title's top edge."""
        return self.lines[0][2]

    @property
    def right(self) -> float:
        """The x coordinate of the longest line's right end."""
        return float(max(x + ink.shape[1] for ink, x, _ in self.lines))

    def clear(self, box: PixelBox, off: float) -> PixelBox:
        """Return a box, moved to begin `off` pixels below these words if they reach into it."""
        reached = box[0] < self.right and self.bottom + off > box[1] > self.top
        return lowered(box, self.bottom + off) if reached else box

    @cached_property
    def parts(self) -> tuple[Lines, Lines]:
        """The title, and the lines below it. A title of one line is above the dancer's head, even as she walks on."""
        title, below = self.lines[: self._titled], self.lines[self._titled :]
        return Lines(title, [box_of(*line) for line in title[len(title) == 1 :]]), Lines(
            below, [box_of(*x) for x in below]
        )


def _fits(
    text: str, size: float, width: float, face: Typeface, ways: tuple[tuple[float, int], ...]
) -> tuple[list[str], float]:
    """Return the lines of a text and their size, which can be read from afar; a text that is too long is cut off."""
    text = text[:LONGEST]
    whole = face.width(text, size)
    for least, most in ways:
        if least * whole > most * width:  # the text cannot fit, and a try with 1000 letters would be slow
            continue
        lines, fits = fit_text(text, size, width, face, most)
        if fits >= least * size:
            return lines, fits
    least, most = ways[-1]
    return lay_in_lines(text, least * size, width, face, most), least * size


# The words of the picture, made from a song and a chart with the letters that the font has.


def words_of(song: Song, chart: Chart, font: Path | None, language: Language) -> Words:
    """Return the words of the picture; a title is transliterated if the font lacks letters of the original."""
    face = Typeface(font)
    title = _readable(face, song, song.title or song.path.stem, "TITLETRANSLIT")
    subtitle = _readable(face, song, song.subtitle, "SUBTITLETRANSLIT")
    artist = _readable(face, song, song.artist, "ARTISTTRANSLIT")
    credit = clean(chart.tags.get("CREDIT", ""))
    detail = f"{chart.steps_type} · {bpm_text(song, chart)} BPM"
    return Words(
        title=title or subtitle,
        artist=artist,
        badge=face.drawable(f"{chart.difficulty} {chart.meter}"),
        difficulty=chart.difficulty,
        detail=face.drawable(detail),
        credit=face.drawable(language.film["credit"].replace("{name}", credit)) if credit else "",
        subtitle=subtitle if title else "",
    )


def _readable(face: Typeface, song: Song, text: str, tag: str) -> str:
    plain = face.drawable(text)
    other = song.tags.get(tag, "")
    return face.drawable(other) if "?" in plain and plain != text and other else plain


def title_warnings(song: Song, words: Words, font: Path | None) -> tuple[str, ...]:
    """Return the warnings about letters of title or artist that cannot be drawn."""
    missing = Typeface(font).missing(clean(song.title + song.artist))
    lost = "?" in words.title.replace("?", "", song.title.count("?")) or "?" in words.artist
    if not missing or not lost:
        return ()
    searched = "no font here" if font is None else f"neither {font} nor a font of the system"
    return (f"{searched} has letters for {missing[:12]!r} in title or artist; give one with --font FILE",)
