"""A run of `analyze`: the configuration for each file, many files in order, packs, the baseline, saved files."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.chart.pack_files import find_settings_file, places_of_feet
from dancetutor_cli.chart.selection import Selection, twin_names
from dancetutor_cli.feet.preset import PresetChoice, choice_of
from dancetutor_cli.lint.analysis import AnalyzeTask, ResultOptions, analyze_files, failure_result
from dancetutor_cli.lint.check import PackSyncs
from dancetutor_cli.lint.configuration import (
    Configuration,
    load_configuration,
    with_assignments,
    with_selection,
)
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.results import ChartResult, FileResult
from dancetutor_cli.run.errors import DancetutorError, plural

if TYPE_CHECKING:
    from dancetutor_cli.lint.baseline import Baseline, Key
    from dancetutor_cli.lint.results import ResultCache


@dataclass(frozen=True, slots=True)
class LintRequest(ResultOptions):
    """The options of the command line. The configuration decides where an option is None.

    config : file or name of a configuration; assignments : "key=value"; select, ignore : rules
    sync : whether the music is decoded even if the configuration does not say so
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
    sync: bool = False


@dataclass
class LintRun:
    """The settings of a run for each file, and its baseline: makes a task of a file, and of a result what is reported.

    Files share a settings file, its configuration and its choice of presets; each is read once.
    """

    request: LintRequest
    _configurations: dict[Path | None, Configuration] = field(default_factory=dict)
    _settings_files: dict[Path, Path | None] = field(default_factory=dict)
    _preset_choices: dict[int, PresetChoice] = field(default_factory=dict)
    _baseline: Baseline | None = None
    _found_keys: list[Key] = field(default_factory=list)

    def configuration(self, path: Path) -> Configuration:
        """Return the configuration for a file: --config or the nearest dancetutor.yaml, with the command line on top.

        The nearest dancetutor.yaml is in the file's folder or in a folder above it.
        """
        given = self.request.config
        source = None if given is not None else self._settings_file(path.parent)
        if source not in self._configurations:
            loaded = load_configuration(given if given is not None else source, found=given is None)
            loaded = with_assignments(loaded, self.request.assignments)
            if self.request.sync:
                loaded = replace(loaded, settings=replace(loaded.settings, sync=True))
            self._configurations[source] = with_selection(loaded, self.request.select, self.request.ignore)
        return self._configurations[source]

    def _settings_file(self, folder: Path) -> Path | None:
        if folder not in self._settings_files:
            self._settings_files[folder] = find_settings_file(folder)
        return self._settings_files[folder]

    def presets(self, path: Path) -> PresetChoice:
        """Return the choice of cost presets for a file's charts; UsageError or FileError if one cannot be loaded."""
        configuration = self.configuration(path)
        if id(configuration) not in self._preset_choices:  # all files of a source share it, see `_configurations`
            self._preset_choices[id(configuration)] = choice_of(self.request.preset, configuration.presets)
        return self._preset_choices[id(configuration)]

    def needs(self, path: Path) -> Iterator[Path]:
        """Yield the other files on which a file's findings depend, existing or not: feet, settings, presets, baseline.

        If a configuration cannot be read, the files that it names are left out, without an error.
        """
        yield from places_of_feet(path)
        yield from twin_names(path)
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
        """Return the task for a file."""
        settings, request = self.configuration(path).settings, self.request
        return AnalyzeTask(path, self.presets(path), request.selection, settings, data, **request.options())

    def tasks(self, files: Iterable[tuple[Path, bytes | None]]) -> list[AnalyzeTask]:
        """Return the task for each file, or for the bytes of standard input under its name."""
        return [self.task(path, data) for path, data in files]

    def with_packs(self, results: Iterable[FileResult]) -> Iterator[FileResult]:
        """Yield the results, then one result for each pack with findings about its songs together."""
        packs = PackSyncs()
        for result in results:
            packs.add(result)
            yield result
        for folder in packs.folders:
            settings = self.configuration(folder / "Pack.ini").settings
            if (found := packs.result(folder, settings)) is not None:
                yield found

    def fail_on(self, path: Path) -> str:
        """Return the least severity that fails the run, from the command line or the configuration of this file."""
        return self.request.fail_on or self.configuration(path).fail_on or "warning"

    def open_baseline(self, path: Path) -> None:
        """Read the baseline that the command line, or the configuration of this file, names."""
        where = self.request.baseline or self.configuration(path).baseline
        if where is None and self.request.update_baseline:
            where = Path("dancetutor-baseline.json")
        if where is not None:
            from dancetutor_cli.lint.baseline import Baseline, load_baseline

            is_new = self.request.update_baseline and not where.exists()
            self._baseline = Baseline(where) if is_new else load_baseline(where)

    @property
    def has_baseline(self) -> bool:
        """Whether findings are compared with a baseline."""
        return self._baseline is not None

    def without_baseline(self, result: FileResult) -> FileResult:
        """Return the result without the findings that the baseline accepts."""
        baseline = self._baseline
        if baseline is None or result.error is not None:
            return result
        self._note_rules_run(baseline, result)
        found = [(f, chart, baseline.key(result.path, _name(chart), f)) for f, chart in result.all_findings()]
        self._found_keys += [key for _, _, key in found]
        known = self.request.update_baseline  # all findings are accepted from now on
        left = [(f, chart) for f, chart, key in found if not known and not baseline.absorbs(key)]
        of_chart: dict[int, list[Finding]] = {}
        for finding, chart in left:
            of_chart.setdefault(id(chart), []).append(finding)
        charts = tuple(replace(chart, findings=tuple(of_chart.get(id(chart), ()))) for chart in result.charts)
        return replace(result, findings=tuple(of_chart.get(id(None), ())), charts=charts)

    def _note_rules_run(self, baseline: Baseline, result: FileResult) -> None:
        path = Path(result.path).absolute()
        settings = self.configuration(Path(result.path)).settings
        baseline.mark_seen(result.path, "", settings.for_file(path))
        for chart in result.charts:
            rules = settings.for_chart(path, chart.steps_type, chart.difficulty, chart.meter)
            baseline.mark_seen(result.path, _name(chart), rules)
        if not result.unselected:
            baseline.mark_all_seen(result.path)

    def close_baseline(self) -> list[str]:
        """Write the baseline if the user wants it; return the messages about it."""
        if self._baseline is None:
            return []
        path = self._baseline.path
        if self.request.update_baseline:
            new = self._baseline.replaced(self._found_keys)
            new.write()
            others = sum(new.allowed.values()) - len(self._found_keys)
            kept = f", {others} of other files and rules kept" if others else ""
            return [f"{path}: {plural(len(self._found_keys), 'finding')} written{kept}"]
        unused = self._baseline.unused_keys()
        if not unused:
            return []
        what = "1 entry is" if len(unused) == 1 else f"{len(unused)} entries are"
        file, chart, rule, place = unused[0]
        first = f"{file} {chart} {rule} " + (f"beat {place / TICKS_PER_BEAT:g}" if chart else f"line {place}")
        return [f"{path}: {what} no longer needed (the first: {first}); --update-baseline removes them"]


