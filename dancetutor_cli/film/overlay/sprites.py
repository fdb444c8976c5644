"""Sprites, drawn once for a size: arrows, receptors, flashes, mines, holds, L/R markers, and plates of words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.feet.limbs import limb_colours
from dancetutor_cli.film.overlay import blit
from dancetutor_cli.film.overlay.blit import Box, Sprite
from dancetutor_cli.film.overlay.text import Typeface
from dancetutor_cli.film.words import move_words
from dancetutor_cli.run.languages import Language
from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.schema import RGB
from dancetutor_cli.run.yaml_files import load

# Corners of an arrow that points up, in halves of its size.
_ARROW = np.array([
    (0.0, -0.94), (0.94, 0.0), (0.62, 0.32), (0.36, 0.06), (0.36, 0.88),
    (-0.36, 0.88), (-0.36, 0.06), (-0.62, 0.32), (-0.94, 0.0),
])  # fmt: skip
_SQUARE = np.array([(-0.86, -0.86), (0.86, -0.86), (0.86, 0.86), (-0.86, 0.86)])
_WIDTH = 0.94  # width of an arrow's shape in any direction, as a share of its size


FLAG_STEP = 1.15  # distance between the lines of a label, in sizes of its letters
FLAG_EDGE = 0.55  # sum of the gaps left and right of a label's words, in sizes of its letters
WHITE, SOFT, INK = (255, 255, 255), (196, 202, 222), (12, 13, 22)  # colours of words, and of plates below them
NOBODY = (150, 154, 170)  # colour of the mark of a note that is not played
# Darkening at the end of an arrow's tail, and the share of the tail's half over which it grows: the head stands out.
TAIL_DIM, TAIL_LONG = 0.6, 0.75


@dataclass(frozen=True, slots=True)
class HighwayStyle:
    """The settings of configs/highway.yaml: colours sRGB 0..255, sizes in lane widths, times in seconds."""

    quantisation: dict[int, RGB]
    players: tuple[RGB, RGB]
    hold: RGB
    roll: RGB
    mine: RGB
    fake: RGB
    receptor: RGB
    background: RGB
    lane_line: RGB
    arrow: float
    mark: float
    mark_aside: tuple[float, float]
    mark_tail: float
    flash_seconds: float
    panel_seconds: float
    callouts: tuple[str, ...]
    callout_ahead: str
    callout: dict[str, RGB]
    difficulty: dict[str, RGB]
    accent: RGB


class WordStyle(NamedTuple):
    """The typeface, colours and language of a film's words."""

    face: Typeface
    highway: HighwayStyle
    language: Language


def highway_style() -> HighwayStyle:
    """Load the style of configs/highway.yaml."""
    return load(config_path("highway.yaml"), HighwayStyle)


def callout_words(language: Language) -> dict[str, str]:
    """Return the moves that configs/highway.yaml calls out, and their words; FileError names a move without words."""
    return move_words(highway_style().callouts, config_path("highway.yaml"), language)


def arrow_size(lane: float, style: HighwayStyle) -> int:
    """Return the size, pixels, of an arrow in a lane of this width."""
    return max(8, round(lane * style.arrow))


def _outline(size: float, direction: float | None) -> NDArray[np.float64]:
    """Return the corners of the note shape; direction : degrees clockwise from up. A diagonal fills its lane, too."""
    if direction is None:
        return np.asarray(_SQUARE * size / 2)
    a = np.radians(direction)
    turn = np.array([[np.cos(a), np.sin(a)], [-np.sin(a), np.cos(a)]])
    corners = np.asarray(_ARROW @ turn / 2)
    if direction % 90:
        least, most = corners.min(axis=0), corners.max(axis=0)
        corners = (corners - (least + most) / 2) * _WIDTH / (most - least).max()
    return corners * size


@lru_cache(maxsize=64)
def distance(canvas: int, size: float, direction: float | None) -> blit.Field:
    """Return the distance to the note shape on a square canvas; the sprites of all colours share this slow part."""
    x, y = blit.grid(canvas, canvas)
    return blit.polygon(x, y, _outline(size * 0.96, direction)) - 0.02 * size


def arrow(size: int, direction: float | None, colour: RGB, hollow: bool = False) -> Sprite:
    """Draw a note with a white rim, a body in `colour` lit from above, a dark edge, and a tail darker than its head.

    hollow : draw a lift, with only its rim in colour
    """
    p = blit.Painter(size, size)
    d = distance(size, size * 0.95, direction)
    unit = size / 64
    base = np.array(colour, dtype=np.float64)
    p.paint(blit.cover(d - 1.6 * unit), (8, 9, 16), 0.9)
    bright = _bright(p, size, direction)
    p.paint(blit.cover(d), (np.full(3, 255.0) if not hollow else base) * bright)
    height = (p.y / size + 0.5)[..., None]
    body = (base * (1.12 - 0.42 * height) + 26 * (1 - height)) * bright
    inner = blit.cover(d + (3.2 if not hollow else 4.5) * unit)
    p.paint(inner, np.clip(body, 0, 255) if not hollow else base * 0.22)
    facet = np.clip((d + 9 * unit) / (6 * unit), 0, 1)  # a darker bevel towards the rim
    p.paint(inner * facet, (0, 0, 0), 0.2)
    return p.sprite()


