"""The one place that orders the work of a bake: plan, feet, body, inverse kinematics, look-at."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.grips import grips_of
from dancetutor_cli.bake.keys import doubtful, key_times, refined
from dancetutor_cli.bake.pieces import Done, Each, Piece, in_turn, joined, piece_ends, trimmed
from dancetutor_cli.chart.model import TICKS_PER_BEAT
from dancetutor_cli.errors import DancetutorError
from dancetutor_cli.motion.footwork.planner import Planner
from dancetutor_cli.motion.footwork.walks import ground_of, with_walks
from dancetutor_cli.motion.ik.ankles import ease_ankles
from dancetutor_cli.motion.ik.rail import bar_of, hold_share, holding
from dancetutor_cli.motion.ik.solver import Targets, solve
from dancetutor_cli.motion.ik.targets import ik_targets, moved
from dancetutor_cli.motion.layers.additive import add_layers
from dancetutor_cli.motion.layers.gaze import look
from dancetutor_cli.motion.model import Motion
from dancetutor_cli.motion.plan import Plan
from dancetutor_cli.motion.settings import MotionSettings, default_settings
from dancetutor_cli.motion.swing.foot_path import FootPath, foot_path
from dancetutor_cli.motion.swing.panels import panels_on_ground
from dancetutor_cli.motion.trajectory.body import BodyPath, body_path, stepping
from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.numerics.smoothing import cubic, sample_path, smooth_path
from dancetutor_cli.physics.hair import add_hair
from dancetutor_cli.play.model import Limb, Part, Play
from dancetutor_cli.rig.kinematics import world_transforms
from dancetutor_cli.rig.mass import centre_of_mass
from dancetutor_cli.rig.skeleton import Skeleton, dancer_skeleton

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart
    from dancetutor_cli.pads import Pad

Array = NDArray[np.float64]
LEAD_IN, LEAD_OUT = 2.0, 2.5  # seconds of standing before the first and after the last step
BEATS_AFTER = 16  # beats after the last row that she still hears
LOWEST = 0.35  # metres of the pelvis over the pad, however far away a palm shall be
STANDS = 0.4  # seconds of standing after she has walked off
SETTLING = 3  # rounds of rough baking before the path of the body is final
TIGHTENED = 2  # rounds of tightening the limits of her balance in the last of those
CORRECTIONS = 6  # rounds of moving the body until its centre of mass is on its path
REFINEMENTS = 2  # rounds of adding keys half-way between others
OFFSET_SMOOTH = 0.010  # seconds over which the centre of mass is smoothed as seen from the pelvis
MOST_HEEL = np.radians(20.0)  # a heel rises at most so much in a round for its ankle's sake
HEEL_DOWN = 0.06  # seconds in which a heel comes down to press a panel
MARGIN = 1.0  # seconds planned and smoothed beyond both ends of a section
OVERLAP = 5.0  # seconds that a piece of a long song is planned and baked beyond its ends: what differs has died away


def bake(
    chart: Chart,
    play: Play,
    pad: Pad,
    *,
    fps: float = 60.0,
    section: tuple[float, float] | None = None,
    settings: MotionSettings | None = None,
    rate: float = 1.0,
    bar: bool = False,
    gait: str = "flat",
    each: Each = in_turn,
) -> Motion:
    """Make the dancer play a chart.

    Parameters
    ----------
    chart : gives the times of beats; play : who steps what; pad : where the panels are
    fps : frames per second of the result, which gets extra keys at every contact
    section : (start, end) in seconds of the music; None: from before the first step to after the last
    settings : numbers of the motion, None for those of `configs/motion.yaml`
    rate : speed at which the music is played; the play's rows are already at it, and all times are those of
        the music as played, so jumps keep real gravity
    bar : whether she holds the bar behind the pad; gait : how she walks on and off, "flat" or "heels"
    each : does the pieces of a long song, in turn or in several processes; the result is the same

    Returns
    -------
    Motion whose feet and palms touch their panels at the notes' times.

    Raises
    ------
    DancetutorError if the play has no steps or the section is empty.
    """
    settings = settings or default_settings()
    if bar:
        settings = holding(settings)
    plan = plan_of(chart, play, pad, settings, rate, bar, gait)
    left = max((walk.end for walk in plan.walks), default=-np.inf) + STANDS
    start, end = section or (min(0.0, plan.first - LEAD_IN), max(plan.last + LEAD_OUT, left))
    if not start < end:
        raise DancetutorError(
            f"the section from {start:.3f} s to {end:.3f} s is empty; its start must come before its end"
        )
    return bake_plan(plan, fps, start, end, settings, each)


def plan_of(
    chart: Chart, play: Play, pad: Pad, settings: MotionSettings | None = None, rate: float = 1.0, bar: bool = False,
    gait: str = "flat",
) -> Plan:  # fmt: skip
    """Only the moves of a play, without a body: what moves when, from where to where. Arguments as in `bake`."""
    settings = settings or default_settings()
    plan = Planner(play, panels_on_ground(pad), _clock(chart, rate), settings).run()
    first, last = plan.first, plan.last
    plan = replace(plan, beats=_beats(chart, play, rate))
    plan = with_walks(plan, ground_of(pad, settings), mines_of(play, pad)[:, 0], gait, settings)
    if not bar:
        return plan
    rail = bar_of(pad, settings.bar)
    arrived = max((w.end for w in plan.walks if w.end < first), default=first - LEAD_IN)
    leaves = min((w.start for w in plan.walks if w.start > last), default=last + LEAD_OUT)
    grips = grips_of(plan, rail, (arrived, leaves), dancer_skeleton(), settings)
    return replace(plan, bar=rail, grips=grips)


def mines_of(play: Play, pad: Pad) -> Array:
    """Second and place (x, z) in the world of every mine of a play, (m, 3), for the quality report."""
    row, column = np.nonzero(play.rows.mines)
    return np.column_stack((play.rows.second[row], panels_on_ground(pad)[column]))


def bake_plan(
    plan: Plan, fps: float, start: float, end: float, settings: MotionSettings, each: Each = in_turn
) -> Motion:
    """Bake a plan from `start` to `end`, seconds; the work behind `bake`.

    Long songs are baked in pieces, always the same ones, so memory and time per second stay as they are in a short one.
    """
    ends = piece_ends(plan, start, end)
    pieces = []
    for k, (first, last) in enumerate(pairwise(ends)):
        before = first if k == 0 else first - OVERLAP
        margin = MARGIN if k == 0 else MARGIN + OVERLAP
        after = MARGIN if last == end else OVERLAP
        part = trimmed(plan, first - margin, last + after)
        span = (np.floor(4 * (before - MARGIN)) / 4, last + after)
        pieces.append(Piece(part, fps, (before, last), (first if k else -np.inf, last), span, settings))
    done = joined(pieces, each([(bake_piece, piece) for piece in pieces]))
    at, rotations, root = done.keys
    contacts = tuple(c for c in plan.contacts if start <= c.start <= end)
    grips = tuple(g for g in plan.grips if g.end > start and g.start < end)
    return Motion(dancer_skeleton(), fps, at, rotations, root, contacts, plan.bar, grips, plan.ground, done.notes)


def bake_piece(piece: Piece) -> Done:
    """One piece of work; may run in any process."""
    plan, settings, skeleton = piece.plan, piece.settings, dancer_skeleton()
    rate = settings.sampling.work_rate
    grid = np.arange(np.floor(piece.span[0] * rate), np.ceil(piece.span[1] * rate) + 1) / rate
    drop = settings.step.heel_drop
    feet = (foot_path(plan.feet[0], grid, drop), foot_path(plan.feet[1], grid, drop))
    body = body_path(plan, grid, feet, skeleton, settings)
    body = _settled(plan, grid, feet, body, skeleton, settings)
    at = key_times(plan, piece.fps, *piece.baked)
    rotations, root = _posed(plan, body, at, skeleton, settings)
    keys = (at, rotations, root)
    for _ in range(REFINEMENTS):
        middles = doubtful(skeleton, keys, plan.grips)
        if len(middles):
            between = (middles, *_posed(plan, body, middles, skeleton, settings))
            keys = refined(skeleton, keys, between, plan.grips)
    at, rotations, root = keys
    add_hair(skeleton, at, rotations, root, settings.hair)
    first, last = piece.baked
    notes = tuple(
        f"from {first:.1f} s to {last:.1f} s no path of {what} keeps within the limits of legs and soles; they gave way"
        for what in body.softened
    )
    return Done(keys, notes)


def _settled(
    plan: Plan, grid: Array, feet: tuple[FootPath, FootPath], body: BodyPath, skeleton: Skeleton,
    settings: MotionSettings,
) -> BodyPath:  # fmt: skip
    """Bake roughly, see where the centre of mass and pinned palms draw the root, and plan the body's path again."""
    coarse = grid[::4]
    deeper, heels = np.zeros(len(plan.presses)), np.zeros((len(grid), 2))
    rounds = SETTLING if plan.presses else 2
    for turn in range(rounds):
        targets = _targets(plan, body, coarse, skeleton, settings)
        rotations, root = solve(skeleton, targets, settings.body.reach)
        offset = _mass(skeleton, rotations, root) - root
        above = smooth_path(cubic(coarse, offset, grid), np.ones(len(grid)), settings.sampling.work_rate, OFFSET_SMOOTH)
        drawn = root[:, 1] - targets.pelvis[:, 1]
        for k, press in enumerate(plan.presses):
            near = (coarse >= press.start - 0.05) & (coarse <= press.end + 0.05)
            more = deeper[k] - min(float(drawn[near].min(initial=0.0)), 0.0)
            deeper[k] = min(more, max(settings.hands.pelvis - LOWEST, 0.0))  # where no palm reaches, nobody sinks
        heels += np.column_stack([np.interp(grid, coarse, h) for h in _heels_up(skeleton, rotations, settings)])
        heels = np.maximum(smooth_path(heels, np.ones(len(grid)), settings.sampling.work_rate, 0.06), 0.0)
        heels *= _may_rise(plan, grid)
        known, last = (body, above, deeper), turn == rounds - 1
        body = body_path(
            plan, grid, feet, skeleton, settings, *known, keep=turn > 0 and not last, tightened=TIGHTENED if last else 0
        )
        body = replace(body, heels=heels)
    return body


