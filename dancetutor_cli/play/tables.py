"""The arrays that the solver's kernels share: a pad's geometry, and the ways to play one row from one state."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.pads import Pad
from dancetutor_cli.pads.pad import HOME_WIDTH

EPSILON = 1e-6  # every comparison of cost-model.md: degrees, panel widths, seconds
MOST_MOVES = 10 * 9 * 8 * 7 + 8  # ways to put four limbs on a row of ten steps, and some room
COLUMN_BITS = 10  # a row packs into one integer: so many bits for each of its masks, see `ROW_MASKS`
ROW_MASKS = ("taps", "holds", "mines", "released", "rolls", "roll_taps")


class Geometry(NamedTuple):
    """A pad with c panels; place c is home, which differs for the two feet.

    left, right : float64 (c + 1, 2), where the left or right foot stands
    angle : float64 (c + 1, c + 1), degrees in (-180, 180] of the vector from left foot to right foot, by their places
    neighbours : bool (c, c), panels one foot can press together
    home : int64 (2,), columns of the starting stance
    """

    left: NDArray[np.float64]
    right: NDArray[np.float64]
    angle: NDArray[np.float64]
    neighbours: NDArray[np.bool_]
    home: NDArray[np.int64]


class Moves(NamedTuple):
    """Every way to play one row from one state: room for `MOST_MOVES`, and scratch space.

    key : int64, packed state after the row
    action : int64, limb codes of the row, 3 bits for each column from the lowest
    part : int64, 2 bits for each column, `Part`
    terms : int32 (, t), what each cost term adds, not counting time
    timed : int64, packed facts that cost by the time since the row before; 0 none
    events : int64, bits of what happens, by their places in `vocabulary.EVENTS`
    state, press, panels : int64, scratch
    """

    key: NDArray[np.int64]
    action: NDArray[np.int64]
    part: NDArray[np.int64]
    terms: NDArray[np.int32]
    timed: NDArray[np.int64]
    events: NDArray[np.int64]
    state: NDArray[np.int64]
    press: NDArray[np.int64]
    panels: NDArray[np.int64]


def geometry(pad: Pad) -> Geometry:
    """The arrays of a pad."""
    (x, y), panels = pad.centre, pad.panels
    left = np.concatenate([panels, [[x - HOME_WIDTH, y]]])
    right = np.concatenate([panels, [[x + HOME_WIDTH, y]]])
    across = right[None, :] - left[:, None]
    angle = np.degrees(np.arctan2(across[..., 1], across[..., 0]))
    angle[angle <= -180.0 + EPSILON] = 180.0
    return Geometry(left, right, angle, pad.neighbours, np.array(pad.home, dtype=np.int64))


def moves(terms: int) -> Moves:
    """Empty room for the ways to play one row."""
    n, whole = MOST_MOVES, np.int64
    return Moves(
        key=np.zeros(n, dtype=whole),
        action=np.zeros(n, dtype=whole),
        part=np.zeros(n, dtype=whole),
        terms=np.zeros((n, terms), dtype=np.int32),
        timed=np.zeros(n, dtype=whole),
        events=np.zeros(n, dtype=whole),
        state=np.zeros(16, dtype=whole),
        press=np.zeros(4, dtype=whole),
        panels=np.zeros(16, dtype=whole),
    )
