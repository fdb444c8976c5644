"""The piece of work of `animate`: one chart in, its play, motion and moves out."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.errors import DancetutorError, UsageError
from dancetutor_cli.jobs.chosen import chosen
from dancetutor_cli.library.selection import Selection
from dancetutor_cli.lint.part import part_of
from dancetutor_cli.motion.forms import USUAL

if TYPE_CHECKING:
    from dancetutor_cli.bake.pieces import BakedPiece, Piece
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.motion.baked import Bar, Motion
    from dancetutor_cli.motion.plan import Plan
    from dancetutor_cli.pads import Pad
    from dancetutor_cli.physics.pipeline import Wishes
    from dancetutor_cli.play.played import Play
    from dancetutor_cli.play.preset import Preset

AFTER = 2.5  # seconds after the last row that a section may still reach


@dataclass(frozen=True, slots=True)
class BakeTask:
    """What to bake. Pickles, so that another process can do it.

    preset : name or file of the solver's costs, None: what `lint.presets` finds for the chart
    play_file : a play as JSON instead of the solver's, or None
    section : as the user wrote it, or None; rate : speed of the music, 1 is its own
    bar : she holds the bar behind the pad; gait : name or file of how she walks on and off
    motion : file with numbers of the motion that are other than those of configs/motion.yaml
    form : name or file of how she stands and turns
    jobs : processes among which the pieces of a long song are shared
    style : name or file of the style in which a ragdoll follows the dancer; None: no ragdoll
    push, trip : what befalls her, as `physics.pushes.parse_push` takes it, and seconds of the song; only with a style
    """

    path: Path
    selection: Selection
    preset: str | None = None
    fps: float = 60.0
    section: str | None = None
    rate: float = 1.0
    play_file: Path | None = None
    bar: bool = False
    gait: str = "flat"
    jobs: int = 1
    motion: Path | None = None
    form: str = USUAL
    style: str | None = None
    push: tuple[str, ...] = ()
    trip: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Asked:
    """A chart, ready to be baked: its play at the asked rate, and the section in seconds, None for all of it.

    notes : lines for people about the request
    """

    song: Song
    chart: Chart
    play: Play
    pad: Pad
    section: tuple[float, float] | None
    notes: tuple[str, ...] = ()


def ask(task: BakeTask) -> Asked:
    """Read and solve. Raises a DancetutorError of one line for all that is wrong with the request."""
    from dancetutor_cli.bake.rate import at_rate

    check_motion(task.motion, task.gait, task.form)
    check_style(task.style)
    wishes_of(task.push, task.trip)
    song, chart, preset, notes = chosen(task.path, task.selection, task.preset, task.section)
    play, pad = _play(task, song, chart, preset)
    if not (play.limb >= 0).any():
        raise DancetutorError(f"{task.path}: {chart.label}: the chart has no steps, so there is nothing to dance")
    section = None
    if task.section is not None:
        start, end = part_of(task.section, song, chart, preset, float(play.rows.second[-1]) + AFTER)
        section = (start / task.rate, end / task.rate)
    return Asked(song, chart, at_rate(play, task.rate), pad, section, notes)


def check_motion(motion: Path | None, gait: str, form: str = USUAL) -> None:
    """Say what is wrong with a file of motion, a gait or a form: FileError or UsageError, before the work."""
    from dancetutor_cli.motion.gait import load_gait
    from dancetutor_cli.motion.settings import load_settings

    load_settings(motion, form)
    load_gait(gait)


def check_style(style: str | None) -> None:
    """Say what is wrong with a style: FileError or UsageError, before the work; UnavailableError without the engine."""
    if style is None:
        return
    from dancetutor_cli.physics.backend import engine
    from dancetutor_cli.physics.style import load_style

    load_style(style)
    engine()


def style_for(style: str | None, push: Sequence[str], trip: Sequence[float]) -> str | None:
    """The style that is asked for, and neutral where none is, but something befalls her."""
    return "neutral" if style is None and (push or trip) else style


def wishes_of(
    push: Sequence[str], trip: Sequence[float], corrections: tuple[str, ...] = (), rate: float = 1.0
) -> Wishes | None:
    """What shall happen to a motion in a ragdoll; None for nothing. UsageError for a push that is none.

    rate : of the music; pushes and trips come at seconds of the song, as sections do
    """
    if not (push or trip or corrections):
        return None
    from dancetutor_cli.physics.pipeline import Wishes
    from dancetutor_cli.physics.pushes import Stumble, parse_push

    pushes = (parse_push(text) for text in push)
    return Wishes(
        corrections,
        tuple(replace(push, second=push.second / rate) for push in pushes),
        tuple(Stumble(second / rate) for second in trip),
    )


def bake_asked(asked: Asked, task: BakeTask, sides: tuple[int, int] | None = None) -> Motion:
    """The motion without a style; times are seconds of the music as it is played, at the task's rate.

    sides : as in `bake.How`
    """
    from dancetutor_cli.bake import bake
    from dancetutor_cli.motion.settings import load_settings

    return bake(
        asked.chart,
        asked.play,
        asked.pad,
        fps=task.fps,
        section=asked.section,
        rate=task.rate,
        bar=task.bar,
        gait=task.gait,
        settings=load_settings(task.motion, task.form),
        sides=sides,
        each=partial(_shared, task.jobs),
    )


def _shared(jobs: int, work: Sequence[tuple[Callable[[Piece], BakedPiece], Piece]]) -> Iterator[BakedPiece]:
    """Results of pieces of work in their order, made in up to `jobs` processes."""
    from dancetutor_cli.bake.pieces import in_turn
    from dancetutor_cli.jobs.pool import Task, open_workers

    if jobs <= 1 or len(work) == 1:
        yield from in_turn(work)
        return
    workers = open_workers(min(jobs, len(work)), lambda key, n: None)
    try:
        for k, (function, piece) in enumerate(work):
            workers.submit(Task(k, _piece, (function, piece)))
        results: dict[int, BakedPiece] = {}
        for done in workers.done():
            if done.error is not None:
                raise done.error
            results[done.key] = done.result
    finally:
        workers.close()
    for k in range(len(work)):
        yield results.pop(k)


def _piece(_: object, function: Callable[[Piece], BakedPiece], piece: Piece) -> BakedPiece:
    return function(piece)


def plan_asked(asked: Asked, task: BakeTask, sides: tuple[int, int] | None = None) -> tuple[Plan, Bar | None]:
    """Only the moves, and the bar that she holds. Arguments as in `bake_asked`."""
    from dancetutor_cli.bake import planned
    from dancetutor_cli.motion.settings import load_settings

    how = {"settings": load_settings(task.motion, task.form), "rate": task.rate, "bar": task.bar, "gait": task.gait}
    plan, context = planned(asked.chart, asked.play, asked.pad, sides=sides, **how)  # type: ignore[arg-type]
    return plan, context.bar


def _play(task: BakeTask, song: Song, chart: Chart, preset: Preset) -> tuple[Play, Pad]:
    from dancetutor_cli.lint.solved import solved_chart
    from dancetutor_cli.pads import load_pad
    from dancetutor_cli.play import prepare

    pad = load_pad(chart.steps_type)
    if pad is None:
        raise UsageError(
            f"{task.path}: no pad is known for steps type '{chart.steps_type}', so there is nobody to bake"
        )
    if task.play_file is not None:
        from dancetutor_cli.formats.play_json import read_play

        return read_play(task.play_file, chart, prepare(chart, pad, preset.roll_window), pad), pad
    play = solved_chart(song, chart, preset).play
    assert play is not None
    return play, pad


def tasks_of(task: BakeTask) -> tuple[BakeTask, ...]:
    """The request; of a chart for two where nobody has chosen a player, one for each who has notes."""
    from dancetutor_cli import chart as charts
    from dancetutor_cli.jobs.two import check_for_two
    from dancetutor_cli.lint.part import check_part

    if task.selection.player is not None:
        return (task,)
    if task.section is not None:
        check_part(task.section)
    song = charts.load(task.path)
    whole = song.charts[task.selection.one(song).index]
    check_for_two(whole)
    players = [part.player for part in whole.players if len(part.notes)]
    if len(players) < 2:
        return (task,)
    if task.play_file is not None:
        raise UsageError(f"--play is for one dancer, and {whole.label} is for two: choose with --player 1 or 2")
    return tuple(replace(task, selection=replace(task.selection, player=player)) for player in players)
