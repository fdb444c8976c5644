"""The path of a centre of mass in balance: soles as support, swinging limbs, the zero-moment point."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from dancetutor_cli.dance.foot_path import Feet, FootPath
from dancetutor_cli.dance.plan import LEAST_FLIGHT
from dancetutor_cli.dance.quadratic import BandedLeastSquares, Limits, Solution, differences, solve_surely
from dancetutor_cli.dance.rig.body import (
    SOLE_BACK_HEEL,
    SOLE_BACK_TOES,
    SOLE_FRONT,
    SOLE_HALF_WIDTH,
    ball_to_ankle,
)
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.dance.settings import MotionSettings
from dancetutor_cli.dance.settings_body import BodySettings, LayerSettings
from dancetutor_cli.dance.smoothing import low_pass, sample_path, soft_excess, steady_spline
from dancetutor_cli.dance.trajectory.height import span
from dancetutor_cli.dance.units import Array, Flags

# The standing soles, as a hull that must contain the zero-moment point.

ONE, TWO = np.pi / 2 * np.arange(2), np.pi / 4 * np.array([0.0, 1.0, -1.0])  # hull angles: of one sole, of two


@dataclass(frozen=True, slots=True)
class Support:
    """The allowed places of the zero-moment point at each of n nodes: a hull of the standing soles.

    across : (n, 5, 2) unit vectors square to its sides; low, high : (n, 5) metres along these, infinite where the hull
        of one sole has no such side
    middle : (n, 2) the best place
    """

    across: Array
    low: Array
    high: Array
    middle: Array


def support_of(feet: Feet, heel_down: float) -> Support:
    """Return the support of the standing soles. heel_down : radians; a heel lower than this carries weight"""
    soles = [_sole(foot, heel_down) for foot in feet]
    across = _sides(feet, soles)
    along = [np.einsum("nda,nca->ndc", across, sole) for sole in soles]
    down = [foot.down[:, None] for foot in feet]
    low = np.minimum(*(np.where(d, x.min(axis=2), np.inf) for d, x in zip(down, along, strict=True)))
    high = np.maximum(*(np.where(d, x.max(axis=2), -np.inf) for d, x in zip(down, along, strict=True)))
    one = np.flatnonzero(down[0][:, 0] != down[1][:, 0])
    low[one, len(ONE) :], high[one, len(ONE) :] = -np.inf, np.inf
    left, right = (sole.mean(axis=1) for sole in soles)
    best = np.where(down[0] == down[1], (left + right) / 2, np.where(down[0], left, right))
    return Support(across, low, high, best)


def _sole(foot: FootPath, heel_down: float) -> Array:
    """Return the corners (n, 4, 2) of the part of a foot that carries weight, in order around it."""
    ahead = np.column_stack((np.sin(foot.yaw), np.cos(foot.yaw)))
    aside = SOLE_HALF_WIDTH * np.column_stack((ahead[:, 1], -ahead[:, 0]))
    back = np.where(foot.pitch < heel_down, SOLE_BACK_HEEL, SOLE_BACK_TOES)[:, None]
    toe, heel = (foot.ball[:, [0, 2]] + far * ahead for far in (SOLE_FRONT, back))
    return np.stack((toe - aside, toe + aside, heel + aside, heel - aside), axis=1)


def _sides(feet: Feet, soles: list[Array]) -> Array:
    """Return unit vectors (n, 5, 2) square to the sides of a hull of the standing soles.

    For one foot these are its own two sides. For two feet they are the sides that touch both soles, and the sides at
    the ends of the line between them. With the same directions at all times, the hull of a turned foot would be
    centimetres wider than the foot.
    """
    line = soles[0].mean(axis=1) - soles[1].mean(axis=1)
    left, right = feet[0].down, feet[1].down
    angle = np.where(left, feet[0].yaw, feet[1].yaw)[:, None] + np.concatenate((ONE, np.zeros(3)))
    both = np.flatnonzero(left & right)
    angle[both, :3] = np.arctan2(line[both, 0], line[both, 1])[:, None] + TWO
    out = np.stack((np.sin(angle), np.cos(angle)), axis=-1)
    out[both, 3:] = _touching(soles[0][both], soles[1][both])
    return out


def _touching(a: Array, b: Array) -> Array:
    """Return unit vectors (m, 2, 2) square to the two lines that touch two rectangles (m, 4, 2) on the same side."""
    edge = (b[:, None] - a[:, :, None]).reshape(-1, 16, 2)
    square = np.stack((edge[..., 1], -edge[..., 0]), axis=-1)
    square /= np.maximum(np.linalg.norm(square, axis=-1, keepdims=True), 1e-9)
    corners = np.concatenate((a, b), axis=1)
    beyond = np.einsum("mea,mca->mec", square, corners)
    beyond -= np.einsum("mea,mea->me", square, np.repeat(a, 4, axis=1))[..., None]
    outer = np.stack((beyond.max(axis=2).argmin(axis=1), beyond.min(axis=2).argmax(axis=1)), axis=1)
    return np.take_along_axis(square, outer[..., None], axis=1)


def along_sides(across: Array, places: Array) -> Array:
    """Return how far (n, d) places (n, 2) are along each of the directions (n, d, 2)."""
    return np.asarray(np.einsum("nda,na->nd", across, places))


# The best zero-moment point of a body whose limbs turn about its centre of mass (`momentum.rotation_zmp_offset`).

AGAINST = 0.7  # largest part of the way from the middle of the soles to their edge: nearer to the edge, balance is lost
FARTHEST = 0.03  # metres; largest offset: beyond it, ankles of wide stands bend too far before a leap


def counter_rotation_zmp(support: Support, turning: Array) -> Array:
    """Return the best zero-moment point (n, 2) of the point mass: with `turning` (n, 2) added, it is near the soles'
    middle.

    It does not go all the way, because the point itself must also stay well within the soles.
    """
    along, middle = along_sides(support.across, turning), along_sides(support.across, support.middle)
    room = np.where(along > 0.0, middle - support.low, support.high - middle)
    with np.errstate(divide="ignore", invalid="ignore"):
        most = np.where(along != 0.0, AGAINST * np.maximum(room, 0.0) / np.abs(along), np.inf)
    far = FARTHEST / np.maximum(np.linalg.norm(turning, axis=1), FARTHEST)
    return np.asarray(support.middle - np.minimum(most.min(axis=1), far)[:, None] * turning)


# The path of the centre of mass over the ground, in balance.
#
# The cart-table model (Kajita 2003): the zero-moment point is x - y / (y'' + g) x'' . It must stay under the standing
# feet, and the pelvis where both legs reach their feet. Within these limits the pelvis, which swinging legs throw, has
# the least jerk. In flight nothing pushes sideways, so the path is straight. If the limits of a song contradict each
# other, they give way by as little as possible.

NODE_RATE, ROUGH_RATE = 80.0, 40.0  # nodes per second of the path, and of a rough path
UNIT = 0.03  # metres; scales the programme
NARROWER, NARROWEST = 0.05, 0.01  # metres: largest move of a limit in a round, and least distance of two limits
NEAR, END = 1e-5, 0.1  # weight of the middle of the soles in general, and at both ends of the path
SUPPORT_BEHIND = 0.15  # metres behind the farthest place of the mass; hands on a bar carry the support so far
GIVE_SUPPORT, GIVE_REACH = 0.0005, 0.01  # costs of leaving the soles and of stretching, see `quadratic.Limits`


@dataclass(frozen=True, slots=True)
class Pendulum:
    """The inverted pendulum on the zero-moment point at n even times.

    times : (n,) seconds; slowness : (n,) 1 / omega^2 = y / (y'' + g), seconds squared; ignored in flight
    smooth_slowness : (n,) slowness without trembling above 10 Hz
    offset : (n, 2) from the pelvis to the centre of mass, as far as known
    farthest : (n,) metres, largest distance of the pelvis from an ankle in the direction of the other one
    turning : (n, 2) as from `momentum.rotation_zmp_offset`, as far as known
    rail : the bar, while hands hold it
    """

    times: Array
    slowness: Array
    smooth_slowness: Array
    offset: Array
    farthest: Array
    turning: Array
    rail: Rail | None = None


@dataclass(frozen=True, slots=True)
class Rail:
    """A bar behind the dancer at n even times: while a hand holds it, it supports her, and she stays within reach.

    ahead : (n,) farthest place of the centre of mass along z, metres
    held : (n,) whether a hand holds it; soft : metres over which the wish to be ahead of that place fades
    """

    ahead: Array
    held: Flags
    soft: float

    def at(self, times: Array, nodes: Array) -> Rail:
        """Return the rail at other times."""
        held = np.interp(nodes, times, self.held.astype(np.float64)) > 0.999
        return replace(self, ahead=np.interp(nodes, times, self.ahead), held=held)

    def supported(self, support: Support) -> Support:
        """Return the support with a place a little farther back than where she stays within reach."""
        on = self.held[:, None]
        place = np.column_stack((support.middle[:, 0], self.ahead - SUPPORT_BEHIND))
        along = along_sides(support.across, place)
        low = np.where(on, np.minimum(support.low, along), support.low)
        high = np.where(on, np.maximum(support.high, along), support.high)
        return replace(support, low=low, high=high)

    def within_reach(self, place: Array) -> Array:
        """Return places (n, 2) that are no farther than the arms let her, softly, where a hand holds the rail."""
        near = self.ahead - soft_excess(self.ahead - place[:, 1], self.soft)
        return np.column_stack((place[:, 0], np.where(self.held, near, place[:, 1])))


def balanced_path(
    feet: Feet,
    pendulum: Pendulum,
    settings: MotionSettings,
    tightened: int = 0,
    hand: float = 1.0,
    shift: Array | None = None,
) -> tuple[Array, bool]:
    """Return the path (n, 2) of the centre of mass over the ground, and whether limits were softened
    (`quadratic.Solution`).

    The body is a cart on a table (Kajita and others 2003): with x the centre of mass over the ground, y its height and
    g gravity the zero-moment point is  z = x - y / (y'' + g) x'' . On nodes k

        minimise    sum_k w_k |z_k - m_k|^2  +  s^6 sum_k |d3(x - o)/dt3|_k^2
        subject to  low_k <= n_k . z_k <= high_k     the soles that stand, side by side with normal n
                    near_k <= x_k - o_k <= far_k     what both legs can reach
                    x''_k = 0                        in flight (a term of large weight)

    m : the middle of the support; w : `middle_weight`, `foot_weight`; o : from the pelvis to the centre of mass; s :
    `smooth`, seconds. Both coordinates are unknowns of one programme, because edges of soles lie aslant.

    Parameters
    ----------
    feet : at the pendulum's times
    settings : of the body, and of the sway of the weight while both feet stand
    hand : as in `Plan`; the side on which the dancer begins to sway; shift : (n,) as in `waits.WaitMotion`
    tightened : rounds in which limits are narrowed where the path, without trembling, leaves them; 0 is a rough path
    """
    times, body, rate = pendulum.times, settings.body, NODE_RATE if tightened else ROUGH_RATE
    nodes = times[0] + np.arange(int(np.ceil((times[-1] - times[0]) * rate - 1e-6)) + 1) / rate
    feet = (_nearest(feet[0], times, nodes), _nearest(feet[1], times, nodes))
    slowness, seen = (np.interp(nodes, times, x) for x in (pendulum.slowness, pendulum.smooth_slowness))
    offset = sample_path(pendulum.offset, times, nodes)
    room = _room(feet, np.interp(nodes, times, pendulum.farthest), body.farthest)
    feet = _carrying(feet, rate)
    support = support_of(feet, float(np.radians(body.heel_carries)))
    rail = None if pendulum.rail is None else pendulum.rail.at(times, nodes)
    down = np.stack([f.down for f in feet])
    both = np.asarray(down.all(axis=0))
    stepping = ~both | _brief(both, settings.step.longest * rate)
    middle = counter_rotation_zmp(support, stepping[:, None] * sample_path(pendulum.turning, times, nodes))
    middle = middle + hand * _sway(feet, nodes, settings.layers)
    if shift is not None:
        middle = middle + _shifted(feet, settings.wait.onto, np.interp(nodes, times, shift), slowness, rate)
    if rail is not None:
        support, middle = rail.supported(support), rail.within_reach(middle)
        farthest = np.where(rail.held, rail.ahead - rail.soft / 2 - offset[:, 1], np.inf)
        room = room[0], np.column_stack((room[1][:, 0], np.minimum(room[1][:, 1], farthest)))
    middle_weight = np.where(stepping, body.middle_weight_fast, body.middle_weight)
    weight = np.where(both, middle_weight, body.foot_weight)
    flight: Flags = np.asarray(~down.any(axis=0))
    alone = np.asarray(down.any(axis=0)) & ~both
    near = np.where(alone & ~_brief(alone, body.commit_time * rate), body.commit, NEAR)
    near[[0, -1]] = END
    want = _PathGoals(replace(support, middle=middle), weight, near, offset, *room)
    what = f"the path of the balance {span(times)}"
    found = _solved(want, flight, slowness, rate, body, what)
    softened = found.softened
    for _ in range(tightened):
        path = found.x.reshape(-1, 2)
        want = _tightened(want, support, _zero_moment(low_pass(path, rate), seen, rate), flight)
        found = _solved(want, flight, slowness, rate, body, what)
        softened |= found.softened
    return steady_spline(nodes, found.x.reshape(-1, 2), times), softened


@dataclass(frozen=True, slots=True)
class _PathGoals:
    """The goals of the path at each of n nodes.

    support : the allowed and the best places of the zero-moment point
    weight : (n,) weight of the best place; near : (n,) weight of the distance of the centre of mass from it
    offset : (n, 2) from the pelvis to the centre of mass
    nearest, farthest : (n, 2) limits of the pelvis's place
    """

    support: Support
    weight: Array
    near: Array
    offset: Array
    nearest: Array
    farthest: Array


def _room(feet: Feet, farthest: Array, along_axes: float) -> tuple[Array, Array]:
    """Return the lowest and highest place (n, 2) of the pelvis that both legs reach. farthest : as of `Pendulum`;
    along_axes : metres, the least of it along each axis
    """
    back = ball_to_ankle(dancer_skeleton())
    ankles = [f.ball[:, [0, 2]] - back * np.column_stack((np.sin(f.yaw), np.cos(f.yaw))) for f in feet]
    apart = np.abs(ankles[0] - ankles[1])
    most = np.maximum(farthest * apart.max(axis=1) / np.maximum(np.hypot(*apart.T), 0.05), along_axes)[:, None]
    return np.maximum(*ankles) - most, np.minimum(*ankles) + most


def _nearest(foot: FootPath, times: Array, nodes: Array) -> FootPath:
    """Return a foot at the sampled times nearest to `nodes`, so that standing and swinging are not mixed."""
    i = np.clip(np.round((nodes - times[0]) / (times[1] - times[0])).astype(np.int64), 0, len(times) - 1)
    return FootPath(foot.ball[i], foot.yaw[i], foot.pitch[i], foot.down[i], foot.progress[i])


def _carrying(feet: Feet, rate: float) -> Feet:
    """Return feet that carry weight: not at the very moment of landing or leaving, unless no other foot stands."""
    down = np.stack([f.down for f in feet])
    down = down | _brief(np.asarray(~down.any(axis=0)), np.ceil(LEAST_FLIGHT * rate))
    firm = down.copy()
    firm[:, 1:] &= down[:, :-1]
    firm[:, :-1] &= down[:, 1:]
    firm = np.where(firm.any(axis=0), firm, down)
    return replace(feet[0], down=firm[0]), replace(feet[1], down=firm[1])


def _brief(flags: Flags, most: float) -> Flags:
    """Return the flags of runs (n,) that are at most `most` long."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], flags, [False])).astype(np.int8))).reshape(-1, 2)
    out = np.zeros(len(flags), dtype=bool)
    for first, end in edges[edges[:, 1] - edges[:, 0] <= most]:
        out[first:end] = True
    return out


