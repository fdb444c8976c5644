"""The changes of a chart file, computed before anything is written: charts are solved, and markers are placed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import chain

import numpy as np

from dancetutor_cli.chart.edits import check_edit
from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.chart.names import is_lights
from dancetutor_cli.chart.players import player_charts, written_parts
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.feet.annotations import step_rows
from dancetutor_cli.feet.preset import Preset, mismatch_message
from dancetutor_cli.feet.solved import solve_song
from dancetutor_cli.markers import edit
from dancetutor_cli.markers.model import ChartFeet, CheckLine, NoteChange, row_letters
from dancetutor_cli.markers.styles import note_styles


@dataclass(slots=True)
class SolvedSong:
    """The feet of a song. problems : contradictions in feet that people have set; notes : lines for people"""

    charts: list[ChartFeet] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    problems: list[CheckLine] = field(default_factory=list)


def solve_charts(song: Song, charts: Sequence[Chart], preset_of: Callable[[Chart], Preset]) -> SolvedSong:
    """Return the feet of each chart that has a pad."""
    found = SolvedSong()
    padless = set()
    parts = [player_charts(chart) for chart in charts]
    solved = solve_song(song, [(part, preset_of(part)) for part in chain.from_iterable(parts)])
    for chart, players in zip(charts, parts, strict=True):
        feet = []
        for part, one in zip(players, solved, strict=False):  # the next players of the song
            found.problems += (CheckLine(problem.message, problem.line, problem.column) for problem in one.problems)
            if one.play is None:
                padless.add(part.steps_type)
                continue
            rows = step_rows(song.data, part)
            feet.append(ChartFeet(part, rows, tuple(row_letters(part, rows, one.play)), one.play))
        separate = written_parts(chart) != (chart,) or not chart.players
        found.charts += feet if separate else [_in_shared_rows(song, chart, feet)]
    padless = {name for name in padless if not is_lights(name)}
    if padless:
        found.notes.append(
            f"{song.path}: there is no pad for {', '.join(sorted(padless))}, so these charts get no feet"
        )
    for chart in (one.chart for one in found.charts):
        if unfit := mismatch_message(preset_of(chart), chart.steps_type):
            found.notes.append(f"{song.path}: {chart.label}: {unfit}")
    return found


def _in_shared_rows(song: Song, chart: Chart, feet: Sequence[ChartFeet]) -> ChartFeet:
    """Return the feet of players whose notes are in the same rows, with letters from left to right.

    The play is the first player's.
    """
    found = step_rows(song.data, chart)
    of_row: dict[int, list[tuple[int, str]]] = {}
    for one in feet:
        for row, steps, text in zip(one.rows.row.tolist(), one.rows.steps, one.letters, strict=True):
            columns = np.flatnonzero(steps) + one.chart.first_column
            of_row.setdefault(row, []).extend(zip(columns.tolist(), text, strict=True))
    letters = ("".join(letter for _, letter in sorted(of_row[row])) for row in found.row.tolist())
    return ChartFeet(chart, found, tuple(letters), feet[0].play)


def mark(song: Song, feet: Sequence[ChartFeet], names: Sequence[str], force: bool) -> NoteChange:
    """Return the change that writes the styles of `names` that are in note data."""
    change = NoteChange([])
    for one in feet:
        for style in note_styles(names):
            change.add(style.write(song, one, force))
    if any(warning.code == "cr-only" for warning in song.warnings):
        change.notes.append(f"{song.path}: lines end at CR alone; a comment would hide the rest, so none is written")
    return change


def unmark(song: Song, charts: Sequence[Chart], names: Sequence[str], force: bool) -> NoteChange:
    """Return the change that removes the styles of `names` that are in note data."""
    change = NoteChange([])
    for chart in charts:
        before = len(change.splices)
        for part in written_parts(chart):
            for style in note_styles(names):
                change.add(style.strip(song, part, force))
        if found := len(change.splices) - before:
            change.lacks.append(CheckLine(f"{chart.label}: {found} markers to remove", chart.line))
    return change


def with_lane_split_charts(
    song: Song, before: Song, data: bytes, feet: Sequence[ChartFeet]
) -> tuple[bytes, list[CheckLine]]:
    """Return the file with the lane-split charts added, and the reports of `--check` about them.

    song : the song without these charts; before : the song as read, perhaps with older ones; data : bytes of `song`
    with markers
    """
    added = edit.added_charts(song, feet)
    singles = [one.chart for one in feet if one.chart.steps_type == edit.SOURCE]
    made = [chart for chart in parse(data + added, song.path).charts if edit.is_ours(chart)][-len(singles) :]
    for chart, source in zip(made, singles, strict=True):
        if len(chart.notes) != len(source.notes) or chart.timing != source.timing:
            raise edit.EditError(song.path, f"{source.label}: cannot be added as a chart for two pads; nothing written")
    if before.data.endswith(added) and len(before.data) - len(song.data) == len(added):
        return data + added, []
    return data + added, [CheckLine(f"{c.label}: its chart for two pads is missing or stale", c.line) for c in singles]


def check(song: Song, data: bytes) -> None:
    """Raise `chart.edits.HarmError` if the new bytes do not read like the original song."""
    if data != song.data:
        check_edit(song, data, edit.is_ours)
