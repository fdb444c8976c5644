"""Glances: where steps are slow and while she waits she looks about, never at the same times or to the same places."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.context import Context
from dancetutor_cli.motion.foot_moves import Swing, Walk
from dancetutor_cli.motion.plan import Plan
from dancetutor_cli.motion.sections import GlanceSettings
from dancetutor_cli.motion.trajectory.facing import screen_yaw
from dancetutor_cli.motion.trajectory.posture import Trajectory
from dancetutor_cli.numerics.ease import smooth
from dancetutor_cli.numerics.smoothing import sample_path

Array = NDArray[np.float64]
SEED = 19980926
# parts of yaw, pitch and tilt of each kind: aside, up, with the head leant
_WAYS = np.array([[1.0, 0.25, 0.0], [0.35, 1.0, 0.2], [0.45, -0.3, 1.0]])


@dataclass(frozen=True, slots=True)
class Glances:
    """How far the head is turned for them at f times, radians: yaw to the left, pitch up, tilt to the left; (f,) each.

    eyes : (f,) radians that they are farther to the left, a little before the head is
    """

    yaw: Array
    pitch: Array
    tilt: Array
    eyes: Array


def glances_at(plan: Plan, body: Trajectory, times: Array, context: Context) -> Glances:
    """Glances at `times` (f,), seconds. Mirror images of a plan have mirror images of them.

    Chance says when and whereto; it is one only where no note is nearer to another than `numbers.slow`, and the less of
    one the nearer they are.
    """
    numbers = context.settings.glance
    out = Glances(*(np.zeros(len(times)) for _ in range(4)))
    notes, busy = _notes(plan), [(walk.start, walk.end) for walk in plan.walks]
    busy += [(press.start - press.lead, press.end + numbers.hand) for press in plan.presses]
    busy += [(start - numbers.jump, end + numbers.jump) for start, end in plan.flights]
    first, last = (int(np.floor(t / numbers.every)) for t in (times.min(), times.max()))
    song = [round(1000 * t) & 0xFFFFFFFF for t in (plan.first, plan.last)]
    for cell in range(first - 1, last + 1):
        chance = np.random.default_rng([SEED, *song, cell & 0xFFFFFFFF])
        start = numbers.every * (cell + chance.uniform(0.0, 0.5))
        end = start + numbers.lasts * chance.uniform(0.6, 1.4)
        kind, side, far = int(chance.integers(len(_WAYS))), float(chance.choice([-1.0, 1.0])), chance.uniform(0.6, 1.2)
        near = slice(*np.searchsorted(times, (start - numbers.eyes_ahead, end)).tolist())
        calm = _calm(notes, start, end, numbers)
        if near.start == near.stop or calm <= 0.0 or any(a < end and start < b for a, b in busy):
            continue
        yaw, pitch, tilt = np.radians(_WAYS[kind]) * [numbers.yaw, numbers.pitch, numbers.tilt] * far * calm
        t = times[near]
        there = _there(t, start, end, numbers.turn)
        out.yaw[near] += side * plan.hand * yaw * there
        out.pitch[near] += pitch * there
        out.tilt[near] += side * plan.hand * tilt * there
        eyes = side * plan.hand * calm * far * np.radians(numbers.eyes) * _WAYS[kind, 0]
        out.eyes[near] += eyes * _there(t + numbers.eyes_ahead, start, end, numbers.turn / 2)
    room = _room(body, times, context)
    return Glances(room * out.yaw, room * out.pitch, room * out.tilt, room * out.eyes)


def _notes(plan: Plan) -> Array:
    """Seconds at which feet land."""
    lands = (m.land for track in plan.feet for m in track.moves if isinstance(m, Swing) and not isinstance(m, Walk))
    return np.unique(np.round(np.fromiter(lands, dtype=np.float64), 3))


def _calm(notes: Array, start: float, end: float, numbers: GlanceSettings) -> float:
    """How much of a glance there is time for, 0 to 1: by the least time between two notes about it."""
    first, last = np.searchsorted(notes, (start - numbers.around, end + numbers.around))
    about = notes[max(first - 1, 0) : last + 1]
    least = min((b - a for a, b in pairwise(about.tolist())), default=np.inf)
    return float(smooth((least - numbers.quick) / (numbers.slow - numbers.quick)))


def _room(body: Trajectory, times: Array, context: Context) -> Array:
    """How free (f,) head and eyes are, 0 to 1: not where they must turn far for the screen."""
    numbers = context.settings.glance
    head, chest = (sample_path(yaw, body.times, times) for yaw in (body.head_yaw, body.chest_yaw))
    screen = screen_yaw(sample_path(body.ground, body.times, times), context.settings)
    gap = np.abs((screen - head + np.pi) % (2 * np.pi) - np.pi)
    neck = 1.0 - np.abs(head - chest) / np.radians(numbers.neck_room)
    return np.asarray(smooth(neck) * smooth(1.0 - gap / np.radians(numbers.eyes_room)))


def _there(times: Array, start: float, end: float, turn: float) -> Array:
    """0 before and after a glance, 1 in it, turning over so many seconds, (f,)."""
    return np.asarray(smooth((times - start) / turn) * smooth((end - times) / turn))
