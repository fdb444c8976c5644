"""The dance of a film: the play that it shows, without quiet times, and the motions of all dancers."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.motion import Motion, shifted
from dancetutor_cli.dance.performance import (
    as_heard,
    pad_of,
    perform,
    piece_runner,
    place_on,
    play_of_all,
    playable,
    solve,
)
from dancetutor_cli.dance.quality.contact import feet_on_mines, mine_messages, mines_of
from dancetutor_cli.film.notes import OnMine
from dancetutor_cli.film.work.request import FilmRequest, FilmSubject
from dancetutor_cli.run.errors import UsageError

if TYPE_CHECKING:
    from dancetutor_cli.dance.performance import Performance
    from dancetutor_cli.feet.pads import Pad
    from dancetutor_cli.feet.play import Play
    from dancetutor_cli.feet.solved import Solved
    from dancetutor_cli.film.clock import Clock, Pass
    from dancetutor_cli.film.notes import NoteTrack


# The parts that are neither danced nor shown: the count-in, and the time after a passage.

REST_SECONDS = 0.7  # seconds without steps before the film begins, so that the dancer stands at its beginning


class Quiet(NamedTuple):
    """Seconds of the music in which nobody steps: from `since` on, before `until`."""

    since: float
    until: float

    def has(self, second: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Return for each of these seconds whether it is in the quiet time."""
        return np.asarray((second >= self.since) & (second < self.until - 1e-6))


def quiet_times(passes: Sequence[Pass]) -> list[Quiet]:
    """Return the quiet times: the count-in if there is one, and the time after a passage in which the dancer rests.

    All runs of a film begin at the same second, and so have the same count-in.
    """
    one, times = passes[0], []
    if one.count:
        times.append(Quiet(one.start - REST_SECONDS * max(p.rate for p in passes), one.sound_from))
    if passes[-1].rest:
        times.append(Quiet(passes[-1].until, math.inf))
    return times


def shown_play(play: Play, passes: Sequence[Pass]) -> Play:
    """Return the play without the rows in quiet times; a quiet time that would leave no row is ignored."""
    for quiet in quiet_times(passes):
        keep = ~quiet.has(play.rows.second)
        if keep.all() or not (play.limb[keep] >= 0).any():
            continue
        rows = replace(play.rows, **_filter_arrays(play.rows, keep))
        moves = tuple(names for names, kept in zip(play.moves, keep.tolist(), strict=True) if kept)
        play = replace(play, rows=rows, moves=moves, **_filter_arrays(play, keep))
    return play


def shown_notes(track: NoteTrack, passes: Sequence[Pass]) -> NoteTrack:
    """Return the notes outside of quiet times."""
    for quiet in quiet_times(passes):
        track = replace(track, **_filter_arrays(track, ~quiet.has(track.second)))
    return track


def _filter_arrays(arrays: Any, keep: NDArray[np.bool_]) -> dict[str, Any]:
    """Return the entries to keep of each array of a dataclass."""
    found = {field.name: getattr(arrays, field.name) for field in fields(arrays)}
    return {name: value[keep] for name, value in found.items() if isinstance(value, np.ndarray)}


# The dance of a film.


@dataclass(frozen=True)
class FilmDance:
    """The dance of a chart as a film shows it.

    solved : the parts of the players, one for most charts
    plays : the play of each part, without notes that nobody plays at the fastest rate or that the film does not show
    play : all plays together on the common pad, `pad`
    motions : the motion of each dancer at each rate; empty for a picture without a dancer
    on_mines : the mines that pass under a foot at the fastest rate
    """

    solved: tuple[Solved, ...]
    plays: tuple[Play, ...]
    play: Play
    pad: Pad
    motions: Mapping[float, tuple[Motion, ...]]
    on_mines: tuple[OnMine, ...] = ()


def film_dance(request: FilmRequest, subject: FilmSubject) -> FilmDance:
    """Find the feet and bake the motions. UsageError for a steps type without a pad."""
    clock = subject.clock
    solved = solve(request.dance, subject.choice)
    rates = sorted({one.rate for one in clock.passes})
    plays = tuple(shown_play(playable(one, rates), clock.passes) for one in solved)
    motions: dict[float, tuple[Motion, ...]] = {}
    if request.look.layout.dancer is not None:
        dance = replace(request.dance, rates=tuple(rates))
        for rate in rates:
            performance = perform(solved, dance, rate)
            motions[rate] = (
                _file_motions(request, performance) if request.motions else _cut(request, performance, clock)
            )
    results, on_mines = _mines(motions, list(zip(solved, plays, strict=True)), rates[-1])
    shown = shown_play(play_of_all(solved, plays), clock.passes)  # also without rows that have become empty
    return FilmDance(solved, plays, shown, pad_of(solved), results, on_mines)


def _cut(request: FilmRequest, performance: Performance, clock: Clock) -> tuple[Motion, ...]:
    """Return the part of a performance that the film shows, with each dancer at her place on the common pad."""
    wanted = replace(clock.cut_at(performance.rate), walks_off=request.background)
    done = performance.bake(wanted, piece_runner())
    return tuple(shifted(one.motion, *who.place) for one, who in zip(done, performance.dancers, strict=True))


def _file_motions(request: FilmRequest, performance: Performance) -> tuple[Motion, ...]:
    """Return the motions of files, which replace the performance's own."""
    count = len(performance.dancers)
    if performance.rate != 1.0:
        raise UsageError("the motion of --dance is for music at normal speed; leave --rate out, or bake it again")
    if len(request.motions) != count:
        raise UsageError(f"the chart is for {count} dancers, so give --dance {count} time{'s' if count > 1 else ''}")
    from dancetutor_cli.formats.npz import read_npz

    return tuple(read_npz(path) for path in request.motions)


def _mines(
    motions: Mapping[float, Sequence[Motion]], plays: Sequence[tuple[Solved, Play]], fastest: float
) -> tuple[dict[float, tuple[Motion, ...]], tuple[OnMine, ...]]:
    """Return the motions with notes about mines under a foot, and these mines at the fastest rate."""
    pad = pad_of([one for one, _ in plays])
    out: dict[float, tuple[Motion, ...]] = {}
    found: list[OnMine] = []
    for rate, some in motions.items():
        results = []
        for motion, (one, play) in zip(some, plays, strict=True):
            assert one.pad is not None
            mines = mines_of(as_heard(play, one.chart.timing.at_rate(rate)), one.pad)
            if len(plays) > 1:
                mines += [0.0, *place_on(pad, one.chart, one.pad)]
            under = feet_on_mines(motion, mines)
            results.append(replace(motion, notes=(*motion.notes, *mine_messages(mines[under >= 0, 0]))))
            if rate == fastest:
                found += _on_mines(one, play, under, len(plays) > 1)
        out[rate] = tuple(results)
    return out, tuple(found)


def _on_mines(one: Solved, play: Play, under: np.ndarray, by_two: bool) -> list[OnMine]:
    row, column = (places[under >= 0] for places in np.nonzero(play.rows.mines))
    at, who = (one.chart.first_column, one.chart.player) if by_two else (0, 0)
    ticks = play.rows.tick[row].tolist()
    return [
        OnMine(tick, c + at, foot, who)
        for tick, c, foot in zip(ticks, column.tolist(), under[under >= 0].tolist(), strict=True)
    ]
