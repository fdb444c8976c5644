"""Feet in the comments of note data: the steps of each row, the lines that open measures, pinned measures."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.cells import PLAYERS
from dancetutor_cli.chart.model import STEP_KINDS, Chart, Song
from dancetutor_cli.feet.limbs import MARKER, MEANING, NotationError, Token, limb_and_part, parse_marker
from dancetutor_cli.feet.overrides import CellOverride, FeetProblem
from dancetutor_cli.run.errors import plural

_STEP = np.zeros(256, dtype=bool)
_STEP[list(b"124Ll")] = True
_SPECIAL = np.zeros(256, dtype=bool)
_SPECIAL[list(b"[\\{D" + PLAYERS)] = True
# cells that are not one letter for each column (StepF2, StepManiaX), or that name a player
_FOREIGN = re.compile(rb"[{%b]|D[LM]" % PLAYERS)
_KEYSOUND = re.compile(rb"\[[^\]]*\]?")


@dataclass(frozen=True, slots=True)
class StepRows:
    """The written rows that hold a step (`1`, `2`, `4`, `L`), in file order; n of them, c columns.

    row : int64 (n,), index of the row in the chart's `RowTable`
    steps : bool (n, c), whether each column holds a step
    """

    row: NDArray[np.int64]
    steps: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.row)


def step_rows(data: bytes, chart: Chart) -> StepRows:
    """Find the steps of a chart as they are written, whatever its timing; `data` holds the bytes of its file."""
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
    """Return the columns (k,) of the steps at a tick, from the notes of the chart."""
    notes = chart.notes
    first, last = np.searchsorted(notes.tick, [tick, tick + 1])
    return notes.column[first:last][np.isin(notes.kind[first:last], STEP_KINDS)]


@dataclass(frozen=True, slots=True)
class MeasureLine:
    """The rest of the line on which a measure opens, after its `:` or `,`.

    measure : number of the measure
    start : offset of the comment's `//`; without a comment, the offset at which a comment may be inserted
    end : offset of the end of the comment, before the line break; without a comment, the same as `start`
    """

    measure: int
    start: int
    end: int


def measure_lines(data: bytes, chart: Chart) -> Iterator[MeasureLine]:
    """Yield the opening lines of a chart's measures that have a comment or may get one.

    Lines that already hold rows are left out. Lines with a CR in the middle are left out too: some readers end the line
    at the CR, so a comment could hide rows or end too early.
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
    """Return the markers in a comment, in order."""
    return list(MARKER.finditer(comment)) if b"{dt1" in comment else []


# Pinned measures, `{dt1! ...}`: the author's own feet, read from the comments of a chart file.


@dataclass(frozen=True, slots=True)
class _Pin:
    """One pinned measure. offset : where its letters begin in the file, in bytes"""

    measure: int
    line: int
    offset: int
    text: bytes


def pinned_cells(song: Song, chart: Chart) -> tuple[list[CellOverride], list[FeetProblem]]:
    """Return every pinned cell of a chart, and a problem for each pinned measure that could not be read."""
    pins = list(_pins(song.data, chart))
    if not pins:
        return [], []
    rows = step_rows(song.data, chart)
    by_measure: dict[int, list[int]] = {}
    for i, measure in enumerate(chart.rows.measure[rows.row].tolist()):
        by_measure.setdefault(measure, []).append(i)
    overrides: list[CellOverride] = []
    problems: list[FeetProblem] = []
    for pin in pins:
        line_start = song.data.rfind(b"\n", 0, pin.offset) + 1
        column = pin.offset - line_start + 1
        mine = by_measure.get(pin.measure, [])
        columns = [rows.steps[i].nonzero()[0].tolist() for i in mine]
        try:
            tokens = parse_marker(pin.text)
            _check_shape(tokens, columns)
        except NotationError as error:
            text = f"pinned measure {pin.measure}: {error}; the pin is not used"
            problems.append(FeetProblem("pin-unreadable", text, pin.line, column + error.at))
            continue
        ticks = chart.rows.tick[rows.row[mine]].tolist()
        for tick, token, cells in zip(ticks, tokens, columns, strict=True):
            overrides += _parse_token(tick, token, cells, pin.line, column)
    return overrides, problems


def has_pins(data: bytes, chart: Chart) -> bool:
    """Whether the chart may have a pinned measure."""
    return data.find(b"{dt1!", *chart.notes_span) >= 0


def _pins(data: bytes, chart: Chart) -> Iterator[_Pin]:
    if not has_pins(data, chart):
        return
    for line in measure_lines(data, chart):
        for match in markers_in(data[line.start : line.end]):
            if match["pin"]:
                number = int(chart.measures.line[line.measure])
                yield _Pin(line.measure, number, line.start + match.start("text"), match["text"])


def _check_shape(tokens: list[Token], columns: list[list[int]]) -> None:
    """Check that each row has a token, and each step a letter. Raises NotationError at the first mismatch."""
    if len(tokens) != len(columns):
        at = tokens[len(columns)].at if len(tokens) > len(columns) else 0
        raise NotationError(f"{len(tokens)} tokens for {len(columns)} rows with steps", at)
    for number, (token, cells) in enumerate(zip(tokens, columns, strict=True), 1):
        if len(token.letters) != len(cells):
            many = plural(len(cells), "step")
            text = f"row {number} of its rows with steps has {many} but {len(token.letters)} letters"
            raise NotationError(text, token.at)


def _parse_token(tick: int, token: Token, columns: list[int], line: int, start: int) -> Iterator[CellOverride]:
    """Yield the overrides of one token. start : column at which the marker's text begins in its line"""
    for letter, place, column in zip(token.letters, token.places, columns, strict=True):
        if letter in MEANING:
            limb, part = limb_and_part(letter, token.letters)
            yield CellOverride(tick, column, limb, part, "pinned", line, start + place)
