"""`dancetutor render`: a tutorial video, a GIF or a sequence of pictures of one chart, or of a folder of charts."""

from __future__ import annotations

import signal
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from dancetutor_cli.chart.selection import Selection, one_song
from dancetutor_cli.commands.arguments import LONG, GivenPath, WholeNumber, confirm_long, default_name, note, warn
from dancetutor_cli.commands.film_options import RenderOptions, film_options, film_request
from dancetutor_cli.commands.first_run import announce_compiling
from dancetutor_cli.commands.option_groups import GroupedCommand
from dancetutor_cli.commands.shared_options import (
    DanceOptions,
    exclude_option,
    into,
    preset_option,
    quiet_option,
    selection_options,
    verbose_option,
    yes_option,
)
from dancetutor_cli.film.media.encoder import FILES, FORMATS, PICTURES, Encoding, choose_encoder, target_of
from dancetutor_cli.reports.progress import FilmProgress
from dancetutor_cli.run.errors import UsageError
from dancetutor_cli.run.files import check_file, check_folder, make_folder, one_of, place_of, plain_name
from dancetutor_cli.run.foreign_text import safe

if TYPE_CHECKING:
    from dancetutor_cli.film.work.request import FilmRequest, FilmSubject


# Options that exclude --background: the game starts the film with the music and plays it once, at its own speed.
_NO_BACKGROUND = (
    "poses",
    "section",
    "rate",
    "loop",
    "count_in",
    "metronome",
    "assist_tick",
    "srt",
    "sync_offset",
    "frames",
)


@click.command(cls=GroupedCommand)
@click.argument("path", type=GivenPath(untrusted=True))
@click.option(
    "-o",
    "--output",
    type=GivenPath(),
    metavar="FILE|DIR",
    help=f"Name of the output: a {one_of(FILES)} file, or a folder if PATH is one.  "
    "[default: SONG-difficulty.mp4, videos]",
)
@click.option("--frames", type=GivenPath(), metavar="DIR", help="Write one PNG per frame into this folder, not a film.")
@click.option("--poses", type=GivenPath(), metavar="DIR", help="Write one PNG per row into this folder, not a film.")
@click.option("--poster", type=GivenPath(), metavar="FILE.png", help="Also write a title picture.")
@click.option("--srt", is_flag=True, help="Also write a file with subtitles that name the moves.")
@click.option(
    "--background",
    is_flag=True,
    help="Film only the dancer, as long as the music: the game plays it behind the notes.",
)
@click.option(
    "--into-file", is_flag=True, help="Write into the chart file: with --background, add the film to #BGCHANGES."
)
@click.option("--jobs", type=WholeNumber(1, 256), metavar="N", help="Number of processes.  [default: one per core]")
@yes_option
@quiet_option
@exclude_option
@verbose_option
@film_options
@selection_options
@preset_option
@click.option("--meter", metavar="N|N-M", help="For a folder: only charts of these meters.")
@click.option(
    "--name",
    metavar="TEMPLATE",
    help="For a folder: the name of each film, with {title}, {artist}, {folder}, {pack}, {file}, {steps_type}, "
    "{difficulty}, {meter} and {index}.",
)
@click.option("--shard", metavar="I/N", help="For a folder: make only part I of N, to share the work between machines.")
@click.option(
    "--scheduler", metavar="ADDRESS", help="For a folder: use a Dask cluster that can read and write the same folders."
)
@click.option(
    "--results",
    type=GivenPath(allow_dash=True),
    metavar="FILE.jsonl",
    help="For a folder: write one line of JSON per chart; - is standard output.",
)
@into("selection", Selection)
@into("dance", DanceOptions)
@into("options", RenderOptions)
def command(path: Path, selection: Selection, dance: DanceOptions, options: RenderOptions) -> None:
    """Make a film of a dancer who plays one chart of PATH, beside the notes with L and R on them.

    The ending of the output name sets the format: .mp4 (H.264 with the music of the song), .gif or .webp.
    If PATH is a folder, make a film of every chart in it. Finished films are not made again, so an interrupted run
    continues.
    """
    _end_on_term()
    files = _background(path, options)
    if sum(one is not None for one in (options.output, options.frames, options.poses)) > 1:
        raise UsageError("give one of --output, --frames and --poses")
    path = _one_film(path, options)
    if path.is_dir():
        for name in ("poses", "poster", "srt", "background"):
            if getattr(options, name):
                raise UsageError(f"--{name} is for one chart, and {path} is a folder")
        from dancetutor_cli.commands.render_batch import render_batch

        render_batch(path, selection, dance, options)
        return
    for name in ("meter", "name", "shard", "results", "scheduler", "exclude"):
        if getattr(options, name):
            cure = f"give folders as PATH and --output, or leave out --{name} to make one film of {path}"
            raise UsageError(f"--{name} is for many films: {cure}")
    if not files:
        _render_one(path, selection, dance, options)
        return
    from dancetutor_cli.markers.background import check_place

    film = options.output or path.with_name(into_file_name(path, selection))
    check_place(film, files)
    _render_one(path, selection, dance, replace(options, output=film))
    _write_background_entries(film, files, options.quiet)


