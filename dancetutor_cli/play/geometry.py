"""Tables of a pad for the solver: what each pose looks like and what each turn between poses is (thesis 3.1.1, 3.1.3).

A pose is (left position, right position), positions 0 = home, 1.. = panels; its index is left * (panels + 1) + right.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.pads import Pad

EPS = 1e-6
# Sides from which an exact 180 was reached.
NO_SIDE, FROM_LEFT, FROM_RIGHT = 0, 1, 2
# Bits of a turn.
SPIN, TURN_135, TURN_180 = 1, 2, 4


@dataclass(frozen=True, slots=True)
class Tables:
    """p poses, c panels.

    angle : float64 (p,), degrees in (-180, 180]; crossed : uint8 (p,)
    turn : uint8 (p, 3, p), bits of the turn from a pose with a side to a pose; side : uint8 (p, 3, p), the side after it
    hand : uint8 (2, p, c), bit 1: across the body, 2: aside, 4: behind
    """

    angle: NDArray[np.float64]
    crossed: NDArray[np.uint8]
    turn: NDArray[np.uint8]
    side: NDArray[np.uint8]
    hand: NDArray[np.uint8]


@cache
def tables(pad: Pad) -> Tables:
    """The tables of a pad."""
    panels, home = pad.positions, pad.home
    left = np.vstack([home[:1], panels])
    right = np.vstack([home[1:], panels])
    n = len(left)
    v = (right[None, :, :] - left[:, None, :]).reshape(n * n, 2)
    middle = ((right[None, :, :] + left[:, None, :]) / 2).reshape(n * n, 2)
    angle = np.degrees(np.arctan2(v[:, 1], v[:, 0]))
    angle[np.abs(angle + 180) < EPS] = 180.0
    crossed = (v[:, 0] < -EPS).astype(np.uint8)
    turn, side = _turns(angle)
    return Tables(angle, crossed, turn, side, _hands(angle, middle, panels))


def _turns(angle: NDArray[np.float64]) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    p = len(angle)
    before, after = angle[:, None, None], angle[None, None, :]
    sides = np.arange(3)[None, :, None]
    delta = (after - before + 180.0) % 360.0 - 180.0  # [-180, 180)
    half = np.abs(np.abs(delta) - 180.0) < EPS
    at_180 = np.abs(before - 180.0) < EPS
    start = np.where(at_180 & (sides == FROM_RIGHT), -180.0, before)
    end = start + delta
    spin = ~half & (np.abs(end) > 180.0 + EPS) & ~(at_180 & (sides == NO_SIDE))
    size = np.abs(delta)
    turn = spin * SPIN + (~half & (size >= 135.0 - EPS)) * TURN_135 + half * TURN_180
    stays = size < EPS
    reached = np.where(end > 0, FROM_LEFT, FROM_RIGHT)
    side = np.where(half, NO_SIDE, np.where(stays, sides, reached))
    side = np.where(np.abs(after - 180.0) < EPS, side, NO_SIDE)
    shape = (p, 3, p)
    return np.broadcast_to(turn, shape).astype(np.uint8), np.broadcast_to(side, shape).astype(np.uint8)


def _hands(angle: NDArray[np.float64], middle: NDArray[np.float64], panels: NDArray[np.float64]) -> NDArray[np.uint8]:
    theta = np.radians(angle)
    facing = np.stack([-np.sin(theta), np.cos(theta)], axis=1)[:, None, :]
    rightward = np.stack([np.cos(theta), np.sin(theta)], axis=1)[:, None, :]
    v = panels[None, :, :] - middle[:, None, :]
    length = np.hypot(v[..., 0], v[..., 1])
    lateral = (v * rightward).sum(axis=2)
    cosine = (v * facing).sum(axis=2) / np.where(length > EPS, length, 1.0)
    off = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
    there = length > EPS
    bend = np.where(off > 90 + EPS, 4, np.where(off > 45 + EPS, 2, 0))
    across = np.stack([lateral > EPS, lateral < -EPS])
    out = np.where(there, across + bend[None], 0)
    return out.astype(np.uint8)
