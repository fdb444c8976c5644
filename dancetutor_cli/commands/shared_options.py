"""Options with one meaning in several commands, as a record for each command; `--report` and `--plot` of a motion."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from dancetutor_cli.commands.arguments import (
    GivenPath,
    Second,
    WholeNumber,
    characters,
    completer_of,
    difficulties,
    folder,
    steps_types,
)
from dancetutor_cli.run.errors import UsageError, choose_text
from dancetutor_cli.run.files import check_file, write_atomic
from dancetutor_cli.run.reading import config_names

if TYPE_CHECKING:
    from dancetutor_cli.chart.selection import Selection
    from dancetutor_cli.dance.quality.figures import MotionReport
    from dancetutor_cli.dance.request import DanceRequest

TABLE = "-"  # the value of --report without a file

_Command = TypeVar("_Command", bound=Callable[..., Any])


def combined(*options: Callable[[_Command], _Command]) -> Callable[[_Command], _Command]:
    """Return one decorator that adds several options, in the order of --help."""

    def decorate(command: _Command) -> _Command:
        for option in reversed(options):
            command = option(command)
        return command

    return decorate


def into(name: str, kind: type) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Return a decorator that gives a command one argument `name`, a `kind`, in place of the options of its fields.

    A field with a default may have no option. The decorator is placed below the options: ``@options`` first, then
    ``@into("options", CommandOptions)``, then the function.
    """
    known = tuple(field.name for field in fields(kind))

    def decorate(command: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(command)
        def gathered(**given: Any) -> Any:
            record = kind(**{field: given.pop(field) for field in known if field in given})
            return command(**given, **{name: record})

        return gathered

    return decorate


def same_fields(options: Any, kind: type) -> dict[str, Any]:
    """Return the options that are called like fields of `kind`, for a request that is made of them."""
    known = {field.name for field in fields(kind)}
    return {field.name: getattr(options, field.name) for field in fields(options) if field.name in known}


# Decorators: a command gets the value of each option by its name.

selection_options = combined(
    click.option(
        "--steps-type",
        metavar="TYPE",
        shell_complete=completer_of(steps_types, files=False),
        help="Only charts of this steps type, such as dance-single.",
    ),
    click.option(
        "--difficulty",
        metavar="NAME",
        shell_complete=completer_of(difficulties, files=False),
        help="Only charts of this difficulty, such as hard.",
    ),
    click.option(
        "--index", type=WholeNumber(0), metavar="N", help="Only the chart with this number in the file; the first is 0."
    ),
    click.option(
        "--player",
        type=WholeNumber(1),
        metavar="N",
        help="In charts for several players: only this player; the first is 1.",
    ),
)

preset_option = click.option(
    "--preset",
    shell_complete=completer_of(folder("presets")),
    metavar="NAME|FILE",
    help="Costs that the solver uses.  [default: as dancetutor.yaml says, or pump for pump-*, smx for smx-*, itg for "
    "other steps types]",
)

verbose_option = click.option(
    "-v",
    "--verbose",
    is_flag=True,
    help="Print every warning. Without it, a warning that many files share is printed once.",
)

quiet_option = click.option("-q", "--quiet", is_flag=True, help="Print only what makes the run fail.")

exclude_option = click.option(
    "--exclude",
    multiple=True,
    metavar="PATTERN",
    help="For a folder: skip files and folders with this name or path, such as Old, '*.sm' or 'Old/*'.",
)

yes_option = click.option("--yes", is_flag=True, help="Do not ask, even if the song is very long.")

section_option = click.option(
    "--section",
    metavar="START:END",
    help="Only this part: seconds (10:25), beats (b16:b48), measures (m4:m12), around the third finding of a rule "
    "(DT201:3), or the third hardest passage (hardest:3).",
)

character_option = click.option(
    "--character",
    shell_complete=completer_of(characters),
    default="dancer",
    show_default=True,
    metavar="NAME|FILE",
    help="Who moves: dancer, dancer-heels, mannequin, or a humanoid from a .glb or .vrm file.",
)

# How a chart is danced: fields of `dance.request.DanceRequest`.
dance_options = combined(
    click.option(
        "--play",
        type=GivenPath(),
        metavar="FILE.json",
        help="Take the feet from this JSON file of analyze, not from the solver.",
    ),
    click.option(
        "--gait",
        shell_complete=completer_of(folder("gaits")),
        default="flat",
        show_default=True,
        metavar="NAME|FILE",
        help="How the dancer walks on and off the pad: flat, heels, or a file like those in configs/gaits.",
    ),
    click.option(
        "--form",
        shell_complete=completer_of(folder("forms")),
        default="usual",
        show_default=True,
        metavar="NAME|FILE",
        help="Where the feet land and how the body turns: usual, middle, edge, heels-in, heels-out, screen, turning, "
        "or a file like those in configs/forms.",
    ),
    click.option(
        "--motion",
        type=GivenPath(),
        metavar="FILE",
        help="How the dancer moves: a YAML file with the numbers of configs/motion.yaml that you change.",
    ),
    click.option(
        "--bar", is_flag=True, help="Let the dancer hold the bar behind the pad, as players of hard charts do."
    ),
)

# The ragdoll that follows a dance or a capture, and disturbances of it.
ragdoll_options = combined(
    click.option(
        "--style",
        shell_complete=completer_of(folder("styles")),
        metavar="NAME[:WEIGHT],...",
        help="Add physics: a ragdoll follows the motion. NAME is neutral, lazy, fierce, heavy, feminine, or a style "
        "file like those in configs/styles. In a dance to a chart, a style also changes the steps. Blend styles with "
        "weights, such as fierce:0.6,heavy:0.4.",
    ),
    click.option(
        "--push",
        multiple=True,
        metavar="TIME:FORCE:DIRECTION",
        help="Push the dancer: second of the song or capture, newtons, and ahead, left, back, right or degrees to "
        "the left.",
    ),
    click.option(
        "--trip",
        type=Second(),
        multiple=True,
        metavar="TIME",
        help="Make the dancer stumble: something catches the foot in the air at this second of the song or capture.",
    ),
)


@dataclass(frozen=True, slots=True)
class DanceOptions:
    """The options of a command about the dance, with the names of fields of `dance.request.DanceRequest`."""

    preset: str | None
    play: Path | None
    bar: bool
    gait: str
    form: str
    motion: Path | None
    style: str | None = None
    push: tuple[str, ...] = ()
    trip: tuple[float, ...] = ()

    def request(self, path: Path, selection: Selection) -> DanceRequest:
        """Return the request of the dance for one chart of a file."""
        from dancetutor_cli.dance.request import DanceRequest

        return DanceRequest(path, selection, **same_fields(self, DanceRequest))


def jobs_option(words: str) -> Callable[[_Command], _Command]:
    """Return --jobs for a command that usually runs in one process. words : the work that more processes speed up"""
    return click.option(
        "--jobs",
        type=WholeNumber(1, 256),
        default=1,
        show_default=True,
        metavar="N",
        help=f"Number of processes. More than one is faster for {words}.",
    )


def report_option(words: str) -> Callable[[_Command], _Command]:
    """Return --report with a help text; the command gets `report_to`: a file's name, `TABLE` without one, or None."""
    return click.option("--report", "report_to", is_flag=False, flag_value=TABLE, metavar="[FILE.json]", help=words)


def language_option(text: str, default: str | None = None) -> Callable[[_Command], _Command]:
    """Return --language; the command gets the argument `language`, a name in configs/languages. text : its help"""
    return click.option(
        "--language",
        shell_complete=completer_of(folder("languages"), files=False),
        metavar="|".join(config_names("languages")),
        default=default,
        show_default=default is not None,
        callback=_language,
        help=text,
    )


def _language(context: click.Context, option: click.Parameter, value: str | None) -> str | None:
    names = config_names("languages")
    if value is None or value in names:
        return value
    raise UsageError(f"there is no language '{value}'{choose_text(value, names)}")


# The motion of a dancer as output: `--report` and `--plot` of `animate` and `retarget`.


def check_targets(report_to: str | None, plot: Path | None) -> None:
    """Raise UsageError for a report or a plot that could not be written. report_to : as `report_option` gives it"""
    if plot is not None:
        check_file(plot, (".svg", ".png"))
    if report_to is not None and report_to != TABLE:
        check_file(Path(report_to), (".json",), or_device=True)


def write_report(report: MotionReport, report_to: str | None, plot: Path | None) -> None:
    """Print a report as a table if `report_to` is set; write it as JSON and as a diagram if files are named."""
    from dancetutor_cli.reports.motion_report import as_json, print_report, write_curves

    if report_to is not None:
        print_report(report)
        for note in report.notes:
            click.echo(f"note: {note}")
        if report_to != TABLE:
            write_atomic(Path(report_to), (json.dumps(as_json(report), indent=1) + "\n").encode())
            click.echo(f"{report_to}: the report")
    if plot is not None:
        write_curves(plot, report)
        click.echo(f"{plot}: the plot")
