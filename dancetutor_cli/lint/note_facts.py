"""Facts for rules about the notes of a chart and its files: grid, kinds, places, differences of .ssc and .sm."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.model import STEP_KINDS, Chart, Kind, Song
from dancetutor_cli.chart.names import TICKS_PER_BEAT, TICKS_PER_MEASURE, is_lights
from dancetutor_cli.chart.reader import load
from dancetutor_cli.chart.selection import twin
from dancetutor_cli.feet.play import Play, runs
from dancetutor_cli.run.errors import FileError

_KINDS = {"mine": Kind.MINE, "roll": Kind.ROLL, "hold": Kind.HOLD, "lift": Kind.LIFT, "fake": Kind.FAKE,
          "keysound": Kind.KEYSOUND}  # fmt: skip
_IS_STEP, _IS_JUDGED = np.zeros(256, dtype=bool), np.zeros(256, dtype=bool)  # by kind; whether the games judge it
_IS_STEP[list(STEP_KINDS)] = _IS_JUDGED[[*STEP_KINDS, Kind.MINE]] = True


class NoteFacts:
    """The facts about the notes of a chart that rules need."""

    def __init__(self, chart: Chart) -> None:
        self._chart = chart

    def off_grid(self, grid: Sequence[int]) -> Iterator[tuple[int, int, int]]:
        """Yield tick, line and number of rows of every run of rows with steps that are on no quantisation of `grid`."""
        notes = self._chart.notes
        off = _off(tuple(grid))
        if not off[notes.tick % TICKS_PER_MEASURE].any():
            return
        steps = _IS_STEP[notes.kind]
        ticks, first = np.unique(notes.tick[steps], return_index=True)
        yield from _runs(off[ticks % TICKS_PER_MEASURE], ticks, notes.line[steps][first])

    def unjudged_runs(self) -> Iterator[tuple[int, int, int]]:
        """Yield tick, line and number of notes of every run of notes in a warp or a fake segment."""
        notes = self._chart.notes
        timing = self._chart.timing
        if not (timing.warps or timing.fakes) or notes.judged.all():
            return
        hidden = ~notes.judged & _IS_JUDGED[notes.kind]
        yield from _runs(hidden, notes.tick, notes.line)

    def of_kind(self, kind: str) -> list[tuple[int, int]]:
        """Return tick and line of every note of a kind of DT508; for jumps and hands, of every such row."""
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
    """Return, for each tick of a measure, whether it is on no quantisation of `grid`."""
    off = np.ones(TICKS_PER_MEASURE, dtype=bool)
    for quantisation in grid:
        off[:: max(TICKS_PER_MEASURE // quantisation, 1)] = False
    return off


def _runs(
    flags: NDArray[np.bool_], ticks: NDArray[np.int64], lines: NDArray[np.int32]
) -> Iterator[tuple[int, int, int]]:
    for first, after in runs(flags).tolist():
        yield int(ticks[first]), int(lines[first]), after - first


# Places in a chart's file: line, column, beat and second of the play's rows and of the note data.


@dataclass(frozen=True)
class PlacedChart:
    """A chart and its play, which is None if the steps type has no pad; methods `at_...` give places of findings."""

    song: Song
    chart: Chart
    play: Play | None

    def beat(self, row: int) -> float:
        """Return the beat of a row of the play."""
        assert self.play is not None
        return round(int(self.play.rows.tick[row]) / TICKS_PER_BEAT, 6)

    def margin(self, row: int) -> int | None:
        """Return how much more the best play with other limbs in this row costs; None if it is not known."""
        margin = -1 if self.play is None or self.play.margin is None else int(self.play.margin[row])
        return None if margin < 0 else margin

    def step_columns(self, row: int) -> list[int]:
        """Return the note columns that have a step in a row of the play."""
        assert self.play is not None
        return [column for column, kind in enumerate(self.play.rows.steps[row].tolist()) if kind]

    @cached_property
    def file_lines(self) -> NDArray[np.int32]:
        """(n,) line in the file of each row of the play; for a row that only a roll makes, of the last written row."""
        assert self.play is not None
        lines, written = self.play.rows.line, self.chart.rows
        if not len(written.tick) or (lines > 0).all():
            return np.maximum(lines, self.chart.line)
        before = written.tick.searchsorted(self.play.rows.tick, side="right") - 1
        return np.where(lines > 0, np.maximum(lines, self.chart.line), written.line[np.maximum(before, 0)])

    def at_row(self, row: int, note_column: int | None = None) -> dict[str, Any]:
        """Return the place of a row of the play, as keyword arguments of `Finding`.

        Without `note_column`, it is the place of the row's first step.
        """
        assert self.play is not None
        if note_column is None:
            note_column = next(iter(self.step_columns(row)), None)
        line = int(self.file_lines[row])
        return {
            "line": line,
            "column": self._text_column(line, note_column or 0),
            "note_column": note_column,
            "margin": self.margin(row),
            **self._time(int(self.play.rows.tick[row]), float(self.play.rows.second[row])),
        }

    def at_line(self, line: int | None) -> dict[str, Any]:
        """Return the place of a line of the chart, with a beat if the line is a row of the note data."""
        line = self.chart.line if line is None else line
        place: dict[str, Any] = {"line": line, "column": 1, "chart": self.chart.index}
        rows = self.chart.rows
        found = int(rows.line.searchsorted(line))
        if found < len(rows.line) and rows.line[found] == line:
            tick = int(rows.tick[found])
            place |= {"beat": tick / TICKS_PER_BEAT, "measure": int(rows.measure[found])}
        return place

    def at_tick(self, tick: int, line: int) -> dict[str, Any]:
        """Return the place of a note that may be in no row of the play."""
        second = float(self.chart.timing.seconds(np.array([tick]))[0])
        return {"line": line, "column": self._text_column(line, 0), **self._time(tick, second)}

    def at_chart(self) -> dict[str, Any]:
        """Return the place at which the chart starts."""
        return {"line": self.chart.line, "column": 1, "chart": self.chart.index}

    def _time(self, tick: int, second: float) -> dict[str, Any]:
        return {
            "beat": tick / TICKS_PER_BEAT,
            "measure": tick // TICKS_PER_MEASURE,
            "second": second,
            "chart": self.chart.index,
        }

    def _text_column(self, line: int, note_column: int) -> int:
        """Return the 1-based column of a note's character on its line, including keysounds and blanks before it."""
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
    """Yield the offsets of the note characters of a row; ``[...]`` keysounds may be between them."""
    inside_keysound = False
    for offset, byte in enumerate(row):
        if inside_keysound:
            inside_keysound = byte != ord("]")
        elif byte == ord("["):
            inside_keysound = True
        else:
            yield offset


