"""The planned changes of a chart file and the files beside it: charts are solved, every style is asked, the result is
read back.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from dancetutor_cli.chart.edits import Splice, apply, unchanged
from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.chart.note_data import parts, written_parts
from dancetutor_cli.chart.pack_files import song_stems
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.feet import sme
from dancetutor_cli.feet.annotations import step_rows
from dancetutor_cli.feet.preset import Preset
from dancetutor_cli.feet.solver.solve import solve_chart
from dancetutor_cli.feet.song_feet import overrides_for
from dancetutor_cli.markers import comments, edit, sidecar, theme
from dancetutor_cli.markers.comments import (
    EDIT,
    MEASURE,
    ROWS,
    SIDECAR,
    SMEDITOR,
    TEXT,
    THEME,
    ChartFeet,
    FileChange,
    Lack,
    MeasureState,
    State,
    row_letters,
)
from dancetutor_cli.run.errors import FileError, MissingFileError
from dancetutor_cli.run.reading import CHART_LIMIT, read_bytes

# The styles that write beside a chart file: sidecar, text, SMEditor's `data.sme`, `.edit` files and a theme's cues.

FilePlan = tuple[FileChange, list[Lack]]


def write(style: str, song: Song, folder: Path, feet: Sequence[ChartFeet]) -> Iterator[FilePlan | FileError]:
    """The files that a style puts beside a song. folder : where they go; what is merged lies there or by the song.

    Yields an error for each file that cannot be made, and goes on with the others.
    """
    if style == SIDECAR:
        path = folder / sidecar.sidecar_path(song.path).name
        old = _present(path, song)
        new = sidecar.write_sidecar(path, old, song, feet)
        why = [(one.chart, sidecar.lack(path, old, song, one.chart, new)) for one in feet]
        yield FileChange(path, old, new), [Lack(text, chart.line) for chart, text in why if text]
    elif style == TEXT:
        path = folder / sidecar.text_path(song.path).name
        old = _present(path, song)
        new = sidecar.write_feet_text(path, old, song, feet)
        lacks = [] if old == new else [Lack(f"{path.name} is {'missing' if old is None else 'stale'}")]
        yield FileChange(path, old, new), lacks
    elif style == SMEDITOR:
        path = folder / sme.FILE_NAME
        _one_song(song, path)
        old = _present(path, song)
        merged = sidecar.write_editor_data(path, old, song, feet)
        lacks = [] if merged == old else [Lack(f"{path.name} does not have the feet that the solver finds")]
        yield FileChange(path, old, merged), lacks
    elif style == EDIT:
        for where, data in edit.edit_files(song, feet):
            if isinstance(data, FileError):
                yield data
                continue
            path = folder / where.name
            old = _present(path, song)
            lacks = [] if old == data else [Lack(f"{path.name} is {'missing' if old is None else 'stale'}")]
            yield FileChange(path, old, data), lacks
    elif style == THEME:
        table, lua = (folder / path.name for path in theme.paths_for(song.path))
        before, script = _present(table, song), _present(lua, song)
        theme.check_lua(lua, script)
        content = theme.write(table, before, song, feet)
        for path, old, new in ((table, before, theme.as_json(content)), (lua, script, theme.as_lua(content))):
            lacks = [] if old == new else [Lack(f"{path.name} is {'missing' if old is None else 'stale'}")]
            yield FileChange(path, old, new), lacks


def strip(style: str, song: Song, charts: Sequence[Chart]) -> Iterator[FilePlan]:
    """What taking a style out again does to the files beside a song."""
    if style == SIDECAR:
        path = sidecar.sidecar_path(song.path)
        old = _read(path)
        yield _removed(path, old, sidecar.strip_sidecar(path, old, song, charts))
    elif style == TEXT:
        path = sidecar.text_path(song.path)
        old = _read(path)
        sidecar.check_text(path, old)
        yield _removed(path, old, None)
    elif style == SMEDITOR:
        path = song.path.parent / sme.FILE_NAME
        old = _read(path)
        yield _removed(path, old, sidecar.strip_editor_data(path, old, song, charts))
    elif style == EDIT:
        for path in edit.edit_paths(song, charts):
            yield _removed(path, read_bytes(path, CHART_LIMIT), None)
    elif style == THEME:
        table, lua = theme.paths_for(song.path)
        old, script = _read(table), _read(lua)
        theme.check_lua(lua, script)
        kept = theme.without_charts(table, old, charts)
        content = {**theme.write(table, None, song, ()), "charts": kept}
        yield _removed(table, old, theme.as_json(content) if kept and old else None)
        yield _removed(lua, script, theme.as_lua(content) if kept and script else None)


def _removed(path: Path, old: bytes | None, new: bytes | None) -> FilePlan:
    return FileChange(path, old, new), [] if old == new else [Lack(f"{path.name} has feet to remove")]


def _one_song(song: Song, path: Path) -> None:
    """`data.sme` knows charts only by their place, so it can only serve one song."""
    if len(stems := song_stems(song.path.parent)) > 1:
        raise FileError(path, f"its folder has {len(stems)} songs, but data.sme can hold only one; it is not written")


def _present(path: Path, song: Song) -> bytes | None:
    """The file as it is, or for a file that goes elsewhere the one that lies by the song."""
    found = _read(path)
    return _read(song.path.with_name(path.name)) if found is None else found


def _read(path: Path) -> bytes | None:
    try:
        return read_bytes(path, CHART_LIMIT)
    except MissingFileError:
        return None


# The planned changes of a chart file: charts are solved, every style is asked, the result is read back and compared.


@dataclass(slots=True)
class MarkerPlan:
    """The plan for one file. data : its new bytes; the rest is for people.

    counts : measures by what was done about them; lacks : what `--check` reports
    """

    data: bytes
    lacks: list[Lack] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    counts: Counter[str] = field(default_factory=Counter)


def solve_charts(
    song: Song,
    charts: Sequence[Chart],
    preset_of: Callable[[Chart], Preset],
    notes: list[str],
    problems: list[Lack],
) -> Iterator[ChartFeet]:
    """The feet of each chart that has a pad; contradictions in what people said about them go to `problems`."""
    padless = set()
    for chart in charts:
        feet = []
        for part in parts(chart):
            overrides, _, wrong = overrides_for(song, part)
            problems += (Lack(problem.message, problem.line, problem.column) for problem in wrong)
            play = solve_chart(part, preset_of(part), overrides)
            if play is None:
                padless.add(part.steps_type)
                continue
            found = step_rows(song.data, part)
            feet.append(ChartFeet(part, found, tuple(row_letters(part, found, play)), play))
        yield from (
            feet if written_parts(chart) != (chart,) or not chart.players else [_in_shared_rows(song, chart, feet)]
        )
    padless = {name for name in padless if not name.startswith("lights")}
    if padless:
        notes.append(f"{song.path}: there is no pad for {', '.join(sorted(padless))}, so these charts get no feet")


def _in_shared_rows(song: Song, chart: Chart, feet: Sequence[ChartFeet]) -> ChartFeet:
    """The feet of two players whose notes stand in the same rows: letters from left to right.

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


