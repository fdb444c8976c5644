"""The dancer's face: narrowed lids in hard passages, a breath and a smile after them, smiles in easy ones, wide eyes in
jumps, and eyes that look at the place of the next step.

A passage is hard if it has quick steps around it (`height.tempo_factor`, averaged over some seconds), or if she is
turned from the screen. How hard it seems to her also changes slowly, so that a face does not freeze where steps go on
evenly. After a hard passage its effect fades at an even rate, so relief is the largest value so far, minus the present
one. The mesh has lids, a jaw and eyes that turn; brows are painted.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.context import Context
from dancetutor_cli.dance.ik.targets import moving_mean
from dancetutor_cli.dance.layers import Glances
from dancetutor_cli.dance.plan import Plan, Step, Swing, chance_of
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.rig.quaternion import UP
from dancetutor_cli.dance.rig.skeleton import EYELID_CLOSING, JAW_LAUGH, Skeleton
from dancetutor_cli.dance.settings_body import FaceSettings, LayerSettings
from dancetutor_cli.dance.smoothing import smooth
from dancetutor_cli.dance.trajectory.facing import wrapped
from dancetutor_cli.dance.trajectory.height import tempo_factor
from dancetutor_cli.dance.trajectory.posture import Trajectory
from dancetutor_cli.dance.units import Array, Poses
from dancetutor_cli.dance.waits import Song, slowly, song_of

BLINK_SEED, PEEK_SEED, SMILE_SALT, EFFORT_SALT, MOUTH_SALT = 20140513, 20260611, 3, 4, 5


@dataclass(frozen=True, slots=True)
class Mood:
    """The expression of the dancer's face at f times, (f,) 0 to 1 each.

    hard : her concentration; relief : how much harder the dance was a moment ago; easy : how long it has been easy
    air : how much of the time around it both feet are in the air
    """

    hard: Array
    relief: Array
    easy: Array
    air: Array


@dataclass(frozen=True, slots=True)
class Peeks:
    """Looks at the place of the next step, at f times. share : (f,) 0 to 1; places : (f, 3) metres in the world"""

    share: Array
    places: Array


def mood_at(plan: Plan, body: Trajectory, at: Array, context: Context) -> Mood:
    """Return the dancer's mood at times `at` (f,), seconds, from the steps around the body's even times."""
    numbers, times = context.settings.face, body.times
    rate = 1.0 / float(times[1] - times[0])
    effort = moving_mean(tempo_factor(plan, times, context.settings), rate, numbers.around)
    turned = moving_mean(smooth(np.abs(wrapped(body.yaw)) / np.radians(numbers.turned_from)), rate, numbers.around)
    seems = slowly(song_of(plan, context), times, numbers.wander_time, EFFORT_SALT)
    effort = effort + numbers.turned * turned + numbers.wander * smooth(effort / numbers.hard_from) * seems
    effort = np.maximum(effort, body.reaching.max(axis=1))
    flights = np.zeros(len(times))
    for start, end in np.searchsorted(times, plan.flights).tolist():
        flights[start:end] = float(end - start > numbers.air_least * rate)
    faded = (times - times[0]) / numbers.fades
    before = np.maximum.accumulate(effort + faded) - faded
    hard = smooth((effort - numbers.hard_from) / (numbers.hard_full - numbers.hard_from))
    relief = smooth((before - effort - numbers.relief_from) / (numbers.relief_full - numbers.relief_from))
    easy = 1.0 - smooth(before / numbers.hard_from)
    air = moving_mean(moving_mean(flights, rate, numbers.air_around), rate, numbers.air_around)
    return Mood(*(np.interp(at, times, one) for one in (hard, relief, easy, air)))


def peeks_at(plan: Plan, free: Array, at: Array, context: Context) -> Peeks:
    """Return peeks at times (f,): before some of the steps with enough time, and before each step that ends a wait.

    free : (f,) 0 where hands are busy. Random choices depend on the time of a step, so mirror images peek as mirror
    images.
    """
    numbers, song = context.settings.face, song_of(plan, context)
    out = Peeks(np.zeros(len(at)), np.zeros((len(at), 3)))
    swings = [move for track in plan.feet for move in track.moves if isinstance(move, Swing)]
    before = -np.inf
    for step in sorted(swings, key=lambda one: one.land):
        gap, before = step.land - before, step.land
        drawn = chance_of(PEEK_SEED, *song, round(1000 * step.land)).random()
        wanted = gap > numbers.long or drawn < numbers.often
        if not isinstance(step, Step) or gap < numbers.least or not wanted:
            continue
        start = max(step.land - gap + numbers.after, step.lift - numbers.early)
        near = slice(*np.searchsorted(at, (start, step.land)).tolist())
        there = smooth((at[near] - start) / numbers.ease) * smooth((step.land - at[near]) / numbers.ease)
        out.share[near] = np.maximum(out.share[near], there * free[near])
        out.places[near] = step.target[0], 0.0, step.target[1]
    return out


def with_peeks(glances: Glances, mood: Mood, peeks: Peeks, free: Array, numbers: FaceSettings) -> Glances:
    """Return glances in which the head lowers to look at a panel, without its other movements. In hard passages it is
    lower, too. free : (f,) as in `peeks_at`
    """
    rest = 1.0 - peeks.share
    low = np.radians(np.maximum(numbers.nod * peeks.share, numbers.bow * mood.hard * free))
    yaw, pitch, tilt, eyes = (rest * one for one in (glances.yaw, glances.pitch, glances.tilt, glances.eyes))
    return Glances(yaw, pitch - low, tilt, eyes)


def add_face(skeleton: Skeleton, poses: Poses, at: Array, shown: tuple[Mood, Peeks, Plan], context: Context) -> None:
    """Turn lids, jaw and eyes at times `at` (f,), in place. shown : mood, peeks, and the plan"""
    (mood, peeks, plan), rotations = shown, poses.rotations
    numbers, layers, song = context.settings.face, context.settings.layers, song_of(plan, context)
    down = np.zeros(len(at))
    looking = np.flatnonzero(peeks.share > 0.0)
    if len(looking):
        down[looking] = peeks.share[looking] * _look_at(skeleton, poses, looking, peeks, numbers)
    smile = np.maximum(
        numbers.relief * mood.relief, numbers.easy * mood.easy * _now_and_then(song, at, numbers.smile_time, SMILE_SALT)
    )
    pressed = mood.hard * (1.0 - _now_and_then(song, at, numbers.mouth_time, MOUTH_SALT))
    lids = numbers.narrow * mood.hard + numbers.squint * smile + down * numbers.lids_follow
    lids = np.clip(lids - numbers.widen * mood.air, -numbers.widen, 1.0)
    open_eye = (1.0 - eyelids(at + context.phase, layers.blink_time, layers.blink)) * (1.0 - lids)
    jaw = np.radians(JAW_LAUGH) * np.maximum(smile, _laugh(at, plan.last, layers))
    breath = (1.0 + np.sin(2 * np.pi * (at + context.phase) / layers.breath_time)) / 2
    jaw += np.radians(numbers.panting) * (mood.relief * breath + mood.hard - pressed)
    jaw -= np.radians(numbers.pressed) * pressed
    jaw += np.radians(numbers.gasp) * mood.air
    for side in "lr":
        _set(skeleton, rotations, f"{side}_eyelid_joint", np.radians(EYELID_CLOSING) * (1.0 - open_eye))
    _set(skeleton, rotations, "temporomandibular", jaw)


def _now_and_then(song: Song, at: Array, every: float, salt: int) -> Array:
    """Return a value (f,) that rises from 0 to 1 and falls again about every `every` seconds, at other times for each
    `salt`.
    """
    return smooth((np.sin(2 * np.pi * at / every + 2.0 * slowly(song, at, every, salt)) - 0.2) / 0.6)


def _laugh(at: Array, last: float, layers: LayerSettings) -> Array:
    """Return how far (f,) the dancer laughs after the last note, 0 to 1."""
    return smooth((at - last - layers.laugh_after) / layers.laugh_rise)


def _look_at(skeleton: Skeleton, poses: Poses, which: NDArray[np.int64], peeks: Peeks, numbers: FaceSettings) -> Array:
    """Turn the eyes of these frames to their places, within limits; return how far down (k,) they turn, radians."""
    places, world = world_transforms(skeleton, poses.rotations[which], poses.root[which])
    head = quat.conjugate(world[:, skeleton.index("skullbase")])
    lowest, most = np.zeros(len(which)), float(np.radians(numbers.aside))
    for side in "lr":
        j = skeleton.index(f"{side}_eyeball_joint")
        way = quat.rotate(head, peeks.places[which] - places[:, j])
        aside = np.clip(np.arctan2(way[:, 0], np.maximum(way[:, 2], 0.05)), -most, most)
        down = np.clip(np.arctan2(-way[:, 1], np.hypot(way[:, 0], way[:, 2])), 0.0, np.radians(numbers.down))
        goal = quat.multiply(quat.from_axis_angle(UP, aside), quat.from_axis_angle(quat.LEFT, down))
        poses.rotations[which, j] = quat.slerp(poses.rotations[which, j], goal, peeks.share[which])
        lowest = np.maximum(lowest, down)
    return lowest


def _set(skeleton: Skeleton, rotations: Array, joint: str, angle: Array) -> None:
    if joint in skeleton.names:
        rotations[:, skeleton.index(joint)] = quat.from_axis_angle(quat.LEFT, angle)


def eyelids(times: Array, every: float, blink: float) -> Array:
    """Return how far the lids are closed (f,), 0 to 1: blinks of `blink` seconds, always at the same times."""
    cell = np.floor(times / every).astype(np.int64)
    out = np.zeros_like(times)
    for c in np.unique(cell):
        start = (c + chance_of(BLINK_SEED, int(c)).uniform(0.1, 0.8)) * every
        s = (times - start) / blink
        near = (s > 0) & (s < 1)
        out[near] = np.where(s < 0.4, smooth(s / 0.4), 1.0 - smooth((s - 0.4) / 0.6))[near]
    return out
