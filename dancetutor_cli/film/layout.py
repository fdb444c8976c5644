"""Layouts, from configs/layouts/*.yaml, and the look of a film as the user asked for it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from dancetutor_cli.film.choices import LEAST_SIDE, MOST_SIDE, Ahead, Quality, RendererKind
from dancetutor_cli.film.scroll import Scroll, parse_scroll
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import named_file
from dancetutor_cli.run.schema import Bounds, Box, Entries, Share
from dancetutor_cli.run.yaml_files import load

# Layouts: where dancer, notes and words stand in the picture; read from configs/layouts/*.yaml.

PixelBox = tuple[int, int, int, int]
WIDE_PAD = 5  # more columns than this take the layout's `wide` boxes
_Side = Annotated[int, Bounds(LEAST_SIDE, MOST_SIDE, "pixels")]
_Room = Annotated[float, Bounds(-100, 100, "metres")]
_ScreenSide = Annotated[float, Bounds(0.05, 100, "metres")]
_Larger = Annotated[float, Bounds(0.1, 10)]
_Rate = Annotated[float, Bounds(0.25, 2)]


@dataclass(frozen=True, slots=True)
class DancerPart:
    """box : share of the picture; camera : name of a camera; region : share of the box that she fills."""

    box: Box
    camera: str = "back"
    region: Box = (0.0, 0.0, 1.0, 1.0)


@dataclass(frozen=True, slots=True)
class HighwayPart:
    """box : share of the picture; lane : pixels at the default size; receptor : share of the box; scroll : "C600"

    tags : moves are named beside their rows, too
    """

    box: Box
    lane: Annotated[float, Bounds(4, 1000, "pixels")]
    receptor: Share = 0.135
    scroll: str = "M480"
    down: bool = False
    tags: bool = True


@dataclass(frozen=True, slots=True)
class TextBox:
    """A place for words. box : share of the picture; text : how much larger than usual they are."""

    box: Box
    text: _Larger = 1.0


@dataclass(frozen=True, slots=True)
class FeetPart:
    """The feet from above. box : share of the picture; wide : on pads of several squares, too."""

    box: Box
    wide: bool = True


@dataclass(frozen=True, slots=True)
class HeaderPart:
    """The song's words. room : share of the box's width that they may take, beside her head."""

    box: Box
    text: _Larger = 1.0
    room: Annotated[float, Bounds(0.05, 1)] = 1.0


@dataclass(frozen=True, slots=True)
class ScreenPart:
    """A screen in the room, which shows the highway. centre : world, metres; size : metres; pixels : its picture."""

    centre: tuple[_Room, _Room, _Room]
    size: tuple[_ScreenSide, _ScreenSide]
    pixels: tuple[_Side, _Side]


@dataclass(frozen=True, slots=True)
class NextPart:
    """Small pads with the next rows. box : share of the picture; count : how many."""

    box: Box
    count: Annotated[int, Bounds(1, 12)] = 3


@dataclass(frozen=True, slots=True)
class PracticePart:
    """How a layout runs if the user asks for nothing else. rates : speeds in turn; count_in : beats."""

    rates: Annotated[tuple[_Rate, ...], Entries(1)] = (1.0,)
    count_in: Annotated[int, Bounds(0, 16, "beats")] = 0


@dataclass(frozen=True, slots=True)
class WideBoxes:
    """Other boxes for pads of more than five panels; None if the part stays where it is. region : the dancer's.

    screen : another place of it

    lanes : share of the highway's width that they take at most
    """

    dancer: Box | None = None
    region: Box | None = None
    highway: Box | None = None
    header: Box | None = None
    legend: Box | None = None
    calls: Box | None = None
    runs: Box | None = None
    count: Box | None = None
    feet: Box | None = None
    next: Box | None = None
    lanes: Annotated[float, Bounds(0.1, 1)] | None = None
    screen: ScreenPart | None = None


@dataclass(frozen=True, slots=True)
class Layout:
    """One file of configs/layouts. size : (width, height) in pixels, the default and what pixel sizes are meant for.

    calls : where moves are called out, by default in the dancer's box; runs : the label of the run, by default below
    the header; count : the numbers of the count-in, by default in the middle of the picture
    """

    size: tuple[_Side, _Side]
    dancer: DancerPart | None = None
    highway: HighwayPart | None = None
    header: HeaderPart | None = None
    calls: TextBox | None = None
    runs: TextBox | None = None
    count: TextBox | None = None
    legend: TextBox | None = None
    progress: TextBox | None = None
    screen: ScreenPart | None = None
    feet: FeetPart | None = None
    next: NextPart | None = None
    practice: PracticePart | None = None
    wide: WideBoxes | None = None

    def scale(self, size: tuple[int, int]) -> float:
        """How many pixels one pixel of the default size has become."""
        return min(size[0] / self.size[0], size[1] / self.size[1])

    def box(self, name: str, size: tuple[int, int], columns: int) -> PixelBox:
        """The box of a part ("dancer", "highway" ...) in pixels: of the picture, or, for the highway, of the screen
        that it is shown on."""
        if name == "highway" and (screen := self.screen_for(columns)) is not None:
            size = screen.pixels
        return pixels(self._other(name, columns) or getattr(self, name).box, size)

    def screen_for(self, columns: int) -> ScreenPart | None:
        """The screen in the room, if there is one."""
        wide = None if self.wide is None or columns <= WIDE_PAD else self.wide.screen
        return self.screen and (wide or self.screen)

    def region(self, columns: int) -> Box:
        """The share of her box that the dancer fills, if there is one."""
        usual = (0.0, 0.0, 1.0, 1.0) if self.dancer is None else self.dancer.region
        return self._other("region", columns) or usual

    def lanes(self, columns: int) -> float | None:
        """The share of the highway's width that its lanes take at most, if the layout says it."""
        return None if self.wide is None or columns <= WIDE_PAD else self.wide.lanes

    def _other(self, name: str, columns: int) -> Box | None:
        """The box that replaces it on a wide pad."""
        return getattr(self.wide, name, None) if self.wide is not None and columns > WIDE_PAD else None


