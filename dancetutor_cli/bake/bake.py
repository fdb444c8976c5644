"""The one place that orders the work of a bake: plan, trajectory, inverse kinematics, layers, hair."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, TypedDict, Unpack

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.grips import grips_of
from dancetutor_cli.bake.keys import doubtful, key_times, refined
from dancetutor_cli.bake.pieces import BakedPiece, Each, Piece, in_turn, joined, piece_ends, trimmed
from dancetutor_cli.bake.settle import heels_may_rise, mass_of, settle, targets_at
from dancetutor_cli.chart.model import TICKS_PER_BEAT
from dancetutor_cli.errors import DancetutorError
from dancetutor_cli.motion.baked import Motion
from dancetutor_cli.motion.bar import bar_of, holding
from dancetutor_cli.motion.context import Context, context_of
from dancetutor_cli.motion.footwork import plan_footwork
from dancetutor_cli.motion.ik.ankles import ease_ankles
from dancetutor_cli.motion.ik.arms import free_hands
from dancetutor_cli.motion.ik.full_body import Poses, solve
from dancetutor_cli.motion.ik.rolling import rolled_soles
from dancetutor_cli.motion.ik.targets import moved
from dancetutor_cli.motion.layers.additive import Doing, add_layers
from dancetutor_cli.motion.layers.fingers import add_fingers, curls, hand_use
from dancetutor_cli.motion.layers.gaze import look
from dancetutor_cli.motion.layers.glances import glances_at
from dancetutor_cli.motion.plan import Plan
from dancetutor_cli.motion.settings import MotionSettings, WalkSettings, default_settings
from dancetutor_cli.motion.swing.foot_path import both_feet
from dancetutor_cli.motion.swing.panels import panels_on_ground
from dancetutor_cli.motion.trajectory.posture import Trajectory, stepping
from dancetutor_cli.motion.waits import waiting_at
from dancetutor_cli.numerics.smoothing import sample_path
from dancetutor_cli.physics.hair import add_hair
from dancetutor_cli.play.let_go import LetGo, told, without_unplayable

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart
    from dancetutor_cli.pads import Pad
    from dancetutor_cli.play.played import Play

Array = NDArray[np.float64]
BEATS_AFTER = 16  # beats after the last row that she still hears
CORRECTIONS = 6  # rounds of moving the body until its centre of mass is on its path
REFINEMENTS = 2  # rounds of adding keys half-way between others
MARGIN = 1.0  # seconds planned and smoothed beyond both ends of a section
OVERLAP = 5.0  # seconds that a piece of a long song is planned and baked beyond its ends: what differs has died away


class How(TypedDict, total=False):
    """How she dances.

    settings : numbers of the motion, those of `configs/motion.yaml` unless given
    rate : speed at which the music is played; the play's rows are already at it, and all times are those of
        the music as played, so jumps keep real gravity
    bar : whether she holds the bar behind the pad; gait : how she walks on and off, a name or file as for `load_gait`
    sides : from which she comes and to which she goes, 0 left or 1 right, where another one dances beside her
    stays : she does not walk off after the last step
    let_go : why notes that no limb has in the play are let go, where the caller has decided that
    each : does the pieces of a long song, in turn or in several processes; the result is the same
    """

    settings: MotionSettings | None
    rate: float
    bar: bool
    gait: str
    sides: tuple[int, int] | None
    stays: bool
    let_go: tuple[LetGo, ...]
    each: Each


def bake(
    chart: Chart,
    play: Play,
    pad: Pad,
    *,
    fps: float = 60.0,
    section: tuple[float, float] | None = None,
    **how: Unpack[How],
) -> Motion:
    """Make the dancer play a chart.

    Parameters
    ----------
    chart : gives the times of beats; play : who steps what; pad : where the panels are
    fps : frames per second of the result, which gets extra keys at every contact
    section : (start, end) in seconds of the music; None: from before the first step to after the last
    how : as in `How`

    Returns
    -------
    Motion whose feet and palms touch their panels at the notes' times.

    Raises
    ------
    DancetutorError if the play has no steps or the section is empty.
    """
    plan, context = planned(chart, play, pad, **how)
    left = max((walk.end for walk in plan.walks), default=-np.inf) + context.settings.walk.gone
    start, end = section or (
        min(0.0, plan.first - context.settings.walk.lead_in),
        max(plan.last + context.settings.walk.lead_out, left),
    )
    if not start < end:
        raise DancetutorError(
            f"the section from {start:.3f} s to {end:.3f} s is empty; its start must come before its end"
        )
    return bake_plan(plan, context, fps, (start, end), how.get("each", in_turn))


def plan_of(chart: Chart, play: Play, pad: Pad, **how: Unpack[How]) -> Plan:
    """Only the moves of a play, without a body: what moves when, from where to where. Arguments as in `bake`."""
    return planned(chart, play, pad, **how)[0]


def planned(chart: Chart, play: Play, pad: Pad, **how: Unpack[How]) -> tuple[Plan, Context]:
    """The plan of a play, with the context that it is danced in. Arguments as in `bake`."""
    settings, rate = how.get("settings") or default_settings(), how.get("rate", 1.0)
    bar = how.get("bar", False)
    rail = bar_of(pad, settings.bar) if bar else None
    context = context_of(pad, holding(settings) if bar else settings, _beats(chart, play, rate), rail)
    context = replace(context, sides=how.get("sides"), stays=how.get("stays", False))

    def second(tick: int) -> float:
        return float(chart.timing.seconds(np.array([tick], dtype=np.int64))[0]) / rate

    play, gone = without_unplayable(play, pad, how.get("let_go", ()))
    plan = replace(plan_footwork(play, second, how.get("gait", "flat"), context), let_go=gone)
    return (plan if rail is None else grips_of(plan, _standing(plan, context.settings.walk), context)), context


def _standing(plan: Plan, walk: WalkSettings) -> tuple[float, float]:
    """When she has arrived and when she leaves, seconds."""
    arrived = max((w.end for w in plan.walks if w.end < plan.first), default=plan.first - walk.lead_in)
    return arrived, min((w.start for w in plan.walks if w.start > plan.last), default=plan.last + walk.lead_out)


def mines_of(play: Play, pad: Pad) -> Array:
    """Second and place (x, z) in the world of every mine of a play, (m, 3), for the quality report."""
    row, column = np.nonzero(play.rows.mines)
    return np.column_stack((play.rows.second[row], panels_on_ground(pad)[column]))


def bake_plan(plan: Plan, context: Context, fps: float, section: tuple[float, float], each: Each = in_turn) -> Motion:
    """Bake a plan over a section, seconds; the work behind `bake`.

    Long songs are baked in pieces, always the same ones, so memory and time per second stay as they are in a short one.
    """
    start, end = section
    pieces = []
    for k, (first, last) in enumerate(pairwise(piece_ends(plan, start, end))):
        before = first if k == 0 else first - OVERLAP
        margin = MARGIN if k == 0 else MARGIN + OVERLAP
        after = MARGIN if last == end else OVERLAP
        part = trimmed(plan, first - margin, last + after)
        span = (np.floor(4 * (before - MARGIN)) / 4, last + after)
        pieces.append(Piece(part, context, fps, (before, last), (first if k else -np.inf, last), span))
    done = joined(pieces, each([(bake_piece, piece) for piece in pieces]))
    add_hair(context.skeleton, *done.keys, context.settings.hair)  # whole: where it hangs depends on where it hung
    contacts = tuple(c for c in plan.contacts if start <= c.start <= end)
    grips = tuple(g for g in plan.grips if g.end > start and g.start < end)
    ground = context.ground if plan.walks else None
    gone = tuple(one for one in plan.let_go if start <= one.second <= end)
    notes = (*((told(gone),) if gone else ()), *done.notes)
    return Motion(context.skeleton, fps, *done.keys, contacts, context.bar, grips, ground, notes, gone)


def bake_piece(piece: Piece) -> BakedPiece:
    """One piece of work; may run in any process."""
    plan, context = piece.plan, piece.context
    skeleton, settings = context.skeleton, context.settings
    rate = settings.sampling.work_rate
    grid = np.arange(np.floor(piece.span[0] * rate), np.ceil(piece.span[1] * rate) + 1) / rate
    body = settle(plan, grid, both_feet(plan.feet, grid, settings), context).trajectory
    body = replace(body, hands=free_hands(plan, body, context))  # all keys ask for them, and each round of more keys
    at = key_times(plan, piece.fps, *piece.baked)
    keys = (at, *posed(plan, body, at, context))
    for _ in range(REFINEMENTS):
        middles = doubtful(skeleton, keys, plan.grips)
        if len(middles):
            between = (middles, *posed(plan, body, middles, context))
            keys = refined(skeleton, keys, between, plan.grips)
    first, last = piece.baked
    notes = tuple(
        f"from {first:.1f} s to {last:.1f} s no path of {what} keeps within the limits of legs and soles; they gave way"
        for what in body.softened
    )
    return BakedPiece(keys, notes)


def posed(plan: Plan, body: Trajectory, at: Array, context: Context) -> Poses:
    """Solve the body at times `at` (f,), and move it so that its centre of mass, head and all, is where it shall be."""
    skeleton, settings, reach = context.skeleton, context.settings, context.settings.body.reach
    targets = targets_at(plan, body, at, context)
    poses = solve(skeleton, targets, reach, 0.0)
    ground = sample_path(body.mass, body.times, at)
    goal = np.column_stack((ground[:, 0], body.mass_height.at(at), ground[:, 1]))
    feet, waiting = both_feet(plan.feet, at, context.settings), waiting_at(plan, at, context)
    hands = hand_use(plan, body, at, waiting, context)
    glances = glances_at(plan, body, at, context)
    free = (1.0 - hands.floor.max(axis=1)) * (1.0 - hands.bar.max(axis=1))
    doing = Doing(
        stepping(feet, context.settings), free, plan.lead, plan.last, sample_path(body.beat, body.times, at), waiting,
        glances,
    )  # fmt: skip
    dressed = Poses(poses.rotations.copy(), poses.root)
    look(dressed, body, at, context)
    add_layers(dressed, at, doing, context)
    mass = mass_of(skeleton, poses)
    head = mass_of(skeleton, dressed) - mass  # hardly changes as the body is moved
    for k in range(CORRECTIONS):
        targets = moved(targets, goal - head - (mass if k == 0 else mass_of(skeleton, poses)))
        poses = solve(skeleton, targets, reach, 0.0)
    rises = heels_may_rise(plan, at, settings.step.press_time)
    rolled = rolled_soles(skeleton, plan, (at, feet, targets, poses), rises)
    if rolled is not None:
        poses = solve(skeleton, rolled, reach, 0.0)
    ease_ankles(skeleton, poses, feet)
    look(poses, body, at, context)
    add_layers(poses, at, doing, context)
    add_fingers(skeleton, poses, curls(at, hands, context.settings.fingers))
    return poses


def _beats(chart: Chart, play: Play, rate: float) -> tuple[float, ...]:
    """Seconds of all beats from the first measure to a while after the last row."""
    if not len(play.rows):
        return ()
    ticks = np.arange(0, int(play.rows.tick[-1]) + BEATS_AFTER * TICKS_PER_BEAT, TICKS_PER_BEAT, dtype=np.int64)
    return tuple(float(t) for t in chart.timing.seconds(ticks) / rate)
