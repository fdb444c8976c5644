"""`dancetutor page`: one HTML file to practise a chart with: the dancer, the notes, loops, speeds, a pad."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from dancetutor_cli.chart.selection import Selection, one_song
from dancetutor_cli.commands.arguments import GivenPath, warn
from dancetutor_cli.commands.first_run import announce_compiling
from dancetutor_cli.commands.folder_run import FolderRun, JoinedWarnings
from dancetutor_cli.commands.option_groups import GroupedCommand
from dancetutor_cli.commands.shared_options import (
    DanceOptions,
    character_option,
    dance_options,
    exclude_option,
    into,
    jobs_option,
    language_option,
    preset_option,
    quiet_option,
    selection_options,
    verbose_option,
)
from dancetutor_cli.run.errors import UsageError, plural
from dancetutor_cli.run.files import check_file, check_folder, plain_name, write_atomic
from dancetutor_cli.run.foreign_text import safe, safe_path

if TYPE_CHECKING:
    from dancetutor_cli.page.work import PageRequest

_FILE = GivenPath()
SUFFIXES = (".html", ".htm")


@dataclass(frozen=True, slots=True)
class PageOptions:
    """The options without those of the charts and of the dance."""

    output: Path | None
    music: bool
    jobs: int
    quiet: bool
    exclude: tuple[str, ...]
    verbose: bool
    second: str | None
    character: str
    language: str | None


@click.command(cls=GroupedCommand)
@click.argument("path", type=GivenPath(untrusted=True))
@click.option(
    "-o",
    "--output",
    type=_FILE,
    metavar="FILE|DIR",
    help="Name of the output: an .html file, or a folder if PATH is one.  [default: SONG-difficulty.html, pages]",
)
@click.option("--music", is_flag=True, help="Put the music into the page; without it the page asks for the file.")
@dance_options
@click.option(
    "--second",
    metavar="next|PRESET|FILE",
    help="Add a second dancer: with the next best feet (next), with the feet of another preset or of a JSON file, or "
    "with the motion of an .npz file.",
)
@language_option("Language of the words.  [default: the browser's]")
@jobs_option("folders and for songs over two minutes")
@quiet_option
@exclude_option
@verbose_option
@character_option
@selection_options
@preset_option
@into("selection", Selection)
@into("dance", DanceOptions)
@into("options", PageOptions)
def command(path: Path, selection: Selection, dance: DanceOptions, options: PageOptions) -> None:
    """Make a web page to practise one chart of PATH with. It needs a browser and no network.

    A dancer plays the chart beside its notes: slower or faster, in loops, row by row, or waiting for your steps. The
    page lists the hardest passages. If PATH is a folder, make a page of every chart in it, and an index page.
    """
    from dancetutor_cli.dance.request import choice_for
    from dancetutor_cli.page.work import PageRequest

    output = options.output
    file = one_song(path) if output is not None and output.suffix.lower() in SUFFIXES else path
    request = PageRequest(
        dance.request(file, selection),
        character=options.character,
        music=options.music,
        second=options.second,
        jobs=options.jobs,
        language=options.language or "",
    )
    announce_compiling(choice_for(file, request.dance.preset), quiet=options.quiet)
    if file.is_dir() and output is not None and output.suffix.lower() in SUFFIXES and not output.is_dir():
        request = _only(request, output, options)
        file = request.dance.path
    if file.is_dir():
        _pages(request, output or Path("pages"), options)
        return
    if output is not None:
        check_file(output, SUFFIXES)
    _page(request, output, options.quiet)


def _only(request: PageRequest, output: Path, options: PageOptions) -> PageRequest:
    """Return the request of the only matching chart in a folder. Raises UsageError if none or several match."""
    from dancetutor_cli.page.work import page_jobs

    wanted, _ = page_jobs(request, output.parent, options.exclude)
    if len(wanted) != 1:
        matching = plural(len(wanted), "chart")
        raise UsageError(f"{output} is one page, but {matching} in {request.dance.path} match: give a folder to -o")
    return replace(wanted[0].request, jobs=options.jobs)


def _page(request: PageRequest, output: Path | None, quiet: bool) -> None:
    from dancetutor_cli.page.work import look_up_page, pack_page

    subject = look_up_page(request)
    target = output or Path(f"{plain_name(f'{subject.title}-{subject.label}') or 'page'}.html")
    check_file(target, SUFFIXES)
    page = pack_page(subject)
    write_atomic(target, page.html)
    if not quiet:
        warn(page.warnings)
        click.echo(f"{target}: {len(page.html) / 1e6:.1f} MB, {page.label}")


def _pages(request: PageRequest, folder: Path, options: PageOptions) -> None:
    """Write a page for each chart, and the index. Exits with 2 if a page could not be made."""
    from dancetutor_cli.page.work import INDEX, make_all, page_jobs, write_index

    if request.dance.play is not None:
        raise UsageError(f"--play is for one chart, and {request.dance.path} is a folder")
    check_folder(folder)
    wanted, unreadable = page_jobs(request, folder, options.exclude)
    run = FolderRun(len(wanted), unreadable, JoinedWarnings(every=options.verbose))
    run.begin(request.dance.path, folder, f"{request.dance.path}: no chart here matches")
    outcomes = {}
    try:
        for one in make_all(wanted, options.jobs):
            outcomes[one.job.target] = one
            number = run.add(one.job.request.dance.path, one.warnings)
            if not options.quiet:
                result = f"FAILED: {one.error}" if one.error else f"{one.size / 1e6:.1f} MB"
                click.echo(safe(f"{number} {one.job.target.name}: {result}"))
    finally:
        if not options.quiet:
            run.warn(partial(click.echo, err=True))
    ordered = [outcomes[job.target] for job in wanted]
    if wanted:
        write_index(folder, ordered, request.dance.path.resolve().name)
    failed = [(str(one.job.request.dance.path), one.job.entry.label, one.error) for one in ordered if one.error]
    if wanted and not options.quiet:
        made = len(ordered) - len(failed)
        click.echo(f"{safe_path(str(folder / INDEX))}: {plural(made, 'page')}")
    run.end(failed)
