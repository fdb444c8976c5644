"""Limbs through limbs: legs and arms as tapered capsules, which are what the eye takes them for."""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.quality.body import Body
from dancetutor_cli.bake.quality.figures import Figure
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
DEEP = 0.01  # metres; what is less deep is clothes and skin that give way
LEG = (("hip", 0.068), ("knee", 0.048), ("talocrural", 0.035))  # joints and radii, metres
ARM = (("shoulder", 0.045), ("elbow", 0.036), ("radiocarpal", 0.026))
HAND = 0.10  # metres of the hand beyond the wrist
GOLDEN = (np.sqrt(5.0) - 1.0) / 2.0
STEPS = 16  # of the golden section: to 0.05 % of a limb
Capsule = tuple[Array, Array, float, float]  # ends (f, 3), and the radius at each


def capsule_figures(body: Body, skeleton: Skeleton) -> tuple[tuple[Figure, ...], tuple[str, ...]]:
    """Frames in which a limb is deeper than 1 cm in another one, and notes on where it is worst."""
    figures, notes = [], []
    for name, depth in limb_depths(body, skeleton).items():
        figures.append(Figure(name, float((depth > DEEP).sum()), "frames", 0.0))
        if (depth > DEEP).any():
            worst = int(np.argmax(depth))
            share = 100.0 * float((depth > DEEP).mean())
            notes.append(
                f"{name} deeper than {100 * DEEP:g} cm in {share:.2f} % of frames, {100 * depth[worst]:.1f} cm at "
                f"most, at {body.times[worst]:.2f} s"
            )
    return tuple(figures), tuple(notes)


def limb_depths(body: Body, skeleton: Skeleton) -> dict[str, Array]:
    """How deep (f,) left and right leg, left and right arm, and any arm and leg are in each other, metres; below 0
    apart."""
    legs, arms = ([_limb(body, skeleton, side, chain) for side in "lr"] for chain in (LEG, ARM))
    return {
        "leg in leg": depth(*legs),
        "arm in arm": depth(*arms),
        "arm in leg": np.maximum.reduce([depth(arm[1:], leg) for arm, leg in product(arms, legs)]),
    }


def _limb(body: Body, skeleton: Skeleton, side: str, chain: tuple[tuple[str, float], ...]) -> list[Capsule]:
    """The capsules of a limb from its root outward; an arm's last one reaches to the end of the hand."""
    places = [body.joints[:, skeleton.index(f"{side}_{name}")] for name, _ in chain]
    radii = [radius for _, radius in chain]
    if chain is ARM:
        along = places[-1] - places[-2]
        places[-1] = places[-1] + HAND * along / np.linalg.norm(along, axis=1, keepdims=True)
    return [(places[k], places[k + 1], radii[k], radii[k + 1]) for k in range(len(chain) - 1)]


def depth(first: list[Capsule], second: list[Capsule]) -> Array:
    """How deep (f,) any capsule of the first list is in any of the second one, metres; negative apart."""
    return np.asarray(np.maximum.reduce([_depth(a, b) for a, b in product(first, second)]))


def _depth(a: Capsule, b: Capsule) -> Array:
    """How deep (f,) a round cone is in another one. From a place on the one the other's nearest is known in closed
    form, and what is left of it is convex along the one: a golden section finds the least."""
    low, high = np.zeros(len(a[0])), np.ones(len(a[0]))
    for _ in range(STEPS):
        first, second = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
        nearer = _gap(a, b, first) < _gap(a, b, second)
        low, high = np.where(nearer, low, first), np.where(nearer, second, high)
    return np.asarray(-_gap(a, b, (low + high) / 2))


def _gap(a: Capsule, b: Capsule, part: Array) -> Array:
    """Room (f,) between the sphere that is `part` (f,) of the way along a, and b."""
    point = a[0] + part[:, None] * (a[1] - a[0])
    on_b = _nearest(b, point)
    apart = np.linalg.norm(b[0] + on_b[:, None] * (b[1] - b[0]) - point, axis=1)
    return np.asarray(apart - a[2] - part * (a[3] - a[2]) - b[2] - on_b * (b[3] - b[2]))


def _nearest(capsule: Capsule, point: Array) -> Array:
    """Which part (f,) of the way along a capsule's line comes nearest to points (f, 3), its radius counted."""
    start, end, thick, thin = capsule
    along = end - start
    long = np.linalg.norm(along, axis=1)
    x = np.sum((point - start) * along, axis=1) / long
    h = np.sqrt(np.maximum(np.sum((point - start) ** 2, axis=1) - x**2, 0.0))
    slope = (thin - thick) / long
    return np.asarray(np.clip((x + h * slope / np.sqrt(1.0 - slope**2)) / long, 0.0, 1.0))
