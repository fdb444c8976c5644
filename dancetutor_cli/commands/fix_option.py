"""`analyze --fix`: the requested fixes, the files that are corrected, and the messages about them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from dancetutor_cli.chart.selection import twin
from dancetutor_cli.commands.arguments import report_error, warn, within_folders
from dancetutor_cli.lint.analysis import analyze_file
from dancetutor_cli.lint.fix import FIXABLE, FixOutcome, FixTask, fix_file, pick
from dancetutor_cli.lint.rule import rule_named
from dancetutor_cli.reports.terminal import colour_diff
from dancetutor_cli.run.errors import UsageError, plural
from dancetutor_cli.run.foreign_text import safe

if TYPE_CHECKING:
    from dancetutor_cli.commands.analyze_options import AnalyzeOptions
    from dancetutor_cli.lint.analysis import AnalyzeTask
    from dancetutor_cli.lint.findings import Finding
    from dancetutor_cli.lint.results import FileResult
    from dancetutor_cli.lint.run import LintRun

SAFE = "safe"
# Options of `analyze` that cannot be used with --fix, which prints no report.
_OF_REPORTS = ("sheet", "watch", "suggest", "alternatives", "update_baseline", "statistics", "stdin_filename")


@dataclass(frozen=True, slots=True)
class FixRequest:
    """One `--fix`: all findings of a rule, or only the finding with a number, from 1; rule `SAFE`: the safe fixes."""

    rule: str
    number: int | None = None


def _parse_fix_request(text: str) -> FixRequest:
    """Return the request of the option's text. Raises UsageError for a rule that has no fix."""
    if text.strip().lower() == SAFE:
        return FixRequest(SAFE)
    match = re.fullmatch(r"\s*([^:]+?)\s*(?::\s*([1-9]\d{0,8})\s*)?", text)
    if match is None:
        raise UsageError(f"--fix '{text}': write a rule, such as DT202, one of its findings, such as DT202:3, or safe")
    rule = rule_named(match[1])
    if rule.code not in FIXABLE:
        raise UsageError(f"--fix {text}: {rule.code} {rule.name} has no fix; {', '.join(FIXABLE)} have one, and safe")
    return FixRequest(rule.code, int(match[2]) if match[2] else None)


def fix_all(run: LintRun, tasks: Sequence[AnalyzeTask], options: AnalyzeOptions) -> int:
    """Correct every file, and print the results. Returns the exit status: 1 if a requested finding remains."""
    wanted = [_parse_fix_request(text) for text in options.fix]
    _check(tasks, options)
    messages = _Messages(diff=options.diff)
    files = within_folders(options.paths, [task.path for task in tasks])
    tasks = [task for task in tasks if task.path in files]
    meant = {task.path.absolute() for task in tasks}
    for task in tasks:
        outcome = _fix(run, task, wanted, options)
        messages.show(task.path, outcome)
        other = twin(task.path)
        if outcome.fixed and other is not None and other.absolute() not in meant:
            warn([f"{other}: the same song in another file, which was not named and is unchanged; correct it as well"])
    return messages.end()


def _check(tasks: Sequence[AnalyzeTask], options: AnalyzeOptions) -> None:
    """Raise UsageError for options that cannot be used with --fix."""
    if options.format_name != "text":
        raise UsageError("--fix prints only text; leave --format out")
    for name in _OF_REPORTS:
        if getattr(options, name):
            raise UsageError(f"--{name.replace('_', '-')} cannot be used with --fix; run analyze again for it")
    if any(task.data is not None for task in tasks):
        raise UsageError("--fix writes into files, not into standard input")


def _fix(run: LintRun, task: AnalyzeTask, wanted: Sequence[FixRequest], options: AnalyzeOptions) -> FixOutcome:
    result = run.without_baseline(analyze_file(task))
    if result.error is not None:
        return FixOutcome(error=result.error)
    findings = tuple(finding for one in wanted if one.rule != SAFE for finding in _of_file(result, one))
    safe = any(one.rule == SAFE for one in wanted)
    return fix_file(FixTask(task, findings, safe, write=not options.diff, backup=options.backup))


def _of_file(result: FileResult, asked_for: FixRequest) -> tuple[tuple[Finding, int], ...]:
    findings = [(finding, chart.player) for chart in result.charts for finding in chart.findings]
    text = f"--fix {asked_for.rule}:{asked_for.number}"
    if asked_for.number is not None and len(result.charts) > 1:
        has = ", ".join(chart.label for chart in result.charts[:12])
        raise UsageError(
            f"{text}: {result.path} has {len(result.charts)} charts, so choose one by --steps-type, --difficulty, "
            f"--index or --player: {has}"
        )
    found = pick(findings, asked_for.rule, asked_for.number)
    if asked_for.number is not None and not found:
        many = len(pick(findings, asked_for.rule, None))
        raise UsageError(f"{text}: {result.path} has {plural(many, 'finding')} of {asked_for.rule}")
    return found


@dataclass
class _Messages:
    """The messages and the exit status of a run. diff : whether changes are only shown, and not written"""

    diff: bool
    files: int = 0
    changed: int = 0
    fixed: int = 0
    unfixed: int = 0
    failed: int = 0

    def show(self, path: Path, outcome: FixOutcome) -> None:
        self.files += 1
        if outcome.error is not None:
            self.failed += 1
            report_error(outcome.error)
            return
        for line in colour_diff(outcome.diff) if self.diff else ():
            click.echo(line)
        self.fixed += len(outcome.fixed)
        self.unfixed += sum(not one.is_gone for one in outcome.unfixed)
        self.changed += bool(outcome.fixed)
        for done in outcome.fixed:
            what = f"{done.fix.rule} " if done.finding is None else f"{done.finding.rule} {done.finding.name} "
            line_number = min(done.fix.lines)
            self._say(f"{path}:{line_number}: {what}[{done.chart}] {'would ' if self.diff else ''}{done.fix.words}")
        for left in outcome.unfixed:
            one = left.finding
            what = "gone" if left.is_gone else "left alone"
            self._say(f"{path}:{one.line}: {one.rule} {one.name} [{left.chart}] {what}: {left.reason}")
        warn(outcome.notes)

    def _say(self, text: str) -> None:
        """Print a line. With --diff, only the diff goes to standard output, so that `patch` can read it."""
        click.echo(safe(text), err=self.diff)

    def end(self) -> int:
        would = "would change" if self.diff else "changed"
        edits = f"{self.changed} {would} by {plural(self.fixed, 'edit')}"
        text = f"{plural(self.files, 'file')}: {edits if self.fixed else 'nothing to change'}"
        text += f", {plural(self.unfixed, 'finding')} left alone" if self.unfixed else ""
        click.echo(text + (f", {self.failed} failed" if self.failed else ""), err=self.diff)
        return 2 if self.failed else int(bool(self.unfixed))
