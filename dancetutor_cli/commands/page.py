"""`dancetutor page`: one HTML file to practise a chart with: the dancer, the notes, loops, speeds, a pad."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from dancetutor_cli.commands.first_run import tell_of_compiling
from dancetutor_cli.commands.selection import (
    Selection,
    character_option,
    gait_option,
    preset_option,
    selection_options,
)
from dancetutor_cli.targets import check_file

_FILE = click.Path(path_type=Path)
SUFFIXES = (".html", ".htm")


@click.command()
@click.argument("path", type=_FILE)
@click.option("-o", "--output", type=_FILE, help="An .html file; default: SONG-difficulty.html.")
@click.option("--music", is_flag=True, help="Put the song's music into the page; otherwise it asks for the file.")
@click.option("--play", "play_file", type=_FILE, help="Feet from this JSON of analyze instead of the solver's.")
@click.option("--bar", is_flag=True, help="She holds on to the bar behind the pad, as players of hard charts do.")
@click.option(
    "--beside",
    metavar="next|PRESET|FILE.json",
    help="A second dancer beside her: the next best play, another preset's, or one of a JSON file.",
)
@gait_option
@click.option(
    "--jobs", type=click.IntRange(1, 256), default=1, show_default=True, help="Processes, for songs over two minutes."
)
@click.option("-q", "--quiet", is_flag=True, help="Say nothing but errors.")
@character_option
@selection_options
@preset_option
def command(
    path: Path, output: Path | None, music: bool, play_file: Path | None, bar: bool, gait: str, jobs: int, quiet: bool,
    beside: str | None, character: str, preset: str | None, **selection: Any,
) -> None:  # fmt: skip
    """Make a page to practise one chart of PATH with, in any browser, without a network.

    The dancer plays the chart beside its notes: slower or quicker, in loops, row by row, and she waits for whoever
    learns it. Its hardest passages are listed.
    """
    from dancetutor_cli.files import write_atomic
    from dancetutor_cli.jobs.bake import BakeTask
    from dancetutor_cli.jobs.page import PageTask, make_page
    from dancetutor_cli.jobs.presets import choice_for
    from dancetutor_cli.library import one_song
    from dancetutor_cli.reports.safe import safe

    if output is not None:
        check_file(output, SUFFIXES)
    file = one_song(path)
    bake = BakeTask(file, Selection(**selection), preset, play_file=play_file, bar=bar, gait=gait, jobs=jobs)
    if not quiet:
        tell_of_compiling(choice_for(file, preset))
    page = make_page(PageTask(bake, character, music, beside))
    target = output or Path(_default_name(page.title, page.label))
    check_file(target, SUFFIXES)
    write_atomic(target, page.html)
    for warning in page.warnings:
        click.echo(f"warning: {safe(warning)}", err=True)
    if not quiet:
        click.echo(f"{target}: {len(page.html) / 1e6:.1f} MB, {page.label}")


def _default_name(title: str, label: str) -> str:
    from dancetutor_cli.jobs.film_list import plain_name

    return f"{plain_name(f'{title}-{label}') or 'page'}.html"
