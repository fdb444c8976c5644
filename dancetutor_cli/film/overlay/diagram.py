"""The pad seen from above: a large pad with both feet as they are now, and small pads with the next rows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.feet.limbs import Limb, limb_colours
from dancetutor_cli.feet.play import StepKind
from dancetutor_cli.film.layout import PixelBox
from dancetutor_cli.film.notes import EPSILON, PanelLights
from dancetutor_cli.film.overlay import blit, sprites
from dancetutor_cli.film.overlay.blit import Box, Sprite
from dancetutor_cli.film.overlay.text import Typeface
from dancetutor_cli.film.picture import FootFromAbove, Frame
from dancetutor_cli.run.schema import RGB

if TYPE_CHECKING:
    from dancetutor_cli.feet.play import Play
    from dancetutor_cli.film.picture import PadLike

NAMES = (170, 177, 203)  # colour of a small pad's name
PANEL, PANEL_EDGE = (46, 51, 74), (88, 95, 130)
NEXT_LEAST = 90.0  # minimum pixels of the shorter side of a small pad, at the layout's default size
NEXT_TEXT = 16.0  # size of the letters of pads' names, pixels
# Labels of the next rows, and of a row that is equal to the row before it.
IN_TURN, AGAIN = ("next", "then", "and-then"), "again"
STEPPED, RESTING = 0.94, 0.6  # size of the marks on small pads, in panels: of a stepping and of a standing foot


@dataclass(frozen=True, slots=True)
class DiagramRows:
    """The rows with steps of a play; r rows, c columns.

    second : float64 (r,), seconds of the music; limb : int8 (r, c), `feet.limbs.Limb`, NONE for a panel without a step
    feet : int16 (r, 2 p), the column on which each foot of p dancers stands after the row, left and right in turn, or
        -1
    """

    second: NDArray[np.float64]
    limb: NDArray[np.int8]
    feet: NDArray[np.int16]


def step_rows(play: Play, dancers: Sequence[tuple[Play, int]] = ()) -> DiagramRows:
    """Return the rows with visible steps, without the virtual taps of rolls.

    dancers : for several dancers, the play of each and the first of its columns in `play`
    """
    shown = play.rows.steps != StepKind.NONE
    shown &= play.rows.steps != StepKind.ROLL_TAP
    keep = shown.any(axis=1)
    limb = np.where(shown, play.limb, np.int8(-1))
    feet = [_feet_at(play.rows.tick[keep], own, first) for own, first in dancers]
    return DiagramRows(play.rows.second[keep], limb[keep], np.hstack(feet) if feet else _stood(play)[keep])


def _stood(play: Play) -> NDArray[np.int16]:
    """Return `play.feet`, with -1 until a foot has stepped: before that, its place is only an assumption."""
    stepped = np.column_stack([(play.limb == side).any(axis=1) for side in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT)])
    return np.where(np.logical_or.accumulate(stepped, axis=0), play.feet, -1).astype(np.int16)


def _feet_at(ticks: NDArray[np.int64], own: Play, first: int) -> NDArray[np.int16]:
    """Return the columns of one dancer's feet after the rows at `ticks`, int16 (r, 2).

    first : the first column of this dancer in the common play
    """
    row = np.searchsorted(own.rows.tick, ticks, side="right") - 1
    feet = np.where(row[:, None] >= 0, _stood(own)[np.maximum(row, 0)], -1)
    return np.where(feet >= 0, feet + first, -1).astype(np.int16)


class PadView(NamedTuple):
    """A pad in the picture. directions : for each column, degrees clockwise from up, None for a middle panel

    turned : pad and dancer are seen from the screen; `directions` are the directions in the picture
    """

    pad: PadLike
    directions: tuple[float | None, ...]
    turned: bool = False


class PadMap:
    """A pad seen from above in a box, which maps panel widths to pixels and draws its panels."""

    def __init__(self, view: PadView, box: PixelBox) -> None:
        self.turned, self._way = view.turned, -1.0 if view.turned else 1.0
        self.panels = np.asarray(view.pad.panels, dtype=np.float64)
        self.directions = view.directions
        low, high = self.panels.min(0) - 0.5, self.panels.max(0) + 0.5
        room = (box[2] - box[0], box[3] - box[1])
        self.unit = 0.98 * min(room[0] / (high[0] - low[0]), room[1] / (high[1] - low[1]))
        middle = self._way * (low + high) / 2
        self.origin = ((box[0] + box[2]) / 2 - middle[0] * self.unit, (box[1] + box[3]) / 2 + middle[1] * self.unit)

    def place(self, x: float, y: float) -> tuple[float, float]:
        """Convert a place in panel widths to pixels."""
        return self.origin[0] + self._way * x * self.unit, self.origin[1] - self._way * y * self.unit

    @property
    def edges(self) -> tuple[float, float, float, float]:
        """The left, top, right and bottom edges of the pad, pixels."""
        places = np.array([self.place(x, y) for x, y in self.panels])
        (left, top), (right, bottom) = places.min(0) - self.unit / 2, places.max(0) + self.unit / 2
        return float(left), float(top), float(right), float(bottom)

    @property
    def smaller(self) -> float:
        """The length of the pad's shorter side, pixels."""
        return float((np.ptp(self.panels, axis=0) + 1.0).min() * self.unit)

    def nearness(self, x: float, y: float) -> float:
        """Return 1 for a place on the pad, falling to 0 for a place half a panel or more beside the pad."""
        low, high = self.panels.min(0) - 0.5, self.panels.max(0) + 0.5
        beside = max(low[0] - x, x - high[0], low[1] - y, y - high[1], 0.0)
        return float(max(0.0, 1.0 - 2.0 * beside))

    def draw(self, frame: Frame, lit: list[tuple[float, int]], opacity: float = 1.0) -> None:
        """Draw the panels; lit : the brightness and the limb of each panel."""
        size = max(4, round(0.95 * self.unit))
        for (x, y), direction, (level, limb) in zip(self.panels, self.directions, lit, strict=True):
            px, py = self.place(x, y)
            at = (round(px - size / 2), round(py - size / 2))
            blit.draw_sprite(frame, panel_sprite(size, direction, None), *at, opacity)
            if level > 0 and limb >= 0:
                blit.draw_sprite(frame, panel_sprite(size, direction, limb), *at, level * opacity)


