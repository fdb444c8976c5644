"""Who dances in a film, and how: the play that it shows, and the motions of all who dance it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.dance.performance import as_heard, pad_of, perform, play_of_all, playable, pooled, solve
from dancetutor_cli.dance.two import place_on
from dancetutor_cli.errors import UsageError
from dancetutor_cli.jobs.counted_in import play_without, quiet_after, quiet_in
from dancetutor_cli.motion.baked import Motion, shifted
from dancetutor_cli.video.tracks import OnMine

if TYPE_CHECKING:
    from dancetutor_cli.dance.performance import Performance
    from dancetutor_cli.jobs.film_request import FilmRequest, FilmSubject
    from dancetutor_cli.pads import Pad
    from dancetutor_cli.play.played import Play
    from dancetutor_cli.play.solved import Solved
    from dancetutor_cli.video.clock import Clock


@dataclass(frozen=True)
class FilmDance:
    """A chart as a film shows it.

    solved : each player's part, one for most charts; plays : of each, without the notes that nobody plays at the
    fastest rate, nor those of which the film shows nothing; play : all of them on the pad under all, `pad`
    motions : of each dancer at each rate; none where the picture has no dancer
    on_mines : mines that a foot is on at the fastest rate as they pass
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
    quiet, after = quiet_in(clock.passes), quiet_after(clock.passes)
    plays = tuple(play_without(play_without(playable(one, rates), quiet), after) for one in solved)
    motions: dict[float, tuple[Motion, ...]] = {}
    if request.look.layout.dancer is not None:
        dance = replace(request.dance, rates=tuple(rates))
        for rate in rates:
            performance = perform(solved, dance, rate)
            motions[rate] = _given(request, performance) if request.motions else _cut(request, performance, clock)
    told, on_mines = _mines(motions, list(zip(solved, plays, strict=True)), rates[-1])
    shown = play_without(play_without(play_of_all(solved, plays), quiet), after)  # rows of which nothing is left, too
    return FilmDance(solved, plays, shown, pad_of(solved), told, on_mines)


def _cut(request: FilmRequest, performance: Performance, clock: Clock) -> tuple[Motion, ...]:
    """What the film shows of a performance, each dancer where she stands on the pad under all."""
    done = performance.motions(clock.cut_at(performance.rate), pooled(), request.background)
    return tuple(shifted(one.motion, *who.place) for one, who in zip(done, performance.dancers, strict=True))


def _given(request: FilmRequest, performance: Performance) -> tuple[Motion, ...]:
    """The motions of files in place of the performance's own."""
    from dancetutor_cli.formats.npz import read_npz

    count = len(performance.dancers)
    if performance.rate != 1.0:
        raise UsageError("--dance is of music at its own speed; leave --rate out, or bake the file again")
    if len(request.motions) != count:
        raise UsageError(f"the chart is danced by {count}, so give --dance {count} time{'s' if count > 1 else ''}")
    return tuple(read_npz(path) for path in request.motions)


def _mines(
    motions: Mapping[float, Sequence[Motion]], plays: Sequence[tuple[Solved, Play]], fastest: float
) -> tuple[dict[float, tuple[Motion, ...]], tuple[OnMine, ...]]:
    """The motions, whose notes tell of mines that a foot is on, and these mines at the fastest rate."""
    from dancetutor_cli.bake import mines_of
    from dancetutor_cli.bake.quality.ground import feet_on_mines, told_mines

    pad = pad_of([one for one, _ in plays])
    out: dict[float, tuple[Motion, ...]] = {}
    found: list[OnMine] = []
    for rate, some in motions.items():
        told = []
        for motion, (one, play) in zip(some, plays, strict=True):
            assert one.pad is not None
            mines = mines_of(as_heard(play, one.chart.timing.at_rate(rate)), one.pad)
            if len(plays) > 1:
                mines += [0.0, *place_on(pad, one.chart, one.pad)]
            under = feet_on_mines(motion, mines)
            told.append(replace(motion, notes=(*motion.notes, *told_mines(mines[under >= 0, 0]))))
            if rate == fastest:
                found += _on_mines(one, play, under, len(plays) > 1)
        out[rate] = tuple(told)
    return out, tuple(found)


def _on_mines(one: Solved, play: Play, under: np.ndarray, by_two: bool) -> list[OnMine]:
    row, column = (places[under >= 0] for places in np.nonzero(play.rows.mines))
    at, who = (one.chart.first_column, one.chart.player) if by_two else (0, 0)
    ticks = play.rows.tick[row].tolist()
    return [
        OnMine(tick, c + at, foot, who)
        for tick, c, foot in zip(ticks, column.tolist(), under[under >= 0].tolist(), strict=True)
    ]
