"""The soles that stand, as a hull in which the zero-moment point may be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.swing.foot_path import Feet, FootPath
from dancetutor_cli.rig.dimensions import SOLE_BACK_HEEL, SOLE_BACK_TOES, SOLE_FRONT, SOLE_HALF_WIDTH

Array = NDArray[np.float64]
ONE, TWO = np.pi / 2 * np.arange(2), np.pi / 4 * np.array([0.0, 1.0, -1.0])  # between sides of hulls of so many soles


@dataclass(frozen=True, slots=True)
class Support:
    """Where the zero-moment point may be at each of n nodes: in a hull of the soles that stand.

    across : (n, 5, 2) unit vectors square to its sides; low, high : (n, 5) metres along these, without end where one
        sole has no such side
    middle : (n, 2) where it is best
    """

    across: Array
    low: Array
    high: Array
    middle: Array


def support_of(feet: Feet, heel_down: float) -> Support:
    """The soles that stand. heel_down : radians; a heel lower than this carries"""
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
    """Corners (n, 4, 2) of what of a foot carries, once round."""
    ahead = np.column_stack((np.sin(foot.yaw), np.cos(foot.yaw)))
    aside = SOLE_HALF_WIDTH * np.column_stack((ahead[:, 1], -ahead[:, 0]))
    back = np.where(foot.pitch < heel_down, SOLE_BACK_HEEL, SOLE_BACK_TOES)[:, None]
    toe, heel = (foot.ball[:, [0, 2]] + far * ahead for far in (SOLE_FRONT, back))
    return np.stack((toe - aside, toe + aside, heel + aside, heel - aside), axis=1)


def _sides(feet: Feet, soles: list[Array]) -> Array:
    """Unit vectors (n, 5, 2) square to the sides of a hull of the soles that stand.

    Of one foot its own two; of two those that touch both soles, and at the ends of the line between them.
    With the same directions at all times the hull of a turned foot would be centimetres wider than the foot.
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
    """Unit vectors (m, 2, 2) square to the two lines that touch both of two rectangles (m, 4, 2) on the same side."""
    edge = (b[:, None] - a[:, :, None]).reshape(-1, 16, 2)
    square = np.stack((edge[..., 1], -edge[..., 0]), axis=-1)
    square /= np.maximum(np.linalg.norm(square, axis=-1, keepdims=True), 1e-9)
    corners = np.concatenate((a, b), axis=1)
    beyond = np.einsum("mea,mca->mec", square, corners)
    beyond -= np.einsum("mea,mea->me", square, np.repeat(a, 4, axis=1))[..., None]
    outer = np.stack((beyond.max(axis=2).argmin(axis=1), beyond.min(axis=2).argmax(axis=1)), axis=1)
    return np.take_along_axis(square, outer[..., None], axis=1)


def along_sides(across: Array, places: Array) -> Array:
    """How far (n, d) places (n, 2) are along each of the directions (n, d, 2)."""
    return np.asarray(np.einsum("nda,na->nd", across, places))
