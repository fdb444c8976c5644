"""A run of `analyze`: which configuration holds for which file, the tasks, the baseline."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.errors import DancetutorError
from dancetutor_cli.jobs.analyze import AnalyzeTask
from dancetutor_cli.jobs.result import ChartResult, FileResult
from dancetutor_cli.library.feet_files import places_of_feet
from dancetutor_cli.library.selection import Selection
from dancetutor_cli.library.settings_file import find_settings_file
from dancetutor_cli.lint.baseline import Baseline, Key, load_baseline
from dancetutor_cli.lint.configuration import (
    Configuration,
    load_configuration,
    with_assignments,
    with_selection,
)
from dancetutor_cli.lint.presets import PresetChoice, choice_of
from dancetutor_cli.meter.bill import AUTO

if TYPE_CHECKING:
    from dancetutor_cli.lint.finding import Finding


@dataclass(frozen=True, slots=True)
class LintRequest:
    """What the command line asks for; None where it says nothing and the configuration decides.

    config : file or name of a configuration; assignments : "key=value"; select, ignore : rules
    """

    selection: Selection = field(default_factory=Selection)
    preset: str | None = None
    config: str | None = None
    assignments: Sequence[str] = ()
    select: Sequence[str] = ()
    ignore: Sequence[str] = ()
    fail_on: str | None = None
    baseline: Path | None = None
    update_baseline: bool = False
    want_rows: bool = False
    want_figures: bool = False
    want_excerpts: bool = True
    suggest: bool = False
    alternatives: int = 0
    meter_scale: str = AUTO
    rate: float = 1.0


@dataclass
class LintRun:
    """Turns files into tasks, and raw results into what is reported."""

    request: LintRequest
    _by_source: dict[Path | None, Configuration] = field(default_factory=dict)
    _sources: dict[Path, Path | None] = field(default_factory=dict)
    _choices: dict[int, PresetChoice] = field(default_factory=dict)
    _baseline: Baseline | None = None
    _found: list[Key] = field(default_factory=list)

    def configuration(self, path: Path) -> Configuration:
        """What holds for a file: --config, or the nearest dancetutor.yaml up the tree, and the command line on top."""
        given = self.request.config
        source = None if given is not None else self._source(path.parent)
        if source not in self._by_source:
            loaded = load_configuration(given if given is not None else source, found=given is None)
            loaded = with_assignments(loaded, self.request.assignments)
            self._by_source[source] = with_selection(loaded, self.request.select, self.request.ignore)
        return self._by_source[source]

    def _source(self, folder: Path) -> Path | None:
        if folder not in self._sources:
            self._sources[folder] = find_settings_file(folder)
        return self._sources[folder]

    def presets(self, path: Path) -> PresetChoice:
        """What is said about the cost presets of a file's charts; UsageError or FileError if one cannot be loaded."""
        configuration = self.configuration(path)
        if id(configuration) not in self._choices:  # one object for all files of a source, see `_by_source`
            self._choices[id(configuration)] = choice_of(self.request.preset, configuration)
        return self._choices[id(configuration)]

    def needs(self, path: Path) -> Iterator[Path]:
        """What else the findings in a file depend on, there or not: what the author said elsewhere, settings, baseline.

        A configuration that cannot be read is no error here: only what it names is not known.
        """
        yield from places_of_feet(path)
        yield path.with_suffix(".sm" if path.suffix.lower() == ".ssc" else ".ssc")
        if self.request.config is not None:
            yield Path(self.request.config)
        with suppress(DancetutorError):
            configuration = self.configuration(path)
            yield from configuration.sources
            yield from (Path(preset) for _, preset in configuration.presets)
            if self.request.preset:
                yield Path(self.request.preset)
            baseline = self.request.baseline or configuration.baseline
            if baseline is not None and not self.request.update_baseline:
                yield baseline

    def task(self, path: Path, data: bytes | None = None) -> AnalyzeTask:
        """The piece of work for a file."""
        settings = self.configuration(path).settings
        request = self.request
        return AnalyzeTask(
            path, self.presets(path), request.selection, settings, request.want_rows, data, request.suggest,
            request.alternatives, request.want_figures, request.want_excerpts, request.meter_scale, request.rate,
        )  # fmt: skip

    def fail_on(self, path: Path) -> str:
        """The least severity that fails the run, as the configuration of the first file says."""
        return self.request.fail_on or self.configuration(path).fail_on or "warning"

    def open_baseline(self, path: Path) -> None:
        """Read the baseline that the command line, or the configuration of this file, names."""
        where = self.request.baseline or self.configuration(path).baseline
        if where is None and self.request.update_baseline:
            where = Path("dancetutor-baseline.json")
        if where is not None:
            is_new = self.request.update_baseline and not where.exists()
            self._baseline = Baseline(where) if is_new else load_baseline(where)

    @property
    def has_baseline(self) -> bool:
        """Whether findings are compared with a baseline."""
        return self._baseline is not None

    def without_known(self, result: FileResult) -> FileResult:
        """The result without the findings that the baseline knows."""
        baseline = self._baseline
        if baseline is None or result.error is not None:
            return result
        self._tell_what_ran(baseline, result)
        found = [(f, chart, baseline.key(result.path, _name(chart), f)) for f, chart in result.all_findings()]
        self._found += [key for _, _, key in found]
        known = self.request.update_baseline  # what is written now is known from now on
        left = [(f, chart) for f, chart, key in found if not known and not baseline.absorbs(key)]
        of_chart: dict[int, list[Finding]] = {}
        for finding, chart in left:
            of_chart.setdefault(id(chart), []).append(finding)
        charts = tuple(replace(chart, findings=tuple(of_chart.get(id(chart), ()))) for chart in result.charts)
        return replace(result, findings=tuple(of_chart.get(id(None), ())), charts=charts)

    def _tell_what_ran(self, baseline: Baseline, result: FileResult) -> None:
        path = Path(result.path).absolute()
        settings = self.configuration(Path(result.path)).settings
        baseline.saw(result.path, "", settings.for_file(path))
        for chart in result.charts:
            rules = settings.for_chart(path, chart.steps_type, chart.difficulty, chart.meter)
            baseline.saw(result.path, _name(chart), rules)
        if not result.unselected:
            baseline.saw_all_charts(result.path)

    def close_baseline(self) -> list[str]:
        """Write the baseline if that was asked for; lines to be said about it."""
        if self._baseline is None:
            return []
        path = self._baseline.path
        if self.request.update_baseline:
            new = self._baseline.replaced(self._found)
            new.write()
            others = sum(new.known.values()) - len(self._found)
            kept = f", {others} of other files and rules kept" if others else ""
            return [f"{path}: {len(self._found)} finding{'' if len(self._found) == 1 else 's'} written{kept}"]
        unused = self._baseline.unused()
        if not unused:
            return []
        what = "1 entry is" if len(unused) == 1 else f"{len(unused)} entries are"
        file, chart, rule, place = unused[0]
        first = f"{file} {chart} {rule} " + (f"beat {place / 48:g}" if chart else f"line {place}")
        return [f"{path}: {what} no longer needed (the first: {first}); --update-baseline takes them out"]


def _name(chart: ChartResult | None) -> str:
    return "" if chart is None else f"{chart.steps_type} {chart.difficulty} {chart.description}".strip() + chart.whose
