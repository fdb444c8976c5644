"""The reader of SMEditor's `data.sme`: the feet and the silenced findings that a person has set in that editor."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.chart.pack_files import EDITOR_FILE, song_stems
from dancetutor_cli.feet.limbs import Limb, Part
from dancetutor_cli.feet.overrides import CellOverride, FeetProblem
from dancetutor_cli.run.errors import FileError, MissingFileError
from dancetutor_cli.run.files import UCS_SUFFIX
from dancetutor_cli.run.reading import CHART_LIMIT, parse_json, read_bytes

FILE_NAME = EDITOR_FILE
# this program's own key in the file: the overrides that the program wrote, which are not a person's
OURS = "dancetutor"
# SMEditor's values: a foot by its name, or a part of a foot by its number.
FEET: dict[str | int, tuple[Limb, Part]] = {
    "Left": (Limb.LEFT_FOOT, Part.WHOLE),
    "Right": (Limb.RIGHT_FOOT, Part.WHOLE),
    1: (Limb.LEFT_FOOT, Part.HEEL),
    2: (Limb.LEFT_FOOT, Part.TOE),
    3: (Limb.RIGHT_FOOT, Part.HEEL),
    4: (Limb.RIGHT_FOOT, Part.TOE),
}
_CODES = {
    "DS": "DS", "Unmarked DS": "DS", "FS": "FS", "Missed FS": "FS", "AM": "AM", "Ambiguous": "AM",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class ChartData:
    """The contents of `data.sme` for one chart. ignores : {tick: codes}"""

    cells: tuple[CellOverride, ...] = ()
    ignores: dict[int, frozenset[str]] = field(default_factory=dict)
    problems: tuple[FeetProblem, ...] = ()


def read_sme(song: Song, chart: Chart) -> ChartData:
    """Read the entry of a chart from the `data.sme` in the song's folder; it is empty if there is no file.

    Never raises.
    """
    path = editor_file(song.path)
    if path is None:
        return ChartData()
    try:
        raw = read_bytes(path, CHART_LIMIT)
    except MissingFileError:
        return ChartData()
    except FileError as error:
        return _unreadable(f"{path.name} {error.message}")
    stems = song_stems(path.parent)
    if len(stems) > 1:
        return _unreadable(f"{path.name} is not used: its folder has several songs")
    try:
        data = parse_json(raw, path)
    except FileError as error:
        return _unreadable(f"{path.name} {error.message}; it is not used")
    entry = chart_entry(data, chart, place_in_type(song, chart))
    return _chart_data(entry, chart, _our_overrides(data, chart, place_in_type(song, chart)))


def editor_file(song: Path) -> Path | None:
    """The path of the `data.sme` beside a chart file, or None; a broken link counts as a file."""
    path = song.parent / FILE_NAME
    if song.suffix.lower() == UCS_SUFFIX:  # `data.sme` holds the charts of a .sm or .ssc file in the same folder
        return None
    # most songs have no file, and raising an error is much slower than this check
    return path if os.path.lexists(path) else None


def place_in_type(song: Song, chart: Chart) -> int:
    """The index of a chart among the charts of its steps type, in file order; `data.sme` identifies charts by it."""
    return [c.index for c in song.charts if c.steps_type == chart.steps_type].index(chart.index)


def chart_entry(data: Any, chart: Chart, place: int) -> Any:
    """The value of a chart in the parsed file, or None."""
    parity = data.get("parity") if isinstance(data, dict) else None
    charts = parity.get(chart.steps_type) if isinstance(parity, dict) else None
    return charts[place] if isinstance(charts, list) and place < len(charts) else None


def _our_overrides(data: Any, chart: Chart, place: int) -> set[tuple[float, int, object]]:
    entry = chart_entry(data.get(OURS), chart, place) if isinstance(data, dict) else None
    return set(overrides_of(entry))


def overrides_of(entry: Any) -> Iterator[tuple[float, int, str | int]]:
    """Yield the beat, the column and the value of each well-formed override of a chart's entry."""
    listed = entry.get("overrides") if isinstance(entry, dict) else None
    for item in listed if isinstance(listed, list) else ():
        if not isinstance(item, list) or len(item) != 3:
            continue
        beat, column, value = item
        numbers = isinstance(beat, int | float) and isinstance(column, int) and not isinstance(beat, bool)
        if numbers and isinstance(value, str | int) and not isinstance(value, bool) and value in FEET:
            yield float(beat), column, value


def tick_of(beat: float) -> int:
    """The tick of a beat that SMEditor has rounded to three digits."""
    return round(beat * TICKS_PER_BEAT)


def _chart_data(entry: Any, chart: Chart, ours: set[tuple[float, int, object]]) -> ChartData:
    notes = set(zip(chart.notes.tick.tolist(), chart.notes.column.tolist(), strict=True))
    lines = dict(zip(chart.notes.tick.tolist(), chart.notes.line.tolist(), strict=True))
    overrides: list[CellOverride] = []
    problems: list[FeetProblem] = []
    for beat, column, value in overrides_of(entry):
        if (beat, column, value) in ours:
            continue
        tick = tick_of(beat)
        if (tick, column) not in notes:
            text = f"{FILE_NAME} gives a foot to beat {beat:g}, column {column}, where no note is"
            problems.append(FeetProblem("sme-no-note", text))
            continue
        limb, part = FEET[value]
        overrides.append(CellOverride(tick, column, limb, part, FILE_NAME, lines[tick], 1))
    return ChartData(tuple(_with_parts(overrides)), dict(_ignores(entry)), tuple(problems))


def _with_parts(overrides: list[CellOverride]) -> Iterator[CellOverride]:
    """Convert SMEditor's parts, in which a foot on one panel is a heel: here, only brackets have a heel and a toe."""
    toes = {(s.tick, s.limb) for s in overrides if s.part == Part.TOE}
    heels = {(s.tick, s.limb) for s in overrides if s.part != Part.TOE}
    for s in overrides:
        part = s.part
        if part != Part.TOE:
            part = Part.HEEL if (s.tick, s.limb) in toes else Part.WHOLE
        elif (s.tick, s.limb) not in heels:
            part = Part.WHOLE
        yield CellOverride(s.tick, s.column, s.limb, part, s.source, s.line, s.place)


def _ignores(entry: Any) -> Iterator[tuple[int, frozenset[str]]]:
    listed = entry.get("ignores") if isinstance(entry, dict) else None
    for beat, names in listed.items() if isinstance(listed, dict) else ():
        try:
            tick = tick_of(float(beat))
        except (ValueError, OverflowError):
            continue
        if isinstance(names, list):
            yield tick, frozenset(_CODES[name] for name in names if isinstance(name, str) and name in _CODES)


def _unreadable(text: str) -> ChartData:
    return ChartData(problems=(FeetProblem("sme-unreadable", text),))
