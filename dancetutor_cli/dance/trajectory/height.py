"""The height of the centre of mass over the whole song as one quadratic programme, and the depth of crouches."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from dancetutor_cli.dance.clearance import reduction
from dancetutor_cli.dance.plan import Jump, Plan
from dancetutor_cli.dance.quadratic import BandedLeastSquares, Limits, solve_surely
from dancetutor_cli.dance.rig.body import GRAVITY
from dancetutor_cli.dance.settings import MotionSettings
from dancetutor_cli.dance.settings_body import BodySettings
from dancetutor_cli.dance.settings_feet import JumpSettings
from dancetutor_cli.dance.smoothing import smooth, smooth_path
from dancetutor_cli.dance.units import Array, Flags

# How low the dancer stands: on bent knees in streams, lower before and after jumps, and the lean in a jump.


LOWEST = 0.42  # part of the time between two landings, or pulses of the beat, at which the dancer is lowest
GIVES, RISEN = 0.4, 2.0  # parts of that time at which she begins to go down and at which she is up again


def tempo_factor(plan: Plan, times: Array, settings: MotionSettings) -> Array:
    """Return how fast (n,) the steps around each of the even `times` are: 0 for the slowest, 1 for a stream."""
    step, around_them = settings.step, settings.body.stream_time
    fast = np.zeros(len(times))
    for swing in plan.swings:
        around = slice(*np.searchsorted(times, (swing.lift - around_them, swing.land + around_them)))
        fast[around] = np.maximum(fast[around], reduction(swing.land - swing.lift, step.fast, step.longest))
    rate = 1.0 / float(times[1] - times[0])
    return smooth_path(fast[:, None], np.ones(len(times)), rate, around_them)[:, 0]


def time_for_jumps(flights: Array, jump: JumpSettings) -> tuple[Array, Array]:
    """Return the time before and after each of (k, 2) flights, (k,) each: 0 for none, 1 for enough to crouch."""
    between = flights[1:, 0] - flights[:-1, 1]
    share = np.clip((between - jump.no_time) / jump.full_time, 0.0, 1.0)
    before, after = np.ones(len(flights)), np.ones(len(flights))
    before[1:], after[:-1] = share, share
    return before, after


def jump_crouch(plan: Plan, times: Array, jump: JumpSettings) -> Array:
    """Return how much lower (n,) the dancer is around jumps, metres: more for higher jumps, less if time is short.

    A run of quick jumps leaves no time for that; in it she is a little lower all the time.
    """
    flights = plan.flights
    if not len(flights):
        return np.zeros(len(times))
    start, end = flights.T
    size = np.clip(GRAVITY * (end - start) ** 2 / 8 / jump.apex_near, jump.crouch_least, jump.crouch_most)
    before, after = time_for_jumps(flights, jump)
    out = np.zeros(len(times))
    for k in range(len(flights)):
        run = slice(*np.searchsorted(times, (start[k] - 4 * jump.crouch_time, end[k] + 4 * jump.crouch_time)))
        away = np.maximum(np.maximum(start[k] - times[run], times[run] - end[k]), 0.0) / jump.crouch_time
        low = jump.low * (1.0 - max(before[k], after[k]))
        out[run] = np.maximum(out[run], low * np.exp(-(away**2)))
        for depth, time, width in (
            (jump.crouch * before[k], start[k] - jump.crouch_before, jump.crouch_time),
            (jump.follow * after[k], end[k] + jump.follow_after, jump.follow_time),
        ):
            near = slice(*np.searchsorted(times, (time - 4 * width, time + 4 * width)))
            out[near] = np.maximum(out[near], size[k] * depth * np.exp(-(((times[near] - time) / width) ** 2)))
    return out


def step_landings(plan: Plan) -> Array:
    """Return the seconds (k,) at which feet land that neither walk nor jump, in order, each once."""
    return np.unique([swing.land for swing in plan.swings if not isinstance(swing, Jump)])


def landing_give(plan: Plan, times: Array, pulses: Array, body: BodySettings) -> Array:
    """Return how far (n,) knees give after steps, metres: most a little after a landing, less if the next is soon.

    Only steps at `pulses` (k,), seconds, count: after one between two of them the dancer comes up again.
    """
    lands = sorted({m.land for track in plan.feet for m in track.moves})
    out, steps = np.zeros(len(times)), step_landings(plan)
    for land in steps[np.isin(steps, pulses)].tolist():
        k = bisect_right(lands, land + 1e-6)
        room = lands[k] - land if k < len(lands) else np.inf
        size = float(smooth((room - body.land_least) / max(body.land_full - body.land_least, 1e-6)))
        lowest = min(body.land_time, LOWEST * room)
        near = slice(*np.searchsorted(times, (land, land + RISEN * lowest)).tolist())
        after = (times[near] - land) / lowest
        shape = smooth((after - GIVES) / (1.0 - GIVES)) * smooth((RISEN - after) / (RISEN - 1.0))
        out[near] = np.maximum(out[near], body.land_give * size * shape)
    return out


def jump_drive(plan: Plan, times: Array, jump: JumpSettings) -> tuple[Array, Array]:
    """Return how much (n, 2) legs push off and catch, at take-offs and landings, 0 to 1.

    It is little without time to crouch before the flight, or without time to give way after it.
    """
    flights = plan.flights
    out = np.zeros((len(times), 2))
    if not len(flights):
        return out[:, 0], out[:, 1]
    start, end = flights.T
    before, after = time_for_jumps(flights, jump)
    for k in range(len(flights)):
        for side, time, much in ((0, start[k], before[k]), (1, end[k], after[k])):
            near = slice(*np.searchsorted(times, (time - jump.push_time, time + jump.push_time)))
            bump = np.clip(2.0 * (1.0 - np.abs(times[near] - time) / jump.push_time), 0.0, 1.0)
            out[near, side] = np.maximum(out[near, side], much * bump)
    return out[:, 0], out[:, 1]


def jump_swing(plan: Plan, times: Array, jump: JumpSettings) -> Array:
    """Return where the arms (n,) are that help a jump: -1 back as the dancer crouches, 1 ahead and up in the air.

    They go back again as she lands. The swing is larger for higher jumps, and smaller if time is short.
    """
    flights = plan.flights
    out, wide = np.zeros(len(times)), jump.arms_time
    if not len(flights):
        return out
    start, end = flights.T
    before, after = (share**2 for share in time_for_jumps(flights, jump))  # with less time, a swing is quicker
    high = np.clip((end - start) / jump.arms_full, 0.0, 1.0) ** 2
    swings = (
        (-before, start - jump.crouch_before),
        (before, start + jump.arms_after),
        (-jump.arms_down * np.minimum(before, after), end + jump.follow_after),
    )
    for k in range(len(flights)):
        for size, time in swings:
            near = slice(*np.searchsorted(times, (time[k] - 4 * wide, time[k] + 4 * wide)))
            out[near] += high[k] * size[k] * np.exp(-(((times[near] - time[k]) / wide) ** 2))
    return np.clip(out, -1.0, 1.0)


def jump_lean(plan: Plan, times: Array, jump: JumpSettings) -> Array:
    """Return how far (n, 2) the shoulders lean in the direction of jumps, radians: in proportion to the way (thesis
    5.6.2).

    Both feet of a jump land at once and have one way; a gallop has the way of the foot that lands first.
    """
    jumps: dict[float, Jump] = {}
    for swing in (m for track in plan.feet for m in track.moves if isinstance(m, Jump)):
        if swing.land not in jumps or jumps[swing.land].lift < swing.lift:  # the last foot to leave takes off
            jumps[swing.land] = swing
    out = np.zeros((len(times), 2))
    for _, swing in sorted(jumps.items()):
        way = np.radians(jump.lean) * (np.array(swing.middles[1]) - np.array(swing.middles[0]))
        first, last = swing.lift - jump.lean_before, swing.land + jump.lean_after
        near = slice(*np.searchsorted(times, (first, last)))
        out[near] += np.sin(np.pi * (times[near] - first) / (last - first))[:, None] ** 2 * way
    return out


# The height of the centre of mass over the whole song as one quadratic programme.
#
# The unknowns are heights at nodes in time; take-offs and landings are nodes. In flight the height falls with g,
# exactly. On the ground the jerk is least, while the height stays near a target and below the reach of the legs, and
# the force on the ground is within what legs can give. A landing and the next move share one ground phase, so they
# overlap without further rules.

NODE_RATE = 80.0  # nodes per second
UNIT = 0.02  # metres, the typical difference of heights; it scales the programme
GIVE_FORCE, GIVE_ROOM = 1e-5, 1e-4  # costs of more force than legs have, and of stretched legs: `quadratic.Limits`
LOOSE = 1e-3  # weight of the target height in flight
LEAST_STAND = 0.012  # seconds; a flight that begins so soon after another one is left out


class Height(Protocol):
    """The height of the centre of mass, metres, at any times."""

    def at(self, times: Array) -> Array:
        """Return the height (f,) at times (f,), seconds."""


@dataclass(frozen=True, slots=True)
class HeightPath:
    """A piecewise cubic through nodes: times (n,) seconds, values (n,) metres, slopes (n,) metres per second.

    softened : whether legs reach farther or push harder than they should, as in `quadratic.Solution`
    """

    times: Array
    values: Array
    slopes: Array
    softened: bool = False

    def at(self, times: Array) -> Array:
        """Return the height (f,) at any times; a cubic through a parabola's points and slopes is that parabola."""
        i = np.clip(np.searchsorted(self.times, times, side="right") - 1, 0, len(self.times) - 2)
        h = self.times[i + 1] - self.times[i]
        s = np.clip((times - self.times[i]) / h, 0.0, 1.0)
        a, b = self.values[i], self.values[i + 1]
        u, v = self.slopes[i] * h, self.slopes[i + 1] * h
        return np.asarray(a + s * (u + s * (3 * (b - a) - 2 * u - v + s * (2 * (a - b) + u + v))))


