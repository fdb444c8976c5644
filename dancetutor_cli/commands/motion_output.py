"""The options `--report` and `--plot` of a command that makes a motion: the checks before the work, and the writing."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import click

from dancetutor_cli.commands.shared_options import TABLE
from dancetutor_cli.run.files import check_file, write_atomic

if TYPE_CHECKING:
    from dancetutor_cli.dance.quality.figures import MotionReport


def check_targets(report_to: str | None, plot: Path | None) -> None:
    """Raise UsageError for a report or a plot that could not be written. report_to : as `report_option` gives it"""
    if plot is not None:
        check_file(plot, (".svg", ".png"))
    if report_to is not None and report_to != TABLE:
        check_file(Path(report_to), (".json",), or_device=True)


def write_report(report: MotionReport, report_to: str | None, plot: Path | None) -> None:
    """Print a report as a table if `report_to` is set; write it as JSON and as a diagram if files are named."""
    from dancetutor_cli.reports.motion_report import as_json, print_report, write_plot

    if report_to is not None:
        print_report(report)
        for note in report.notes:
            click.echo(f"note: {note}")
        if report_to != TABLE:
            write_atomic(Path(report_to), (json.dumps(as_json(report), indent=1) + "\n").encode())
            click.echo(f"{report_to}: the report")
    if plot is not None:
        write_plot(plot, report)
        click.echo(f"{plot}: the plot")
