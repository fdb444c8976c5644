"""Where measures stand on a sheet: columns of measures side by side, systems of columns one below the other."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import TICKS_PER_BEAT, TICKS_PER_MEASURE
from dancetutor_cli.reports.sheet.style import Style

_COMMON_SHARE = 0.1  # a rhythm is common if at least this share of the distances between rows is as short
_TOP = 10.0  # above the first measure of a column, for half an arrow


@dataclass(frozen=True, slots=True)
class Layout:
    """Places in CSS pixels. A column has `per_column` measures, a system `columns` columns.

    beat : height of a beat; column_width : with margin and gutter
    """

    style: Style
    lanes: int
    measures: int
    beat: float
    per_column: int
    columns: int

    @property
    def column_width(self) -> float:
        """Width of a column with its margin and gutter."""
        return self.style.margin + self.lanes * self.style.lane + self.style.gutter

    @property
    def measure_height(self) -> float:
        """Height of a measure."""
        return self.beat * 4

    @property
    def systems(self) -> int:
        """How many systems the chart needs."""
        return math.ceil(self.measures / (self.per_column * self.columns))

    @property
    def system_height(self) -> float:
        """Height of a system."""
        return self.per_column * self.measure_height + 2 * _TOP

    def measures_of(self, system: int) -> range:
        """Measures of a system."""
        size = self.per_column * self.columns
        return range(system * size, min((system + 1) * size, self.measures))

    def left(self, measure: int) -> float:
        """x of the first lane of a measure, inside its system."""
        column = measure // self.per_column % self.columns
        return column * self.column_width + self.style.margin

    def top(self, measure: int) -> float:
        """y of the start of a measure, inside its system."""
        return _TOP + measure % self.per_column * self.measure_height

    def x(self, tick: int, lane: int) -> float:
        """Middle of a lane at a tick."""
        return self.left(tick // TICKS_PER_MEASURE) + (lane + 0.5) * self.style.lane

    def y(self, tick: int) -> float:
        """Height of a tick."""
        measure, inside = divmod(tick, TICKS_PER_MEASURE)
        return self.top(measure) + inside / TICKS_PER_BEAT * self.beat


def lay_out(ticks: NDArray[np.int64], lanes: int, style: Style, last: int = 0) -> Layout:
    """A layout for rows at these ticks: a beat as high as the chart's densest common rhythm needs.

    last : tick of the last end of a hold
    """
    measures = max(int(ticks.max(initial=0)), last) // TICKS_PER_MEASURE + 1
    gaps = np.diff(np.unique(ticks))
    gap = float(np.quantile(gaps, _COMMON_SHARE)) if len(gaps) else TICKS_PER_BEAT
    low, high = style.beat
    beat = min(max(style.row_spacing * TICKS_PER_BEAT / gap, low), high)
    per_column = max(1, int(style.columns_height // (beat * 4)))
    width = style.margin + lanes * style.lane + style.gutter
    columns = max(1, int(style.page_width // width))
    return Layout(style, lanes, measures, beat, per_column, columns)