@dataclass(frozen=True, slots=True)
class HeightGoals:
    """The targets and limits of the height of the centre of mass at n even times, metres.

    times : (n,) seconds; target : (n,) the preferred height; highest : (n,) the largest allowed height
    above : (n,) height of the centre of mass over the pelvis, whose jerk on the ground is least
    firm : (n,) weight of `target` at take-offs and landings: elsewhere the weight is always 1
    tempo : (n,) from `tempo_factor`: for slower steps, the height follows them more
    """

    times: Array
    target: Array
    highest: Array
    above: Array
    firm: Array
    tempo: Array


def height_path(goals: HeightGoals, flights: Array, body: BodySettings) -> HeightPath:
    """Compute the height h of the centre of mass, as one quadratic programme on nodes k that are uneven in time.

        minimise    sum_k c_k (h_k - target_k)^2  +  s^6 sum_k |d3(h - above)/dt3|_k^2
        subject to  f_least <= 1 + h''_k / g <= f_most     force on the ground, in body weights
                    h_k <= highest_k                       what legs can reach
                    h''_k = -g                             in flight (a term of large weight)

    c : 1, `firm` at take-offs and landings, little in flight; s : `height_smooth`, seconds; f : `least_force` and
    `most_force`. `quadratic.solve_surely` solves it, and softens limits that contradict each other.

    Parameters
    ----------
    flights : (k, 2) of take-off and landing, seconds, in order; body : settings
    """
    times = goals.times
    flights = flights[(flights[:, 0] > times[0] + 0.05) & (flights[:, 1] < times[-1] - 0.05)]
    flights = _separate_flights(flights)
    nodes, flying = _nodes(times[0], times[-1], flights)
    inner = np.arange(1, len(nodes) - 1)
    in_flight = flying[inner - 1] & flying[inner]
    problem = _objective(nodes, flying, in_flight, goals, body)
    acceleration = _second(nodes) / GRAVITY
    standing = ~in_flight
    touching = (flying[inner - 1] | flying[inner])[standing]
    n = int(standing.sum())
    force = Limits(
        inner[standing] - 1, acceleration[standing],
        np.where(touching, -1.0, body.least_force - 1.0), np.full(n, body.most_force - 1.0), GIVE_FORCE,
    )  # fmt: skip
    every, top = np.arange(len(nodes)), np.interp(nodes, times, goals.highest)
    room = Limits(every, np.full((len(nodes), 1), 1 / UNIT), np.full(len(nodes), -np.inf), top / UNIT, GIVE_ROOM)
    solution = solve_surely(problem, [force, room], f"the height of the body {span(times)}")
    return HeightPath(nodes, solution.x, _slopes(nodes, solution.x, flying), solution.softened)


