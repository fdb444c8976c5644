"""Who dances in a film, and how: the play that it shows, and the motions of the one or the two who dance it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.errors import UsageError
from dancetutor_cli.jobs.counted_in import play_without, quiet_after, quiet_in
from dancetutor_cli.jobs.film_request import FilmRequest, Subject
from dancetutor_cli.jobs.two import check_for_two, pad_of_both, place_on, sides_of
from dancetutor_cli.lint.solved import solved_chart
from dancetutor_cli.motion.baked import shifted
from dancetutor_cli.play.played import Limb, Play
from dancetutor_cli.play.rows import prepare

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart
    from dancetutor_cli.lint.subject import ChartSubject
    from dancetutor_cli.motion.baked import Motion
    from dancetutor_cli.pads import Pad
    from dancetutor_cli.video.tracks import OnMine


@dataclass(frozen=True)
class Danced:
    """A chart as it is danced.

    solved : each player's part, one for most charts; play : what the picture shows, of both, without the notes that
    nobody plays at the fastest rate; pad : under both
    motions : at each rate, none where the picture has no dancer; partners : the second player's
    on_mines : mines that a foot is on at the fastest rate as they pass
    """

    solved: tuple[ChartSubject, ...]
    play: Play
    pad: Pad
    motions: Mapping[float, Motion]
    partners: Mapping[float, Motion] = field(default_factory=dict)
    on_mines: tuple[OnMine, ...] = ()


def danced(request: FilmRequest, subject: Subject) -> Danced:
    """Find the feet and bake the motions. UsageError for a steps type without a pad."""
    chart = subject.chart
    if len(chart.players) > 1:
        return _by_two(request, subject)
    chart = chart.players[0] if chart.players else chart
    solved = solved_chart(subject.song, chart, subject.preset)
    play, pad = _known(request, solved)
    if request.play is not None:
        from dancetutor_cli.formats.play_json import read_play

        play = read_play(request.play, chart, play.rows, pad)
    shown, motions = _motions(request, replace(subject, chart=chart), (play, pad))
    motions, on_mines = _mines_told(motions, shown, pad)
    return Danced((replace(solved, play=play),), shown, pad, motions, on_mines=on_mines)


def _by_two(request: FilmRequest, subject: Subject) -> Danced:
    chart = subject.chart
    check_for_two(chart)
    alone = {"--bar": request.bar, "--play": request.play, "--push": request.push, "--trip": request.trip}
    option = next((name for name, given in alone.items() if given), None)
    if option is not None:
        raise UsageError(f"{option} is for one dancer, and {chart.label} is for two: choose with --player 1 or 2")
    whole = pad_of_both(chart.steps_type)
    solved = tuple(solved_chart(subject.song, part, subject.preset) for part in chart.players)
    plays, motions, on_mines = [], [], []
    for one, sides in zip(solved, sides_of(chart.players), strict=True):
        play, pad = _known(request, one)
        shown, baked = _motions(request, replace(subject, chart=one.chart), (play, pad), sides)
        baked, under = _mines_told(baked, shown, pad)
        at, who = one.chart.first_column, one.chart.player
        on_mines += [mine._replace(column=mine.column + at, player=who) for mine in under]
        plays.append(shown)
        place = place_on(whole, one.chart, pad)
        motions.append({rate: shifted(motion, *place) for rate, motion in baked.items()})
    return Danced(solved, together(chart, plays, whole), whole, motions[0], motions[1], tuple(on_mines))


def _mines_told(
    motions: Mapping[float, Motion], play: Play, pad: Pad
) -> tuple[dict[float, Motion], tuple[OnMine, ...]]:
    """The motions, whose notes tell of mines that a foot is on, and these mines at the fastest rate."""
    from dancetutor_cli.bake import mines_of
    from dancetutor_cli.bake.quality.ground import feet_on_mines, told_mines
    from dancetutor_cli.bake.rate import at_rate
    from dancetutor_cli.video.tracks import OnMine

    told, under = {}, np.zeros(0, np.int8)
    for rate, motion in sorted(motions.items()):
        mines = mines_of(at_rate(play, rate), pad)
        under = feet_on_mines(motion, mines)
        told[rate] = replace(motion, notes=(*motion.notes, *told_mines(mines[under >= 0, 0])))
    row, column = (places[: len(under)][under >= 0] for places in np.nonzero(play.rows.mines))
    ticks = play.rows.tick[row].tolist()
    return told, tuple(map(OnMine, ticks, column.tolist(), under[under >= 0].tolist()))


def _known(request: FilmRequest, solved: ChartSubject) -> tuple[Play, Pad]:
    if solved.play is None or solved.pad is None:
        raise UsageError(f"{request.path}: no pad is known for steps type '{solved.chart.steps_type}'")
    return solved.play, solved.pad


def together(chart: Chart, plays: Sequence[Play], whole: Pad) -> Play:
    """What both step as one play of the chart as it is written: who steps what, and what happens; no costs."""
    rows = prepare(chart, whole)
    limb = np.full(rows.steps.shape, int(Limb.NONE), dtype=np.int8)
    part = np.zeros(rows.steps.shape, dtype=np.uint8)
    moves: list[set[str]] = [set() for _ in range(len(rows))]
    for player, play in zip(chart.players, plays, strict=True):
        here = np.minimum(np.searchsorted(rows.tick, play.rows.tick), len(rows) - 1)
        at, column = np.nonzero((play.rows.steps > 0) & (rows.tick[here] == play.rows.tick)[:, None])
        limb[here[at], column + player.first_column] = play.limb[at, column]
        part[here[at], column + player.first_column] = play.part[at, column]
        for row, names in zip(here.tolist(), play.moves, strict=True):
            moves[row] |= set(names)
    return Play(
        rows=rows,
        limb=limb,
        part=part,
        feet=np.full((len(rows), 2), -1, dtype=np.int16),
        facing=np.zeros(len(rows)),
        terms=(),
        cost=np.zeros((len(rows), 0), dtype=np.int32),
        margin=None,
        moves=tuple(tuple(sorted(names)) for names in moves),
        preset=plays[0].preset,
    )


def _motions(
    request: FilmRequest, subject: Subject, known: tuple[Play, Pad], sides: tuple[int, int] | None = None
) -> tuple[Play, dict[float, Motion]]:
    """The play without what nobody plays at the fastest rate of the film, and the dancer's motion at each of them, on
    the clock that is heard there: she falls as fast as all do. known : her play and pad; sides : as in `bake.How`"""
    from dancetutor_cli.bake.rate import at_rate
    from dancetutor_cli.motion.settings import load_settings
    from dancetutor_cli.play.let_go import without_unplayable

    settings = load_settings(request.motion, request.form)
    passes = subject.clock.passes
    after = quiet_after(passes)
    play, pad = play_without(play_without(known[0], quiet_in(passes)), after), known[1]
    rates = sorted({one.rate for one in passes})
    fastest, gone = without_unplayable(at_rate(play, rates[-1]), pad)
    shown = replace(fastest, rows=play.rows)
    if request.look.layout.dancer is None:
        return shown, {}
    from dancetutor_cli.bake import bake
    from dancetutor_cli.bake.styled import styled
    from dancetutor_cli.jobs.bake import wishes_of

    return shown, {
        rate: styled(
            bake(
                subject.chart,
                at_rate(shown, rate),
                pad,
                fps=request.fps,
                section=(passes[0].start / rate, passes[-1].end / rate),
                rate=rate,
                bar=request.bar,
                gait=request.gait,
                settings=settings,
                sides=sides,
                let_go=gone,
                stays=not request.background,  # the film goes dark as she stands there
            ),
            request.style,
            settings,
            wishes_of(request.push, request.trip, rate=rate),
        ).motion
        for rate in rates
    }
