"""The changes between two versions of a pack, by file, chart and row: the notes, their times, the meters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from dancetutor_cli.chart.model import Chart, Kind, Song
from dancetutor_cli.chart.names import TICKS_PER_BEAT, TICKS_PER_MEASURE
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.lint.snapshots import Snapshot, StoredFile
from dancetutor_cli.run.errors import FileError, plural

_SIGNS = {
    Kind.TAP: "1", Kind.HOLD: "2", Kind.ROLL: "4", Kind.MINE: "M", Kind.LIFT: "L", Kind.FAKE: "F", Kind.KEYSOUND: "K",
}  # fmt: skip
_SHIFT = 0.0005  # seconds; times that differ by no more are the same
Row = tuple[tuple[int, int, int], ...]  # (column, kind, tick of the end or -1) of each note, by column


@dataclass(frozen=True, slots=True)
class RowChange:
    """A row that has changed. before, now : the row as in the file, "" if there is none; note : changed hold ends"""

    tick: int
    before: str
    now: str
    note: str = ""

    def __str__(self) -> str:
        what = f"{self.before} → {self.now}" if self.before and self.now else ""
        what = what or (f"new {self.now}" if self.now else f"removed {self.before}")
        beat = f"measure {self.tick // TICKS_PER_MEASURE} beat {round(self.tick / TICKS_PER_BEAT, 3):g}"
        return f"{beat}: {what}{f', {self.note}' if self.note else ''}"


@dataclass(frozen=True, slots=True)
class ChartChange:
    """The changes of a file or of one of its charts. chart : label of the chart, "" for the file; messages : lines"""

    file: str
    chart: str
    messages: tuple[str, ...]
    rows: tuple[RowChange, ...] = ()


def compare(before: Snapshot, now: Snapshot) -> Iterator[ChartChange]:
    """Yield all changes from one version to another."""
    for name in sorted({*before.files, *now.files}):
        if name not in before.files:
            yield ChartChange(name, "", (before.new,))
        elif name not in now.files:
            yield ChartChange(name, "", ("was removed",))
        else:
            yield from _file(name, before.files[name], now.files[name])


def _file(name: str, before: StoredFile, now: StoredFile) -> Iterator[ChartChange]:
    try:
        data = now.read()
    except FileError as error:
        yield ChartChange(name, "", (f"can no longer be read: {error.message}",))
        return
    try:
        if before.is_same(data):  # also for a file that cannot be parsed
            return
        old = parse(before.read(), Path(name))
    except FileError as error:
        yield ChartChange(name, "", (f"could not be read before: {error.message}",))
        return
    try:
        new = parse(data, Path(name))
    except FileError as error:
        yield ChartChange(name, "", (f"can no longer be read: {error.message}",))
        return
    if changes := tuple(_head(old, new)):
        yield ChartChange(name, "", changes)
    charts, others = _by_key(old), _by_key(new)
    for key in dict.fromkeys((*charts, *others)):
        if key not in charts:
            yield ChartChange(name, others[key].label, (f"is new: {len(_rows(others[key]))} rows",))
        elif key not in others:
            yield ChartChange(name, charts[key].label, ("was removed",))
        elif (change := _chart(name, charts[key], others[key])) is not None:
            yield change


def _head(old: Song, new: Song) -> Iterator[str]:
    """Yield the changes of title, artist and music."""
    for what, a, b in (
        ("title", old.title, new.title),
        ("artist", old.artist, new.artist),
        ("music", old.music, new.music),
    ):
        if a != b:
            yield f"{what} '{a}' → '{b}'"


def _by_key(song: Song) -> dict[tuple[str, str, int], Chart]:
    """Return the charts by steps type, difficulty, and number among the charts that share both."""
    found: dict[tuple[str, str, int], Chart] = {}
    for chart in song.charts:
        place = 0
        while (key := (chart.steps_type, chart.difficulty, place)) in found:
            place += 1
        found[key] = chart
    return found


def _chart(name: str, old: Chart, new: Chart) -> ChartChange | None:
    changes: list[str] = []
    if old.meter != new.meter:
        changes.append(f"meter {old.meter} → {new.meter}")
    if old.description != new.description:
        changes.append(f"description '{old.description}' → '{new.description}'")
    a, b = _rows(old), _rows(new)
    if moved := _distance(a, b):
        changes.append(f"all notes moved {_beats(moved)}")
        changes += _times(old, new, sorted(a), moved)
        return ChartChange(name, new.label, tuple(changes))
    changes += _times(old, new, sorted(a.keys() & b.keys()))
    columns = max(old.columns, new.columns)
    rows = tuple(_row(tick, a.get(tick, ()), b.get(tick, ()), columns) for tick in sorted(a.keys() | b.keys())
                 if a.get(tick) != b.get(tick))  # fmt: skip
    if rows:
        added, lost = sum(not row.before for row in rows), sum(not row.now for row in rows)
        kinds = ((added, "added"), (lost, "removed"), (len(rows) - added - lost, "changed"))
        (count, kind), *others = (one for one in kinds if one[0])
        changes.append(", ".join([f"{plural(count, 'row')} {kind}", *(f"{count} {kind}" for count, kind in others)]))
    return ChartChange(name, new.label, tuple(changes), rows) if changes else None


def _rows(chart: Chart) -> Mapping[int, Row]:
    """Return tick -> the notes of a row."""
    notes, found = chart.notes, dict[int, list[tuple[int, int, int]]]()
    columns = (notes.tick.tolist(), notes.column.tolist(), notes.kind.tolist(), notes.end.tolist())
    for tick, column, kind, end in zip(*columns, strict=True):
        found.setdefault(tick, []).append((column, kind, end))
    return {tick: tuple(row) for tick, row in found.items()}


def _distance(before: Mapping[int, Row], now: Mapping[int, Row]) -> int:
    """Return the ticks by which all rows and the ends of holds moved; 0 if they did not all move by the same."""
    if not before or len(before) != len(now):
        return 0
    moved = min(now) - min(before)

    def there(row: Row) -> Row:
        return tuple((column, kind, end + moved if end >= 0 else end) for column, kind, end in row)

    return moved if all(now.get(tick + moved) == there(row) for tick, row in before.items()) else 0


def _beats(ticks: int) -> str:
    count = round(abs(ticks) / TICKS_PER_BEAT, 3)
    return f"{count:g} beat{'' if count == 1 else 's'} {'later' if ticks > 0 else 'earlier'}"


def _row(tick: int, before: Row, now: Row, columns: int) -> RowChange:
    ends = {column: end for column, kind, end in before if kind in (Kind.HOLD, Kind.ROLL)}
    moved = [
        f"held to beat {ends[column] / TICKS_PER_BEAT:g} → {end / TICKS_PER_BEAT:g}"
        for column, kind, end in now
        if kind in (Kind.HOLD, Kind.ROLL) and ends.get(column, end) != end
    ]
    return RowChange(tick, _signs(before, columns), _signs(now, columns), "; ".join(moved))


def _signs(row: Row, columns: int) -> str:
    if not row:
        return ""
    signs = ["0"] * max(columns, row[-1][0] + 1)
    for column, kind, _ in row:
        signs[column] = _SIGNS.get(Kind(kind), "?")
    return "".join(signs)


def _times(old: Chart, new: Chart, ticks: Sequence[int], moved: int = 0) -> Iterator[str]:
    """Yield how the times of shared rows differ: all rows by the same (the sync), or from some beat on (the tempo).

    ticks : ticks of the rows in the old chart; moved : ticks by which they are later in the new chart
    """
    if not ticks:
        return
    at = np.array(ticks, dtype=np.int64)
    shift = np.asarray(new.timing.seconds(at + moved)) - np.asarray(old.timing.seconds(at))
    other = np.abs(shift) > _SHIFT
    if not other.any():
        if moved:
            yield "at the same times"
        return
    if other.all() and float(np.ptp(shift)) <= _SHIFT:
        yield f"all rows {abs(shift[0]) * 1000:.0f} ms {'later' if shift[0] > 0 else 'earlier'}"
        return
    first = ticks[int(other.argmax())] / TICKS_PER_BEAT
    yield f"{int(other.sum())} rows at other times from beat {first:g} on, by up to {np.abs(shift).max() * 1000:.0f} ms"


def change_lines(changes: Sequence[ChartChange], most_rows: int | None) -> Iterator[str]:
    """Yield the changes for people: a line for each file or chart, then its rows.

    most_rows : most rows of a chart that are shown, None: all
    """
    for change in _folded(changes):
        yield f"{change.file}{f' [{change.chart}]' if change.chart else ''}: {'; '.join(change.messages)}"
        shown = change.rows if most_rows is None else change.rows[:most_rows]
        yield from (f"  {row}" for row in shown)
        if len(shown) < len(change.rows):
            yield f"  ... and {len(change.rows) - len(shown)} more rows"


def _folded(changes: Sequence[ChartChange]) -> Iterator[ChartChange]:
    """Yield the changes; charts of a file with the same messages and without rows are one change."""
    alike: dict[tuple[str, tuple[str, ...]], list[ChartChange]] = {}
    for n, change in enumerate(changes):
        own = (str(n),) if change.rows or not change.chart else ()
        alike.setdefault((change.file, (*change.messages, *own)), []).append(change)
    for found in alike.values():
        yield found[0] if len(found) == 1 else replace(found[0], chart=f"{len(found)} charts")