def _heels_up(skeleton: Skeleton, rotations: Array, settings: MotionSettings) -> tuple[Array, Array]:
    """How far (f,) each heel must rise so that its ankle does not bend beyond what ankles can, radians."""
    limit = np.radians(settings.step.ankle_limit)
    out = []
    for side in "lr":
        q = rotations[:, skeleton.index(f"{side}_talocrural")]
        q = np.where(q[:, :1] < 0, -q, q)
        out.append(np.clip(-2.0 * np.arctan2(q[:, 1], q[:, 0]) - limit, 0.0, MOST_HEEL))
    return out[0], out[1]


def _may_rise(plan: Plan, times: Array) -> Array:
    """How much (n, 2) each heel may rise for its ankle's sake, 0 to 1: not while it presses a panel."""
    out = np.ones((len(times), 2))
    for contact in (c for c in plan.contacts if c.limb < Limb.LEFT_HAND and c.part == Part.HEEL):
        away = np.maximum(contact.start - times, times - contact.end)
        out[:, contact.limb] = np.minimum(out[:, contact.limb], smooth(away / HEEL_DOWN))
    return out


def _targets(plan: Plan, body: BodyPath, at: Array, skeleton: Skeleton, settings: MotionSettings) -> Targets:
    drop = settings.step.heel_drop
    up = sample_path(body.heels, body.times, at)
    feet = [foot_path(plan.feet[side], at, drop) for side in (0, 1)]
    raised = [replace(f, pitch=f.pitch + up[:, side]) for side, f in enumerate(feet)]
    return ik_targets(plan, body, (raised[0], raised[1]), at, skeleton, settings)


