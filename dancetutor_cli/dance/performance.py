"""The performance of a chart: one or two dancers and how they dance. All sections, films and files are its parts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.chart.players import ONE_PAD, OWN_PADS
from dancetutor_cli.dance.context import PANEL, panels_on_ground
from dancetutor_cli.dance.ends import (
    entrance_of,
    entrance_piece,
    exit_of,
    exit_piece,
    on_the_pad,
    rest_from,
    with_entrance,
    with_exit,
)
from dancetutor_cli.dance.footwork.planner import Manner, plan_dance
from dancetutor_cli.dance.footwork.turning import leading_foot
from dancetutor_cli.dance.motion import Cut, Motion
from dancetutor_cli.dance.pieces import (
    BakedPiece,
    Piece,
    PieceRunner,
    RagdollStyle,
    bake_section,
    in_processes,
    in_turn,
    pieces_of,
    whole_span,
    with_store,
)
from dancetutor_cli.dance.request import ChartChoice, DanceRequest, check_request, no_pad, read_chart
from dancetutor_cli.dance.settings import load_settings
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.play import Play, prepare_rows
from dancetutor_cli.feet.solved import Solved, solve_song
from dancetutor_cli.feet.unplayable import without_unplayable
from dancetutor_cli.run.errors import DancetutorError, UsageError

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart
    from dancetutor_cli.chart.timing import Timing
    from dancetutor_cli.dance.context import Context
    from dancetutor_cli.dance.physics.blend import Blend
    from dancetutor_cli.dance.plan import Plan
    from dancetutor_cli.feet.pads import Pad


@dataclass(frozen=True, slots=True)
class Performer:
    """One of the dancers: her part of the chart, and her motion on her own pad.

    play, plan : at seconds of the music as it is heard, without the notes that nobody plays
    place : the middle of her pad from the middle of the pad of all dancers, (x, z) in metres
    """

    solved: Solved
    pad: Pad
    play: Play
    plan: Plan
    context: Context
    place: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Performance:
    """The dance of a chart at one rate of its music. For a single dancer, `dancers` has length one.

    pad : under all dancers; timing : of the music as it is heard
    blend : the styles in which a ragdoll follows the dancers; None: no ragdoll
    """

    request: DanceRequest
    rate: float
    timing: Timing
    pad: Pad
    dancers: tuple[Performer, ...]
    blend: Blend | None = None

    @property
    def span(self) -> tuple[float, float]:
        """The first and last second, of the music as it is heard."""
        spans = [whole_span(one.plan, one.context) for one in self.dancers]
        return min(start for start, _ in spans), max(end for _, end in spans)

    def bake(self, wanted: Cut | None = None, run: PieceRunner = in_turn) -> list[BakedPiece]:
        """Bake the motion of each dancer on her own pad; `place` is the position of that pad.

        Parameters
        ----------
        wanted : the part of the performance to bake; None: all of it
        run : bakes the pieces, in turn or in several processes
        """
        wanted = wanted or Cut(*self.span)
        ragdoll = self._ragdoll(wanted)
        return [self._motion(one, wanted, ragdoll, run) for one in self.dancers]

    def _motion(self, who: Performer, wanted: Cut, style: RagdollStyle | None, run: PieceRunner) -> BakedPiece:
        plan, context, fps = who.plan, who.context, self.request.fps
        wanted = on_the_pad(plan, wanted)
        done = bake_section(pieces_of(plan, context, fps, style), (wanted.start, wanted.end), run)
        motion = done.motion
        if (entrance := entrance_of(plan, wanted)) is not None:
            piece = entrance_piece(entrance, context, fps, wanted, style)
            motion = with_entrance(motion, _one(run, piece), wanted)
        if (until := rest_from(plan, wanted)) is not None:
            rest = exit_of(plan, (until, wanted.end), context.at(until))
            piece = exit_piece(rest, context, fps, (until, wanted.end), style)
            motion = with_exit(motion, _one(run, piece), until, wanted)
        return replace(done, motion=motion)

    def _ragdoll(self, wanted: Cut) -> RagdollStyle | None:
        if self.blend is None:
            return None
        from dancetutor_cli.dance.physics.pipeline import parse_ragdoll_options

        options = parse_ragdoll_options(self.request.push, self.request.trip, self.rate)
        disturbances = [("--push", one.second) for one in options.pushes]
        disturbances += [("--trip", one.second) for one in options.stumbles]
        for name, second in disturbances:
            if not wanted.start <= second <= wanted.end:
                limits = f"{wanted.start:.3f} s to {wanted.end:.3f} s"
                raise UsageError(f"{name} {second:g}: give a time within the motion, {limits}")
        return RagdollStyle(self.blend, options)


def _one(run: PieceRunner, piece: Piece) -> Motion:
    return next(iter(run([piece]))).motion


def solve(request: DanceRequest, chart: ChartChoice | None = None) -> tuple[Solved, ...]:
    """Solve the feet of each dancer. Raises a DancetutorError of one line for each error in the request.

    chart : the chart of the request, if the caller has read it
    """
    if chart is None:
        check_request(request)
        chart = read_chart(request)
    solved = tuple(solve_song(chart.song, list(zip(chart.parts, chart.presets, strict=True))))
    for one in solved:
        if one.play is None or one.pad is None:
            raise no_pad(request, one.chart)
    if request.play is None:
        return solved
    from dancetutor_cli.feet.play_json import read_play

    one = solved[0]
    assert one.play is not None and one.pad is not None
    return (replace(one, play=read_play(request.play, one.chart, one.play.rows)),)


def perform(solved: Sequence[Solved], request: DanceRequest, rate: float = 1.0) -> Performance:
    """Plan the dance of all dancers at one of the request's rates. Raises DancetutorError if a chart has no steps."""
    timing = solved[0].chart.timing.at_rate(rate)
    parts = [one.chart for one in solved]
    pad = pad_of(solved)
    sides = sides_of(parts) if len(parts) > 1 else (None,)
    blend = None
    if request.style is not None:
        from dancetutor_cli.dance.physics.blend import load_choice

        blend = load_choice(request.style).blend(timing)
    dancers = []
    people = persons_of([(one.play, one.pad) for one in solved if one.play is not None and one.pad is not None])
    for one, side, person in zip(solved, sides, people, strict=True):
        play, own = one.play, one.pad
        assert play is not None and own is not None
        if not (play.limb >= 0).any():
            raise DancetutorError(
                f"{request.path}: {one.chart.label}: the chart has no steps, so there is nothing to dance"
            )
        fastest, gone = without_unplayable(as_heard(play, one.chart.timing.at_rate(max(request.rates))), own)
        play = as_heard(fastest, timing)
        numbers = request.motion, request.form
        settings = load_settings(*numbers) if blend is None else blend.settings(*numbers)
        manner = Manner(settings=settings, bar=request.bar, gait=request.gait, sides=side, person=person, dropped=gone)
        plan, context = plan_dance(timing, play, own, **manner)
        place = place_on(pad, one.chart, own) if len(parts) > 1 else (0.0, 0.0)
        dancers.append(Performer(one, own, play, plan, context, place))
    return Performance(request, rate, timing, pad, tuple(dancers), blend)