def _name(chart: ChartResult | None) -> str:
    return (
        ""
        if chart is None
        else f"{chart.steps_type} {chart.difficulty} {chart.description}".strip() + chart.player_suffix
    )


# Many files: results come from the cache, from this process or from worker processes, always in order.

# Below this number of files the start of workers costs more than they save.
_WORTH_WORKERS = 8
_SHARES = 4  # a worker gets a batch of its share of the remaining files, divided by this
_MOST_AT_ONCE = 8  # most files of a batch, because their results come together


def analyze_all(
    tasks: Sequence[AnalyzeTask],
    jobs: int | None,
    cache: ResultCache | None,
    before_work: Callable[[Sequence[AnalyzeTask]], None] = lambda tasks: None,
) -> Iterator[FileResult]:
    """Yield the result of every task in the order of the tasks, each as early as possible.

    jobs : worker processes for results that are not in the cache; None: one for each core, 1: this process
    before_work : called with the tasks whose results are not in the cache, if there are any
    """
    keys = [cache.key(task) if cache else None for task in tasks]
    known = {n: found for n, key in enumerate(keys) if cache and key and (found := cache.get(key)) is not None}
    missing = [n for n in range(len(tasks)) if n not in known]
    if cache and missing:
        cache.prune()
    if missing:
        before_work([tasks[n] for n in missing])
    new = [tasks[n] for n in missing]
    has_workers = jobs != 1 and len(missing) >= _WORTH_WORKERS
    fresh = _in_workers(new, jobs) if has_workers else ((n, one, True) for n, one in enumerate(analyze_files(new)))
    done: dict[int, FileResult] = dict(known)
    for n in range(len(tasks)):
        while n not in done:
            place, result, sound = next(fresh)
            done[missing[place]] = result
            key = keys[missing[place]]
            if cache and key and sound:
                cache.put(key, result)
        yield done.pop(n)


