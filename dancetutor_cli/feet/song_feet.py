"""The feet that people have set for a song: in its file, in SMEditor's `data.sme`, and in dancetutor.yaml."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any

from dancetutor_cli.chart.model import STEP_KINDS, Chart, Song
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.chart.pack_files import (
    EDITOR_FILE,
    SETTINGS_FILE,
    check_not_a_link_out,
    find_settings_file,
    song_stems,
)
from dancetutor_cli.chart.players import shares_rows
from dancetutor_cli.feet.annotations import has_pins, pinned_cells
from dancetutor_cli.feet.conditions import Condition, When, condition_of
from dancetutor_cli.feet.limbs import LETTERS, MEANING, UNKNOWN, Limb, Part, limb_and_part
from dancetutor_cli.feet.overrides import CellOverride, FeetProblem, Ignores, Overrides, split_contradictions
from dancetutor_cli.run.errors import FileError, MissingFileError
from dancetutor_cli.run.files import UCS_SUFFIX
from dancetutor_cli.run.reading import CHART_LIMIT, parse_json, read_bytes, shown_key
from dancetutor_cli.run.schema import MarkedYaml, Parsed, Texts, convert
from dancetutor_cli.run.yaml_files import read

# Feet and silenced findings from `feet` in dancetutor.yaml.
#
# feet:
#   - when: {path: song.ssc, difficulty: Hard}   # as in `overrides`
#     steps: {16: L, 16.5: R, 17: LR}            # beat: a letter for each note, left to right, as in {dt1 ...}
#     ignore: {24: doublestep, 25.5: [DT202]}    # beat: rules whose findings are not wanted there


def _tick(beat: Any) -> int:
    if isinstance(beat, bool) or not isinstance(beat, int | float) or not 0 <= beat < 1e6:
        raise ValueError(f"'{shown_key(beat)}' is not a beat; write a number such as 16 or 16.5")
    return round(beat * TICKS_PER_BEAT)


def _letters(value: Any) -> str:
    letters = str(value)
    wrong = [letter for letter in letters if letter not in LETTERS]
    if wrong or not letters:
        known = f"{', '.join(MEANING)}, or {UNKNOWN} for any"
        raise ValueError(f"'{shown_key(wrong[0] if wrong else '')}' is not a limb; choose {known}")
    return letters


_Tick = Annotated[int, Parsed(_tick)]  # written as a beat


@dataclass(frozen=True, slots=True)
class FeetEntry:
    """An entry of `feet`. steps : {tick: letters}; ignore : {tick: rules, as the user wrote them}"""

    when: When
    steps: dict[_Tick, Annotated[str, Parsed(_letters)]] = field(default_factory=dict)
    ignore: dict[_Tick, Texts] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class SettingsFeet:
    """The feet, ignores and problems that dancetutor.yaml has for one chart."""

    cells: tuple[CellOverride, ...] = ()
    ignores: Mapping[int, frozenset[str]] | None = None
    problems: tuple[FeetProblem, ...] = ()


def read_settings_feet(song: Song, chart: Chart, path: Path | None) -> SettingsFeet:
    """Read the feet of a chart from a dancetutor.yaml; without a path, there are none. Raises FileError."""
    if path is None:
        return SettingsFeet()
    status = path.stat()
    overrides: list[CellOverride] = []
    problems: list[FeetProblem] = []
    ignores: dict[int, frozenset[str]] = {}
    for when, entry in _entries(path, status.st_mtime_ns, status.st_size):
        if not when.holds(song.path, chart.steps_type, chart.difficulty, chart.meter):
            continue
        for tick, letters in entry.steps.items():
            found = list(_parse_letters(chart, tick, letters))
            overrides += [one for one in found if isinstance(one, CellOverride)]
            problems += [one for one in found if isinstance(one, FeetProblem)]
        for tick, rules in entry.ignore.items():
            ignores[tick] = ignores.get(tick, frozenset()).union(rules)
    return SettingsFeet(tuple(overrides), ignores, tuple(problems))


@lru_cache(maxsize=8)
def _entries(path: Path, _time: int, _size: int) -> tuple[tuple[Condition, FeetEntry], ...]:
    check_not_a_link_out(path)
    return tuple((condition_of(entry.when, path.parent), entry) for entry in entries_of(read(path)))


def entries_of(source: MarkedYaml) -> tuple[FeetEntry, ...]:
    """Return the checked entries of `feet` in a dancetutor.yaml. Raises FileError with the line and the valid names."""
    if source.data.get("feet") is None:
        return ()
    return convert(source, tuple[FeetEntry, ...], ("feet",))


def _parse_letters(chart: Chart, tick: int, letters: str) -> Iterator[CellOverride | FeetProblem]:
    """Yield an override for each note of a row, or one problem if the number of letters does not fit."""
    here = [n for n in (chart.notes.tick == tick).nonzero()[0].tolist() if chart.notes.kind[n] in STEP_KINDS]
    beat = f"{SETTINGS_FILE} gives beat {tick / TICKS_PER_BEAT:g}"
    if len(here) != len(letters):
        what = f"{len(letters)} letter{'s' if len(letters) > 1 else ''}"
        yield FeetProblem("settings-count", f"{beat} {what}, and {len(here) or 'no'} notes are there; not used")
        return
    for n, letter in zip(here, letters, strict=True):
        if letter in MEANING:
            limb, part = limb_and_part(letter, letters)
            yield CellOverride(tick, int(chart.notes.column[n]), limb, part, SETTINGS_FILE, int(chart.notes.line[n]), 1)


# Overrides and ignores from all three sources.

AuthorFeet = tuple[Overrides, Ignores, tuple[FeetProblem, ...]]


class SongFeet:
    """The feet that people have set for the charts of a song; the files that may hold them are searched once."""

    def __init__(self, song: Song) -> None:
        self._song = song
        self._editor = editor_file(song.path)
        self._settings = find_settings_file(song.path.parent)

    def author_feet(self, chart: Chart) -> AuthorFeet:
        """Return the feet, the ignores and the problems of a chart, for the solver and the linter.

        The sources are pinned measures in the file, overrides in `data.sme` beside it, and `feet` in the
        dancetutor.yaml of a folder above. If several sources set a cell, the first of these is used.

        Returns the overrides for the solver, the ignores for the linter, and the contradictions, which become findings.
        Raises FileError if dancetutor.yaml cannot be read.
        """
        song = self._song
        # people set feet for the chart as it is written in the file
        whole = chart if chart.written is None else chart.written
        in_file = whole if shares_rows(chart) else chart
        if self._editor is None and self._settings is None and not has_pins(song.data, in_file):
            return Overrides.none(), Ignores(), ()
        pins, problems = pinned_cells(song, in_file)
        editor = EditorFeet() if self._editor is None else read_editor_feet(song, whole)
        settings = read_settings_feet(song, whole, self._settings)
        given = (*settings.cells, *editor.cells, *pins)
        overrides = {
            (s.tick, s.column): s for s in (given if chart.written is None else _of_player(chart, given))
        }  # later win
        good, contradictory = split_contradictions(chart, overrides.values())
        if chart.player > 1:  # problems outside the notes are reported only for the first player
            editor, settings = replace(editor, problems=()), replace(settings, problems=())
            problems = [] if shares_rows(chart) else problems
        cells = {(s.tick, s.column): (s.limb, s.part) for s in good}
        ignores = Ignores(editor.ignores, settings.ignores or {})
        return Overrides.of(cells), ignores, (*problems, *editor.problems, *settings.problems, *contradictory)


def _of_player(chart: Chart, overrides: Iterable[CellOverride]) -> Iterator[CellOverride]:
    """Yield the overrides of the notes of one player, in this player's columns."""
    mine = set(zip(chart.notes.tick.tolist(), chart.notes.column.tolist(), strict=True))
    for one in overrides:
        column = one.column - chart.first_column
        if (one.tick, column) in mine:
            yield replace(one, column=column)