def span(times: Array) -> str:
    """Return the seconds from the first to the last of some times, as words for the user."""
    return f"from {times[0]:.1f} s to {times[-1]:.1f} s"


def _separate_flights(flights: Array) -> Array:
    """Return flights (k, 2) with time on the ground between them; one that begins as the last one ends is left out."""
    keep, landed = [], -np.inf
    for k, (start, end) in enumerate(flights):
        if start - landed >= LEAST_STAND:
            keep.append(k)
            landed = end
    return np.asarray(flights[keep])


def _nodes(start: float, end: float, flights: Array) -> tuple[Array, Flags]:
    """Return node times, and for each interval between nodes whether it is flight."""
    times, flying = [np.array([start])], []
    stands = zip([start, *flights[:, 1]], [*flights[:, 0], end], strict=True)
    phases = sorted([*((a, b, False) for a, b in stands), *((a, b, True) for a, b in flights)])
    for a, b, fly in phases:
        count = max(3, int(np.ceil((b - a) * NODE_RATE)))
        times.append(a + (b - a) * np.arange(1, count + 1) / count)
        flying.append(np.full(count, fly))
    return np.concatenate(times), np.concatenate(flying)


def _second(t: Array) -> Array:
    """Return the coefficients (n - 2, 3) of the second derivative at each inner node of an uneven grid."""
    a, b = t[1:-1] - t[:-2], t[2:] - t[1:-1]
    return np.stack((2 / (a * (a + b)), -2 / (a * b), 2 / (b * (a + b))), axis=1)


