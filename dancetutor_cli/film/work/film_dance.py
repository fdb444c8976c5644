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


def bake_film_dance(request: FilmRequest, subject: FilmSubject) -> FilmDance:
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
    shown = shown_play(play_of_all(solved, plays), clock.passes)  # also without rows that have become empty
    under = {rate: _mines_under_feet(some, solved, plays, rate) for rate, some in motions.items()}
    results = {rate: tuple(map(_with_mine_notes, some, under[rate])) for rate, some in motions.items()}
    on_mines = _on_mines(solved, plays, under[rates[-1]]) if motions else ()
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


class _UnderFeet(NamedTuple):
    """The mines of a dancer at one rate. second : (m,) as heard; foot : (m,) the foot over it, 0 or 1, -1 for none"""

    second: NDArray[np.float64]
    foot: NDArray[np.int8]


def _mines_under_feet(
    motions: Sequence[Motion], solved: Sequence[Solved], plays: Sequence[Play], rate: float
) -> list[_UnderFeet]:
    """Return the mines of each dancer and the feet over them; in the order of the mines of her play."""
    whole, out = pad_of(solved), []
    for motion, one, play in zip(motions, solved, plays, strict=True):
        assert one.pad is not None
        mines = mines_of(as_heard(play, one.chart.timing.at_rate(rate)), one.pad)
        if len(solved) > 1:
            mines += [0.0, *place_on(whole, one.chart, one.pad)]
        out.append(_UnderFeet(mines[:, 0], feet_on_mines(motion, mines)))
    return out


def _with_mine_notes(motion: Motion, under: _UnderFeet) -> Motion:
    """Return the motion with a note for the user about the mines under a foot."""
    return replace(motion, notes=(*motion.notes, *mine_messages(under.second[under.foot >= 0])))


def _on_mines(solved: Sequence[Solved], plays: Sequence[Play], under: Sequence[_UnderFeet]) -> tuple[OnMine, ...]:
    """Return the mines under a foot, with columns of the pad of all dancers."""
    found = []
    for one, play, (_, foot) in zip(solved, plays, under, strict=True):
        first, who = (one.chart.first_column, one.chart.player) if len(solved) > 1 else (0, 0)
        row, column = (places[foot >= 0] for places in np.nonzero(play.rows.mines))
        places = zip(play.rows.tick[row].tolist(), column.tolist(), foot[foot >= 0].tolist(), strict=True)
        found += [OnMine(tick, first + c, side, who) for tick, c, side in places]
    return tuple(found)
