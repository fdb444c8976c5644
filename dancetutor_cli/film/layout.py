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

# Layouts: the places of the dancer, the notes and the words in the picture, read from configs/layouts/*.yaml.

PixelBox = tuple[int, int, int, int]
WIDE_PAD = 5  # a pad with more columns than this uses the layout's `wide` boxes
_Side = Annotated[int, Bounds(LEAST_SIDE, MOST_SIDE, "pixels")]
_Room = Annotated[float, Bounds(-100, 100, "metres")]
_ScreenSide = Annotated[float, Bounds(0.05, 100, "metres")]
_Larger = Annotated[float, Bounds(0.1, 10)]
_Rate = Annotated[float, Bounds(0.25, 2)]


@dataclass(frozen=True, slots=True)
class DancerPart:
    """The dancer's place. box : share of the picture; camera : name of a camera

    region : share of the box that the dancer fills
    """

    box: Box
    camera: str = "back"
    region: Box = (0.0, 0.0, 1.0, 1.0)


@dataclass(frozen=True, slots=True)
class HighwayPart:
    """The highway's place. box : share of the picture; lane : width of a lane, pixels at the default size

    receptor : height of the receptors, share of the box; scroll : such as "C600"
    tags : whether moves are named beside their rows
    """

    box: Box
    lane: Annotated[float, Bounds(4, 1000, "pixels")]
    receptor: Share = 0.135
    scroll: str = "M480"
    down: bool = False
    tags: bool = True


@dataclass(frozen=True, slots=True)
class TextBox:
    """A place for words. box : share of the picture; text : size of the words, as a factor of the usual size."""

    box: Box
    text: _Larger = 1.0


@dataclass(frozen=True, slots=True)
class FeetPart:
    """The place of the feet seen from above. box : share of the picture; wide : show them also on wide pads."""

    box: Box
    wide: bool = True


@dataclass(frozen=True, slots=True)
class HeaderPart:
    """The place of the song's words. room : share of the box's width that the words may take, beside the dancer's head.

    box, text : as in `TextBox`
    """

    box: Box
    text: _Larger = 1.0
    room: Annotated[float, Bounds(0.05, 1)] = 1.0


@dataclass(frozen=True, slots=True)
class ScreenPart:
    """A screen in the room, which shows the highway. centre : in the world, metres; size : metres

    pixels : size of the screen's picture
    """

    centre: tuple[_Room, _Room, _Room]
    size: tuple[_ScreenSide, _ScreenSide]
    pixels: tuple[_Side, _Side]


@dataclass(frozen=True, slots=True)
class NextPart:
    """The place of the small pads that show the next rows. box : share of the picture; count : number of pads."""

    box: Box
    count: Annotated[int, Bounds(1, 12)] = 3


@dataclass(frozen=True, slots=True)
class PracticePart:
    """The runs of a layout if the user sets no others. rates : the speeds in turn; count_in : beats."""

    rates: Annotated[tuple[_Rate, ...], Entries(1)] = (1.0,)
    count_in: Annotated[int, Bounds(0, 16, "beats")] = 0


@dataclass(frozen=True, slots=True)
class WideBoxes:
    """Other boxes for pads of more than five panels; None for a part that keeps its place.

    region : share of the box that the dancer fills
    screen : another place of the screen
    lanes : greatest share of the highway's width that the lanes take
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
    """One file of configs/layouts. size : the default (width, height) in pixels, to which all pixel sizes refer.

    calls : the place in which moves are called out, by default in the dancer's box
    runs : the place of the run's label, by default below the header
    count : the place of the count-in's numbers, by default the middle of the picture
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
        """Return the number of pixels that one pixel of the default size becomes in a picture of this size."""
        return min(size[0] / self.size[0], size[1] / self.size[1])

    def box(self, name: str, size: tuple[int, int], columns: int) -> PixelBox:
        """Return the box of a part ("dancer", "highway" ...) in pixels of the picture.

        The box of a highway that is shown on a screen is in pixels of the screen.
        """
        if name == "highway" and (screen := self.screen_for(columns)) is not None:
            size = screen.pixels
        return pixels(self._other(name, columns) or getattr(self, name).box, size)

    def screen_for(self, columns: int) -> ScreenPart | None:
        """Return the screen in the room, None if the layout has no screen."""
        wide = None if self.wide is None or columns <= WIDE_PAD else self.wide.screen
        return self.screen and (wide or self.screen)

    def region(self, columns: int) -> Box:
        """Return the share of the dancer's box that she fills; the whole box in a layout without a dancer."""
        usual = (0.0, 0.0, 1.0, 1.0) if self.dancer is None else self.dancer.region
        return self._other("region", columns) or usual

    def lanes(self, columns: int) -> float | None:
        """Return the greatest share of the highway's width that its lanes take, None if the layout does not set it."""
        return None if self.wide is None or columns <= WIDE_PAD else self.wide.lanes

    def _other(self, name: str, columns: int) -> Box | None:
        """Return the box that replaces the box of the part on a wide pad, None if the part keeps its own."""
        return getattr(self.wide, name, None) if self.wide is not None and columns > WIDE_PAD else None


def pixels(box: Box, size: tuple[int, int]) -> PixelBox:
    """Convert a box in shares of the picture to (left, top, right, bottom) in pixels."""
    left, top, right, bottom = box
    return round(left * size[0]), round(top * size[1]), round(right * size[0]), round(bottom * size[1])


def lowered(box: PixelBox, top: float) -> PixelBox:
    """Return a box of the same size that begins at `top`."""
    down = round(top) - box[1]
    return box[0], box[1] + down, box[2], box[3] + down


def overlap(a: PixelBox, b: PixelBox) -> bool:
    """Whether two boxes share a pixel."""
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def load_layout(name: str) -> Layout:
    """Load a layout by name, or from a YAML file of the user's. UsageError lists the names of the layouts."""
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


# The look of a film as the user asked for it on the command line.


@dataclass(frozen=True, slots=True)
class FilmLook:
    """The look, which does not change during a film. size : (width, height), even.

    camera, scroll : None for the layout's own; down : whether notes fall
    font : a font file, None for the built-in font
    ahead : the time between a call and its move, None for the configured time
    findings : whether the linter's findings are called out
    language : the language of the words, a name in configs/languages
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
