"""The unit of work of `analyze`: one file in, one `FileResult` out; a failure is part of the result."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, fields, replace
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dancetutor_cli.chart.names import is_lights
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.feet.preset import PresetChoice, mismatch_message, preset_for
from dancetutor_cli.lint.check import check_chart, check_file, merged_by_foot
from dancetutor_cli.lint.findings import AUTO, Cause, Figures, Finding
from dancetutor_cli.lint.results import ChartResult, FileResult
from dancetutor_cli.lint.rule_settings import Settings
from dancetutor_cli.run.errors import FileError, NoChartsError
from dancetutor_cli.run.process import freeze_objects

if TYPE_CHECKING:
    from dancetutor_cli.chart.density import Density
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.feet.preset import Preset
    from dancetutor_cli.lint.meter.song import MeterReport, Meters
    from dancetutor_cli.lint.subject import ChartSubject


def chart_result(subject: ChartSubject, task: AnalyzeTask) -> ChartResult:
    """Return the results for a chart, with the parts that the task asks for."""
    from dancetutor_cli.chart.hash import chart_hash
    from dancetutor_cli.lint.figures import alternatives_of, arrows, with_excerpts

    chart, play = subject.chart, subject.play
    preset = preset_for(chart, task.path, task.presets)
    findings, causes = _check_and_explain(subject, task, preset)
    return ChartResult(
        index=chart.index,
        steps_type=chart.written_type,
        player=chart.player,
        difficulty=chart.difficulty,
        meter=chart.meter,
        description=chart.description,
        playable=play is not None,
        row_count=len(subject.step_rows),
        cost=0 if play is None else play.total,
        counts=subject.counts,
        findings=with_excerpts(findings, play) if play is not None and task.want_excerpts else findings,
        rows=_rows(subject) if task.want_rows else None,
        arrows="" if subject.pad is None else arrows(subject.pad),
        figures=_figures(subject, task) if task.want_figures else None,
        alternatives=alternatives_of(subject, preset, task.alternatives) if task.alternatives else None,
        causes=causes,
        ambiguous=tuple(_ambiguous(subject)) if task.want_rows else None,
        preset=None if play is None else play.preset,
        mismatch=None if play is None else mismatch_message(preset, chart.steps_type),
        hash=chart_hash(subject.song, chart),
    )


def _rows(subject: ChartSubject) -> str:
    from dancetutor_cli.feet.play_json import json_rows

    return "[]" if subject.play is None else json_rows(subject.play, subject.file_lines)


def _check_and_explain(
    subject: ChartSubject, task: AnalyzeTask, preset: Preset
) -> tuple[tuple[Finding, ...], tuple[Cause, ...] | None]:
    """Return the findings of the linter and the causes of doublesteps.

    Causes and suggestions are found only if the task wants them, because they take long.
    """
    findings, causes = check_chart(subject, task.settings), None
    if task.want_rows or task.suggest:
        from dancetutor_cli.lint.figures import causes_of, with_causes

        causes = causes_of(subject, preset)
        findings = with_causes(findings, causes, subject.pad.names if subject.pad else ())
    if task.suggest:
        from dancetutor_cli.lint.suggest import with_suggestions

        findings = with_suggestions(findings, subject, task.settings, preset)
    return merged_by_foot(findings, subject), causes


def _figures(subject: ChartSubject, task: AnalyzeTask) -> Figures:
    from dancetutor_cli.chart.density import density
    from dancetutor_cli.lint.figures import facing_counts, hand_rows, tech_counts

    dense = density(subject.chart, task.settings.stream_rows)
    return Figures(
        dense.mean, dense.peak, dense.breakdown, dense.stream_measures, tech_counts(subject),
        subject.seconds_played(), facing_counts(subject), len(hand_rows(subject)),
    )  # fmt: skip


def _ambiguous(subject: ChartSubject) -> Iterator[tuple[float, str]]:
    from dancetutor_cli.chart.names import TICKS_PER_BEAT
    from dancetutor_cli.feet.play import Ambiguity

    play = subject.play
    if play is not None and play.ambiguity is not None:
        for row in play.ambiguity.nonzero()[0].tolist():
            kind = Ambiguity(int(play.ambiguity[row])).name.lower()
            yield round(int(play.rows.tick[row]) / TICKS_PER_BEAT, 6), kind


_ROWS = 16_000  # rows of charts that are checked together; the last chart may exceed it
_CHART = 50  # rows that each chart counts in addition to its own
_MOST_FOR_SCALE = 20  # most charts of a file that are solved only to find the scale of its meters


@dataclass(frozen=True, slots=True, kw_only=True)
class ResultOptions:
    """The parts of a run's results besides findings. All fields except `want_rows` are part of a kept result's key.

    want_rows : include every row, for JSON; want_figures : include densities and technical steps, for CSV
    want_excerpts : include the rows around each finding, for text; suggest : include the edit that would remove it
    alternatives : how many other plays to include
    meter_scale, rate : the scale on which meters are estimated, and the speed of the music for that estimate
    """

    want_rows: bool = False
    want_figures: bool = False
    want_excerpts: bool = True
    suggest: bool = False
    alternatives: int = 0
    meter_scale: str = AUTO
    rate: float = 1.0

    def options(self) -> dict[str, Any]:
        """Return the fields of this class alone, by name, also for a subclass with more fields."""
        return {one.name: getattr(self, one.name) for one in fields(ResultOptions)}


@dataclass(frozen=True, slots=True)
class AnalyzeTask(ResultOptions):
    """The work to do on one file. It pickles, so that another process can do it.

    presets : which cost preset each chart gets
    data : the bytes to read instead of the file, for standard input
    """

    path: Path
    presets: PresetChoice
    selection: Selection
    settings: Settings
    data: bytes | None = None


def analyze_file(task: AnalyzeTask) -> FileResult:
    """Read, solve and lint one file, see `analyze_files`."""
    return next(analyze_files([task]))


def analyze_files(tasks: Iterable[AnalyzeTask]) -> Iterator[FileResult]:
    """Read, solve and lint files in order; the charts of several files are checked together.

    A fault of a chart file never raises: it is the `error` of the file's result. FileError if dancetutor.yaml cannot be
    read, after the results of the files before.
    """
    window = _Window()
    for task in tasks:
        try:
            window.add(_File(task))
        except Exception:
            window.check()
            yield from window.results()
            raise
        yield from window.results()
    window.check()
    yield from window.results()


class _Window:
    """Charts that wait to be checked together, and the files without a result.

    Most charts have few rows, and each array operation has a fixed cost.
    """

    def __init__(self) -> None:
        self._files: deque[_File] = deque()
        self._waiting: list[tuple[_File, ChartSubject]] = []
        self._rows = 0

    def add(self, file: _File) -> None:
        """Solve the charts of a file, and check whenever enough wait. A file that fails leaves the window as it was."""
        before = len(self._waiting), self._rows
        try:
            for subject in file.solve():
                self._waiting.append((file, subject))
                self._rows += subject.row_count + _CHART
                if self._rows >= _ROWS:  # here and not after the file, which may hold thousands of charts
                    self.check()
                    freeze_objects()  # by now all modules are imported
                    before = 0, 0
        except Exception:
            del self._waiting[before[0] :]
            self._rows = before[1]
            raise
        self._files.append(file)

    def results(self) -> Iterator[FileResult]:
        """Yield the results of the files that come before the first waiting chart, in order, and forget them."""
        first = self._waiting[0][0] if self._waiting else None
        while self._files and self._files[0] is not first:
            yield self._files.popleft().result()

    def check(self) -> None:
        """Check all waiting charts."""
        from dancetutor_cli.lint.subject import share_plays

        waiting, self._waiting, self._rows = self._waiting, [], 0
        share_plays(subject for _, subject in waiting)
        for file, subject in waiting:
            try:
                file.add(subject)
            except Exception:  # only the files before this one are reported: the others lack some charts
                while file in self._files:
                    self._files.pop()
                raise


class _File:
    """A file whose result is not complete yet."""

    def __init__(self, task: AnalyzeTask) -> None:
        self._task = task
        self._charts: list[ChartResult] = []
        self._failed: FileResult | None = None
        try:
            self._song = load_song(task)
        except NoChartsError as error:
            self._failed = FileResult(str(task.path), "", "", None, (f"{error.message}: nothing to dance",), (), ())
        except FileError as error:
            self._failed = _unreadable(task, error)
        else:
            from dancetutor_cli.lint.meter.song import Meters

            self._selected = task.selection.charts(self._song)
            self._meters = Meters(self._song, task.settings)

    def solve(self) -> Iterator[ChartSubject]:
        """Return the selected charts, solved one by one."""
        return iter(()) if self._failed else solve_selected(self._song, self._selected, self._task)

    def add(self, subject: ChartSubject) -> None:
        """Keep the results for one of the selected charts."""
        self._charts.append(chart_result(subject, self._task))
        self._meters.add(subject, self._task.rate)

    def result(self) -> FileResult:
        """Return the result of the file."""
        if self._failed:
            return self._failed
        from dancetutor_cli.lint.subject import FileSubject

        task, song, charts = self._task, self._song, self._with_meters()
        found = None
        if task.settings.sync:
            from dancetutor_cli.lint.song_sync import song_sync

            found = song_sync(song)
            charts = tuple(replace(chart, sync=found.of_charts.get(chart.index)) for chart in charts)
        return FileResult(
            str(task.path),
            song.title,
            song.artist,
            None,
            tuple(_warnings(song, charts)),
            check_file(FileSubject(song, found), task.settings),
            charts,
            _unselected(song, self._selected),
            None if found is None else found.sync,
        )

    def _with_meters(self) -> tuple[ChartResult, ...]:
        """Return the charts with their meters. The scale of the meters depends on all charts of the file."""
        task = self._task
        for subject in _charts_for_scale(self._song, self._selected, task, self._meters):
            self._meters.add(subject, task.rate)
        found = self._meters.reports(task.meter_scale)
        return tuple(_with_report(one, found[one.index]) if one.index in found else one for one in self._charts)


def _with_report(chart: ChartResult, report: MeterReport) -> ChartResult:
    findings = report.with_findings(chart.findings)
    return replace(chart, estimate=report.estimate, score=report.score, findings=findings)


def _charts_for_scale(
    song: Song, selected: tuple[Chart, ...], task: AnalyzeTask, meters: Meters
) -> Iterator[ChartSubject]:
    """Yield charts that are not selected but are solved for the scale of the meters.

    The estimate of a chart's meter must not depend on the selection.
    """
    from dancetutor_cli.lint.subject import solved_chart

    kinds, meant = meters.ask_for_others(task.meter_scale), {chart.index for chart in selected}
    others = (chart for chart in song.charts if chart.steps_type in kinds and chart.index not in meant)
    for chart in islice(others, _MOST_FOR_SCALE):
        yield solved_chart(song, chart, preset_for(chart, task.path, task.presets))


def _unselected(song: Song, selected: tuple[Chart, ...]) -> tuple[str, ...]:
    meant = {chart.index for chart in selected}  # a file may hold thousands of charts
    return tuple(f"{chart.index} {chart.label}" for chart in song.charts if chart.index not in meant)


def load_song(task: AnalyzeTask) -> Song:
    """Read the task's file; FileError if that fails."""
    from dancetutor_cli.chart.reader import load, parse  # imports numpy, which a kept result does not need

    return load(task.path) if task.data is None else parse(task.data, task.path)