def _third(t: Array) -> Array:
    """Return coefficients (n - 3, 4) of the third derivative on four neighbouring nodes: 6 divided differences."""
    x = np.stack([t[k : len(t) - 3 + k] for k in range(4)], axis=1)
    out = np.empty_like(x)
    for i in range(4):
        out[:, i] = 6.0 / np.prod([x[:, i] - x[:, j] for j in range(4) if j != i], axis=0)
    return out


def _objective(
    nodes: Array, flying: Flags, in_flight: Flags, goals: HeightGoals, body: BodySettings
) -> BandedLeastSquares:
    n = len(nodes)
    wanted, above, firm = (np.interp(nodes, goals.times, x) for x in (goals.target, goals.above, goals.firm))
    problem = BandedLeastSquares(n, 1)
    step = np.gradient(nodes) * NODE_RATE
    before, after = np.concatenate(([False], flying)), np.concatenate((flying, [False]))
    counts = np.where(before | after, np.where(before & after, LOOSE, np.maximum(firm, LOOSE)), step)
    problem.add(np.arange(n), np.full((n, 1), 1 / UNIT), counts, wanted[:, None] / UNIT)
    inner = np.flatnonzero(in_flight)
    fall = _second(nodes)[in_flight] / GRAVITY
    problem.add(inner, fall, np.full(len(inner), 1e6), np.full((len(inner), 1), -1.0))
    slow = body.height_calm + (body.height_smooth - body.height_calm) * np.interp(nodes, goals.times, goals.tempo)
    jerk = _third(nodes) * slow[1:-2, None] ** 3 / UNIT
    parts = np.stack([flying[k : n - 3 + k] for k in range(3)], axis=1)
    weight = np.where(parts.any(axis=1), 0.02, 1.0) * np.where(parts.all(axis=1), 0.0, step[1:-2])
    throws = sum(jerk[:, k] * above[k : n - 3 + k] for k in range(4))
    problem.add(np.arange(n - 3), jerk, weight, np.asarray(throws)[:, None])
    return problem


def _slopes(t: Array, x: Array, flying: Flags) -> Array:
    """Return slopes at the nodes: of the parabola next to flight, otherwise of the parabola through three nodes."""
    h = np.diff(t)
    rise = np.diff(x) / h
    out = np.empty_like(x)
    out[1:-1] = (rise[:-1] * h[1:] + rise[1:] * h[:-1]) / (h[:-1] + h[1:])
    out[0], out[-1] = rise[0], rise[-1]
    after, before = np.flatnonzero(flying), np.flatnonzero(flying) + 1
    out[after] = rise[after] + GRAVITY * h[after] / 2  # at the start of a flight interval
    out[before] = rise[before - 1] - GRAVITY * h[before - 1] / 2  # and at its end
    return out
