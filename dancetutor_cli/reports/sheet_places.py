"""The layout of a chart sheet, and its sizes and colours: configs/sheet.yaml, with the colours of notes and feet."""

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

_Grid = Annotated[int, Bounds(1)]


@dataclass(frozen=True, slots=True)
class SheetStyle:
    """Sizes in CSS pixels, colours as "#rrggbb".

    unsure : per cent; rows with a lower confidence are marked
    beat : least and greatest height of a beat; limbs : by `feet.limbs.Limb`
    quantisation : colour of a note by the coarsest grid that it is on (4 for 4ths ...)
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
        """Return the colour of a note at a tick."""
        finest = max(self.quantisation)
        fits = (q for q in sorted(self.quantisation) if tick % max(TICKS_PER_MEASURE // q, 1) == 0)
        return self.quantisation[next(fits, finest)]


@cache
def sheet_style() -> SheetStyle:
    """Return the style of the project's configuration. Raises FileError for a missing or unknown key."""
    style = load(config_path("sheet.yaml"), SheetStyle)
    quantisation = convert(read(config_path("highway.yaml")), dict[_Grid, HexColour], ("quantisation",))
    limbs = tuple(hex_colour(rgb) for rgb in limb_colours().by_limb)
    return replace(style, quantisation=quantisation, limbs=limbs)


# The layout of a sheet: columns of measures side by side, systems of columns one below the other.

_COMMON_SHARE = 0.1  # a rhythm is common if at least this share of the distances between rows is as short
_SHRUNK = 0.9  # a beat may shrink to this share of the height it needs, so that one more measure fits the page
_EDGE = 12.0  # pixels beside the outermost columns
_TOP = 18.0  # pixels above the first measure of a column and below its last, for half an arrow


@dataclass(frozen=True, slots=True)
class SheetLayout:
    """The places of measures in CSS pixels: measures in columns, columns in systems, each system a page when printed.

    beat : height of a beat; columns : number of columns in a system
    heights : number of measures in a column, for each system
    """

    style: SheetStyle
    lanes: int
    measures: int
    beat: float
    columns: int
    heights: tuple[int, ...]

    @property
    def column_width(self) -> float:
        """The width of a column with its margin and gutter."""
        return (self.style.page_width - 2 * _EDGE) / self.columns

    @property
    def measure_height(self) -> float:
        """The height of a measure."""
        return self.beat * 4

    @property
    def systems(self) -> int:
        """The number of systems of the chart."""
        return len(self.heights)

    def system_height(self, system: int) -> float:
        """Return the height of a system."""
        return self.heights[system] * self.measure_height + 2 * _TOP

    def measures_of(self, system: int) -> range:
        """Return the measures of a system."""
        before = sum(self.heights[:system]) * self.columns
        return range(before, min(before + self.heights[system] * self.columns, self.measures))

    def column_of(self, measure: int) -> range:
        """Return the measures of the column that holds a measure."""
        system = self._system_of(measure)
        here, height = self.measures_of(system), self.heights[system]
        start = here.start + (measure - here.start) // height * height
        return range(start, min(start + height, here.stop))

    def left(self, measure: int) -> float:
        """Return x of the first lane of a measure, inside its system."""
        system = self._system_of(measure)
        column = (measure - self.measures_of(system).start) // self.heights[system]
        return _EDGE + column * self.column_width + self.style.margin

    def top(self, measure: int) -> float:
        """Return y of the start of a measure, inside its system."""
        return _TOP + (measure - self.column_of(measure).start) * self.measure_height

    def _system_of(self, measure: int) -> int:
        starts = [0, *accumulate(height * self.columns for height in self.heights[:-1])]
        return bisect_right(starts, measure) - 1

    def x(self, tick: int, lane: int) -> float:
        """Return x of the middle of a lane at a tick, inside its system."""
        return self.left(tick // TICKS_PER_MEASURE) + (lane + 0.5) * self.style.lane

    def y(self, tick: int) -> float:
        """Return y of a tick, inside its system."""
        measure, inside = divmod(tick, TICKS_PER_MEASURE)
        return self.top(measure) + inside / TICKS_PER_BEAT * self.beat


def lay_out(ticks: NDArray[np.int64], lanes: int, style: SheetStyle, last: int = 0) -> SheetLayout:
    """Return a layout for rows at these ticks; a beat is as high as the chart's densest common rhythm needs.

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
    """Yield the measures in a column of each system; the last system has no more than its columns need."""
    most = first
    while measures > most * columns:
        yield most
        measures, most = measures - most * columns, tallest
    yield max(1, math.ceil(measures / columns))
