"""The options of `analyze` as a record, the checks of their combinations, the view of findings; `--show-settings`."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import click

from dancetutor_cli.commands.arguments import Source
from dancetutor_cli.run.errors import DancetutorError, UsageError
from dancetutor_cli.run.foreign_text import safe_path

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart
    from dancetutor_cli.lint.run import LintRun


@dataclass(frozen=True, slots=True)
class AnalyzeOptions:
    """The options without those of the charts (`chart.selection.Selection`); None for options that are not given.

    full : whether findings are shown in full, else in brief; for the other options, see their help
    """

    paths: tuple[Path, ...]
    preset: str | None
    format_name: str
    output_file: Path | None
    fail_on: str | None
    exit_zero: bool
    select: tuple[str, ...]
    ignore: tuple[str, ...]
    config: str | None
    assignments: tuple[str, ...]
    show_settings: bool
    baseline: Path | None
    update_baseline: bool
    quiet: bool
    exclude: tuple[str, ...]
    full: bool | None
    statistics: bool
    sheet: Path | None
    language: str | None
    sync: bool
    plot: Path | None
    suggest: bool
    alternatives: int
    fix: tuple[str, ...]
    diff: bool
    backup: bool
    report_html: Path | None
    compare: str | None
    tech_counts: Path | None
    meter_scale: str
    rate: float
    watch: bool
    jobs: int | None
    no_cache: bool
    stdin_filename: Path | None

    def check(self) -> None:
        """Raise UsageError for an option without the option that it needs."""
        if self.language is not None and self.sheet is None:
            raise UsageError("--language belongs to --sheet; add --sheet")
        if self.plot is not None and not self.sync:
            raise UsageError("--plot draws what --sync finds; add --sync")
        if not self.fix and (self.diff or self.backup):
            raise UsageError("--diff and --backup belong to --fix; add --fix RULE or --fix safe")

    def view(self, output: IO[str]) -> str:
        """Return how findings are shown: a format or, for text, also "full", "brief" or "none"."""
        if self.format_name != "text":
            return self.format_name
        if self.full is not None:
            return "full" if self.full else "brief"
        if self.alternatives:
            return "full"
        if self.report_html is not None or self.sheet is not None or self.statistics:
            return "none"
        if output.isatty():
            return "full" if self.suggest else "brief"
        return "text"


# `analyze --show-settings`: the settings of files and their charts, printed as one complete dancetutor.yaml.

_Rules = Mapping[str, Mapping[str, Any]]


def show_settings(run: LintRun, files: list[Source]) -> int:
    """Print the settings of the first file of each configuration. Returns the exit status, 0."""
    seen: set[tuple[Path, ...]] = set()
    for path, data in files:
        sources = run.configuration(path).sources
        if sources not in seen:
            if seen:
                click.echo("---")
            seen.add(sources)
            for line in _lines(run, path, data):
                click.echo(line)
    return 0


def _lines(run: LintRun, path: Path, data: bytes | None) -> Iterator[str]:
    configuration, settings = run.configuration(path), run.configuration(path).settings
    yield f"# {safe_path(str(path))}, by {', '.join(safe_path(str(source)) for source in configuration.sources)}"
    yield f"fail-on: {run.fail_on(path)}"
    if baseline := run.request.baseline or configuration.baseline:
        yield f"baseline: {_quoted(str(baseline))}"
    yield f"stream-rows: {settings.stream_rows}"
    yield f"sure-feet: {settings.sure_feet:g}"
    yield f"coin-toss: {settings.coin_toss}"
    base = settings.for_file(path.absolute())
    yield "rules:"
    yield from (f"  {line}" for line in _rule_lines(base, _all_off()))
    found = list(_charts(path, data))
    overrides = []
    for kind in dict.fromkeys((one.steps_type, one.difficulty, one.meter) for one in found):
        lines = list(_rule_lines(settings.for_chart(path.absolute(), *kind), base))
        when = f"{{steps-type: {_quoted(kind[0])}, difficulty: {_quoted(kind[1])}, meter: {kind[2]}}}"
        preset = next(_preset(run, path, one) for one in found if (one.steps_type, one.difficulty, one.meter) == kind)
        overrides += [f"  - when: {when}", f"    preset: {_quoted(preset)}"]
        overrides += ["    rules:", *(f"      {line}" for line in lines)] if lines else []
    yield from ["overrides:", *overrides] if overrides else []


def _preset(run: LintRun, path: Path, chart: Chart) -> str:
    from dancetutor_cli.feet.preset import preset_for

    return preset_for(chart, path, run.presets(path)).name


def _all_off() -> _Rules:
    """Return rules without settings, to compare the first settings with."""
    from dancetutor_cli.lint.rule import all_rules

    return {code: {"severity": None} for code in all_rules()}


def _rule_lines(rules: _Rules, before: _Rules) -> Iterator[str]:
    """Yield a line for each rule with the settings that differ from `before`; a rule that does not run is off."""
    from dancetutor_cli.lint.rule import all_rules

    for code, rule in all_rules().items():
        now, old = rules.get(code, {"severity": "off"}), before.get(code, {"severity": "off"})
        changed = {key: value for key, value in now.items() if old.get(key) != value}
        if changed:
            words = ", ".join(f"{key}: {_quoted(value)}" for key, value in changed.items())
            yield f"{code}: {{{words}}}  # {rule.name}"


def _quoted(value: object) -> str:
    """Return a value as YAML on one line."""
    return json.dumps(value, ensure_ascii=False)


def _charts(path: Path, data: bytes | None) -> tuple[Chart, ...]:
    """Return the charts of a file; none if it cannot be read, which `analyze` reports."""
    from dancetutor_cli.chart import reader

    try:
        return (reader.load(path) if data is None else reader.parse(data, path)).charts
    except (DancetutorError, OSError):
        return ()
