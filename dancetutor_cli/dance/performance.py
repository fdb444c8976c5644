"""The performance of a chart: its dancers and how they dance. Every section, film, page and file shows a part of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

from dancetutor_cli.dance.bake import Manner, bake_piece, cut, planned
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
from dancetutor_cli.dance.kept import with_store
from dancetutor_cli.dance.motion import Cut, Motion
from dancetutor_cli.dance.pieces import BakedPiece, Piece, PieceRunner, RagdollStyle, in_turn, pieces_of, whole_span
from dancetutor_cli.dance.request import ChartChoice, DanceRequest, check_request, no_pad, read_chart
from dancetutor_cli.dance.settings import load_settings
from dancetutor_cli.dance.two import merge_plays, pad_of_both, persons_of, place_on, sides_of
from dancetutor_cli.feet.play import without_unplayable
from dancetutor_cli.feet.solved import Solved, solve_song
from dancetutor_cli.run.errors import DancetutorError, UsageError
from dancetutor_cli.run.pool import in_order

if TYPE_CHECKING:
    from dancetutor_cli.chart.timing import Timing
    from dancetutor_cli.dance.context import Context
    from dancetutor_cli.dance.physics.blend import Blend
    from dancetutor_cli.dance.plan import Plan
    from dancetutor_cli.feet.pads import Pad
    from dancetutor_cli.feet.play import Play


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

    def motions(self, wanted: Cut | None = None, run: PieceRunner = in_turn) -> list[BakedPiece]:
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
        done = cut(pieces_of(plan, context, fps, style), (wanted.start, wanted.end), run)
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
                raise UsageError(f"{name} {second:g}: the motion lasts from {wanted.start:.3f} s to {wanted.end:.3f} s")
        return RagdollStyle(self.blend, options)


def _one(run: PieceRunner, piece: Piece) -> Motion:
    return next(iter(run(bake_piece, [piece]))).motion


def solve(request: DanceRequest, chart: ChartChoice | None = None) -> tuple[Solved, ...]:
    """Solve the feet of each dancer. Raises a DancetutorError of one line for each error in the request.

    chart : the chart of the request, if the caller has read it
    """
    if chart is None:
        check_request(request)
        chart = read_chart(request)
    presets = {part.player: preset for part, preset in zip(chart.parts, chart.presets, strict=True)}
    solved = tuple(solve_song(chart.song, chart.parts, lambda part: presets[part.player]))
    for one in solved:
        if one.play is None or one.pad is None:
            raise no_pad(request, one.chart)
    if request.play is None:
        return solved
    from dancetutor_cli.feet.play_json import read_play

    one = solved[0]
    assert one.play is not None and one.pad is not None
    return (replace(one, play=read_play(request.play, one.chart, one.play.rows, one.pad)),)


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
        plan, context = planned(timing, play, own, **manner)
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


def pooled(jobs: int = 1) -> PieceRunner:
    """Return a runner that bakes pieces in up to `jobs` processes, in order, and reads kept pieces from the store."""
    return with_store(in_turn if jobs <= 1 else partial(_pooled, jobs))


def _pooled(jobs: int, function: Callable[[Piece], BakedPiece], pieces: Sequence[Piece]) -> Iterator[BakedPiece]:
    if len(pieces) == 1:
        yield function(pieces[0])
        return
    yield from in_order(jobs, function, [(piece,) for piece in pieces])
