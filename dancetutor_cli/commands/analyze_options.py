"""The options of `analyze` as a record, with checks of their combinations and the view of findings."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import IO

from dancetutor_cli.run.errors import UsageError


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