# The differences between the .ssc of a song and the .sm beside it.

Key = tuple[str, str, int]


def differences(song: Song) -> Iterator[tuple[str, int | None, int | None]]:
    """Yield message, line and chart of every difference between a .ssc and the .sm beside it; nothing for a .sm."""
    other_path = twin(song.path) if song.format == "ssc" else None
    if other_path is None:
        return
    name = other_path.name
    try:
        other = load(other_path)
    except FileError as error:
        yield f"{name} cannot be read: {error.message}", None, None
        return
    here, there = _by_key(song), _by_key(other)
    for key, chart in here.items():
        if key in there and (what := _difference(chart, there[key])):
            yield f"{chart.label} has different {what} in {name}", chart.line, chart.index
    if added := [chart for key, chart in here.items() if key not in there]:
        yield f"{_labels(added)} not in {name}", added[0].line, added[0].index
    if lost := [chart for key, chart in there.items() if key not in here]:
        yield f"{_labels(lost)} only in {name}, missing here", None, None


def _labels(charts: list[Chart]) -> str:
    """Return the labels with a verb: "dance-single Hard 9 and dance-single Easy 3 are"."""
    names = [chart.label for chart in charts]
    return f"{', '.join(names[:-1])} and {names[-1]} are" if len(names) > 1 else f"{names[0]} is"


def _by_key(song: Song) -> dict[Key, Chart]:
    """Return the charts, except lights, by steps type, difficulty, and number among the charts that share both."""
    found: dict[Key, Chart] = {}
    places: Counter[tuple[str, str]] = Counter()
    for chart in song.charts:
        if is_lights(chart.steps_type):
            continue
        kind = (chart.steps_type, chart.difficulty)
        found[*kind, places[kind]] = chart
        places[kind] += 1
    return found


def _difference(a: Chart, b: Chart) -> str:
    """Return the difference of two charts: "notes", "a meter" or "times"; "" if they are the same."""
    fields = ("tick", "column", "kind", "end")
    if any(not np.array_equal(getattr(a.notes, name), getattr(b.notes, name)) for name in fields):
        return "notes"
    if a.meter != b.meter:
        return "a meter"
    if np.abs(a.timing.seconds(a.notes.tick) - b.timing.seconds(b.notes.tick)).max(initial=0.0) > 0.001:
        return "times"
    return ""
