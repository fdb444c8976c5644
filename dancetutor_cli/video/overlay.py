"""The words of the picture: title, artist, difficulty, legend, and the strip with density, position and time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.video import shapes, sprites
from dancetutor_cli.video.blit import Frame, Sprite, blit, rectangle
from dancetutor_cli.video.clock import Clock
from dancetutor_cli.video.layout import PixelBox
from dancetutor_cli.video.notes import Callout
from dancetutor_cli.video.sprites import HighwayStyle
from dancetutor_cli.video.text import Typeface

WHITE = (255, 255, 255)
SOFT = (196, 202, 222)
INK = (12, 13, 22)
CALL_STAYS = 0.35  # seconds that a call stays after its note


@dataclass(frozen=True, slots=True)
class Words:
    """What is written. `badge` is the difficulty and meter; `detail` what stands beside it."""

    title: str
    artist: str
    badge: str
    difficulty: str
    detail: str
    credit: str = ""


class Header:
    """Title, artist and badge at the top left of its box, drawn once."""

    def __init__(self, words: Words, box: PixelBox, scale: float, face: Typeface, style: HighwayStyle) -> None:
        self.box = box
        width = box[2] - box[0]
        title_size, small = 33 * scale, 19 * scale
        self.lines: list[tuple[Sprite, float, float]] = []
        y = float(box[1])
        title = face.fit(words.title, title_size, 0.97 * width)
        y = self._add(face.sprite(title, title_size, WHITE, weight=0.55 * scale, shadow=2 * scale), box[0], y)
        if words.artist:
            artist = face.fit(words.artist, small, 0.97 * width)
            y = self._add(
                face.sprite(artist, small, SOFT, weight=0.25 * scale, shadow=1.5 * scale), box[0], y + 1 * scale
            )
        colour = style.difficulty.get(words.difficulty, style.difficulty["Edit"])
        badge = pill(words.badge, small * 0.95, colour, face, scale)
        self._add(badge, box[0] + 2 * scale, y + 6 * scale)
        if words.detail:
            x = box[0] + badge.shape[1] + 10 * scale
            detail = face.fit(words.detail, small * 0.85, width - badge.shape[1] - 12 * scale)
            text = face.sprite(detail, small * 0.85, SOFT, shadow=1.5 * scale)
            self._add(text, x, y + 6 * scale + (badge.shape[0] - text.shape[0]) / 2)
        if words.credit:
            credit = face.fit(words.credit, small * 0.85, 0.42 * width)  # the dancer's head is further right
            line = face.sprite(credit, small * 0.85, SOFT, shadow=1.5 * scale)
            self._add(line, box[0], y + 6 * scale + badge.shape[0] + 3 * scale)

    def _add(self, sprite: Sprite, x: float, y: float) -> float:
        self.lines.append((sprite, x, y))
        return float(y + sprite.shape[0])

    def draw(self, frame: Frame) -> None:
        """Lay the words over the picture."""
        for sprite, x, y in self.lines:
            blit(frame, sprite, x, round(y))


def pill(text: str, size: float, colour: tuple[int, int, int], face: Typeface, scale: float) -> Sprite:
    """Dark words on a coloured lozenge."""
    words = face.sprite(text, size, INK, weight=0.3 * scale)
    height = max(8, round(1.55 * size))
    width = max(words.shape[1] + height // 2 + 2, height)
    painter = shapes.Painter(height, width)
    d = shapes.rounded_box(painter.x, painter.y, width / 2 - 1, height / 2 - 1, height / 2 - 1)
    painter.paint(shapes.cover(d), colour)
    out = painter.sprite()
    sprites.centre(out, words)
    return out


class Legend:
    """What the markers mean, one under the other from the box's bottom up; hands only where the chart needs them."""

    def __init__(self, limbs: set[int], box: PixelBox, scale: float, face: Typeface) -> None:
        names = ("left foot", "right foot", "left hand", "right hand")
        self.lines: list[tuple[Sprite, float, float]] = []
        step = 31 * scale
        middle = box[3] - step / 2
        for limb in sorted({0, 1} | limbs, reverse=True):
            mark = sprites.marker(max(8, round(24 * scale)), limb, face)
            text = face.sprite(names[limb], 16 * scale, WHITE, weight=0.2 * scale, shadow=1.5 * scale)
            self.lines.append((mark, box[0], middle - mark.shape[0] / 2))
            self.lines.append((text, box[0] + mark.shape[1] + 5 * scale, middle - text.shape[0] / 2))
            middle -= step

    def draw(self, frame: Frame) -> None:
        """Lay the legend over the picture."""
        for sprite, x, y in self.lines:
            blit(frame, sprite, x, round(y))


