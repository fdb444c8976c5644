"""The options of a command in groups, the common ones first; an option is in the same group in all commands."""

from __future__ import annotations

import click

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
