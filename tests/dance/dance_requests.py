"""Dances and films of chart files as commands make them, for the tests of all rooms."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from dancetutor_cli.character.animation import Animation
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.chart.timing import heard_second
from dancetutor_cli.commands.animate import AFTER
from dancetutor_cli.dance.motion import Motion, sample
from dancetutor_cli.dance.performance import perform, solve
from dancetutor_cli.dance.request import DanceRequest, check_request, read_chart, section_of
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.feet.solved import Solved
from dancetutor_cli.film.layout import FilmLook
from dancetutor_cli.film.work.request import FilmRequest

DANCE = {field.name for field in fields(DanceRequest)} - {"fps"}  # a film's frames per second are its own


def film_request(path: Path, selection: Selection, look: FilmLook, **more: Any) -> FilmRequest:
    """A request of a film. more : fields of `FilmRequest`, and of its dance, but for `fps`, which is the film's"""
    dance = {name: more.pop(name) for name in DANCE & set(more)}
    return FilmRequest(DanceRequest(path, selection, **dance), look, **more)


def solved_one(path: Path, selection: Selection, preset: str | None = None, **more: Any) -> Solved:
    """One chart with its feet. more : fields of `DanceRequest`"""
    (one,) = solve(DanceRequest(path, selection, preset, **more))
    return one


def animated(request: DanceRequest, section: str | None = None, rate: float = 1.0) -> Animation:
    """What `animate` makes of a request. section : as the user writes it, of the song, None: all of it"""
    check_request(request)
    choice = read_chart(request, section)
    performance = perform(solve(request, choice), request, rate)
    if section is None:
        return Animation(performance)
    last = max(float(one.solved.play.rows.second[-1]) for one in performance.dancers if one.solved.play is not None)
    start, end = section_of(choice, section, last + AFTER)
    return Animation(performance, (heard_second(start, rate), heard_second(end, rate)))


def baked(request: DanceRequest, section: str | None = None, rate: float = 1.0) -> Motion:
    """The motion of one who dances alone. Arguments as in `animated`."""
    (one,) = animated(request, section, rate).baked_pieces
    return one.motion


def apart(one: Motion, other: Motion, start: float, end: float) -> float:
    """Largest distance of any joint between two motions at the keys of the first one in these seconds, metres."""
    at = one.times[(one.times >= start) & (one.times <= end)]
    places = [world_transforms(motion.skeleton, *sample(motion, at))[0] for motion in (one, other)]
    return float(np.linalg.norm(places[0] - places[1], axis=2).max())
