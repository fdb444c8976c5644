"""The command line: one module per subcommand, imported only when it is called.

analyze, analyze_options      the subcommand; its options as a record, and `analyze --show-settings`
pack, drawings                `analyze` of packs, `--compare` and `--tech-counts`; `--sheet` and `--plot`
fix_option                    `analyze --fix`
render, render_batch          a film; the films of a folder
folder_run                    the messages of a run over a folder, for films and pages; joined warnings
film_options                  the options of `render`, and the request made from them
annotate, animate, retarget, page, doctor, warmup, completion   the other subcommands
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


# The options of a command in groups, the common ones first; an option is in the same group in all commands.

# Group -> the first names of its options, in the order in which help prints them.
GROUPS = {
    "Charts": (
        "--difficulty", "--steps-type", "--index", "--section", "--meter", "--player", "--exclude", "--stdin-filename",
        "--preset",
    ),
    "Input": ("--play", "--dance", "--animation"),
    "Output": (
        "--output", "--output-file", "--format", "--frames", "--poses", "--poster", "--srt", "--music", "--background",
        "--into-file", "--name", "--report", "--plot", "--report-html", "--sheet", "--json", "--print", "--remove",
        "--with-input",
    ),
    "What is printed": (
        "--full", "--statistics", "--suggest", "--compare", "--sync", "--alternatives", "--tech-counts",
        "--meter-scale",
    ),
    "Rules and exit status": (
        "--explain", "--select", "--ignore", "--fail-on", "--config", "--set", "--show-settings", "--baseline",
        "--update-baseline", "--exit-zero",
    ),
    "Changes to files": ("--markers", "--strip", "--fix", "--diff", "--check", "--dry-run", "--backup", "--force"),
    "Picture": (
        "--size", "--quality", "--fps", "--layout", "--camera", "--scroll", "--down", "--second", "--show-findings",
        "--call-ahead", "--language", "--font", "--renderer", "--encoder",
    ),
    "Dancer": (
        "--character", "--style", "--form", "--gait", "--bar", "--motion", "--push", "--trip", "--physics", "--correct",
    ),
    "Music and speed": (
        "--rate", "--loop", "--count-in", "--metronome", "--assist-tick", "--sync-offset", "--mute",
    ),
    "Batch": ("--jobs", "--watch", "--no-cache", "--results", "--shard", "--scheduler", "--yes"),
    "General": ("--quiet", "--verbose", "--color", "--help"),
}  # fmt: skip


# Old and new names of options: each name now means one thing in all commands. The old names still work.
RENAMED = (("--style", "--markers"), ("--beside", "--tech-counts"), ("--beside", "--second"))


class GroupedCommand(click.Command):
    """A command whose help prints its options by `GROUPS`; an option in no group is under "Other options"."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse the arguments that the user typed, with old names of options replaced; click calls this."""
        options = {name for parameter in self.params for name in parameter.opts}
        renamed = {old: new for old, new in RENAMED if old not in options and new in options}
        parts = [argument.partition("=") for argument in args]
        return super().parse_args(ctx, [renamed.get(name, name) + equals + value for name, equals, value in parts])

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the options in groups; click calls this for `--help`."""
        group_of = {name: title for title, names in GROUPS.items() for name in names}
        rank = {name: place for names in GROUPS.values() for place, name in enumerate(names)}
        rows: dict[str, list[tuple[int, tuple[str, str]]]] = {title: [] for title in (*GROUPS, "Other options")}
        for parameter in self.get_params(ctx):
            record = parameter.get_help_record(ctx) if isinstance(parameter, click.Option) else None
            if record is not None:
                name = max(parameter.opts, key=len)
                rows[group_of.get(name, "Other options")].append((rank.get(name, 0), record))
        for title, ranked in rows.items():
            if ranked:
                with formatter.section(title):
                    formatter.write_dl([record for _, record in sorted(ranked)])
