"""What stands at the lower edge of most layouts: the legend, and the strip with density, position and time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.film.layout import PixelBox
from dancetutor_cli.film.overlay import blit, sprites
from dancetutor_cli.film.overlay.blit import Box, Sprite
from dancetutor_cli.film.overlay.sprites import HighwayStyle
from dancetutor_cli.film.overlay.text import Typeface
from dancetutor_cli.film.picture import Frame
from dancetutor_cli.run.schema import RGB


class LegendWords(NamedTuple):
    """The words of a legend. limbs : number of a limb -> its name, for the limbs in the picture

    note : words below the last limb or player; players : name and note colour of each of two players
    """

    limbs: Mapping[int, str]
    note: str = ""
    players: Sequence[tuple[str, RGB]] = ()


class Legend:
    """The legend, which explains the markers, one below the other, at the bottom of its box.

    A dark plate keeps the words readable over a panel of the pad. Lines for which the box has no room stand below it,
    because the song's words are above it.
    """

    def __init__(self, words: LegendWords, box: PixelBox, scale: float, face: Typeface) -> None:
        limbs, note, players = words
        size = max(8, round(24 * scale))
        shown = [(sprites.marker(size, limb, face), limbs[limb]) for limb in sorted(limbs)]
        shown += [(sprites.arrow(size, 0.0, colour), name) for name, colour in players]
        step, edge = 31 * scale, 8 * scale
        height = step * (len(shown) + bool(note))
        top = max(box[3] - height, float(box[1]))
        lines: list[tuple[Sprite, float, float]] = []
        right = float(box[0])
        for row, (mark, name) in enumerate(shown):
            middle = top + (row + 0.5) * step
            text = face.sprite(name, 16 * scale, sprites.WHITE, weight=0.2 * scale)
            x = box[0] + mark.shape[1] + 5 * scale
            lines += [(mark, box[0], middle - mark.shape[0] / 2), (text, x, middle - text.shape[0] / 2)]
            right = max(right, x + text.shape[1])
        if note:
            text = face.sprite(note, 16 * scale, sprites.WHITE, weight=0.2 * scale)
            lines.append((text, box[0], top + height - 0.5 * step - text.shape[0] / 2))
            right = max(right, float(box[0] + text.shape[1]))
        around = round(height + 1.2 * edge), round(right - box[0] + 2 * edge)
        plate = sprites.lozenge(*around, 8 * scale, sprites.INK, opacity=0.62)
        self.lines = [(plate, box[0] - edge, top - 0.6 * edge), *lines]

    @property
    def boxes(self) -> list[Box]:
        """The box of the plate: left, top, right, bottom."""
        return [sprites.box_of(*self.lines[0])]

    def draw(self, frame: Frame, opacity: float = 1.0) -> None:
        """Draw the legend over the picture."""
        for sprite, x, y in self.lines:
            blit.draw_sprite(frame, sprite, x, round(y), opacity)


@dataclass(frozen=True, slots=True)
class SongShape:
    """The whole song for the strip. steps : float64 (n,), seconds of the steps, sorted

    start, end : the range of the strip, seconds; film : the part that the film shows, (start, end) seconds
    """

    steps: NDArray[np.float64]
    start: float
    end: float
    film: tuple[float, float]


def strip_ground(picture: Frame, scale: float) -> None:
    """Draw the background of the strip, with a line at its top."""
    picture[...] = (9, 10, 19)
    picture[: max(1, round(1.2 * scale))] = (44, 48, 70)


class ProgressStrip:
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
        strip_ground(picture, self.scale)
        a, b = self.graph[0] - left, self.graph[1] - left
        if b <= a:
            return picture
        heights = step_density(self.song, b - a, max(2.0, 2.0 * self.scale))
        floor = bottom - top - 7 * self.scale
        room = floor - 7 * self.scale
        colour = style.accent if bright else (92, 98, 128)
        for x, height in enumerate(heights):
            base = 1.5 * self.scale
            blit.draw_rectangle(picture, (a + x, floor - base - (room - base) * height, a + x + 1, floor), colour, 0.88)
        for edge in self.song.film:
            at = a + self._position(edge) * (b - a)
            if a < at < b:
                box = (at - self.scale, 0, at + self.scale, bottom - top)
                blit.draw_rectangle(picture, box, style.difficulty["Medium"], 0.8)
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
        here = (x - 1.2 * self.scale, top + 4 * self.scale, x + 1.2 * self.scale, bottom - 4 * self.scale)
        blit.draw_rectangle(frame, here, sprites.WHITE)
        words = self._sprite(f"{clock_text(second)} / {clock_text(self.song.end)}")
        blit.draw_sprite(frame, words, left + 14 * self.scale, round((top + bottom - words.shape[0]) / 2))

    def _time_sprite(self, text: str) -> Sprite:
        return self.face.sprite(text, self.text, sprites.WHITE, weight=0.2 * self.scale)


def step_density(song: SongShape, bins: int, smooth: float) -> NDArray[np.float64]:
    """Return the density of steps along the song, `bins` values relative to the highest.

    smooth : minimum width of the smoothing, bins
    """
    counts, _ = np.histogram(song.steps, bins=bins, range=(song.start, max(song.end, song.start + 1e-6)))
    width = max(1, round(max(smooth, bins * 1.2 / max(song.end - song.start, 1.0))))
    kernel = np.hanning(width + 2)[1:-1]
    values = np.convolve(counts, kernel / kernel.sum(), mode="same")
    peak = values.max(initial=0.0)
    result: NDArray[np.float64] = values / peak if peak > 0 else values.astype(np.float64)
    return result


def clock_text(second: float) -> str:
    """Format a second as "1:05", with hours from one hour on; a second before the music is "0:00"."""
    whole = int(max(0.0, second))
    hours, rest = divmod(whole, 3600)
    return f"{hours}:{rest // 60:02d}:{rest % 60:02d}" if hours else f"{rest // 60}:{rest % 60:02d}"
