"""The command line: one module per subcommand, imported only when it is called.

analyze, analyze_options      the subcommand; its options as a record, and `analyze --show-settings`
pack, drawings                `analyze` of packs, `--compare` and `--tech-counts`; `--sheet` and `--plot`
fix_option                    `analyze --fix`
render, render_batch          a film; the films of a folder
folder_run                    the messages of a run over a folder, for films and pages; joined warnings
film_options                  the options of `render`, and the request made from them
annotate, animate, retarget, page, doctor, warmup, completion   the other subcommands
option_groups                 the groups of options in a help text; old names of options
shared_options                options of several commands; `--report` and `--plot` of motions
arguments                     paths, charts, targets and completed names on the command line
first_run                     messages before work that compiles; the output without a subcommand
"""

from __future__ import annotations

import importlib
import os
from pathlib import Path

import click

import dancetutor_cli
from dancetutor_cli.run.errors import choose_text

# name -> (module, short help); the short help is here so that `--help` imports no subcommand.
COMMANDS = {
    "analyze": ("analyze", "Find which foot steps each note, and check the chart."),
    "annotate": ("annotate", "Write L/R foot markers into chart files, or remove them."),
    "animate": ("animate", "Write the motion of a 3D dancer who plays a chart."),
    "retarget": ("retarget", "Put captured motion on a character."),
    "render": ("render", "Make a film, picture sequence or GIF of a chart."),
    "page": ("page", "Make a web page to practise a chart with: loops, any speed, playing along."),
    "doctor": ("doctor", "Check renderers, encoders, caches, fonts and disk."),
    "warmup": ("warmup", "Compile everything now, so that later runs start quickly."),
    "completion": ("completion", "Make the Tab key complete commands, options and names."),
}


def _set_colours(context: click.Context, _: click.Parameter, value: str) -> None:
    """Make this run, and the processes it starts, print colours or none, by environment variables that all obey."""
    if value == "auto" or context.resilient_parsing:
        return
    names = ("NO_COLOR", "FORCE_COLOR")
    before = {name: os.environ.pop(name, None) for name in names}
    os.environ[names[value == "always"]] = "1"

    def restore() -> None:
        for name in names:
            os.environ.pop(name, None)
        os.environ.update({name: earlier for name, earlier in before.items() if earlier is not None})

    context.call_on_close(restore)


def _colour_option() -> click.Option:
    """Return the option --color, which all subcommands have."""
    return click.Option(
        ["--color"],
        type=click.Choice(["auto", "always", "never"]),
        default="auto",
        show_default=True,
        expose_value=False,
        is_eager=True,
        callback=_set_colours,
        help="Print colours; auto: at a terminal, unless NO_COLOR is set.",
    )


class _LazyGroup(click.Group):
    """A group that imports the module of a subcommand only when the subcommand is called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        module = importlib.import_module(f"dancetutor_cli.commands.{COMMANDS[cmd_name][0]}")
        command = module.command
        assert isinstance(command, click.Command)
        if all(option.name != "color" for option in command.params):
            command.params.append(_colour_option())
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        name = args[0]
        if name not in COMMANDS and not name.startswith("-"):
            ctx.fail(f"there is no command '{name}'{choose_text(name, COMMANDS)}")
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl([(name, text) for name, (_, text) in COMMANDS.items()])


@click.group(
    cls=_LazyGroup,
    invoke_without_command=True,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
)
@click.version_option(dancetutor_cli.__version__, prog_name="dancetutor")
@click.pass_context
def cli(context: click.Context) -> None:
    """Find which foot steps each note of a chart, check the chart, and show a 3D dancer who plays it.

    Charts are .sm and .ssc files (StepMania, ITGmania and others) and .ucs files (Pump It Up).
    """
    if context.invoked_subcommand is None:
        from dancetutor_cli.commands.first_run import first_steps

        click.echo(first_steps(Path()))