def _bright(p: blit.Painter, size: int, direction: float | None) -> NDArray[np.float64]:
    """Return the brightness of an arrow at each place: 1 from its head to its middle, less towards the tail's end."""
    a = 0.0 if direction is None else np.radians(direction)
    behind = np.zeros_like(p.x + p.y) if direction is None else (p.y * np.cos(a) - p.x * np.sin(a)) / (0.5 * size)
    return np.asarray(1.0 - TAIL_DIM * np.clip(behind / TAIL_LONG, 0.0, 1.0)[..., None])


def receptor(size: int, direction: float | None, colour: RGB) -> Sprite:
    """Draw the still target of a lane: a dark body with a bright rim."""
    p = blit.Painter(size, size)
    d = distance(size, size * 0.95, direction)
    unit = size / 64
    p.paint(blit.cover(d - 1.6 * unit), (6, 7, 14), 0.85)
    p.paint(blit.cover(d), colour, 0.9)
    p.paint(blit.cover(d + 3.4 * unit), (30, 33, 50))
    return p.sprite()


def glow(size: int, direction: float | None, colour: RGB) -> Sprite:
    """Draw the light around and on a receptor whose panel is pressed; 1.5 times as large as the arrow."""
    full = size * 3 // 2
    p = blit.Painter(full, full)
    d = distance(full, size * 0.95, direction)
    halo = np.exp(-np.maximum(d, 0) / (0.085 * size))
    edge = np.clip((full / 2 - np.hypot(p.x, p.y)) / (0.12 * full), 0, 1)
    p.paint(halo * edge, colour, 0.85)
    p.paint(blit.cover(d + 0.08 * size, 0.12 * size * blit.SAMPLES), (255, 255, 255), 0.75)
    return p.sprite()


def mine(size: int, colour: RGB) -> Sprite:
    """Draw a round mine, unlike any arrow: a dark ball with spikes and a burning middle."""
    p = blit.Painter(size, size)
    angle = np.arctan2(p.y, p.x)
    spikes = 0.035 * size * np.cos(8 * angle)
    d = blit.disc(p.x, p.y, 0.33 * size) - spikes
    unit = size / 64
    p.paint(blit.cover(d - 2 * unit), (255, 255, 255), 0.85)
    p.paint(blit.cover(d), (26, 26, 34))
    p.paint(blit.cover(np.abs(blit.disc(p.x, p.y, 0.235 * size)) - 2.4 * unit), colour)
    cross = np.minimum(np.abs(p.x - p.y), np.abs(p.x + p.y)) / np.sqrt(2) - 2.4 * unit
    p.paint(blit.cover(np.maximum(cross, blit.disc(p.x, p.y, 0.15 * size))), colour)
    return p.sprite()


