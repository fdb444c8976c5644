"""`dancetutor render`: a tutorial video, a GIF or a sequence of pictures of one chart."""

from __future__ import annotations

import re
import signal
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from dancetutor_cli.commands.selection import Selection, preset_option, selection_options
from dancetutor_cli.errors import FileError, UsageError

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.jobs.film_request import Practice, Request, Subject
    from dancetutor_cli.video.encoder import Target
    from dancetutor_cli.video.layout import Layout

QUALITIES = ("draft", "good", "best")
RENDERERS = ("auto", "cpu", "gl")
LONG = 20 * 60.0  # seconds of film; more than this is asked about first
GIF_FPS, GIF_SIDE = 25, 480  # of GIF and WebP, where nothing else is asked for


class _Size(click.ParamType):  # type: ignore[type-arg,unused-ignore]
    """ "A size in pixels, as 1280x720."""

    name = "WxH"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[int, int]:
        match = re.fullmatch(r"(\d{2,5})[x×](\d{2,5})", str(value).strip().lower())
        if not match:
            self.fail(f"'{value}' is no size; write it as 1280x720", param, ctx)
        width, height = int(match[1]), int(match[2])
        if not (64 <= width <= 7680 and 64 <= height <= 7680):
            self.fail(f"{width}x{height} is not possible; 64 to 7680 pixels each way", param, ctx)
        return width, height


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), help="A .mp4, .gif or .webp; default: SONG-difficulty.mp4."
)
@click.option("--frames", type=click.Path(path_type=Path), metavar="DIR", help="Write PNG pictures into this folder.")
@click.option("--size", type=_Size(), help="Default: the layout's, 1280x720; a GIF's is smaller.")
@click.option("--fps", type=click.IntRange(1, 120), help="Frames per second [default: 30; GIF 25].")
@click.option("--section", metavar="START:END", help="Only this part: seconds, or beats (16b:32b) or measures (4m:8m).")
@click.option(
    "--layout", default="side-by-side", show_default=True, metavar="NAME|FILE", help="A file of configs/layouts."
)
@click.option(
    "--camera", metavar="NAME|POS/TARGET", help="back, front, side, three-quarter, top, or x,y,z/x,y,z in metres."
)
@click.option("--scroll", metavar="C600|X2|M600", help="Speed of the notes [default: the layout's].")
@click.option("--down", is_flag=True, help="The notes fall instead of rise.")
@click.option("--quality", type=click.Choice(QUALITIES), default="good", show_default=True)
@click.option("--renderer", type=click.Choice(RENDERERS), default="auto", show_default=True)
@click.option("--jobs", type=click.IntRange(1, 256), help="Processes that draw [default: one per core].")
@click.option("--rate", metavar="R[,R...]", help="Speeds of the runs, as 0.5,0.75,1; the pitch stays.")
@click.option("--loop", type=click.IntRange(1, 99), help="How many runs [default: one for each rate].")
@click.option("--count-in", type=click.IntRange(0, 16), metavar="BEATS", help="Count before each run.")
@click.option("--assist-tick", is_flag=True, help="A clap on each step.")
@click.option("--metronome", is_flag=True, help="A tick on each beat.")
@click.option(
    "--sync-offset", type=float, default=0.0, metavar="MS", help="Play the music this much later (ITG charts: 9)."
)
@click.option("--font", type=click.Path(path_type=Path), help="A font file, for titles in other scripts.")
@click.option("--mute", is_flag=True, help="Leave the sound out.")
@click.option("--yes", is_flag=True, help="Render even a very long film without asking.")
@click.option("-q", "--quiet", is_flag=True, help="Say nothing but errors.")
@selection_options
@preset_option
def command(file: Path, output: Path | None, frames: Path | None, yes: bool, quiet: bool, **options: Any) -> None:
    """Make a video of a dancer who plays one chart of FILE, beside her the notes with L and R markers.

    The name of the output says what it is: .mp4 (H.264 with the song's music), .gif or .webp; --frames writes pictures.
    """
    from dancetutor_cli.jobs.film_request import look_up

    _end_on_term()
    kind = _kind(output, frames)
    request = _request(file, options, kind)
    subject = look_up(request)
    target = frames or output or Path(default_name(subject.song, subject.chart))
    _check_target(target, frames is not None)
    _allow_long(subject, file, yes)
    _make(request, subject, target, kind, options["jobs"], quiet)


def _kind(output: Path | None, frames: Path | None) -> Target:
    """What is to be written: "mp4", "gif", "webp" or "png"."""
    from dancetutor_cli.video.encoder import target_of

    if output is not None and frames is not None:
        raise UsageError("give either --output or --frames, not both")
    if frames is not None:
        return "png"
    return target_of(output) if output is not None else "mp4"