def pad_of(solved: Sequence[Solved]) -> Pad:
    """Return the pad under all dancers."""
    pad = solved[0].pad if len(solved) == 1 else pad_of_both(solved[0].chart.written_type)
    assert pad is not None
    return pad


def play_of_all(solved: Sequence[Solved], plays: Sequence[Play]) -> Play:
    """Return the steps of all dancers as one play, on the pad under all of them. plays : the play of each dancer"""
    if len(solved) == 1:
        return plays[0]
    first = solved[0]
    return merge_plays(first.song.charts[first.chart.index], plays, pad_of(solved), first.preset.roll_window)


def playable(one: Solved, rates: Iterable[float]) -> Play:
    """Return a play without the notes that nobody plays at the fastest rate; its seconds are seconds of the song."""
    assert one.play is not None and one.pad is not None
    fastest, _ = without_unplayable(as_heard(one.play, one.chart.timing.at_rate(max(rates))), one.pad)
    return replace(fastest, rows=one.play.rows)


def as_heard(play: Play, timing: Timing) -> Play:
    """Return a play whose seconds are seconds of `timing`, the music as it is heard."""
    return replace(play, rows=replace(play.rows, second=timing.seconds(play.rows.tick)))


def piece_runner(jobs: int = 1) -> PieceRunner:
    """Return a runner that bakes pieces in up to `jobs` processes, in order, and reads kept pieces from the store."""
    return with_store(in_turn if jobs <= 1 else partial(in_processes, jobs))


# Charts for two dancers: the pad under both, and the place of each dancer on it.

