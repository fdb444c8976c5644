"""The bits of packed words, and a pad's geometry, a preset's rules and the ways to play one row as arrays.

The arrays are few and wide, with names for their columns, because numba's time to compile grows with every array
passed.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.feet.pads import HOME_WIDTH, Pad
from dancetutor_cli.run.errors import UsageError

# Bits of the two words of a packed row, `Tables.pattern`, from the lowest one at the right. A mask has one bit for each
# column, at most ten:
#
#     row    60 FRESH | 50 ROLL_TAPS | 40 ROLLS | 30 RELEASED | 20 MINES | 10 HOLDS | 0 TAPS
#     more                           | 30 EARLIER |               0 FORCED: 3 bits for each column
#
#     TAPS, HOLDS, MINES   what stands in the row's cells; with rolls as taps, ROLLS and ROLL_TAPS are empty
#     RELEASED, FRESH      columns whose hold has ended since the row before; whether that was just now
#     ROLLS, ROLL_TAPS     columns whose roll goes on after the row; virtual taps of rolls
#     FORCED, EARLIER      limb codes of overrides; columns whose hold ended at the last row with steps
#
# A limb code is 0 for nobody, a `Limb` + 1, or UNPLAYED_CODE. `state` has the bits of a state. Words in `tables`:
#
#     edge           35 cost without time | 19 number of facts | 18 last one that leads there | 0 place of state before
#     node           32 cost so far | 0 edge that led here
#     wide           WIDE_ACTION: 32 parts, 2 bits for each column | 0 limb codes, 3 bits for each column
#                    WIDE_EVENTS: 32 number of the costs by term | 0 events
#     pair           32 pattern | 0 state; beside it 16 first move | 0 number of moves

MOST_PLACES = 32  # places of a foot: panels, home, pairs of neighbours
EPSILON = 1e-6  # every comparison of docs/cost-model.md: degrees, panel widths, seconds
MOST_MOVES = 10 * 9 * 8 * 7 + 8  # ways to put four limbs on a row of ten steps, and some spare room
COLUMN_BITS = 10  # bits of each mask of a packed row
TAPS, HOLDS, MINES, RELEASED, ROLLS, ROLL_TAPS = (i * COLUMN_BITS for i in range(6))  # where the masks start
FRESH = 6 * COLUMN_BITS  # bit of a row whose holds have just been released
# first bits in the second word: limb codes of overrides, and holds that ended at the last row with steps
FORCED, EARLIER = 0, 3 * COLUMN_BITS
UNPLAYED_CODE = 5  # the limb code of a step for which no limb is free
FRESH_TICKS = 6  # a 32nd; a hold that ended at most this long ago has just been released
DISTANCE_UNIT = 20  # distances are whole numbers of 1/20 panel widths

# columns of `Moves.wide`: packed state after the row; limb codes, 3 bits for each column; `Part`, 2 bits for each
# column; packed facts, whose costs depend on the time since the row before, 0: no facts; bits of `vocabulary.EVENTS`
MOVE_KEY, MOVE_ACTION, MOVE_PART, MOVE_TIMED, MOVE_EVENTS = range(5)
UP, DOWN, LEFT, RIGHT, MIDDLE = range(5)
# places in `Rules.limits`, the limits of time and length of moves
(
    GALLOP_TICKS, GALLOP_SECONDS, GALLOP_NEIGHBOURS, STREAM_TICKS, STREAM_SECONDS, STREAM_LENGTH, DRILL_TICKS,
    DRILL_SECONDS, DRILL_LENGTH,
) = range(9)  # fmt: skip


class Geometry(NamedTuple):
    """A pad with c panels. The places of a foot are 0 to c - 1: one panel; c: home; above c: two neighbouring panels.

    left, right : float64 (p, 2), middle of a foot on each place; home differs for the two feet
    angle : float64 (p, p), degrees in (-180, 180] of the vector from left foot to right foot; 0 if they are together
    distance : int64 (p, p), between the middles of places, 1/20 panel widths
    place : int64 (c, c), place of a foot on two panels, -1 if they are not neighbours; the diagonal has the places on
    one panel
    panels : int64 (p, 2, 2), by place and foot: heel and toe; the toe is -1 on one panel
    mask : int64 (p,), the panels of a place as bits; near : int64 (p,), these panels and their neighbours as bits
    arrow : int64 (c,), direction of a panel's arrow: `UP`, `DOWN`, `LEFT`, `RIGHT`, `MIDDLE`; diagonals are up or down
    middle : the panel in the middle of the pad, -1 if there is none
    """

    left: NDArray[np.float64]
    right: NDArray[np.float64]
    angle: NDArray[np.float64]
    distance: NDArray[np.int64]
    place: NDArray[np.int64]
    panels: NDArray[np.int64]
    mask: NDArray[np.int64]
    near: NDArray[np.int64]
    arrow: NDArray[np.int64]
    middle: int


class Rules(NamedTuple):
    """The rules and costs of a model (its index in `vocabulary.MODELS`), a pad and a preset; see `vocabulary` for
    names.

    weights : int64 (w,); switches : bool (s,); curves : int64 (c, MOST_MS + 1), by milliseconds since the row before
    home : int64 (2,), the panels on which left and right foot start
    limits : float64, see `GALLOP_TICKS`; long : bool (c, c), see `techniques.long_ways`
    """

    model: int
    geometry: Geometry
    weights: NDArray[np.int64]
    switches: NDArray[np.bool_]
    curves: NDArray[np.int64]
    home: NDArray[np.int64]
    limits: NDArray[np.float64]
    long: NDArray[np.bool_]


class Moves(NamedTuple):
    """Every way to play one row from one state: room for `MOST_MOVES`.

    wide : int64 (, 5), see above; terms : int32 (, w), cost of each weight, without time
    scratch : int64 (8, 32); packed : int64, by state of a layer; reached : int64, by move of a layer, both scratch
    """

    wide: NDArray[np.int64]
    terms: NDArray[np.int32]
    scratch: NDArray[np.int64]
    packed: NDArray[np.int64]
    reached: NDArray[np.int64]


class Making(NamedTuple):
    """The rules, and the arrays for the ways to play a row."""

    rules: Rules
    moves: Moves


def geometry(pad: Pad) -> Geometry:
    """Return the arrays of a pad."""
    (x, y), c = pad.centre, len(pad)
    pairs = [(a, b) for a in range(c) for b in range(a + 1, c) if pad.neighbours[a, b]]
    if c + 1 + len(pairs) > MOST_PLACES:
        raise UsageError(
            f"pad '{pad.steps_type}' has too many neighbours ({len(pairs)} pairs): make its 'reach' smaller"
        )
    middles = np.array([(pad.panels[a] + pad.panels[b]) / 2 for a, b in pairs]).reshape(-1, 2)
    left = np.concatenate([pad.panels, [[x - HOME_WIDTH, y]], middles])
    right = np.concatenate([pad.panels, [[x + HOME_WIDTH, y]], middles])
    across = right[None, :] - left[:, None]
    angle = np.degrees(np.arctan2(across[..., 1], across[..., 0]))
    angle[angle <= -180.0 + EPSILON] = 180.0
    angle[np.hypot(across[..., 0], across[..., 1]) <= EPSILON] = 0.0
    far = left[None, :] - left[:, None]
    distance = np.round(DISTANCE_UNIT * np.hypot(far[..., 0], far[..., 1])).astype(np.int64)
    place = np.full((c, c), -1, dtype=np.int64)
    np.fill_diagonal(place, np.arange(c))
    panels = np.full((len(left), 2, 2), -1, dtype=np.int64)
    panels[:c, :, 0] = np.arange(c)[:, None]
    for number, (a, b) in enumerate(pairs):
        place[a, b] = place[b, a] = c + 1 + number
        for foot in range(2):
            panels[c + 1 + number, foot] = heel_and_toe(pad, a, b, foot)
    bits = np.where(panels >= 0, np.int64(1) << panels.clip(min=0), np.int64(0)).astype(np.int64)
    mask = bits[:, 0, 0] | bits[:, 0, 1]
    around = np.where(place >= 0, np.int64(1) << np.arange(c), np.int64(0))
    near = np.array([np.bitwise_or.reduce(around[(m >> np.arange(c) & 1).astype(bool)].ravel()) for m in mask.tolist()])
    return Geometry(
        left, right, angle, distance, place, panels, mask, near.astype(np.int64),
        np.array([_arrow(*way) for way in pad.arrows]),
        next((p for p in range(c) if np.hypot(*(pad.panels[p] - pad.centre)) <= EPSILON), -1),
    )  # fmt: skip


def _arrow(x: float, y: float) -> int:
    if abs(x) <= EPSILON and abs(y) <= EPSILON:
        return MIDDLE
    if abs(x) > abs(y) + EPSILON:
        return RIGHT if x > 0 else LEFT
    return UP if y > 0 else DOWN


def heel_and_toe(pad: Pad, a: int, b: int, foot: int) -> tuple[int, int]:
    """Return the panels of a foot's heel and toe on two neighbours: the toe is nearer to the screen, else outside."""
    (ax, ay), (bx, by) = pad.panels[a], pad.panels[b]
    if abs(ay - by) > EPSILON:
        return (a, b) if ay < by else (b, a)
    return (a, b) if (ax > bx) == (foot == 0) else (b, a)


def empty_moves(weights: int, width: int = 1 << 10) -> Moves:
    """Return empty arrays for the ways to play one row, and for a layer of `width` states."""
    return Moves(
        np.zeros((MOST_MOVES, 5), dtype=np.int64),
        np.zeros((MOST_MOVES, weights), dtype=np.int32),
        np.zeros((8, 32), dtype=np.int64),
        np.empty(width, dtype=np.int64),
        np.empty(16 * width, dtype=np.int64),
    )