def _sway(feet: Feet, times: Array, layers: LayerSettings) -> Array:
    """Return (n, 2): how far the weight sways from foot to foot while both stand."""
    across = feet[0].ball[:, [0, 2]] - feet[1].ball[:, [0, 2]]
    across = across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 0.05)
    both = feet[0].down & feet[1].down
    slow = 2 * np.pi * times / layers.sway_time
    phase = np.sin(slow) + layers.sway_quick * np.sin(slow / layers.sway_quick_time)
    return np.asarray(across * (layers.sway * phase * both)[:, None])


def _shifted(feet: Feet, onto: float, shift: Array, slowness: Array, rate: float) -> Array:
    """Return the way (n, 2) of the zero-moment point that moves the weight by `shift` (n,) metres to the left foot.

    onto : largest part of the way to the middle of a foot
    """
    across = feet[0].ball[:, [0, 2]] - feet[1].ball[:, [0, 2]]
    far = np.maximum(np.linalg.norm(across, axis=1), 0.05)
    point = _zero_moment(shift[:, None], slowness, rate)[:, 0]
    most = onto * far / 2
    return np.asarray(across / far[:, None] * (np.clip(point, -most, most) * (feet[0].down & feet[1].down))[:, None])


def _zero_moment(path: Array, slowness: Array, rate: float) -> Array:
    """Return the zero-moment point (n, 2) of a path (n, 2); at its ends, the path itself."""
    out = path.copy()
    out[1:-1] -= slowness[1:-1, None] * np.diff(path, n=2, axis=0) * rate**2
    return out


