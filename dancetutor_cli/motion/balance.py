"""Where the centre of mass travels over the ground, so that the dancer keeps her balance.

The cart-table model (Kajita 2003): the zero-moment point is  x - y / (y'' + g) x'' . It has to stay under the feet that
stand, and the pelvis where both legs reach their feet; within that the path has the least jerk. In flight nothing
pushes sideways, so it is straight. Where a song asks for the impossible, limits give way by as little as they must.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.banded import BandedLeastSquares, differences
from dancetutor_cli.motion.feet import FootPath
from dancetutor_cli.motion.paths import cubic, sample_path
from dancetutor_cli.motion.qp import Limits, solve
from dancetutor_cli.motion.settings import BodySettings, LayerSettings, MotionSettings

Array = NDArray[np.float64]
NODE_RATE = 80.0  # nodes per second
UNIT = 0.03  # metres; scales the programme
HALF_WIDTH = 0.022  # of the part of a sole that may carry the whole weight
FRONT, BACK_TOES, BACK_HEEL = 0.065, -0.012, -0.125  # its ends before the ball; on toes, and with the heel down
HEEL_DOWN = np.radians(1.2)  # a heel lower than this carries
FARTHEST = 0.42  # metres over the ground, along each axis, from the pelvis to an ankle
ANKLE_BEHIND = 0.115  # metres from the ball to the ankle
GIVE_SUPPORT, GIVE_REACH = 0.0005, 0.01  # prices of leaving the soles and of stretching, see `qp.Limits`


def balanced_path(
    feet: tuple[FootPath, FootPath], lever: Array, offset: Array, times: Array, settings: MotionSettings
) -> Array:
    """Path (n, 2) of the centre of mass over the ground.

    Parameters
    ----------
    feet : at the n even `times`, seconds
    lever : (n,) y / (y'' + g), seconds squared; ignored in flight
    offset : (n, 2) from the pelvis to the centre of mass, as far as known
    settings : of the body, and how the weight sways while both feet stand
    """
    body, rate = settings.body, NODE_RATE
    nodes = np.arange(times[0], times[-1] + 1.0 / rate, 1.0 / rate)
    feet = (_nearest(feet[0], times, nodes), _nearest(feet[1], times, nodes))
    lever = np.interp(nodes, times, lever)
    offset = sample_path(offset, times, nodes)
    room = _room(feet)
    feet = _carrying(feet)
    low, high, middle = _support(feet)
    middle = middle + _sway(feet, nodes, settings.layers)
    down = np.stack([f.down for f in feet])
    flight = np.asarray(~down.any(axis=0))
    weight = np.where(down.all(axis=0), body.middle_weight, body.foot_weight)
    out = np.empty((len(nodes), 2))
    for k in (0, 1):
        wanted = _Wanted(middle[:, k], low[:, k], high[:, k], weight, offset[:, k], room[0][:, k], room[1][:, k])
        out[:, k] = _axis(wanted, flight, lever, rate, body)
    return cubic(nodes, out, times)


@dataclass(frozen=True, slots=True)
class _Wanted:
    """What one axis of the path shall do, (n,) each: where the zero-moment point shall be and may be, where pelvis."""

    middle: Array
    low: Array
    high: Array
    weight: Array
    offset: Array
    nearest: Array
    farthest: Array


def _room(feet: tuple[FootPath, FootPath]) -> tuple[Array, Array]:
    """Lowest and highest place (n, 2) of the pelvis from which both legs reach."""
    ankles = [f.ball[:, [0, 2]] - ANKLE_BEHIND * np.column_stack((np.sin(f.yaw), np.cos(f.yaw))) for f in feet]
    return np.maximum(*ankles) - FARTHEST, np.minimum(*ankles) + FARTHEST


def _nearest(foot: FootPath, times: Array, nodes: Array) -> FootPath:
    """A foot at the sampled times nearest to other ones: standing and swinging are not mixed."""
    i = np.clip(np.round((nodes - times[0]) / (times[1] - times[0])).astype(np.int64), 0, len(times) - 1)
    return FootPath(foot.ball[i], foot.yaw[i], foot.pitch[i], foot.down[i], foot.progress[i])


def _carrying(feet: tuple[FootPath, FootPath]) -> tuple[FootPath, FootPath]:
    """Feet that may carry: not at the very moment of landing or leaving, unless no other foot stands."""
    down = np.stack([f.down for f in feet])
    firm = down.copy()
    firm[:, 1:] &= down[:, :-1]
    firm[:, :-1] &= down[:, 1:]
    firm = np.where(firm.any(axis=0), firm, down)
    return replace(feet[0], down=firm[0]), replace(feet[1], down=firm[1])


def _support(feet: tuple[FootPath, FootPath]) -> tuple[Array, Array, Array]:
    """Lowest, highest and best place (n, 2) of the zero-moment point: a box around the soles that stand."""
    lows, highs, middles = [], [], []
    for foot in feet:
        ahead = np.column_stack((np.sin(foot.yaw), np.cos(foot.yaw)))
        back = np.where(foot.pitch < HEEL_DOWN, BACK_HEEL, BACK_TOES)[:, None]
        middle = foot.ball[:, [0, 2]] + (FRONT + back) / 2 * ahead
        half = HALF_WIDTH + ((FRONT - back) / 2 - HALF_WIDTH) * ahead**2
        down = foot.down[:, None]
        lows.append(np.where(down, middle - half, np.inf))
        highs.append(np.where(down, middle + half, -np.inf))
        middles.append(middle)
    left, right = feet[0].down[:, None], feet[1].down[:, None]
    best = np.where(left == right, (middles[0] + middles[1]) / 2, np.where(left, middles[0], middles[1]))
    return np.minimum(*lows), np.maximum(*highs), best


def _sway(feet: tuple[FootPath, FootPath], times: Array, layers: LayerSettings) -> Array:
    """(n, 2): how far the weight wanders from foot to foot while both stand."""
    across = feet[0].ball[:, [0, 2]] - feet[1].ball[:, [0, 2]]
    across = across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 0.05)
    both = feet[0].down & feet[1].down
    phase = np.sin(2 * np.pi * times / layers.sway_time) + 0.4 * np.sin(2 * np.pi * times / (0.37 * layers.sway_time))
    return np.asarray(across * (layers.sway * phase * both)[:, None])


def _axis(want: _Wanted, flight: NDArray[np.bool_], lever: Array, rate: float, body: BodySettings) -> Array:
    n = len(want.middle)
    problem = BandedLeastSquares(n, 1)
    inner = np.arange(1, n - 1)
    second = differences(2) * rate**2
    zmp = np.array([0.0, 1.0, 0.0]) - lever[inner, None] * second
    stand = ~flight[inner]
    k = inner[stand]
    problem.add(k - 1, zmp[stand] / UNIT, want.weight[k], want.middle[k, None] / UNIT)
    fly = inner[~stand]
    problem.add(fly - 1, np.tile(second, (len(fly), 1)), np.full(len(fly), 10.0), np.zeros((len(fly), 1)))
    problem.add(np.arange(n), np.full((n, 1), 1 / UNIT), np.full(n, 1e-5), want.middle[:, None] / UNIT)
    jerk = np.tile(differences(3) * (rate * body.smooth) ** 3 / UNIT, (n - 3, 1))
    problem.add(np.arange(n - 3), jerk, np.ones(n - 3), np.zeros((n - 3, 1)))
    # between two feet too far apart for both legs the pelvis is in the middle
    low, high = (b + want.offset for b in (want.nearest, want.farthest))
    low, high = np.minimum(low, (low + high) / 2), np.maximum(high, (low + high) / 2)
    limits = [
        Limits(k - 1, zmp[stand] / UNIT, want.low[k] / UNIT, want.high[k] / UNIT, GIVE_SUPPORT),
        Limits(np.arange(n), np.full((n, 1), 1 / UNIT), low / UNIT, high / UNIT, GIVE_REACH),
    ]
    return solve(problem, limits).x