# The reader of SMEditor's `data.sme`: the feet and the silenced findings that a person has set in that editor.

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
class EditorFeet:
    """The contents of `data.sme` for one chart. ignores : {tick: codes}"""

    cells: tuple[CellOverride, ...] = ()
    ignores: dict[int, frozenset[str]] = field(default_factory=dict)
    problems: tuple[FeetProblem, ...] = ()


def read_editor_feet(song: Song, chart: Chart) -> EditorFeet:
    """Read the entry of a chart from the `data.sme` in the song's folder; it is empty if there is no file.

    Never raises.
    """
    path = editor_file(song.path)
    if path is None:
        return EditorFeet()
    try:
        raw = read_bytes(path, CHART_LIMIT)
    except MissingFileError:
        return EditorFeet()
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
    return _editor_feet(entry, chart, _our_overrides(data, chart, place_in_type(song, chart)))


def editor_file(song: Path) -> Path | None:
    """Return the path of the `data.sme` beside a chart file, or None; a broken link counts as a file."""
    path = song.parent / FILE_NAME
    if song.suffix.lower() == UCS_SUFFIX:  # `data.sme` holds the charts of a .sm or .ssc file in the same folder
        return None
    # most songs have no file, and raising an error is much slower than this check
    return path if os.path.lexists(path) else None


def place_in_type(song: Song, chart: Chart) -> int:
    """Return the index of a chart among the charts of its steps type, in file order, as `data.sme` counts them."""
    return [c.index for c in song.charts if c.steps_type == chart.steps_type].index(chart.index)


def chart_entry(data: Any, chart: Chart, place: int) -> Any:
    """Return the value of a chart in the parsed file, or None."""
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
    """Return the tick of a beat that SMEditor has rounded to three digits."""
    return round(beat * TICKS_PER_BEAT)


def _editor_feet(entry: Any, chart: Chart, ours: set[tuple[float, int, object]]) -> EditorFeet:
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
    return EditorFeet(tuple(_with_parts(overrides)), dict(_ignores(entry)), tuple(problems))


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


def _unreadable(text: str) -> EditorFeet:
    return EditorFeet(problems=(FeetProblem("sme-unreadable", text),))