def _background(path: Path, options: RenderOptions) -> list[Path]:
    """Return the chart files in which to enter the film. Raises UsageError for options that exclude --background."""
    if not options.background:
        if options.into_file:
            raise UsageError("--into-file works only with --background; add --background")
        return []
    given = [name for name in _NO_BACKGROUND if getattr(options, name)]
    if given:
        raise UsageError(
            f"--{given[0].replace('_', '-')} cannot be used with --background: the game plays the whole film"
        )
    if not options.into_file:
        return []
    from dancetutor_cli.markers.background import files_of_song

    return files_of_song(path)


def into_file_name(path: Path, selection: Selection) -> str:
    """Return the name of a film that is entered into a chart file: SONG-which.dancetutor.mp4."""
    which = selection.difficulty or (f"{selection.index}" if selection.index is not None else "")
    stem = plain_name(f"{path.stem}-{which}" if which else path.stem) or "film"
    return "".join("_" if letter in ",;:=#\\" else letter for letter in stem) + ".dancetutor.mp4"


def _write_background_entries(film: Path, files: Sequence[Path], quiet: bool) -> None:
    from dancetutor_cli.markers.background import write_entries

    for line in write_entries(film, files):
        if not quiet:
            click.echo(safe(line), err=line.startswith("warning"))


def _one_film(path: Path, options: RenderOptions) -> Path:
    """Return the file of a folder with one song if the options are for one chart, else the path unchanged."""
    output = options.output
    film = output is not None and output.suffix.lower() in FILES and not output.is_dir()
    if not path.is_dir() or not (film or options.poses or options.poster or options.srt or options.background):
        return path
    file = one_song(path)
    if film and file == path:
        raise UsageError(f"{output} is one film, but {path} has several songs; name one of its files")
    return file


def _render_one(path: Path, selection: Selection, dance: DanceOptions, options: RenderOptions) -> None:
    from dancetutor_cli.dance.request import choice_for
    from dancetutor_cli.film.work.request import look_up

    output, folder = options.output, options.frames or options.poses
    kind = PICTURES if folder is not None else "mp4" if output is None else target_of(output)
    if output is not None:
        check_file(output)
    if options.poster is not None:
        check_file(options.poster, (".png",), or_device=True)
    if folder is not None:
        check_folder(folder)
    request = film_request(path, selection, dance, options, FORMATS[kind])
    subject = look_up(request)
    start, end = subject.chart.notes_span
    announce_compiling(choice_for(path, request.dance.preset), lambda: end - start, quiet=options.quiet)
    target = folder or output or default_name(subject.song, subject.chart, ".mp4")
    if folder is None:
        check_file(target)
    if not options.poses:
        _allow_long(subject, path, options.yes)
    is_new = folder is not None and not target.exists()
    if folder is not None:
        make_folder(target)
    try:
        _make(request, subject, target, kind, options)
    finally:
        if is_new:
            with suppress(OSError):
                target.rmdir()  # fails if the folder is not empty


def _allow_long(subject: FilmSubject, file: Path, yes: bool) -> None:
    """Ask before hours of work; without a terminal, refuse, because nobody can answer."""
    clock = subject.clock
    if yes or max(clock.seconds, subject.chart_seconds) <= LONG:
        return
    what = f"{file}: the film would last {clock.seconds / 60:.0f} minutes ({clock.frames:,} frames)"
    if clock.seconds <= LONG:
        what = f"{file}: the chart is {subject.chart_seconds / 3600:.1f} hours long, though its last note is early"
    confirm_long(what, "Render")


def _make(request: FilmRequest, subject: FilmSubject, target: Path, kind: str, options: RenderOptions) -> None:
    from dancetutor_cli.film.work.batch import Batch, film_workers
    from dancetutor_cli.film.work.jobs import FilmJob
    from dancetutor_cli.film.work.segments import FilmRecords
    from dancetutor_cli.run.pool import default_jobs

    say = (lambda _warnings: None) if options.quiet else warn
    say(subject.warnings)
    encoding = Encoding(kind, request.look.size, request.fps, request.look.quality)
    if subject.clock.seconds > encoding.format.largest and not options.quiet:
        what = f"{subject.clock.seconds:.0f} s of .{kind} make a very large file"
        note(f"{what}; choose a part with --section, or write .mp4")
    if encoding.format.h264:
        encoding = replace(encoding, encoder=choose_encoder(options.encoder))
    poses = options.poses is not None
    place = target if kind == PICTURES else place_of(target)
    job = FilmJob(request, subject.chart.label, place, encoding, None, poses, options.poster, options.srt)
    with FilmProgress(target.name, options.quiet) as progress:
        workers = film_workers(options.jobs or default_jobs(), progress.advance, request.look.renderer)
        begin = partial(progress.begin, fps=request.fps)
        (outcome,) = Batch([job], workers, begin, records=FilmRecords(None)).run()
    if outcome.error is not None:
        raise outcome.error
    say(outcome.warnings[len(subject.warnings) :])
    if not options.quiet:
        width, height = request.look.size
        length = f"{outcome.frames} pictures" if kind == PICTURES else f"{subject.clock.seconds:.1f} s"
        click.echo(f"{target}: {length}, {width}x{height} at {request.fps} fps, {subject.chart.label}")


def _end_on_term() -> None:
    """End on SIGTERM as on Ctrl-C: workers are stopped, and no half-written file stays."""

    def stop(_number: int, _frame: object) -> None:
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, stop)