def _request(file: Path, options: dict[str, Any], kind: Target) -> Request:
    from dancetutor_cli.jobs.film_request import Request
    from dancetutor_cli.video.encoder import even_size
    from dancetutor_cli.video.film_look import FilmLook
    from dancetutor_cli.video.layout import load_layout
    from dancetutor_cli.video.scroll import parse_scroll

    layout = load_layout(options["layout"])
    wanted = options["size"] or _default_size(layout.size, kind)
    size = even_size(wanted) if kind == "mp4" else wanted
    if size != wanted:
        click.echo(f"note: {wanted[0]}x{wanted[1]} becomes {size[0]}x{size[1]}; H.264 needs even numbers", err=True)
    scroll = parse_scroll(options["scroll"]) if options["scroll"] else None
    look = FilmLook(
        layout,
        size,
        options["quality"],
        options["renderer"],
        options["camera"],
        scroll,
        options["down"],
        options["font"],
    )
    return Request(
        path=file,
        selection=Selection(options["steps_type"], options["difficulty"], options["index"]),
        look=look,
        fps=options["fps"] or (GIF_FPS if kind in ("gif", "webp") else 30),
        preset=options["preset"],
        section=options["section"],
        sync=options["sync_offset"] / 1000,
        mute=options["mute"],
        practice=_practice(options, layout),
    )


def _practice(options: dict[str, Any], layout: Layout) -> Practice:
    from dancetutor_cli.jobs.film_request import Practice, parse_rates
    from dancetutor_cli.video.layout import PracticePart

    usual = layout.practice or PracticePart()
    rates = parse_rates(options["rate"]) if options["rate"] else usual.rates
    count_in = usual.count_in if options["count_in"] is None else options["count_in"]
    return Practice(rates, options["loop"] or 0, count_in, options["assist_tick"], options["metronome"])


def _default_size(size: tuple[int, int], kind: Target) -> tuple[int, int]:
    if kind not in ("gif", "webp"):
        return size
    return round(size[0] * GIF_SIDE / max(size) / 2) * 2, round(size[1] * GIF_SIDE / max(size) / 2) * 2


def default_name(song: Song, chart: Chart) -> str:
    """SONG-difficulty.mp4, in characters that every file system takes."""
    name = f"{song.title or song.path.stem}-{chart.difficulty or 'chart'}".lower()
    plain = re.sub(r"[^\w.-]+", "_", name).strip("._")[:100]
    return f"{plain or 'film'}.mp4"


def _check_target(target: Path, folder: bool) -> None:
    """Refuse before the work what could not be written after it."""
    if not target.parent.is_dir():
        raise FileError(target, "its folder does not exist")
    if folder and target.exists() and not target.is_dir():
        raise FileError(target, "is a file; --frames needs a folder")
    if not folder and target.is_dir():
        raise FileError(target, "is a folder; give a file name, or --frames for pictures")


def _allow_long(subject: Subject, file: Path, yes: bool) -> None:
    """Ask before hours of work; without a terminal nobody can answer, so refuse."""
    clock = subject.clock
    if yes or max(clock.seconds, subject.written) <= LONG:
        return
    what = f"{file}: the film would last {clock.seconds / 60:.0f} minutes ({clock.frames:,} frames)"
    if clock.seconds <= LONG:
        what = f"{file}: the chart is {subject.written / 3600:.1f} hours long, though its last note is early"
    if sys.stdin.isatty() and sys.stderr.isatty():
        click.confirm(f"{what}. Render it?", abort=True, err=True)
    else:
        raise UsageError(f"{what}; choose a part with --section, or say --yes")


def _make(request: Request, subject: Subject, target: Path, kind: Target, jobs: int | None, quiet: bool) -> None:
    from dancetutor_cli.jobs.film_plan import prepare
    from dancetutor_cli.jobs.pool import default_jobs
    from dancetutor_cli.jobs.render import make_film
    from dancetutor_cli.reports.progress import FilmProgress
    from dancetutor_cli.video.encoder import Encoding

    for warning in subject.warnings:
        click.echo(f"warning: {warning}", err=True)
    encoding = Encoding(kind, request.look.size, request.fps, request.look.quality)
    count = jobs or default_jobs()
    with FilmProgress(target.name, quiet) as progress:
        prepared = make_film(lambda: prepare(request, subject), encoding, target, count, progress)
    for warning in prepared.warnings:
        click.echo(f"warning: {warning}", err=True)
    if not quiet:
        width, height = request.look.size
        click.echo(
            f"{target}: {subject.clock.seconds:.1f} s, {width}x{height} at {request.fps} fps, {subject.chart.label}"
        )


def _end_on_term() -> None:
    """End on SIGTERM as on Ctrl-C: workers stopped, nothing half-written left."""

    def stop(_number: int, _frame: object) -> None:
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, stop)