def hold_body(width: int, colour: RGB, roll: bool) -> Sprite:
    """Draw a tile of a hold's body, a band; a roll's tile has a saw-tooth of light and so differs without colour."""
    height = 2 * (width // 2)
    p = blit.Painter(height, width)
    half = 0.5 * width
    edge = half - np.abs(p.x) - 1
    base = np.array(colour, dtype=np.float64)
    p.paint(np.clip(edge, 0, 1), (255, 255, 255), 0.85)
    shade = 1.0 - 0.25 * np.abs(p.x / half)[..., None]
    p.paint(np.clip(edge - 0.05 * width, 0, 1), np.clip(base * shade, 0, 255))
    if roll:
        saw = (p.y - 0.5 * np.abs(p.x) * height / half) % height / height
        p.paint(np.clip(edge - 0.05 * width, 0, 1) * (saw < 0.5), np.clip(base * 1.5 + 40, 0, 255), 0.75)
    return p.sprite()


def hold_tail(width: int, colour: RGB) -> Sprite:
    """Draw the lower end of a hold: a half disc of the body's width."""
    height = width // 2 + 1
    p = blit.Painter(2 * height, width)
    d = blit.disc(p.x, p.y, 0.5 * width - 1)
    p.paint(blit.cover(d), (255, 255, 255), 0.85)
    p.paint(blit.cover(d + 0.05 * width), np.clip(np.array(colour) * 0.8, 0, 255))
    return p.sprite()[height:]


def marker(size: int, limb: int, face: Typeface, rim: bool = False) -> Sprite:
    """Draw the mark of the limb that steps a note: letter, colour and shape.

    A left foot is a disc, a right foot a square; hands have the same shapes with a ring.

    limb : value of `feet.limbs.Limb`, 0..3; -1 for a note without a free foot, a grey disc with a cross
    rim : draw a light rim around the dark rim, for a mark on a note of any colour
    """
    p = blit.Painter(size, size)
    paint = NOBODY if limb < 0 else limb_colours().by_limb[limb]
    unit = size / 32
    radius = 0.5 * size - 1
    right = limb in (1, 3)
    d = blit.rounded_box(p.x, p.y, 0.93 * radius, 0.93 * radius, 0.3 * radius) if right else blit.disc(p.x, p.y, radius)
    edge = 2.2 * unit
    if rim:
        p.paint(blit.cover(d), (255, 255, 255))
        d, edge = d + 1.5 * unit, 1.4 * unit
    p.paint(blit.cover(d), (10, 11, 20))
    p.paint(blit.cover(d + edge), paint)
    if limb < 0:
        cross = np.minimum(np.abs(p.x - p.y), np.abs(p.x + p.y)) * 0.7071 - 2.2 * unit
        p.paint(blit.cover(np.maximum(cross, d + 6.0 * unit)), (10, 11, 20))
        return p.sprite()
    if limb >= 2:
        p.paint(blit.cover(np.abs(d + edge + 3.0 * unit) - 0.9 * unit), (10, 11, 20))
    out = p.sprite()
    letter = face.sprite("R" if right else "L", (0.66 if limb < 2 else 0.52) * size, (10, 11, 20), weight=0.035 * size)
    centre(out, letter)
    return out


def centre(target: Sprite, ink: Sprite) -> None:
    """Draw `ink`, centred by its visible pixels, over the middle of `target`."""
    ys, xs = np.nonzero(ink[..., 3] > 8)
    ink = ink[ys.min() : ys.max() + 1, xs.min() : xs.max() + 1]
    top, left = ((t - i + 1) // 2 for t, i in zip(target.shape[:2], ink.shape[:2], strict=True))
    _over(target[top : top + ink.shape[0], left : left + ink.shape[1]], ink)


def _over(place: Sprite, ink: Sprite) -> None:
    keep = 255 - ink[..., 3:].astype(np.int64)
    place[...] = (place * keep + 127) // 255 + ink


def flag_height(lines: int, size: float) -> int:
    """Return the height, pixels, of a label with this number of lines and this size of letters."""
    return max(6, round(1.5 * size)) + round(FLAG_STEP * size) * (lines - 1)


def flag(lines: Sequence[str], size: float, colour: RGB, face: Typeface, edge: RGB | None = None) -> Sprite:
    """Draw lines of words on a dark label, which stands beside a row; edge : colour of the edge, if not `colour`."""
    words = [face.sprite(line, size, colour, weight=0.012 * size) for line in lines]
    step, height = round(FLAG_STEP * size), flag_height(len(lines), size)
    one = height - step * (len(lines) - 1)
    width = max(line.shape[1] for line in words) + round(FLAG_EDGE * size)
    p = blit.Painter(height, width)
    d = blit.rounded_box(p.x, p.y, width / 2 - 0.5, height / 2 - 0.5, 0.28 * one)
    p.paint(blit.cover(d), colour if edge is None else edge, 0.9)
    p.paint(blit.cover(d + 0.07 * size), (16, 18, 32))
    out = p.sprite()
    block = np.zeros((words[0].shape[0] + step * (len(words) - 1), max(line.shape[1] for line in words), 4), out.dtype)
    for number, line in enumerate(words):
        left = (block.shape[1] - line.shape[1]) // 2
        _over(block[number * step : number * step + line.shape[0], left : left + line.shape[1]], line)
    centre(out, block)
    return out


@lru_cache(maxsize=8)
def shade(size: int) -> Sprite:
    """Draw a soft dark disc, which separates a marker from its arrow."""
    p = blit.Painter(size, size)
    p.paint(np.clip(1 - np.hypot(p.x, p.y) / (0.5 * size), 0, 1), (0, 0, 0), 0.6)
    return p.sprite()


def box_of(sprite: Sprite, x: float, y: float) -> Box:
    """Return left, top, right and bottom of a sprite whose top left corner is at (x, y)."""
    return x, y, x + sprite.shape[1], y + sprite.shape[0]


def plate(lines: Sequence[str], size: float, colour: tuple[int, int, int], face: Typeface) -> Sprite:
    """Draw lines of dark words on a coloured plate with round ends."""
    words = [face.sprite(line, size, INK, weight=size / 62) for line in lines]
    one, step = max(8, round(1.55 * size)), round(1.2 * size)
    height = one + step * (len(lines) - 1)
    width = max(max(line.shape[1] for line in words) + one // 2 + 2, one)
    out = lozenge(height, width, one / 2 - 1, colour)
    for number, line in enumerate(words):
        centre(out[number * step : number * step + one], line)
    return out


def lozenge(height: int, width: int, radius: float, colour: tuple[int, int, int], opacity: float = 1) -> Sprite:
    """Draw a box with round corners."""
    painter = blit.Painter(height, width)
    d = blit.rounded_box(painter.x, painter.y, width / 2 - 1, height / 2 - 1, radius)
    painter.paint(blit.cover(d), colour, opacity)
    return painter.sprite()
