"""`dancetutor warmup`: compile every kernel once and store it, for example while a CI image is built."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import click
import numpy as np

from dancetutor_cli.chart.reader import load
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.commands.option_groups import GroupedCommand
from dancetutor_cli.commands.shared_options import quiet_option
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.feet.preset import DEFAULT_PRESET
from dancetutor_cli.film.choices import QUALITIES, Quality
from dancetutor_cli.film.clock import Practice
from dancetutor_cli.film.layout import FilmLook, load_layout
from dancetutor_cli.film.work.request import FilmRequest, look_up
from dancetutor_cli.run.reading import charts_path

if TYPE_CHECKING:
    from dancetutor_cli.film.work.planning import PreparedFilm


# A little work of every kind, which compiles all kernels.

_SONG = "two_left_feet/two_left_feet.ssc"
_TYPES = ("dance-single", "dance-double")


def pieces_of_work() -> Iterator[tuple[str, Callable[[], None]]]:
    """Yield the name and the function of each piece of work."""
    prepared: dict[str, PreparedFilm] = {}
    for steps_type in _TYPES:
        yield f"solve and bake {steps_type}", lambda kind=steps_type: _prepare(prepared, kind)  # type: ignore[misc]
    yield "solve with the other cost model", _solve
    for quality in QUALITIES:
        yield f"draw at quality {quality}", lambda value=quality: _draw(prepared[_TYPES[0]], value)  # type: ignore[misc]


def _solve() -> None:
    """Solve a chart with the other one of the two cost models, each of which has its own kernels.

    Also copy full tables, which the solver gets after many charts, into larger ones.
    """
    from dancetutor_cli.feet.pads import load_pad
    from dancetutor_cli.feet.preset import load_preset
    from dancetutor_cli.feet.solver import tables
    from dancetutor_cli.feet.solver.engine import Engine
    from dancetutor_cli.feet.solver.solve import solve_chart
    from dancetutor_cli.feet.solver.tables import grown

    song, preset, pad = load(charts_path() / _SONG), load_preset("thesis"), load_pad(_TYPES[0])
    solve_chart(song.charts[0], preset)
    assert pad is not None
    empty = Engine(pad, preset).tables
    for full in (tables.MORE_STATES, tables.MORE_PATTERNS, tables.MORE_PAIRS, tables.MORE_TERMS, tables.MORE_FACTS):
        grown(empty, full, 1)


def _prepare(prepared: dict[str, PreparedFilm], steps_type: str) -> None:
    from dancetutor_cli.film.work.planning import prepare

    look = FilmLook(load_layout("television"), (320, 180), renderer="cpu")
    selection = Selection(steps_type=steps_type, difficulty="hard")
    practice = Practice(metronome=True)
    dance = DanceRequest(charts_path() / _SONG, selection, DEFAULT_PRESET, bar=steps_type == _TYPES[1])
    request = FilmRequest(dance, look, section="m3:m5", practice=practice)
    prepared[steps_type] = prepare(request, look_up(request))


def _draw(prepared: PreparedFilm, quality: Quality) -> None:
    from dancetutor_cli.film.film import Film
    from dancetutor_cli.film.media.yuv import yuv420
    from dancetutor_cli.film.overlay.blit import Run, fill_run

    look = replace(prepared.plan.look, quality=quality)
    film = Film(replace(prepared.plan, look=look))
    width, height = look.size
    for number in (0, 1):
        frame = film.frame(number)
        fill_run(frame, np.zeros((8, 8, 4), dtype=np.uint8), 0, Run(0, 8, 0))  # a hold's body, which these frames lack
        yuv420(frame, np.empty(width * height * 3 // 2, dtype=np.uint8))


@click.command(cls=GroupedCommand)
@quiet_option
def command(quiet: bool) -> None:
    """Compile everything now, so that later runs start quickly.

    Solve, bake and draw a few frames of the demo song. This fills the cache of compiled code.
    """
    begin = time.monotonic()
    for name, work in pieces_of_work():
        started = time.monotonic()
        work()
        if not quiet:
            click.echo(f"{name}: {time.monotonic() - started:.1f} s")
    if not quiet:
        click.echo(f"ready after {time.monotonic() - begin:.1f} s")