def mark(song: Song, feet: Sequence[ChartFeet], styles: Sequence[str], force: bool) -> MarkerPlan:
    """Write the styles that live inside note data: `measure` and `rows`."""
    plan = MarkerPlan(song.data)
    splices: list[Splice] = []
    for one in feet:
        if MEASURE in styles:
            new, states = comments.write_measures(song.data, one.chart, one.rows, one.letters, force)
            splices += new
            _count_measures(plan, song, one.chart, states)
        if ROWS in styles:
            new, lacking = comments.write_rows(song.data, one.chart, one.rows, one.letters)
            splices += new
            if lacking:
                plan.lacks.append(Lack(f"{one.chart.label}: {lacking} rows have no letters", one.chart.line))
            plan.counts["rows"] += len(one.rows)
    plan.data = apply(song.data, splices)
    if any(warning.code == "cr-only" for warning in song.warnings):
        plan.notes.append(f"{song.path}: lines end at CR alone; a comment would hide the rest, so none is written")
    return plan


def add_charts(song: Song, before: Song, plan: MarkerPlan, feet: Sequence[ChartFeet]) -> None:
    """Add the lane-split charts to the plan.

    song : without them, as `plan` was made from; before : the song as it was read, perhaps with older ones
    """
    added = edit.added_charts(song, feet)
    singles = [one.chart for one in feet if one.chart.steps_type == edit.SOURCE]
    plan.data += added
    removed = len(before.data) - len(song.data)
    if not before.data.endswith(added) or removed != len(added):
        plan.lacks += (Lack(f"{c.label}: its chart for two pads is missing or stale", c.line) for c in singles)
    made = [chart for chart in parse(plan.data, song.path).charts if edit.is_ours(chart)][-len(singles) :]
    for chart, source in zip(made, singles, strict=True):
        if len(chart.notes) != len(source.notes) or chart.timing != source.timing:
            raise edit.EditError(song.path, f"{source.label}: cannot be added as a chart for two pads; nothing written")


def unmark(song: Song, charts: Sequence[Chart], styles: Sequence[str], force: bool) -> MarkerPlan:
    """Take the styles that live inside note data out."""
    plan = MarkerPlan(song.data)
    splices: list[Splice] = []
    for chart in charts:
        found: list[Splice] = []
        for part in written_parts(chart):
            if MEASURE in styles:
                found += comments.strip_measures(song.data, part, force)
                plan.counts["pinned"] += 0 if force else comments.pinned(song.data, part)
            plan.counts["removed"] += len(found)
            if ROWS in styles:
                found += comments.strip_rows(song.data, part)
        if found:
            plan.lacks.append(Lack(f"{chart.label}: {len(found)} markers to remove", chart.line))
        splices += found
    plan.data = apply(song.data, splices)
    return plan


def checked(song: Song, plan: MarkerPlan) -> MarkerPlan:
    """The plan, if its bytes read like the song they were made from; raises `chart.edits.HarmError` if not."""
    if plan.data != song.data:
        unchanged(song, plan.data, edit.is_ours)
    return plan


def _count_measures(plan: MarkerPlan, song: Song, chart: Chart, states: Sequence[MeasureState]) -> None:
    """Count what was found, and list what lacks: one line for each kind in a chart, with the first place."""
    by_state: dict[State, list[MeasureState]] = {}
    for one in states:
        by_state.setdefault(one.state, []).append(one)
        plan.counts[one.state.value] += 1
    words = {
        State.MISSING: "have no feet yet",
        State.STALE: "have feet that no longer fit their rows",
        State.DIFFERENT: "have other feet than the solver finds",
    }
    for state, text in words.items():
        if found := by_state.get(state):
            number = f"{len(found)} measures" if len(found) > 1 else f"measure {found[0].measure}"
            text = text if len(found) > 1 else text.replace("have", "has", 1)
            plan.lacks.append(Lack(f"{chart.label}: {number} {text}", found[0].line))
    if found := by_state.get(State.IMPOSSIBLE):
        single = len(found) == 1
        text = "1 measure begins on the line of its" if single else f"{len(found)} measures begin on the line of their"
        left = "it is" if single else "they are"
        plan.notes.append(f"{song.path}:{found[0].line}: {chart.label}: {text} comma; {left} left alone")
