"""Where measures stand on a chart sheet; its sizes and colours: configs/sheet.yaml, with those of notes and feet."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import accumulate
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.names import TICKS_PER_BEAT, TICKS_PER_MEASURE
from dancetutor_cli.feet.limbs import hex_colour, limb_colours
from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.schema import NOT_IN_FILES, Bounds, HexColour, Positive, convert
from dancetutor_cli.run.yaml_files import load, read

LETTERS = ("L", "R", "<", ">")  # by limb
_Grid = Annotated[int, Bounds(1)]


@dataclass(frozen=True, slots=True)
class SheetStyle:
    """Sizes in CSS pixels, colours as "#rrggbb".

    unsure : per cent; rows whose feet are less sure are marked
    beat : least and greatest height of a beat; limbs : by `feet.limbs.Limb`
    quantisation : colour of a note by the coarsest grid it stands on (4 for 4ths ...)
    """

    page_width: Positive
    page_height: Positive
    heading: Positive
    lane: Positive
    arrow: Positive
    mark: Positive
    row_spacing: Positive
    beat: tuple[Positive, Positive]
    margin: Positive
    gutter: Positive
    density: Positive
    unsure: Positive
    colours: dict[str, HexColour]
    quantisation: Annotated[Mapping[int, str], NOT_IN_FILES] = field(default_factory=dict)
    limbs: Annotated[tuple[str, ...], NOT_IN_FILES] = ()

    def note_colour(self, tick: int) -> str:
        """Colour of a note at a tick."""
        finest = max(self.quantisation)
        fits = (q for q in sorted(self.quantisation) if tick % max(TICKS_PER_MEASURE // q, 1) == 0)
        return self.quantisation[next(fits, finest)]


@cache
def sheet_style() -> SheetStyle:
    """The style of the project's configuration; FileError names what is missing or unknown."""
    style = load(config_path("sheet.yaml"), SheetStyle)
    quantisation = convert(read(config_path("highway.yaml")), dict[_Grid, HexColour], ("quantisation",))
    limbs = tuple(hex_colour(rgb) for rgb in limb_colours().by_limb)
    return replace(style, quantisation=quantisation, limbs=limbs)


# Where measures stand on a sheet: columns of measures side by side, systems of columns one below the other.

_COMMON_SHARE = 0.1  # a rhythm is common if at least this share of the distances between rows is as short
_SHRUNK = 0.9  # a beat may be as much lower than the rhythm needs, so that one more measure fits the page
_EDGE = 12.0  # beside the outermost columns
_TOP = 18.0  # above the first measure of a column and below its last, for half an arrow


@dataclass(frozen=True, slots=True)
class SheetLayout:
    """Places in CSS pixels: measures in columns, columns in systems, each system a page when printed.

    beat : height of a beat; columns : side by side in a system
    heights : for each system, how many measures its columns have
    """

    style: SheetStyle
    lanes: int
    measures: int
    beat: float
    columns: int
    heights: tuple[int, ...]

    @property
    def column_width(self) -> float:
        """Width of a column with its margin and gutter."""
        return (self.style.page_width - 2 * _EDGE) / self.columns

    @property
    def measure_height(self) -> float:
        """Height of a measure."""
        return self.beat * 4

    @property
    def systems(self) -> int:
        """How many systems the chart needs."""
        return len(self.heights)

    def system_height(self, system: int) -> float:
        """Height of a system."""
        return self.heights[system] * self.measure_height + 2 * _TOP

    def measures_of(self, system: int) -> range:
        """Measures of a system."""
        before = sum(self.heights[:system]) * self.columns
        return range(before, min(before + self.heights[system] * self.columns, self.measures))

    def column_of(self, measure: int) -> range:
        """Measures of the column that a measure stands in."""
        system = self._system_of(measure)
        here, height = self.measures_of(system), self.heights[system]
        start = here.start + (measure - here.start) // height * height
        return range(start, min(start + height, here.stop))

    def left(self, measure: int) -> float:
        """x of the first lane of a measure, inside its system."""
        system = self._system_of(measure)
        column = (measure - self.measures_of(system).start) // self.heights[system]
        return _EDGE + column * self.column_width + self.style.margin

    def top(self, measure: int) -> float:
        """y of the start of a measure, inside its system."""
        return _TOP + (measure - self.column_of(measure).start) * self.measure_height

    def _system_of(self, measure: int) -> int:
        starts = [0, *accumulate(height * self.columns for height in self.heights[:-1])]
        return bisect_right(starts, measure) - 1

    def x(self, tick: int, lane: int) -> float:
        """Middle of a lane at a tick."""
        return self.left(tick // TICKS_PER_MEASURE) + (lane + 0.5) * self.style.lane

    def y(self, tick: int) -> float:
        """Height of a tick."""
        measure, inside = divmod(tick, TICKS_PER_MEASURE)
        return self.top(measure) + inside / TICKS_PER_BEAT * self.beat


def lay_out(ticks: NDArray[np.int64], lanes: int, style: SheetStyle, last: int = 0) -> SheetLayout:
    """A layout for rows at these ticks: a beat as high as the chart's densest common rhythm needs.

    last : tick of the last end of a hold
    """
    measures = max(int(ticks.max(initial=0)), last) // TICKS_PER_MEASURE + 1
    gaps = np.diff(np.unique(ticks))
    gap = float(np.quantile(gaps, _COMMON_SHARE)) if len(gaps) else TICKS_PER_BEAT
    low, high = style.beat
    beat = min(max(style.row_spacing * TICKS_PER_BEAT / gap, low), high)
    room = style.page_height - 2 * _TOP
    tallest = max(1, int(room // (beat * 4 * _SHRUNK)))
    beat = min(room / tallest / 4, high)  # whole measures fill the page
    first = max(1, int((room - style.heading) // (beat * 4)))
    columns = max(1, int((style.page_width - 2 * _EDGE) // (style.margin + lanes * style.lane + style.gutter)))
    return SheetLayout(style, lanes, measures, beat, columns, tuple(_heights(measures, columns, first, tallest)))


def _heights(measures: int, columns: int, first: int, tallest: int) -> Iterator[int]:
    """Measures in the columns of each system; the last one has no more than it needs to fill its columns."""
    most = first
    while measures > most * columns:
        yield most
        measures, most = measures - most * columns, tallest
    yield max(1, math.ceil(measures / columns))
