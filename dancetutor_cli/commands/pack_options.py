"""Options of `analyze` about how hard charts play, and about a pack as a whole."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

from dancetutor_cli.commands.chart_options import number
from dancetutor_cli.commands.paths import GivenPath
from dancetutor_cli.meter.bill import AUTO, SCALES

Command = TypeVar("Command", bound=Callable[..., Any])

_OPTIONS = (
    click.option(
        "--report-html",
        type=GivenPath(dir_okay=False),
        metavar="FILE.html",
        help="Write the page of a pack: charts by meter and technique, pictures, outliers, what is missing.",
    ),
    click.option(
        "--compare",
        type=GivenPath(exists=True),
        metavar="OTHER",
        help="Tell what changed since another version of PATH, by chart and row.  [format text]",
    ),
    click.option(
        "--beside",
        type=GivenPath(exists=True),
        metavar="CACHE|FILE.csv",
        help="Print only a table: our technique counts beside those that ITGmania wrote into its Cache/Songs, or a "
        "table's. With --full every chart that differs.",
    ),
    click.option(
        "--meter-scale",
        type=click.Choice(SCALES),
        default=AUTO,
        show_default=True,
        help="The scale that the estimated meters of dance charts are on; auto: that of the song's other charts.",
    ),
    click.option(
        "--rate",
        type=click.FloatRange(min=0.1, max=10),
        default=1.0,
        show_default=True,
        callback=number,
        help="Estimate meters for music that plays at this rate; the feet stay those of rate 1.",
    ),
)


def pack_options(command: Command) -> Command:
    """Add --report-html, --compare, --beside, --meter-scale and --rate to a command."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command
