"""Questions rules ask about the notes of a chart: grid, kinds, what the game does not judge."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import TICKS_PER_MEASURE, Chart, Kind

_KINDS = {"mine": Kind.MINE, "roll": Kind.ROLL, "hold": Kind.HOLD, "lift": Kind.LIFT, "fake": Kind.FAKE,
          "keysound": Kind.KEYSOUND}  # fmt: skip
_STEPS = (Kind.TAP, Kind.HOLD, Kind.ROLL, Kind.LIFT)


class Notes:
    """The notes of a chart."""

    def __init__(self, chart: Chart) -> None:
        self._chart = chart

    def off_grid(self, grid: Sequence[int]) -> Iterator[tuple[int, int, int]]:
        """Tick, line and number of rows of every run of rows with steps that no quantisation of `grid` has."""
        notes = self._chart.notes
        ticks, first = np.unique(notes.tick[np.isin(notes.kind, _STEPS)], return_index=True)
        lines = notes.line[np.isin(notes.kind, _STEPS)][first]
        odd = np.ones(len(ticks), dtype=bool)
        for quantisation in grid:
            odd &= ticks % max(TICKS_PER_MEASURE // quantisation, 1) != 0
        yield from _runs(odd, ticks, lines)

    def unjudged(self) -> Iterator[tuple[int, int, int]]:
        """Tick, line and number of the notes of every run that lies in a warp or a fake segment."""
        notes = self._chart.notes
        hidden = ~notes.judged & np.isin(notes.kind, (*_STEPS, Kind.MINE))
        yield from _runs(hidden, notes.tick, notes.line)

    def of_kind(self, kind: str) -> list[tuple[int, int]]:
        """Tick and line of every note of a kind of DT508; jumps and hands are rows."""
        notes = self._chart.notes
        if kind in _KINDS:
            found = notes.kind == _KINDS[kind]
            return list(zip(notes.tick[found].tolist(), notes.line[found].tolist(), strict=True))
        steps = np.isin(notes.kind, _STEPS) & notes.judged
        ticks, first, counts = np.unique(notes.tick[steps], return_index=True, return_counts=True)
        rows = counts >= 3 if kind == "hand" else counts == 2
        return list(zip(ticks[rows].tolist(), notes.line[steps][first][rows].tolist(), strict=True))


def _runs(
    flags: NDArray[np.bool_], ticks: NDArray[np.int64], lines: NDArray[np.int32]
) -> Iterator[tuple[int, int, int]]:
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
    for first, after in edges.reshape(-1, 2).tolist():
        yield int(ticks[first]), int(lines[first]), after - first
