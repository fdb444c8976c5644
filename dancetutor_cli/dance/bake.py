"""The order of the work of a bake: trajectory, inverse kinematics, layers, ragdoll, hair."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Unpack

import numpy as np

from dancetutor_cli.dance.context import Context
from dancetutor_cli.dance.face import add_face, mood_at, peeks_at, with_peeks
from dancetutor_cli.dance.foot_path import Feet, both_feet
from dancetutor_cli.dance.footwork.planner import Manner, plan_dance
from dancetutor_cli.dance.ik.ankles import ease_ankles, rolled_soles
from dancetutor_cli.dance.ik.full_body import solve_poses
from dancetutor_cli.dance.ik.knees import ease_hips
from dancetutor_cli.dance.ik.targets import FreeHands, free_hands, translated
from dancetutor_cli.dance.keys import Keys, doubtful_times, key_times, refined
from dancetutor_cli.dance.layers import Activity, add_fingers, add_layers, curls, glances_at, hand_use, look
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.physics.hair import add_hair
from dancetutor_cli.dance.pieces import BakedPiece, Piece, PieceRunner, RagdollStyle, bake_section, in_turn, pieces_of
from dancetutor_cli.dance.plan import Plan
from dancetutor_cli.dance.rig.body import mass_of
from dancetutor_cli.dance.settings import Span, state_weights
from dancetutor_cli.dance.settle import settle, targets_at
from dancetutor_cli.dance.smoothing import sample_path
from dancetutor_cli.dance.trajectory.legs import heels_may_rise
from dancetutor_cli.dance.trajectory.posture import Trajectory, lift_side
from dancetutor_cli.dance.units import Array, Poses
from dancetutor_cli.dance.waits import waiting_at

if TYPE_CHECKING:
    from dancetutor_cli.chart.timing import Timing
    from dancetutor_cli.feet.pads import Pad
    from dancetutor_cli.feet.play import Play

CORRECTIONS = 6  # rounds of moving the body until its centre of mass is on its path
REFINEMENTS = 2  # rounds of adding keys half-way between others


def bake(
    timing: Timing,
    play: Play,
    pad: Pad,
    *,
    fps: float = 60.0,
    section: Span | None = None,
    **manner: Unpack[Manner],
) -> Motion:
    """Bake the dance of a play, for tests and tools. The commands bake the pieces of a `performance.Performance`.

    Parameters
    ----------
    timing : gives the times of beats; play : the feet of the chart; pad : where the panels are. Timing and play are
        at seconds of the music as it is heard (`Timing.at_rate`), so jumps keep real gravity
    fps : frames per second of the result, which has extra keys at every contact
    section : (start, end) in seconds of the music, cut out of the dance of the whole chart; None:
        from before the first step to after the last one
    manner : as in `Manner`

    Returns
    -------
    A Motion whose feet and palms touch their panels at the times of the notes.

    Raises
    ------
    DancetutorError if the play has no steps or the section is empty.
    """
    plan, context = plan_dance(timing, play, pad, **manner)
    return bake_plan(plan, context, fps, section)


def bake_plan(
    plan: Plan, context: Context, fps: float, section: Span | None = None, run: PieceRunner = in_turn
) -> Motion:
    """Bake a plan, or the section of it between two seconds, for tests and tools. Arguments as in `bake`.

    run : bakes the pieces of a long song, in turn or in several processes; the result is the same
    """
    pieces = pieces_of(plan, context, fps)
    return bake_section(pieces, section or (pieces[0].kept_span[0], pieces[-1].kept_span[1]), run).motion


def bake_piece(piece: Piece) -> BakedPiece:
    """Bake one piece of work, in any process."""
    plan, context = piece.plan, piece.context
    skeleton, settings = context.skeleton, context.settings
    rate = settings.sampling.work_rate
    grid = np.arange(np.floor(piece.span[0] * rate), np.ceil(piece.span[1] * rate) + 1) / rate
    states, changes = context.states(*piece.span)
    bodies = [settle(plan, grid, both_feet(plan.feet, grid, one.settings), one).trajectory for one in states]
    body = bodies[0]
    if len(bodies) > 1:
        from dancetutor_cli.dance.changes import mean_body

        body = mean_body(bodies, changes)
    # all keys need the free hands, and so does each round of more keys: they are computed once
    hands = [(one, free_hands(plan, body, one)) for one in states]
    at = key_times(plan, piece.fps, *piece.baked)
    keys = (at, *_pose_states(plan, body, hands, at, changes))
    for _ in range(REFINEMENTS):
        middles = doubtful_times(skeleton, keys, plan.grips)
        if len(middles):
            between = (middles, *_pose_states(plan, body, hands, middles, changes))
            keys = refined(skeleton, keys, between, plan.grips)
    first, last = piece.baked
    notes = tuple(
        f"from {first:.1f} s to {last:.1f} s no path of {what} keeps the limits of legs and soles; they were exceeded"
        for what in body.softened
    )
    motion = _motion(piece, keys, notes)
    add_hair(skeleton, motion.times, motion.rotations, motion.root, settings.hair)
    return BakedPiece(motion) if piece.ragdoll is None else _followed(motion, piece, piece.ragdoll)


def _motion(piece: Piece, keys: Keys, notes: tuple[str, ...]) -> Motion:
    plan, context, (first, last) = piece.plan, piece.context, piece.baked
    grips = tuple(g for g in plan.grips if g.end > first and g.start < last)
    return Motion(context.skeleton, piece.fps, *keys, piece.contacts, context.bar, grips, piece.ground, notes)


def _followed(motion: Motion, piece: Piece, ragdoll: RagdollStyle) -> BakedPiece:
    """Return the motion of the ragdoll that follows `motion`, with a new braid, because the head moves differently.

    A push or trip near the end of a piece is reported by the piece in which it happens. The neighbouring piece has only
    a part of it.
    """
    from dancetutor_cli.dance.physics.pipeline import through_ragdoll

    options, (first, last) = ragdoll.options.within(motion.times[0], motion.times[-1]), piece.kept_span
    passed = through_ragdoll(motion, ragdoll.blend, options)
    add_hair(motion.skeleton, motion.times, passed.motion.rotations, passed.motion.root, piece.context.settings.hair)
    seconds = [*(one.second for one in options.stumbles), *(one.second for one in options.pushes)]
    lines = zip(seconds, passed.motion.notes[len(motion.notes) :], strict=True)
    notes = (*motion.notes, *(line for second, line in lines if first <= second < last))
    return BakedPiece(replace(passed.motion, notes=notes), passed.distances)


def _pose_states(
    plan: Plan, body: Trajectory, hands: Sequence[tuple[Context, FreeHands]], at: Array, changes: Sequence[Span]
) -> Poses:
    """Return the poses at times `at` (f,). States turn into each other in `changes`; hands : of each state, its context
    and its free hands
    """
    feet = [both_feet(plan.feet, at, context.settings) for context, _ in hands]
    if len(hands) == 1:
        return pose_body(plan, body, (at, feet[0]), *hands[0])
    from dancetutor_cli.dance.changes import mean_feet, mean_of_states

    weights = state_weights(changes, at)
    mean = mean_feet(feet, weights)
    poses = [pose_body(plan, body, (at, mean), context, free) for context, free in hands]
    return mean_of_states(hands[0][0].skeleton, poses, weights)


def pose_body(
    plan: Plan, body: Trajectory, sampled: tuple[Array, Feet], context: Context, free_hands: FreeHands
) -> Poses:
    """Solve the body at times (f,), and move it until its centre of mass, with the gaze and the layers, is on its path.

    sampled : the times, and the feet at these times; free_hands : at the body's times
    """
    skeleton, settings, reach = context.skeleton, context.settings, context.settings.body.reach
    at, feet = sampled
    targets = targets_at(plan, body, (at, feet), context, free_hands)
    poses = solve_poses(skeleton, targets, reach, 0.0)
    ground = sample_path(body.mass, body.times, at)
    goal = np.column_stack((ground[:, 0], body.mass_height.at(at), ground[:, 1]))
    waiting = waiting_at(plan, at, context)
    hands = hand_use(plan, body, at, waiting, context)
    free = (1.0 - hands.floor.max(axis=1)) * (1.0 - hands.bar.max(axis=1))
    mood, peeks = mood_at(plan, body, at, context), peeks_at(plan, free, at, context)
    glances = with_peeks(glances_at(plan, body, at, context), mood, peeks, free, settings.face)
    doing = Activity(
        lift_side(feet, settings),
        free,
        plan.lead,
        mood.relief,
        sample_path(body.beat, body.times, at),
        waiting,
        glances,
    )
    trial = Poses(poses.rotations.copy(), poses.root)
    look(trial, body, at, context)
    add_layers(trial, at, doing, context)
    mass = mass_of(skeleton, poses)
    # of the mass, by the gaze and the layers; hardly changes as the body is moved
    look_shift = mass_of(skeleton, trial) - mass
    for k in range(CORRECTIONS):
        targets = translated(targets, goal - look_shift - (mass if k == 0 else mass_of(skeleton, poses)))
        poses = solve_poses(skeleton, targets, reach, 0.0)
    rises = heels_may_rise(plan, at, settings.step.press_time)
    rolled = rolled_soles(skeleton, plan, (at, feet, targets, poses), rises)
    if rolled is not None:
        poses = solve_poses(skeleton, rolled, reach, 0.0)
    ease_hips(skeleton, poses)
    ease_ankles(skeleton, poses, feet)
    look(poses, body, at, context)
    add_layers(poses, at, doing, context)
    add_face(skeleton, poses, at, (mood, peeks, plan), context)
    add_fingers(skeleton, poses, curls(at + context.phase, hands, context.settings.fingers))
    return poses