def solve_selected(song: Song, charts: tuple[Chart, ...], task: AnalyzeTask) -> Iterator[ChartSubject]:
    """Yield each chart with its play; for a chart for two players, the part of each player."""
    from dancetutor_cli.feet.solved import solve_song
    from dancetutor_cli.lint.subject import subject_of

    parts = [part for chart in charts for part in task.selection.player_parts(chart)]
    return map(subject_of, solve_song(song, [(part, preset_for(part, task.path, task.presets)) for part in parts]))


def _warnings(song: Song, charts: tuple[ChartResult, ...]) -> Iterator[str]:
    yield from (warning.message for warning in song.warnings)
    for result in charts:
        if is_lights(result.steps_type):  # nobody dances the lights
            continue
        if result.player < 2:  # the warnings of a chart for two players are reported once
            yield from (f"{result.label}: {warning.message}" for warning in song.charts[result.index].warnings)
        if not result.playable:
            yield f"{result.label}: steps type '{result.steps_type}' has no pad, so its feet are not known"
        elif result.mismatch:
            yield f"{result.label}: {result.mismatch}"


def failure_result(task: AnalyzeTask, message: str) -> FileResult:
    """Return the result of a task that failed with this message."""
    return _unreadable(task, FileError(task.path, message))


def _unreadable(task: AnalyzeTask, error: FileError) -> FileResult:
    finding = Finding("DT101", "unreadable", "error", error.message, error.line, error.column)
    return FileResult(str(task.path), "", "", str(error), (), (finding,), ())


# Charts for a sheet: solved, linted and counted.


@dataclass(frozen=True)
class Drawable:
    """A chart with everything that a sheet shows. `counts` : name of a move -> number of rows."""

    subject: ChartSubject
    findings: tuple[Finding, ...]
    density: Density
    counts: dict[str, int]


def drawable_charts(task: AnalyzeTask) -> Iterator[Drawable]:
    """Yield the selected charts of a file that have notes; FileError if the file cannot be read."""
    from dancetutor_cli.chart.density import density

    song = load_song(task)
    for subject in solve_selected(song, task.selection.charts(song), task):
        if len(subject.chart.notes):
            findings = merged_by_foot(check_chart(subject, task.settings), subject)
            moves = subject.play.moves if subject.play else ()
            counts = Counter(name for names in moves for name in names)
            yield Drawable(subject, findings, density(subject.chart, task.settings.stream_rows), dict(counts))
