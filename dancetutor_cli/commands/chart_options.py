"""The options that say which charts of a song are meant, and with which cost preset; the same for every subcommand."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

from dancetutor_cli.commands.arguments import GivenPath, characters, difficulties, folder, named, steps_types
from dancetutor_cli.run.errors import UsageError, did_you_mean
from dancetutor_cli.run.reading import config_names

TABLE = "-"  # the value of --report without a file

_Command = TypeVar("_Command", bound=Callable[..., Any])


def combined(*options: Callable[[_Command], _Command]) -> Callable[[_Command], _Command]:
    """One decorator that adds several options, in the order of --help."""

    def decorate(command: _Command) -> _Command:
        for option in reversed(options):
            command = option(command)
        return command

    return decorate


def number(_context: click.Context, _option: click.Parameter, value: float) -> float:
    """The value, unless it is nan, which no range keeps out."""
    if value != value:
        raise click.BadParameter("nan is not a number.")
    return value


# Decorators: a command gets the value of each option by its name.

selection_options = combined(
    click.option(
        "--steps-type",
        metavar="TYPE",
        shell_complete=named(steps_types, files=False),
        help="Only charts of this steps type, for example dance-single.",
    ),
    click.option(
        "--difficulty",
        metavar="NAME",
        shell_complete=named(difficulties, files=False),
        help="Only charts of this difficulty, for example hard.",
    ),
    click.option("--index", type=click.IntRange(min=0), metavar="N", help="Only the chart at this place, from 0."),
    click.option(
        "--player", type=click.IntRange(min=1), metavar="N", help="Of charts for several: only this player, from 1."
    ),
)

preset_option = click.option(
    "--preset",
    shell_complete=named(folder("presets")),
    metavar="NAME|FILE",
    help="Cost preset of the solver.  [default: as dancetutor.yaml says, else pump for pump-*, smx for smx-*, itg "
    "for others]",
)

verbose_option = click.option(
    "-v", "--verbose", is_flag=True, help="Tell each warning; else what is the same of many files is one line."
)

quiet_option = click.option("-q", "--quiet", is_flag=True, help="Say nothing but what fails the run.")

exclude_option = click.option(
    "--exclude",
    multiple=True,
    metavar="PATTERN",
    help="Of a folder: leave out what has this name or path below it, such as Old, '*.sm' or 'Old/*'.",
)

section_option = click.option(
    "--section",
    metavar="START:END",
    help="Only this part: seconds (10:25), beats (b16:b48), measures (m4:m12), what is around the third "
    "finding of a rule (DT201:3), or the third hardest passage (hardest:3).",
)

character_option = click.option(
    "--character",
    shell_complete=named(characters),
    default="dancer",
    show_default=True,
    metavar="NAME|FILE",
    help="Who dances: dancer, mannequin, or a humanoid from a .glb or .vrm file.",
)

gait_option = click.option(
    "--gait",
    shell_complete=named(folder("gaits")),
    default="flat",
    show_default=True,
    metavar="NAME|FILE",
    help="How she walks on and off: flat, heels, or a file as those in configs/gaits.",
)

form_option = click.option(
    "--form",
    shell_complete=named(folder("forms")),
    default="usual",
    show_default=True,
    metavar="NAME|FILE",
    help="How she stands and turns: usual, middle, edge, heels-in, heels-out, screen, turning, or a file as those "
    "in configs/forms.",
)

style_option = click.option(
    "--style",
    shell_complete=named(folder("styles")),
    metavar="NAME|FILE",
    help="A ragdoll follows her in this style: neutral, lazy, fierce, heavy, feminine, or a file as those in "
    "configs/styles.",
)

motion_option = click.option(
    "--motion",
    type=GivenPath(),
    metavar="FILE",
    help="How she moves: a YAML file that names the numbers of configs/motion.yaml that it changes.",
)

push_options = combined(
    click.option(
        "--push",
        multiple=True,
        metavar="TIME:FORCE:DIRECTION",
        help="Somebody pushes her: second of the song, newtons, and ahead, left, back, right or degrees to her left.",
    ),
    click.option(
        "--trip",
        type=float,
        multiple=True,
        metavar="TIME",
        help="Something catches the foot that swings at this second of the song.",
    ),
)


def report_option(words: str) -> Callable[[_Command], _Command]:
    """Adds --report with these words; the function gets `report_to`: a file's name, `TABLE` without one, or None."""
    return click.option("--report", "report_to", is_flag=False, flag_value=TABLE, metavar="[FILE.json]", help=words)


def language_option(text: str, default: str | None = None) -> Callable[[_Command], _Command]:
    """Makes --language; the function gets keyword argument `language`, a name of configs/languages. text : its help."""
    return click.option(
        "--language",
        shell_complete=named(folder("languages"), files=False),
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
    raise UsageError(f"there is no language '{value}'{did_you_mean(value, names)}; there are: {', '.join(names)}")
