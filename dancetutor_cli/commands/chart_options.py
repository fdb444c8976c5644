"""The options that say which charts of a song are meant, and with which cost preset; the same for every subcommand."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.commands.arguments import GivenPath, characters, difficulties, folder, named, steps_types
from dancetutor_cli.run.errors import UsageError, did_you_mean
from dancetutor_cli.run.reading import config_names

__all__ = [
    "TABLE",
    "Selection",
    "character_option",
    "exclude_option",
    "form_option",
    "gait_option",
    "language_option",
    "motion_option",
    "number",
    "preset_option",
    "push_options",
    "quiet_option",
    "report_option",
    "section_option",
    "selection_options",
    "style_option",
    "verbose_option",
]

TABLE = "-"  # the value of --report without a file

_Command = TypeVar("_Command", bound=Callable[..., Any])

_OPTIONS = (
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


def selection_options(command: _Command) -> _Command:
    """Add --steps-type, --difficulty and --index; make a `Selection` of the three arguments, which tells the charts."""
    for option in reversed(_OPTIONS):
        command = option(command)
    return command


def preset_option(command: _Command) -> _Command:
    """Add --preset; the function gets keyword argument `preset`, to be given to `lint.configuration`."""
    option = click.option(
        "--preset",
        shell_complete=named(folder("presets")),
        metavar="NAME|FILE",
        help="Cost preset of the solver.  [default: as dancetutor.yaml says, else pump for pump-*, smx for smx-*, itg "
        "for others]",
    )
    return option(command)


def verbose_option(command: _Command) -> _Command:
    """Add --verbose; the function gets keyword argument `verbose`, to be given to `reports.terminal`."""
    option = click.option(
        "-v", "--verbose", is_flag=True, help="Tell each warning; else what is the same of many files is one line."
    )
    return option(command)


def quiet_option(command: _Command) -> _Command:
    """Add --quiet; the function gets keyword argument `quiet`."""
    return click.option("-q", "--quiet", is_flag=True, help="Say nothing but what fails the run.")(command)


def exclude_option(command: _Command) -> _Command:
    """Add --exclude; the function gets keyword argument `exclude`, to be given to `chart.find_files`."""
    option = click.option(
        "--exclude",
        multiple=True,
        metavar="PATTERN",
        help="Of a folder: leave out what has this name or path below it, such as Old, '*.sm' or 'Old/*'.",
    )
    return option(command)


def number(_context: click.Context, _option: click.Parameter, value: float) -> float:
    """The value, unless it is nan, which no range keeps out."""
    if value != value:
        raise click.BadParameter("nan is not a number.")
    return value


def section_option(command: _Command) -> _Command:
    """Add --section; the function gets keyword argument `section`, to be given to `lint.passages`."""
    option = click.option(
        "--section",
        metavar="START:END",
        help="Only this part: seconds (10:25), beats (b16:b48), measures (m4:m12), what is around the third "
        "finding of a rule (DT201:3), or the third hardest passage (hardest:3).",
    )
    return option(command)


def character_option(command: _Command) -> _Command:
    """Add --character; the function gets keyword argument `character`, to be given to `character.load_character`."""
    option = click.option(
        "--character",
        shell_complete=named(characters),
        default="dancer",
        show_default=True,
        metavar="NAME|FILE",
        help="Who dances: dancer, mannequin, or a humanoid from a .glb or .vrm file.",
    )
    return option(command)


def gait_option(command: _Command) -> _Command:
    """Add --gait; the function gets keyword argument `gait`."""
    option = click.option(
        "--gait",
        shell_complete=named(folder("gaits")),
        default="flat",
        show_default=True,
        metavar="NAME|FILE",
        help="How she walks on and off: flat, heels, or a file as those in configs/gaits.",
    )
    return option(command)


def report_option(words: str) -> Callable[[_Command], _Command]:
    """Adds --report with these words; the function gets `report_to`: a file's name, `TABLE` without one, or None."""
    return click.option("--report", "report_to", is_flag=False, flag_value=TABLE, metavar="[FILE.json]", help=words)


def form_option(command: _Command) -> _Command:
    """Add --form; the function gets keyword argument `form`, to be given to `dance.settings.load_settings`."""
    option = click.option(
        "--form",
        shell_complete=named(folder("forms")),
        default="usual",
        show_default=True,
        metavar="NAME|FILE",
        help="How she stands and turns: usual, middle, edge, heels-in, heels-out, screen, turning, or a file as those "
        "in configs/forms.",
    )
    return option(command)


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


def style_option(command: _Command) -> _Command:
    """Add --style; the function gets keyword argument `style`, to be given to `dance.physics.style.load_style`."""
    option = click.option(
        "--style",
        shell_complete=named(folder("styles")),
        metavar="NAME|FILE",
        help="A ragdoll follows her in this style: neutral, lazy, fierce, heavy, feminine, or a file as those in "
        "configs/styles.",
    )
    return option(command)


def push_options(command: _Command) -> _Command:
    """Add --push and --trip; the function gets `push` and `trip`, tuples to be given to `dance.physics.pushes`."""
    for option in (
        click.option(
            "--trip",
            type=float,
            multiple=True,
            metavar="TIME",
            help="Something catches the foot that swings at this second of the song.",
        ),
        click.option(
            "--push",
            multiple=True,
            metavar="TIME:FORCE:DIRECTION",
            help="Somebody pushes her: second of the song, newtons, and ahead, left, back, right or degrees to her "
            "left.",
        ),
    ):
        command = option(command)
    return command


def motion_option(command: _Command) -> _Command:
    """Add --motion; the function gets keyword argument `motion`, to be given to `dance.settings.load_settings`."""
    option = click.option(
        "--motion",
        type=GivenPath(),
        metavar="FILE",
        help="How she moves: a YAML file that names the numbers of configs/motion.yaml that it changes.",
    )
    return option(command)
