"""Limbs through limbs: legs and arms as tapered capsules, which are what the eye takes them for."""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.bake.quality.figures import Figure
from dancetutor_cli.bake.quality.resampled import Body
from dancetutor_cli.rig.capsules import ANKLE, KNEE, THIGH, Capsule, depth
from dancetutor_cli.rig.skeleton import Skeleton

Array = NDArray[np.float64]
DEEP = 0.01  # metres; what is less deep is clothes and skin that give way
LEG = (("hip", THIGH), ("knee", KNEE), ("talocrural", ANKLE))  # joints and radii, metres
ARM = (("shoulder", 0.045), ("elbow", 0.036), ("radiocarpal", 0.026))
HAND = 0.10  # metres of the hand beyond the wrist


def capsule_figures(body: Body, skeleton: Skeleton) -> tuple[tuple[Figure, ...], tuple[str, ...]]:
    """Frames in which a limb is deeper than 1 cm in another one, and notes on where it is worst."""
    figures, notes = [], []
    for name, deep in limb_depths(body, skeleton).items():
        figures.append(Figure(name, float((deep > DEEP).sum()), "frames", 0.0))
        if (deep > DEEP).any():
            worst = int(np.argmax(deep))
            share = 100.0 * float((deep > DEEP).mean())
            notes.append(
                f"{name} deeper than {100 * DEEP:g} cm in {share:.2f} % of frames, {100 * deep[worst]:.1f} cm at "
                f"most, at {body.times[worst]:.2f} s"
            )
    return tuple(figures), tuple(notes)


def limb_depths(body: Body, skeleton: Skeleton) -> dict[str, Array]:
    """How deep (f,) left and right leg, left and right arm, and any arm and leg are in each other, metres; below 0
    apart."""
    legs, arms = ([_limb(body, skeleton, side, chain) for side in "lr"] for chain in (LEG, ARM))
    return {
        "leg in leg": depth(legs[0], legs[1]),
        "arm in arm": depth(arms[0], arms[1]),
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