SIDE_NOTES = 8  # notes at either end that decide where a player stands
# Steps type as written -> the pad under both dancers. In couple charts each has half of it; otherwise her own pad.
_WHOLE = {**ONE_PAD, **{kind: f"{kind.partition('-')[0]}-double" for kind in OWN_PADS}}


def check_alone(request: DanceRequest, chart: Chart) -> None:
    """Raise UsageError if a request cannot be met for all dancers of a chart. Each of them can dance alone.

    A picture has room for two dancers, and some options of a request are only for one dancer.
    """
    count = len(chart.players)
    if count > 2:
        choice = f"at most two dancers fit in one picture: choose with --player 1 to {count}"
        raise UsageError(f"{chart.label} is for {count} players, and {choice}")
    alone = {"--bar": request.bar, "--play": request.play, "--push": request.push, "--trip": request.trip}
    option = next((name for name, given in alone.items() if given), None)
    if option is not None:
        raise UsageError(f"{option} is for one dancer, and {chart.label} is for two: choose with --player 1 or 2")


def pad_of_both(steps_type: str) -> Pad:
    """Return the pad under both dancers of a chart for two. steps_type : as the chart is written"""
    pad = load_pad(_WHOLE.get(steps_type, steps_type))
    assert pad is not None
    return pad


def place_on(whole: Pad, part: Chart, pad: Pad) -> tuple[float, float]:
    """Return the place of a player's own pad from the middle of the pad of both: (x, z) in metres of the world.

    The x of panels goes to the player's right, the x of the world to her left.
    """
    away = whole.panels[part.first_column] - pad.panels[0] + np.array(pad.centre) - np.array(whole.centre)
    return float(-away[0] * PANEL), float(away[1] * PANEL)


def sides_of(parts: Sequence[Chart]) -> tuple[tuple[int, int], ...]:
    """Return the side from which each dancer comes and the side to which she goes, 0 left or 1 right: the outer sides.

    On one pad the dancers may change places. Then each goes to the other side, so that their ways do not cross.

    parts : the players' parts of a chart, in their order
    """
    whole = pad_of_both(parts[0].written_type)
    return tuple(
        zip(*(_on_the_right(parts, whole, ends) for ends in (slice(SIDE_NOTES), slice(-SIDE_NOTES, None))), strict=True)
    )


def persons_of(plays: Sequence[tuple[Play, Pad]]) -> tuple[int, ...]:
    """Return the person of each dancer, as `Context.person`: 0 for a single dancer, otherwise 0 and 1.

    In the mirror image of a chart, each dancer stays the same person. Side and leading foot decide the persons; both
    change in the mirror image. If they do not decide, the times of notes and their distance ahead decide; these do not
    change. Only if two plays are each other's mirror image, the left dancer comes first, so that the two are not twins.

    plays : of each dancer, from the left, with her own pad
    """
    if len(plays) < 2:
        return (0,)
    leads = [leading_foot(play, panels_on_ground(pad)) for play, pad in plays]
    if leads[0] == leads[1]:
        return leads[0], 1 - leads[0]
    return (1, 0) if _ahead(*plays) > 0 else (0, 1)


def _ahead(one: tuple[Play, Pad], other: tuple[Play, Pad]) -> int:
    """Return which of two plays comes first, -1 or 1, by properties that mirror images share; 0 for mirror images."""
    keys = []
    for play, pad in (one, other):
        row, column = np.nonzero(play.limb >= 0)
        order = np.lexsort((pad.panels[column, 1], row))
        keys.append((play.rows.tick[row][order].tolist(), pad.panels[column, 1][order].tolist()))
    return int(keys[0] > keys[1]) - int(keys[0] < keys[1])


def _on_the_right(parts: Sequence[Chart], whole: Pad, ends: slice) -> list[int]:
    """Return 1 for each player on the right, otherwise 0. Some of the notes decide, and the right half of the players
    gets 1.
    """
    columns = [part.first_column + part.notes.column[ends] for part in parts]
    places = [float(whole.panels[own, 0].mean()) if len(own) else 0.0 for own in columns]
    ranks = np.argsort(np.argsort(places, kind="stable"))
    return [int(2 * rank >= len(parts)) for rank in ranks]


def merge_plays(chart: Chart, plays: Sequence[Play], whole: Pad, roll_window: float) -> Play:
    """Return the steps of both dancers as one play of the chart as it is written: limbs and moves, without costs.

    roll_window : of the preset with which the plays were found
    """
    rows = prepare_rows(chart, whole, roll_window)
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
