"""Doing a little of everything, so that numba's cache is full."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from dancetutor_cli.jobs.film_request import Practice, Request, look_up
from dancetutor_cli.jobs.selection import Selection
from dancetutor_cli.resources import charts_path
from dancetutor_cli.video.film_look import QUALITIES, FilmLook, Quality
from dancetutor_cli.video.layout import load_layout

if TYPE_CHECKING:
    from dancetutor_cli.jobs.film_plan import Prepared

_SONG = "two_left_feet/two_left_feet.ssc"
_TYPES = ("dance-single", "dance-double")


def steps() -> Iterator[tuple[str, Callable[[], None]]]:
    """What to do, by name."""
    prepared: dict[str, Prepared] = {}
    for steps_type in _TYPES:
        yield f"solve and bake {steps_type}", lambda kind=steps_type: _prepare(prepared, kind)  # type: ignore[misc]
    for quality in QUALITIES:
        yield f"draw at quality {quality}", lambda value=quality: _draw(prepared[_TYPES[0]], value)  # type: ignore[misc]


def _prepare(prepared: dict[str, Prepared], steps_type: str) -> None:
    from dancetutor_cli.jobs.film_plan import prepare

    look = FilmLook(load_layout("television"), (320, 180), renderer="cpu")
    selection = Selection(steps_type=steps_type, difficulty="hard")
    request = Request(charts_path() / _SONG, selection, look, section="m3:m5", practice=Practice(metronome=True))
    prepared[steps_type] = prepare(request, look_up(request))


def _draw(prepared: Prepared, quality: Quality) -> None:
    from dataclasses import replace

    from dancetutor_cli.video.film import Film

    look = replace(prepared.plan.look, quality=quality)
    film = Film(replace(prepared.plan, look=look))
    for number in (0, 1):
        film.frame(number)