def _tightened(want: _PathGoals, given: Support, zmp: Array, flight: Flags) -> _PathGoals:
    """Return goals whose limits are moved inward by as much as a zero-moment point (n, 2) is beyond the given limits.

    Trembling above 10 Hz is not visible, and the quality report does not measure it. But some of it is needed to arrive
    in time, because the weight goes from foot to foot within a few hundredths of a second.
    """
    low, high, tight = given.low, given.high, want.support
    along = along_sides(given.across, zmp)
    stand = ~flight[:, None]
    span = np.subtract(high, low, where=stand, out=np.zeros_like(low))
    inside = np.minimum(NARROWEST, span) / 2
    lower = tight.low + np.where(stand, np.clip(low - along, 0.0, NARROWER), 0.0)
    upper = tight.high - np.where(stand, np.clip(along - high, 0.0, NARROWER), 0.0)
    narrowed = replace(
        tight,
        low=np.where(stand, np.minimum(lower, high - inside), low),
        high=np.where(stand, np.maximum(upper, low + inside), high),
    )
    return replace(want, support=narrowed)


def _solved(want: _PathGoals, flight: Flags, slowness: Array, rate: float, body: BodySettings, what: str) -> Solution:
    """Solve the path (n, 2), flat; both coordinates are unknowns of one programme, alternating."""
    support = want.support
    n = len(support.middle)
    problem = BandedLeastSquares(2 * n, 1, 8)
    inner = np.arange(1, n - 1)
    second = differences(2) * rate**2
    zmp = (np.array([0.0, 1.0, 0.0]) - slowness[inner, None] * second) / UNIT
    stand = ~flight[inner]
    k, fly = inner[stand], inner[~stand]
    jerk = np.tile(differences(3) * (rate * body.smooth) ** 3 / UNIT, (n - 3, 1))
    # between two feet too far apart for both legs the pelvis is in the middle
    low, high = (b + want.offset for b in (want.nearest, want.farthest))
    low, high = np.minimum(low, (low + high) / 2), np.maximum(high, (low + high) / 2)
    limits = []
    for a in (0, 1):
        axis = np.eye(2)[a]
        problem.add(2 * k - 2, _both(zmp[stand], axis), want.weight[k], support.middle[k, a, None] / UNIT)
        straight = _both(np.tile(second, (len(fly), 1)), axis)
        problem.add(2 * fly - 2, straight, np.full(len(fly), 10.0), np.zeros((len(fly), 1)))
        problem.add(2 * np.arange(n) + a, np.full((n, 1), 1 / UNIT), want.near, support.middle[:, a, None] / UNIT)
        thrown = sum(jerk[:, q] * want.offset[q : n - 3 + q, a] for q in range(4))
        problem.add(2 * np.arange(n - 3), _both(jerk, axis), np.ones(n - 3), np.asarray(thrown)[:, None])
        every = 2 * np.arange(n) + a, np.full((n, 1), 1 / UNIT)
        limits.append(Limits(*every, low[:, a] / UNIT, high[:, a] / UNIT, GIVE_REACH))
    for d in range(support.low.shape[1]):
        there = np.isfinite(support.low[k, d])
        at = k[there]
        along = 2 * at - 2, _both(zmp[stand][there], support.across[at, None, d])
        limits.append(Limits(*along, support.low[at, d] / UNIT, support.high[at, d] / UNIT, GIVE_SUPPORT))
    return solve_surely(problem, limits, what)


def _both(coefficients: Array, direction: Array) -> Array:
    """Return coefficients (m, 2 q) of a term in both coordinates, from (m, q) along a direction (2,) or (m, 1, 2)."""
    count, width = coefficients.shape
    return (coefficients[:, :, None] * direction).reshape(count, 2 * width)