class Runs:
    """Which run of a practice film this is and how fast, at the bottom; and the numbers of the count-in."""

    def __init__(self, clock: Clock, size: tuple[int, int], scale: float, face: Typeface) -> None:
        self.clock, self.size, self.scale = clock, size, scale
        several = len(clock.passes) > 1 or any(one.rate != 1 for one in clock.passes)
        texts = [self._text(number) for number in range(len(clock.passes))] if several else []
        self.labels = [pill(text, 20 * scale, WHITE, face, scale) for text in texts]
        counts = range(1, max(one.count for one in clock.passes) + 1)
        big = 150 * scale
        self.numbers = {n: face.sprite(str(n), big, WHITE, weight=3 * scale, shadow=5 * scale) for n in counts}

    def _text(self, number: int) -> str:
        one, count = self.clock.passes[number], len(self.clock.passes)
        speed = f"{one.rate:.0%} speed" if one.rate != 1 else "full speed"
        return f"{speed} · {number + 1} of {count}" if count > 1 else speed

    def draw(self, frame: Frame, second: float, run: int) -> None:
        """Draw at `second` of the music in pass `run`."""
        if self.labels:
            label = self.labels[run]
            blit(frame, label, (self.size[0] - label.shape[1]) / 2, round(0.875 * self.size[1]))
        one = self.clock.passes[run]
        if one.count and second < one.sound_from - 1e-6:
            left = (one.sound_from - second) / (one.sound_from - one.start) * one.count
            number = self.numbers[min(one.count, max(1, math.ceil(left - 1e-6)))]
            fade = min(1.0, 0.35 + 0.65 * (left % 1.0 or 1.0))
            x, y = (self.size[0] - number.shape[1]) / 2, (self.size[1] - number.shape[0]) / 2
            blit(frame, number, x, round(y), fade)


class Calls:
    """Moves called out over the dancer before they come, at the top right of her box, with the time left as a bar."""

    SHOWN = 2  # at a time, the nearest on top

    def __init__(
        self, callouts: tuple[Callout, ...], box: PixelBox, scale: float, face: Typeface, style: HighwayStyle
    ) -> None:
        self.callouts, self.box, self.scale, self.face, self.style = callouts, box, scale, face, style
        self.seconds = np.array([one.second for one in callouts])
        self._sprite = lru_cache(maxsize=32)(self._pill)

    def _pill(self, text: str, severity: str) -> Sprite:
        size = 24 * self.scale
        room = 0.45 * (self.box[2] - self.box[0])
        return pill(self.face.fit(text, size, room), size, self.style.callout[severity], self.face, self.scale)

    def draw(self, frame: Frame, second: float) -> None:
        """Draw what comes within the next `callout_seconds` after `second`."""
        first = int(np.searchsorted(self.seconds, second - CALL_STAYS))
        y = self.box[1] + 22 * self.scale
        for one in self.callouts[first : first + self.SHOWN]:
            left = one.second - second
            if left > self.style.callout_seconds:
                break
            label = self._sprite(one.text, one.severity)
            x = self.box[2] - label.shape[1] - 22 * self.scale
            fade = min(1.0, (self.style.callout_seconds - left) / 0.15, 1.0 + left / CALL_STAYS)
            blit(frame, label, x, round(y), fade)
            y += label.shape[0] + 4 * self.scale
            share = min(1.0, max(0.0, left / self.style.callout_seconds))
            bar = (label.shape[1] - 8 * self.scale) * share
            edge = x + 4 * self.scale
            rectangle(frame, edge, y, edge + bar, y + 4 * self.scale, self.style.callout[one.severity], 0.9 * fade)
            y += 14 * self.scale