@lru_cache(maxsize=128)
def panel_sprite(size: int, direction: float | None, limb: int | None) -> Sprite:
    """Draw a panel with its arrow, lit in the colour of `limb` unless that is None."""
    p = blit.Painter(size, size)
    d = blit.rounded_box(p.x, p.y, size / 2 - 1, size / 2 - 1, 0.09 * size)
    colour = None if limb is None else np.array(limb_colours().by_limb[limb], dtype=np.float64)
    p.paint(blit.cover(d), PANEL_EDGE if colour is None else np.clip(colour * 1.1, 0, 255))
    p.paint(blit.cover(d + 0.025 * size), PANEL if colour is None else colour * 0.75)
    arrow = sprites.distance(size, size * 0.62, direction)
    p.paint(blit.cover(arrow), (120, 128, 168) if colour is None else (255, 255, 255), 0.55)
    return p.sprite()


@lru_cache(maxsize=512)
def shoe_sprite(
    size: int, degrees: int, limb: int, face: Typeface, ghost: bool, rim: tuple[int, int, int] = (255, 255, 255)
) -> Sprite:
    """Draw a sole from above with its letter, its toe turned `degrees` clockwise from the screen."""
    p = blit.Painter(size, size)
    a = np.radians(degrees)
    x, y = p.x * np.cos(a) + p.y * np.sin(a), -p.x * np.sin(a) + p.y * np.cos(a)
    mirror = 1 if limb == 0 else -1
    along = np.clip((y / size) / 0.3, -1, 1)
    width = 0.15 - 0.022 * along  # wider at the toes than at the heel
    bend = 0.02 * mirror * (along**2 - 0.3)
    capsule = np.hypot(x / size - bend, np.maximum(np.abs(y / size) - 0.26, 0)) - width
    d = capsule * size
    colour = np.array(limb_colours().by_limb[limb], dtype=np.float64)
    p.paint(blit.cover(d - 0.012 * size), (8, 9, 16), 0.85 if not ghost else 0.4)
    p.paint(blit.cover(d + 0.005 * size), rim, 0.95 if not ghost else 0.5)
    p.paint(blit.cover(d + 0.03 * size), colour, 1.0 if not ghost else 0.55)
    out = p.sprite()
    sprites.centre(out, face.sprite("LR"[limb], 0.3 * size, (10, 11, 20), weight=0.012 * size))
    return out


