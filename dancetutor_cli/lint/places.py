"""Where things stand in a chart's file: line, column, beat and second of rows of the play and of the note data."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import TICKS_PER_BEAT, TICKS_PER_MEASURE, Chart, Song
from dancetutor_cli.play.played import Play


@dataclass(frozen=True)
class PlacedChart:
    """One chart and its play, which is None where the steps type has no pad; `at_...` are the places of findings."""

    song: Song
    chart: Chart
    play: Play | None

    def beat(self, row: int) -> float:
        """Beat of a row of the play."""
        assert self.play is not None
        return round(int(self.play.rows.tick[row]) / TICKS_PER_BEAT, 6)

    def margin(self, row: int) -> int | None:
        """How much more the best play with other limbs in this row costs; None if there is none, or nobody asked."""
        margin = -1 if self.play is None or self.play.margin is None else int(self.play.margin[row])
        return None if margin < 0 else margin

    def pressed(self, row: int) -> list[int]:
        """Note columns that have a step in a row of the play."""
        assert self.play is not None
        return [column for column, kind in enumerate(self.play.rows.steps[row].tolist()) if kind]

    def file_line(self, row: int) -> int:
        """Line in the file of a row of the play; where only a roll made it, of the row written before."""
        return int(self.file_lines[row])

    @cached_property
    def file_lines(self) -> NDArray[np.int32]:
        """The same of every row."""
        assert self.play is not None
        lines, written = self.play.rows.line, self.chart.rows
        if not len(written.tick) or (lines > 0).all():
            return np.maximum(lines, self.chart.line)
        before = written.tick.searchsorted(self.play.rows.tick, side="right") - 1
        return np.where(lines > 0, np.maximum(lines, self.chart.line), written.line[np.maximum(before, 0)])

    def at_row(self, row: int, note_column: int | None = None) -> dict[str, Any]:
        """Where a row of the play stands, as keyword arguments of `Finding`; without `note_column`: its first step."""
        assert self.play is not None
        if note_column is None:
            note_column = next(iter(self.pressed(row)), None)
        line = self.file_line(row)
        return {
            "line": line,
            "column": self._text_column(line, note_column or 0),
            "note_column": note_column,
            "margin": self.margin(row),
            **self._time(int(self.play.rows.tick[row]), float(self.play.rows.second[row])),
        }

    def at_line(self, line: int | None) -> dict[str, Any]:
        """Where a line of the chart stands; with a beat if it is a row of the note data."""
        line = self.chart.line if line is None else line
        place: dict[str, Any] = {"line": line, "column": 1, "chart": self.chart.index}
        rows = self.chart.rows
        found = int(rows.line.searchsorted(line))
        if found < len(rows.line) and rows.line[found] == line:
            tick = int(rows.tick[found])
            place |= {"beat": tick / TICKS_PER_BEAT, "measure": int(rows.measure[found])}
        return place

    def at_tick(self, tick: int, line: int) -> dict[str, Any]:
        """Where a note of the chart stands that may be in no row of the play."""
        second = float(self.chart.timing.seconds(np.array([tick]))[0])
        return {"line": line, "column": self._text_column(line, 0), **self._time(tick, second)}

    def at_chart(self) -> dict[str, Any]:
        """Where the chart itself starts."""
        return {"line": self.chart.line, "column": 1, "chart": self.chart.index}

    def _time(self, tick: int, second: float) -> dict[str, Any]:
        return {
            "beat": tick / TICKS_PER_BEAT,
            "measure": tick // TICKS_PER_MEASURE,
            "second": second,
            "chart": self.chart.index,
        }

    def _text_column(self, line: int, note_column: int) -> int:
        """1-based column of a note's character on its line; keysounds and blanks before it are counted."""
        rows = self.chart.rows
        found = int(rows.line.searchsorted(line))
        if found >= len(rows.line) or rows.line[found] != line:
            return 1
        start, end = int(rows.start[found]), int(rows.end[found])
        line_start = self.song.data.rfind(b"\n", 0, start) + 1
        text = self.song.data[start:end]
        if b"[" in text:
            places = list(_note_offsets(text))
            inside = places[note_column] if note_column < len(places) else 0
        else:
            inside = note_column if note_column < len(text) else 0
        return start - line_start + inside + 1


def _note_offsets(row: bytes) -> Iterator[int]:
    """Offsets of the note characters of a row; ``[...]`` keysounds stand between them."""
    inside_keysound = False
    for offset, byte in enumerate(row):
        if inside_keysound:
            inside_keysound = byte != ord("]")
        elif byte == ord("["):
            inside_keysound = True
        else:
            yield offset
