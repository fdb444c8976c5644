"""Questions rules ask about the notes of a chart: grid, kinds, what the game does not judge."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import TICKS_PER_MEASURE, Chart, Kind

_KINDS = {"mine": Kind.MINE, "roll": Kind.ROLL, "hold": Kind.HOLD, "lift": Kind.LIFT, "fake": Kind.FAKE,
          "keysound": Kind.KEYSOUND}  # fmt: skip
_STEPS = (Kind.TAP, Kind.HOLD, Kind.ROLL, Kind.LIFT)
_IS_STEP, _IS_JUDGED = np.zeros(256, dtype=bool), np.zeros(256, dtype=bool)  # by kind; whether the games judge it
_IS_STEP[list(_STEPS)] = _IS_JUDGED[[*_STEPS, Kind.MINE]] = True


class Notes:
    """The notes of a chart."""

    def __init__(self, chart: Chart) -> None:
        self._chart = chart

    def off_grid(self, grid: Sequence[int]) -> Iterator[tuple[int, int, int]]:
        """Tick, line and number of rows of every run of rows with steps that no quantisation of `grid` has."""
        notes = self._chart.notes
        off = _off(tuple(grid))
        if not off[notes.tick % TICKS_PER_MEASURE].any():
            return
        steps = _IS_STEP[notes.kind]
        ticks, first = np.unique(notes.tick[steps], return_index=True)
        yield from _runs(off[ticks % TICKS_PER_MEASURE], ticks, notes.line[steps][first])

    def unjudged(self) -> Iterator[tuple[int, int, int]]:
        """Tick, line and number of the notes of every run that lies in a warp or a fake segment."""
        notes = self._chart.notes
        timing = self._chart.timing
        if not (timing.warps or timing.fakes) or notes.judged.all():
            return
        hidden = ~notes.judged & _IS_JUDGED[notes.kind]
        yield from _runs(hidden, notes.tick, notes.line)

    def of_kind(self, kind: str) -> list[tuple[int, int]]:
        """Tick and line of every note of a kind of DT508; jumps and hands are rows."""
        notes = self._chart.notes
        if kind in _KINDS:
            found = notes.kind == _KINDS[kind]
            return list(zip(notes.tick[found].tolist(), notes.line[found].tolist(), strict=True))
        steps = _IS_STEP[notes.kind] & notes.judged
        ticks, first, counts = np.unique(notes.tick[steps], return_index=True, return_counts=True)
        rows = counts >= 3 if kind == "hand" else counts == 2
        return list(zip(ticks[rows].tolist(), notes.line[steps][first][rows].tolist(), strict=True))


@lru_cache(maxsize=64)
def _off(grid: tuple[int, ...]) -> NDArray[np.bool_]:
    """For each tick of a measure whether no quantisation of `grid` has it."""
    off = np.ones(TICKS_PER_MEASURE, dtype=bool)
    for quantisation in grid:
        off[:: max(TICKS_PER_MEASURE // quantisation, 1)] = False
    return off


def _runs(
    flags: NDArray[np.bool_], ticks: NDArray[np.int64], lines: NDArray[np.int32]
) -> Iterator[tuple[int, int, int]]:
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
    for first, after in edges.reshape(-1, 2).tolist():
        yield int(ticks[first]), int(lines[first]), after - first