@lru_cache(maxsize=32)
def _marker(size: int, limb: int, face: Typeface) -> Sprite:
    """Return the mark of the notes from a cache, because each frame of a practice film needs several marks."""
    return sprites.marker(size, limb, face)


class FeetDiagram:
    """The large pad with all feet on it, at any second.

    rims : the colour around each dancer's feet; name : the words above the pad
    """

    def __init__(
        self,
        pads: PadMap,
        lights: PanelLights,
        face: Typeface,
        rims: tuple[RGB, ...] = ((255,) * 3,),
        name: Sprite | None = None,
    ) -> None:
        self.pads, self.lights, self.face, self.rims, self.name = pads, lights, face, rims, name

    @property
    def boxes(self) -> list[Box]:
        """The box of the pad: left, top, right, bottom."""
        return [self.pads.edges]

    def draw(self, frame: Frame, second: float, feet: Sequence[FootFromAbove | None], opacity: float = 1.0) -> None:
        """Draw the pad and the feet; a lifted foot is larger and lighter.

        feet : the feet of the dancers, left and right in turn
        """
        self.pads.draw(frame, [self.lights.at(column, second) for column in range(len(self.pads.panels))], opacity)
        if self.name is not None:
            blit.draw_sprite(frame, self.name, *corner_above(self.pads, self.name), opacity)
        for number, foot in enumerate(feet):
            if foot is None:
                continue
            limb, rim = number % 2, self.rims[min(number // 2, len(self.rims) - 1)]
            dx, dy = foot.toe[0] - foot.heel[0], foot.toe[1] - foot.heel[1]
            degrees = (round(np.degrees(np.arctan2(dx, dy)) / 3) * 3 + 180 * self.pads.turned) % 360
            size = max(8, 2 * round(0.5 * self.pads.unit * (1.12 + 0.6 * min(foot.height, 0.3))))
            shoe = shoe_sprite(size, degrees, limb, self.face, foot.height > 0.035, rim)
            middle = (foot.heel[0] + foot.toe[0]) / 2, (foot.heel[1] + foot.toe[1]) / 2
            x, y = self.pads.place(*middle)
            if (seen := self.pads.nearness(*middle)) > 0.0:  # the dancer may walk beside the pad
                blit.draw_sprite(frame, shoe, round(x - size / 2), y - size / 2, seen * opacity)


def name_sprite(name: str, face: Typeface, scale: float) -> Sprite:
    """Draw a pad's name. scale : pixels for one pixel at the layout's default size"""
    text = NEXT_TEXT * scale
    return face.sprite(name, text, NAMES, weight=text / 90)


def box_below(box: PixelBox, name: Sprite | None) -> PixelBox:
    """Return the part of a pad's box that is below the pad's name."""
    return box if name is None else (box[0], box[1] + name.shape[0], box[2], box[3])


def corner_above(pads: PadMap, name: Sprite) -> tuple[float, float]:
    """Return left and top of a name that stands in the middle above its pad, pixels."""
    left, top, right, _ = pads.edges
    return (left + right - name.shape[1]) / 2, int(top) - name.shape[0]


def cut_box(box: PixelBox, count: int, axis: int) -> list[PixelBox]:
    """Cut a box into `count` equal parts with gaps: beside each other for axis 0, below each other for axis 1."""
    low, high = box[axis], box[axis + 2]
    gap = round((0.04 if axis == 0 else 0.06) * (high - low))
    length = (high - low - (count - 1) * gap) // count
    parts = []
    for number in range(count):
        start = low + number * (length + gap)
        part = list(box)
        part[axis], part[axis + 2] = start, start + length
        parts.append((part[0], part[1], part[2], part[3]))
    return parts


class Lettering(NamedTuple):
    """The lettering of names. scale : pixels for one pixel at the layout's default size; words : label -> words"""

    face: Typeface
    scale: float
    words: Mapping[str, str]


class NextRows:
    """Small pads with the next rows: their panels, the limbs that step them, and the places of both feet after the row.

    The pads are beside or below each other, whichever makes them larger. If they would be too small, there are fewer
    pads. Each pad has a name: "next", "then", "and then", or "again" for a row that is equal to the row before it.
    """

    def __init__(
        self,
        rows: DiagramRows,
        view: PadView,
        box: PixelBox,
        count: int,
        letters: Lettering,
    ) -> None:
        face, scale, words = letters
        self.rows, self.face = rows, face
        least = NEXT_LEAST * scale
        self.names = {name: name_sprite(words[name], face, scale) for name in (*IN_TURN, AGAIN)}
        wide, high = (max(name.shape[axis] for name in self.names.values()) for axis in (1, 0))
        while True:
            beside, below = cut_box(box, count, 0), cut_box(box, count, 1)
            above = [PadMap(view, (a, b + high, c, d)) for a, b, c, d in beside]
            left = [PadMap(view, (a + wide + 2, b, c, d)) for a, b, c, d in below]
            self.pads = max(above, left, key=lambda pads: pads[0].unit)
            self._above = self.pads is above
            if count == 1 or self.pads[0].smaller >= least:
                return
            count -= 1

    def draw(self, frame: Frame, second: float) -> None:
        """Draw the rows after `second`."""
        first = int(np.searchsorted(self.rows.second, second + EPSILON, side="right"))
        for place, pads in enumerate(self.pads):
            row = first + place
            if row >= len(self.rows.second):
                continue
            limbs = self.rows.limb[row]
            pads.draw(frame, [(1.0 if limb >= 0 else 0.0, int(limb)) for limb in limbs])
            for column in np.flatnonzero((limbs >= 0) | (limbs == Limb.UNPLAYED)):
                self._mark(frame, pads, int(column), max(int(limbs[column]), -1), STEPPED)
            for foot, column in enumerate(self.rows.feet[row]):
                if column >= 0 and limbs[column] < 0:
                    self._mark(frame, pads, int(column), foot % 2, RESTING)
            name = self.name(place, row)
            blit.draw_sprite(frame, name, *self._corner(pads, name))

    def name(self, place: int, row: int) -> Sprite:
        """Return the name of the pad at `place`, which shows this row."""
        same = place > 0 and bool((self.rows.limb[row] == self.rows.limb[row - 1]).all())
        return self.names[AGAIN if same else IN_TURN[min(place, len(IN_TURN) - 1)]]

    def _corner(self, pads: PadMap, name: Sprite) -> tuple[float, float]:
        """Return the top left corner of a pad's name, which stands in the middle above the pad or on its left."""
        left, top, _, bottom = pads.edges
        if self._above:
            return corner_above(pads, name)
        return left - name.shape[1] - 2, round((top + bottom - name.shape[0]) / 2)

    def _mark(self, frame: Frame, pads: PadMap, column: int, limb: int, share: float) -> None:
        """Draw the mark of a limb on a panel; the mark of a foot that only stands there is small and faded."""
        mark = _marker(max(8, round(share * pads.unit)), limb, self.face)
        x, y = pads.place(*pads.panels[column])
        at = (round(x - mark.shape[1] / 2), round(y - mark.shape[0] / 2))
        blit.draw_sprite(frame, mark, *at, 1.0 if share == STEPPED else 0.6)
