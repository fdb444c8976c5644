"""The options for the look and the sound of a film, and the request made from them."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.commands.arguments import GivenPath, Number, WholeNumber, completer_of, folder, note
from dancetutor_cli.commands.shared_options import (
    DanceOptions,
    character_option,
    combined,
    dance_options,
    language_option,
    ragdoll_options,
    section_option,
)
from dancetutor_cli.film.choices import LEAST_SIDE, MOST_SIDE, QUALITIES, RENDERERS, parse_ahead
from dancetutor_cli.run.errors import UsageError
from dancetutor_cli.run.languages import ENGLISH

if TYPE_CHECKING:
    from dancetutor_cli.film.choices import Quality, RendererKind
    from dancetutor_cli.film.clock import Practice
    from dancetutor_cli.film.layout import FilmLook, Layout
    from dancetutor_cli.film.media.encoder import FilmFormat
    from dancetutor_cli.film.work.request import FilmRequest

MOST_LATE = 60_000.0  # limit of --sync-offset, milliseconds


class _Size(click.ParamType):  # type: ignore[type-arg,unused-ignore]
    """A size in pixels, such as 1280x720."""

    name = "WxH"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[int, int]:
        match = re.fullmatch(r"(\d{2,5})[x×](\d{2,5})", str(value).strip().lower())
        if not match:
            raise UsageError(f"--size {value}: write width x height, such as 1280x720")
        width, height = int(match[1]), int(match[2])
        if not (LEAST_SIDE <= width <= MOST_SIDE and LEAST_SIDE <= height <= MOST_SIDE):
            self.fail(f"{width}x{height} is not possible; {LEAST_SIDE} to {MOST_SIDE} pixels each way", param, ctx)
        return width, height


# The decorator of the options of a film; `film_request` makes a request of their values.
film_options = combined(
    click.option("--size", type=_Size(), help="Size in pixels.  [default: the layout's, 1280x720; smaller for GIF]"),
    click.option("--fps", type=WholeNumber(1, 120), metavar="N", help="Frames per second.  [default: 30; GIF 25]"),
    section_option,
    click.option(
        "--layout",
        shell_complete=completer_of(folder("layouts")),
        metavar="NAME|FILE",
        help="Where dancer and notes are: a name or a file like those in configs/layouts.  [default: side-by-side; "
        "background with --background]",
    ),
    character_option,
    dance_options,
    ragdoll_options,
    click.option(
        "--camera",
        metavar="NAME|POS/TARGET",
        help="Where the camera is: back, back-high, front, front-high, side, three-quarter, television, top, or "
        "x,y,z/x,y,z in metres.",
    ),
    click.option(
        "--scroll", metavar="C600|X2|M600", help="Scroll speed of the notes, as in the games.  [default: the layout's]"
    ),
    click.option("--down", is_flag=True, help="Let the notes scroll down instead of up."),
    click.option(
        "--quality",
        type=click.Choice(QUALITIES),
        default="good",
        show_default=True,
        help="How carefully to draw: draft is quick, best is smooth.",
    ),
    click.option(
        "--renderer",
        type=click.Choice(RENDERERS),
        default="auto",
        show_default=True,
        help="Which renderer draws; gl needs OpenGL.",
    ),
    click.option(
        "--encoder",
        type=click.Choice(("auto", "x264", "nvenc", "vaapi")),
        default="auto",
        show_default=True,
        help="Which H.264 encoder to use; auto: NVENC where it works, otherwise x264.",
    ),
    click.option(
        "--rate",
        metavar="R[,R...]",
        help="Speed of the music, 1 is normal. A list such as 0.5,0.75,1 plays the song once at each speed.",
    ),
    click.option(
        "--loop",
        type=WholeNumber(1, 99),
        metavar="N",
        help="Play the song this many times.  [default: once at each rate]",
    ),
    click.option("--count-in", type=WholeNumber(0, 16), metavar="BEATS", help="Count this many beats before each run."),
    click.option("--assist-tick", is_flag=True, help="Clap on each step."),
    click.option("--metronome", is_flag=True, help="Tick on each beat."),
    click.option(
        "--sync-offset",
        type=Number(-MOST_LATE, MOST_LATE),
        default=0.0,
        metavar="MS",
        help="Play the music this many ms later (9 for ITG charts).",
    ),
    click.option(
        "--call-ahead",
        metavar="TIME",
        help="Show the words for a move this long before it: seconds, or beats such as b2.  [default: 0.9 s]",
    ),
    click.option(
        "--dance",
        "motions",
        type=GivenPath(),
        multiple=True,
        metavar="FILE.npz",
        help="Draw this motion, which `animate` wrote. For two players, give both files.",
    ),
    click.option("--show-findings", is_flag=True, help="Show the findings of the linter, too (for authors)."),
    language_option("Language of the words.", ENGLISH),
    click.option("--font", type=GivenPath(), metavar="FILE", help="A font file, for titles in other scripts."),
    click.option("--mute", is_flag=True, help="Make a film without sound."),
)


@dataclass(frozen=True, slots=True)
class RenderOptions:
    """The options of `render` without those of the charts and of the dance; None for options that are not given."""

    size: tuple[int, int] | None
    fps: int | None
    section: str | None
    layout: str | None
    character: str
    camera: str | None
    scroll: str | None
    down: bool
    quality: Quality
    renderer: RendererKind
    encoder: str
    rate: str | None
    loop: int | None
    count_in: int | None
    assist_tick: bool
    metronome: bool
    sync_offset: float
    call_ahead: str | None
    motions: tuple[Path, ...]
    show_findings: bool
    language: str
    font: Path | None
    mute: bool
    output: Path | None
    frames: Path | None
    poses: Path | None
    poster: Path | None
    srt: bool
    background: bool
    into_file: bool
    meter: str | None
    name: str | None
    shard: str | None
    scheduler: str | None
    results: Path | None
    jobs: int | None
    exclude: tuple[str, ...]
    yes: bool
    quiet: bool
    verbose: bool


def film_request(
    file: Path, selection: Selection, dance: DanceOptions, options: RenderOptions, film_format: FilmFormat
) -> FilmRequest:
    """Return the request of these options. Raises UsageError for a wrong option."""
    from dancetutor_cli.character.characters import check_character
    from dancetutor_cli.dance.request import with_style
    from dancetutor_cli.film.layout import load_layout
    from dancetutor_cli.film.work.request import FilmRequest

    layout = load_layout(options.layout or ("background" if options.background else "side-by-side"))
    if options.background and (layout.highway is not None or layout.dancer is None):
        raise UsageError(
            "--background is the dancer alone, the game draws the notes: choose a layout without a highway"
        )
    look = _film_look(options, layout, film_format)
    return FilmRequest(
        with_style(replace(dance.request(file, selection), rates=_rates(options, layout))),
        look,
        fps=options.fps or film_format.fps,
        section=options.section,
        sync=options.sync_offset / 1000,
        mute=options.mute,
        practice=_practice(options, layout, film=not options.poses),
        character=check_character(options.character),
        background=options.background,
        motions=options.motions,
    )


def _film_look(options: RenderOptions, layout: Layout, film_format: FilmFormat) -> FilmLook:
    """Return the look of the film. Raises UsageError for a font without the letters of the language, or no font."""
    from dancetutor_cli.film.layout import FilmLook
    from dancetutor_cli.film.media.encoder import even_size
    from dancetutor_cli.film.overlay.text import check_letters, font
    from dancetutor_cli.film.scroll import parse_scroll

    if options.font is not None:
        font(str(options.font), 24)  # raises an error for a wrong font before the work begins
    check_letters(options.language, options.font)
    wanted = options.size or _default_size(layout.size, film_format)
    size = even_size(wanted) if film_format.h264 else wanted
    if size != wanted:
        note(f"{wanted[0]}x{wanted[1]} becomes {size[0]}x{size[1]}; H.264 needs even numbers")
    return FilmLook(
        layout=layout,
        size=size,
        quality=options.quality,
        renderer=options.renderer,
        camera=options.camera,
        scroll=parse_scroll(options.scroll) if options.scroll else None,
        down=options.down,
        font=options.font,
        ahead=parse_ahead(options.call_ahead) if options.call_ahead else None,
        findings=options.show_findings,
        language=options.language,
    )


def _rates(options: RenderOptions, layout: Layout) -> tuple[float, ...]:
    from dancetutor_cli.film.clock import parse_rates
    from dancetutor_cli.film.layout import PracticePart

    return parse_rates(options.rate) if options.rate else (layout.practice or PracticePart()).rates


def _practice(options: RenderOptions, layout: Layout, film: bool) -> Practice:
    """Return the options for practising. film : whether the dancer comes to rest after a passage; poses need no rest"""
    from dancetutor_cli.film.clock import REST, Practice
    from dancetutor_cli.film.layout import PracticePart

    usual = layout.practice or PracticePart()
    count_in = usual.count_in if options.count_in is None else options.count_in
    rest = REST if film else 0.0
    return Practice(options.loop or 0, count_in, options.assist_tick, options.metronome, rest)


def _default_size(size: tuple[int, int], film_format: FilmFormat) -> tuple[int, int]:
    longer = max(size)
    if film_format.side >= longer:
        return size
    return round(size[0] * film_format.side / longer / 2) * 2, round(size[1] * film_format.side / longer / 2) * 2