def _posed(plan: Plan, body: BodyPath, at: Array, skeleton: Skeleton, settings: MotionSettings) -> tuple[Array, Array]:
    """Solve the body at times `at` (f,), and move it so that its centre of mass, head and all, is where it shall be."""
    targets = _targets(plan, body, at, skeleton, settings)
    rotations, root = solve(skeleton, targets, settings.body.reach, 0.0)
    ground = sample_path(body.mass, body.times, at)
    goal = np.column_stack((ground[:, 0], body.mass_height.at(at), ground[:, 1]))
    drop = settings.step.heel_drop
    feet = foot_path(plan.feet[0], at, drop), foot_path(plan.feet[1], at, drop)
    side = stepping(feet, settings)
    free = 1.0 - sample_path(body.reaching, body.times, at).max(axis=1)
    free *= 1.0 - hold_share(plan.grips, at, settings.bar.reach_time).max(axis=1)
    dressed = rotations.copy()
    look(skeleton, dressed, root, body, at, settings)
    add_layers(skeleton, at, dressed, side, free, settings.layers, plan.lead)
    head = _mass(skeleton, dressed, root) - _mass(skeleton, rotations, root)  # hardly changes as the body is moved
    for _ in range(CORRECTIONS):
        targets = moved(targets, goal - head - _mass(skeleton, rotations, root))
        rotations, root = solve(skeleton, targets, settings.body.reach, 0.0)
    ease_ankles(skeleton, rotations, feet)
    look(skeleton, rotations, root, body, at, settings)
    add_layers(skeleton, at, rotations, side, free, settings.layers, plan.lead)
    return rotations, root


def _mass(skeleton: Skeleton, rotations: Array, root: Array) -> Array:
    """Centre of mass (f, 3) of solved frames."""
    return centre_of_mass(skeleton, *world_transforms(skeleton, rotations, root))


def _beats(chart: Chart, play: Play, rate: float) -> tuple[float, ...]:
    """Seconds of all beats from the first measure to a while after the last row."""
    ticks = np.arange(0, int(play.rows.tick[-1]) + BEATS_AFTER * TICKS_PER_BEAT, TICKS_PER_BEAT, dtype=np.int64)
    return tuple(float(t) for t in chart.timing.seconds(ticks) / rate)


def _clock(chart: Chart, rate: float) -> Callable[[int], float]:
    def second(tick: int) -> float:
        return float(chart.timing.seconds(np.array([tick], dtype=np.int64))[0]) / rate

    return second
