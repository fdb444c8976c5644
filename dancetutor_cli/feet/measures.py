"""Where feet stand in note data: the steps of each row, and the comments on the lines that open measures."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import Chart, Kind
from dancetutor_cli.chart.stepf2 import PLAYERS
from dancetutor_cli.feet.notation import MARKER

_STEP = np.zeros(256, dtype=bool)
_STEP[list(b"124Ll")] = True
_SPECIAL = np.zeros(256, dtype=bool)
_SPECIAL[list(b"[\\{" + PLAYERS)] = True
_FOREIGN = re.compile(rb"[{%b]" % PLAYERS)  # StepF2's notes: not a letter for each column, or whose it is
_STEPS = (Kind.TAP, Kind.HOLD, Kind.ROLL, Kind.LIFT)
_KEYSOUND = re.compile(rb"\[[^\]]*\]?")


@dataclass(frozen=True, slots=True)
class StepRows:
    """The written rows that hold a step (`1`, `2`, `4`, `L`), in file order; n of them, c columns.

    row : int64 (n,), place in the chart's `RowTable`
    steps : bool (n, c), which columns
    """

    row: NDArray[np.int64]
    steps: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.row)


def step_rows(data: bytes, chart: Chart) -> StepRows:
    """Find the steps of a chart as written, whatever the timing makes of them; `data` are the bytes of its file."""
    columns = chart.columns
    start, end = chart.rows.start, chart.rows.end
    steps = np.zeros((len(start), columns), dtype=bool)
    regular = end - start == columns
    if columns and regular.any():
        text = np.frombuffer(data, dtype=np.uint8)[start[regular][:, None] + np.arange(columns)]
        special = _SPECIAL[text].any(axis=1)
        steps[regular] = _STEP[text]
        regular[np.flatnonzero(regular)[special]] = False
    if chart.marked:
        regular[:] = False
    for i in np.flatnonzero(~regular).tolist():
        cells = _KEYSOUND.sub(b"", data[start[i] : end[i]].replace(b"\\", b""))
        steps[i] = False
        if chart.marked or _FOREIGN.search(cells):
            steps[i, _columns_at(chart, int(chart.rows.tick[i]))] = True
        else:
            cells = cells[:columns]
            steps[i, : len(cells)] = _STEP[np.frombuffer(cells, dtype=np.uint8)]
    row = np.flatnonzero(steps.any(axis=1))
    return StepRows(row, steps[row])


def _columns_at(chart: Chart, tick: int) -> NDArray[np.int16]:
    """Where the notes that are steps stand at a tick, as the chart was read."""
    notes = chart.notes
    first, last = np.searchsorted(notes.tick, [tick, tick + 1])
    return notes.column[first:last][np.isin(notes.kind[first:last], _STEPS)]


@dataclass(frozen=True, slots=True)
class MeasureLine:
    """The rest of the line on which a measure opens, after its `:` or `,`.

    measure : its number
    start : offset of the comment's `//`, or without a comment where one may be put
    end : end of the comment, before the line's end; without a comment the same as `start`
    """

    measure: int
    start: int
    end: int


def measure_lines(data: bytes, chart: Chart) -> Iterator[MeasureLine]:
    """The opening lines of a chart's measures that have a comment or may get one.

    Left out are lines on which rows already stand, and lines with a CR of their own inside: some readers end a line
    there, so that a comment would swallow rows or not reach as far as it should.
    """
    for measure, anchor in enumerate(chart.measures.anchor.tolist()):
        end = data.find(b"\n", anchor)
        rest = data[anchor:] if end < 0 else data[anchor:end].removesuffix(b"\r")
        text = rest.lstrip(b" \t")
        if b"\r" in rest:
            continue
        if not text:
            yield MeasureLine(measure, anchor, anchor)
        elif text.startswith(b"//"):
            yield MeasureLine(measure, anchor + len(rest) - len(text), anchor + len(rest))


def markers_in(comment: bytes) -> list[re.Match[bytes]]:
    """The markers in a comment, in order."""
    return list(MARKER.finditer(comment)) if b"{dt1" in comment else []