# Index and result of each task, and whether the result is sound: false if a worker failed.
_Fresh = Iterator[tuple[int, FileResult, bool]]


def _in_workers(tasks: Sequence[AnalyzeTask], jobs: int | None) -> _Fresh:
    from dancetutor_cli.run.pool import Task as Work
    from dancetutor_cli.run.pool import default_jobs, open_workers

    count = jobs or default_jobs()
    workers = open_workers(count)
    try:
        for places in _batches(len(tasks), count):
            workers.submit(Work(places, _analyze, ([tasks[place] for place in places],)))
        for done in workers.results():
            if done.error is None:
                for place, result in zip(done.key, done.result, strict=True):
                    yield place, result, True
            elif len(done.key) > 1:  # one of the files has failed: each is tried again alone
                for place in done.key:
                    workers.submit(Work(range(place, place + 1), _analyze, ([tasks[place]],)))
            else:
                yield done.key[0], failure_result(tasks[done.key[0]], str(done.error)), False
    finally:
        workers.close()


def _batches(tasks: int, jobs: int) -> Iterator[range]:
    """Yield the indices of the tasks in each batch for a worker.

    At first a batch has many tasks, which are neighbours with similar charts, so that workers rarely wait. In the end
    it has one task, so that all workers end at about the same time.
    """
    first = 0
    while first < tasks:
        after = first + min(max((tasks - first) // (_SHARES * jobs), 1), _MOST_AT_ONCE)
        yield range(first, after)
        first = after


def _analyze(tasks: Sequence[AnalyzeTask]) -> list[FileResult]:
    return list(analyze_files(tasks))


# Wait until files are saved, in the same way on every system, by checking their times and sizes.

Stamp = tuple[int, int]
INTERVAL = 0.3  # seconds between two checks
_SETTLED = 0.15  # seconds; a file counts as saved if it has not changed for so long, because editors write in parts


def changes(
    files: Callable[[], Sequence[Path]],
    needs: Callable[[Path], Iterable[Path]] = lambda _: (),
    wait: Callable[[float], None] = time.sleep,
) -> Iterator[tuple[list[Path], list[Path]]]:
    """Yield (all files, new or saved files) at once, then after every change; ends with KeyboardInterrupt.

    files : function that finds the files again, so that new charts are found
    needs : function that returns the other files on which a file's result depends, existing or not; a change of these
        counts as a change of the file
    wait : function that sleeps for some seconds
    """
    known: dict[Path, Stamp] = {}
    before: list[Path] | None = None
    while True:
        found = list(files())
        watched = {path: [path, *needs(path)] for path in found}
        seen = {path: _stamp(path) for path in {path for group in watched.values() for path in group}}
        changed = [path for path, group in watched.items() if path not in known or _differ(group, known, seen)]
        if changed and before is not None:
            wait(_SETTLED)
            if any(_stamp(path) != stamp for path, stamp in seen.items()):
                continue  # still being written
        known = seen
        if changed or before is None or set(before) - set(found):
            before = found
            yield found, changed
        wait(INTERVAL)


def _differ(paths: Collection[Path], known: Mapping[Path, Stamp], seen: Mapping[Path, Stamp]) -> bool:
    """Whether one of the paths has another stamp than before. A path that was not watched before does not count."""
    return any(path in known and known[path] != seen[path] for path in paths)


def _stamp(path: Path) -> Stamp:
    try:
        status = path.stat()
    except OSError:
        return (-1, -1)
    return status.st_mtime_ns, status.st_size