@dataclass(frozen=True, slots=True)
class SongShape:
    """The whole song for the strip. steps : float64 (n,), seconds of its steps, sorted; start, end : shown range;

    section : the rendered part, (start, end) seconds
    """

    steps: NDArray[np.float64]
    start: float
    end: float
    section: tuple[float, float]


class Progress:
    """The strip with the density of the whole song, the position, and the time."""

    def __init__(self, song: SongShape, box: PixelBox, scale: float, face: Typeface, style: HighwayStyle) -> None:
        self.song, self.box, self.scale, self.face = song, box, scale, face
        left, _, right, _ = box
        self.text = 17 * scale
        total = clock_text(song.end)
        room = face.width(f"{total} / {total}", self.text) + 34 * scale
        self.graph = (round(left + room), right - round(20 * scale))
        self.ahead = self._paint(style, bright=False)
        self.played = self._paint(style, bright=True)
        self._sprite = lru_cache(maxsize=16)(self._time_sprite)

    def _paint(self, style: HighwayStyle, bright: bool) -> Frame:
        left, top, right, bottom = self.box
        picture = np.empty((bottom - top, right - left, 3), dtype=np.uint8)
        picture[...] = (9, 10, 19)
        picture[: max(1, round(1.2 * self.scale))] = (44, 48, 70)
        a, b = self.graph[0] - left, self.graph[1] - left
        if b <= a:
            return picture
        heights = density(self.song, b - a, max(2.0, 2.0 * self.scale))
        floor = bottom - top - 7 * self.scale
        room = floor - 7 * self.scale
        colour = style.accent if bright else (92, 98, 128)
        for x, height in enumerate(heights):
            base = 1.5 * self.scale
            rectangle(picture, a + x, floor - base - (room - base) * height, a + x + 1, floor, colour, 0.88)
        for edge in self.song.section:
            at = a + self._position(edge) * (b - a)
            if a < at < b:
                rectangle(picture, at - self.scale, 0, at + self.scale, bottom - top, style.difficulty["Medium"], 0.8)
        return picture

    def _position(self, second: float) -> float:
        return min(1.0, max(0.0, (second - self.song.start) / max(1e-9, self.song.end - self.song.start)))

    def draw(self, frame: Frame, second: float) -> None:
        """Draw the strip at `second` of the music."""
        left, top, right, bottom = self.box
        a, b = self.graph
        x = a + self._position(second) * (b - a)
        split = max(0, min(right - left, int(x) - left))
        frame[top:bottom, left:right] = self.ahead
        frame[top:bottom, left : left + split] = self.played[:, :split]
        rectangle(
            frame, x - 1.2 * self.scale, top + 4 * self.scale, x + 1.2 * self.scale, bottom - 4 * self.scale, WHITE
        )
        words = self._sprite(f"{clock_text(second)} / {clock_text(self.song.end)}")
        blit(frame, words, left + 14 * self.scale, round((top + bottom - words.shape[0]) / 2))

    def _time_sprite(self, text: str) -> Sprite:
        return self.face.sprite(text, self.text, WHITE, weight=0.2 * self.scale)


def density(song: SongShape, bins: int, smooth: float) -> NDArray[np.float64]:
    """Steps per second along the song, `bins` values, the highest 1."""
    counts, _ = np.histogram(song.steps, bins=bins, range=(song.start, max(song.end, song.start + 1e-6)))
    width = max(1, round(max(smooth, bins * 1.2 / max(song.end - song.start, 1.0))))
    kernel = np.hanning(width + 2)[1:-1]
    values = np.convolve(counts, kernel / kernel.sum(), mode="same")
    peak = values.max(initial=0.0)
    result: NDArray[np.float64] = values / peak if peak > 0 else values.astype(np.float64)
    return result


def clock_text(second: float) -> str:
    """ "1:05", with hours where there are any; before the music it stands at 0:00."""
    whole = int(max(0.0, second))
    hours, rest = divmod(whole, 3600)
    return f"{hours}:{rest // 60:02d}:{rest % 60:02d}" if hours else f"{rest // 60}:{rest % 60:02d}"