def pixels(box: Box, size: tuple[int, int]) -> PixelBox:
    """A box in shares of the picture as (left, top, right, bottom) in pixels."""
    left, top, right, bottom = box
    return round(left * size[0]), round(top * size[1]), round(right * size[0]), round(bottom * size[1])


def lowered(box: PixelBox, top: float) -> PixelBox:
    """A box of the same size that begins at `top`."""
    down = round(top) - box[1]
    return box[0], box[1] + down, box[2], box[3] + down


def overlap(a: PixelBox, b: PixelBox) -> bool:
    """Whether two boxes share a pixel."""
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def load_layout(name: str) -> Layout:
    """A layout by name, or from a YAML file of the user's. UsageError lists the names there are."""
    path = named_file("layouts", name)
    layout = load(path, Layout)
    if layout.dancer is None and layout.highway is None:
        raise FileError(path, "a layout needs a dancer, a highway or both")
    if layout.screen is not None and (layout.dancer is None or layout.highway is None):
        raise FileError(path, "a layout with a screen needs a dancer and a highway")
    if layout.feet is not None and layout.dancer is None:
        raise FileError(path, "a layout with feet needs a dancer")
    if layout.highway is not None:
        parse_scroll(layout.highway.scroll)
    return layout


# The look of a film as the user asked for it on the command line; light, so that wrong options are refused at once.


@dataclass(frozen=True, slots=True)
class FilmLook:
    """The look, which does not change during a film. size : (width, height), even.

    camera, scroll : None for the layout's; down : notes fall; font : a font file, None for the built-in one
    ahead : how long before a move it is called out, None as configured; findings : call out the linter's, too
    language : of the words in it, a name of configs/languages
    """

    layout: Layout
    size: tuple[int, int]
    quality: Quality = "good"
    renderer: RendererKind = "auto"
    camera: str | None = None
    scroll: Scroll | None = None
    down: bool = False
    font: Path | None = None
    ahead: Ahead | None = None
    findings: bool = False
    language: str = "en"
