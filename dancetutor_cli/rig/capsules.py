"""Limbs as tapered capsules, which are what the eye takes them for: how deep one is in another one."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.rig.limb import Vec, add, dot, length, scale, sub
from dancetutor_cli.run.kernels.compiling import inner_kernel, njit

Array = NDArray[np.float64]
THIGH, KNEE, ANKLE = 0.068, 0.048, 0.035  # radii of a leg, metres
GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0
STEPS = 16  # of the golden section: to 0.05 % of a limb
Capsule = tuple[Array, Array, float, float]  # ends (f, 3), and the radius at each


def leg_capsules(hip: Array, knee: Array, ankle: Array) -> list[Capsule]:
    """Thigh and shank of a leg, joints (f, 3)."""
    return [(hip, knee, THIGH, KNEE), (knee, ankle, KNEE, ANKLE)]


def depth(first: list[Capsule], second: list[Capsule], steps: int = STEPS) -> Array:
    """How deep (f,) any capsule of the first list is in any of the second one, metres; negative apart."""
    out = np.full(len(first[0][0]), -np.inf)
    for (a, b, thick, thin), (c, d, other, end) in product(first, second):
        a, b, c, d = (np.ascontiguousarray(place) for place in (a, b, c, d))
        _deepest((a, b, c, d), (thick, thin, other, end), steps, out)
    return out


@njit(cache=True)
def _deepest(
    ends: tuple[Array, Array, Array, Array], radii: tuple[float, float, float, float], steps: int, out: Array
) -> None:
    """Raise out (f,) to how deep a round cone is in another one, ends (f, 3) of both.

    From a place on the one the other's nearest is known in closed form, and what is left of it is convex along the one:
    a golden section finds the least.
    """
    a, b, c, d = ends
    for f in range(len(out)):
        line = (vec(a[f]), vec(b[f]), vec(c[f]), vec(d[f]))
        low, high = 0.0, 1.0
        first, second = 1.0 - GOLDEN, GOLDEN
        left, right = _gap(line, radii, first), _gap(line, radii, second)
        for _ in range(steps):
            if left < right:
                high, second, right = second, first, left
                first = high - GOLDEN * (high - low)
                left = _gap(line, radii, first)
            else:
                low, first, left = first, second, right
                second = low + GOLDEN * (high - low)
                right = _gap(line, radii, second)
        out[f] = max(out[f], -min(left, right))


@inner_kernel
def vec(a: Array) -> Vec:
    return (a[0], a[1], a[2])


@inner_kernel
def _gap(line: tuple[Vec, Vec, Vec, Vec], radii: tuple[float, float, float, float], part: float) -> float:
    """Room between the sphere that is `part` of the way along the first cone, and the second one."""
    a, b, c, d = line
    along = sub(d, c)
    away = sub(add(a, scale(sub(b, a), part)), c)
    long = length(along)
    x = dot(away, along) / long
    h = math.sqrt(max(dot(away, away) - x * x, 0.0))
    slope = (radii[3] - radii[2]) / long
    on = min(max((x + h * slope / math.sqrt(1.0 - slope * slope)) / long, 0.0), 1.0)
    apart = length(sub(away, scale(along, on)))
    return apart - radii[0] - part * (radii[1] - radii[0]) - radii[2] - on * (radii[3] - radii[2])
