"""`dancetutor analyze`: find the feet of charts and lint them."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from dancetutor_cli.commands.selection import Selection, preset_option, selection_options

if TYPE_CHECKING:
    from dancetutor_cli.reports import Report


@click.command()
@click.argument("paths", nargs=-1, required=True, type=click.Path(path_type=Path), metavar="PATH...")
@selection_options
@preset_option
@click.option(
    "--format",
    "format_name",
    type=click.Choice(["text", "json"]),
    default="text",
    show_default=True,
    help="How to print the result.",
)
@click.option(
    "--fail-on",
    type=click.Choice(["error", "warning", "never"]),
    default="warning",
    show_default=True,
    help="The least severity of a finding that makes the exit status 1.",
)
@click.option("--exit-zero", is_flag=True, help="Findings do not fail the run; unreadable files still do.")
def command(
    paths: tuple[Path, ...],
    steps_type: str | None,
    difficulty: str | None,
    index: int | None,
    preset: str,
    format_name: str,
    fail_on: str,
    exit_zero: bool,
) -> int:
    """Find the feet of charts and lint them.

    PATH is a .sm or .ssc file, or a folder that is searched for them.

    Exit status: 0 no findings, 1 findings, 2 something could not be read or run.
    """
    from dancetutor_cli.jobs.analyze import Task, analyze_file, preset_name
    from dancetutor_cli.library import find_files
    from dancetutor_cli.lint.configuration import load_configuration
    from dancetutor_cli.reports.tally import Tally

    selection = Selection(steps_type, difficulty, index)
    settings = load_configuration(None).settings
    report = _report(format_name, preset_name(preset))
    tally = Tally(fail_on, exit_zero)
    report.begin()
    for path in find_files(paths):
        result = analyze_file(Task(path, preset, selection, settings, want_rows=format_name == "json"))
        tally.add(result)
        report.add(result)
    report.end(tally)
    return tally.exit_status


def _report(format_name: str, preset: str) -> Report:
    if format_name == "json":
        from dancetutor_cli.reports.json_report import JsonReport

        return JsonReport(click.get_binary_stream("stdout"), preset)
    from dancetutor_cli.reports.text import TextReport

    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="replace")
    return TextReport(sys.stdout, sys.stderr)
