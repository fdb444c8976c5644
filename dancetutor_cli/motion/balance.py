"""Where the centre of mass travels over the ground, so that the dancer keeps her balance.

The cart-table model (Kajita 2003): the zero-moment point is  x - y / (y'' + g) x'' . It has to stay under the feet that
stand; within that the path has the least jerk. In flight nothing pushes sideways, so the path is straight.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.banded import BandedLeastSquares, differences
from dancetutor_cli.motion.feet import FootPath
from dancetutor_cli.motion.paths import cubic
from dancetutor_cli.motion.qp import Limits, solve
from dancetutor_cli.motion.settings import BodySettings, LayerSettings, MotionSettings

Array = NDArray[np.float64]
NODE_RATE = 80.0  # nodes per second
UNIT = 0.03  # metres; scales the programme
HALF_WIDTH = 0.036  # of the part of a sole that may carry the whole weight
FRONT, BACK_TOES, BACK_HEEL = 0.065, -0.012, -0.125  # its ends before the ball; on toes, and with the heel down
HEEL_DOWN = np.radians(1.2)  # a heel lower than this carries


def balanced_path(feet: tuple[FootPath, FootPath], lever: Array, times: Array, settings: MotionSettings) -> Array:
    """Path (n, 2) of the centre of mass over the ground.

    Parameters
    ----------
    feet : at the n even `times`, seconds
    lever : (n,) y / (y'' + g), seconds squared; ignored in flight
    settings : of the body, and how the weight sways while both feet stand
    """
    body, rate = settings.body, NODE_RATE
    nodes = np.arange(times[0], times[-1] + 1.0 / rate, 1.0 / rate)
    feet = (_nearest(feet[0], times, nodes), _nearest(feet[1], times, nodes))
    lever = np.interp(nodes, times, lever)
    feet = _carrying(feet)
    low, high, middle = _support(feet)
    middle = middle + _sway(feet, nodes, settings.layers)
    down = np.stack([f.down for f in feet])
    flight = np.asarray(~down.any(axis=0))
    weight = np.where(down.all(axis=0), body.middle_weight, body.foot_weight)
    out = np.empty((len(nodes), 2))
    for axis in (0, 1):
        out[:, axis] = _axis(middle[:, axis], low[:, axis], high[:, axis], weight, flight, lever, rate, body)
    return cubic(nodes, out, times)


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


def _axis(
    middle: Array, low: Array, high: Array, weight: Array, flight: NDArray[np.bool_], lever: Array, rate: float,
    body: BodySettings,
) -> Array:  # fmt: skip
    n = len(middle)
    problem = BandedLeastSquares(n, 1)
    inner = np.arange(1, n - 1)
    second = differences(2) * rate**2
    zmp = np.array([0.0, 1.0, 0.0]) - lever[inner, None] * second
    stand = ~flight[inner]
    k = inner[stand]
    problem.add(k - 1, zmp[stand] / UNIT, weight[k], middle[k, None] / UNIT)
    fly = inner[~stand]
    problem.add(fly - 1, np.tile(second, (len(fly), 1)), np.full(len(fly), 10.0), np.zeros((len(fly), 1)))
    problem.add(np.arange(n), np.full((n, 1), 1 / UNIT), np.full(n, 1e-5), middle[:, None] / UNIT)
    jerk = np.tile(differences(3) * (rate * body.smooth) ** 3 / UNIT, (n - 3, 1))
    problem.add(np.arange(n - 3), jerk, np.ones(n - 3), np.zeros((n - 3, 1)))
    bounds = Limits(k - 1, zmp[stand] / UNIT, low[k] / UNIT, high[k] / UNIT)
    solution = solve(problem, [bounds])
    return solution.x if solution.found else problem.solve()[:, 0]
