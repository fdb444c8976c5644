"""Both feet leave the ground at once and come down at once: what jumps, leaps and hops over mines have in common."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.foot_moves import STRAIGHT, Bulge, Jump
from dancetutor_cli.motion.footwork.chart_row import Row
from dancetutor_cli.motion.footwork.foothold import Heel, Pitches, around, heel_up
from dancetutor_cli.motion.footwork.footing import Footing, Proposal, pair
from dancetutor_cli.motion.settings import JumpSettings
from dancetutor_cli.motion.swing.jump_ways import jump_ways
from dancetutor_cli.rig.mass import GRAVITY

Array = NDArray[np.float64]
FARTHER = 1.5  # parts of `jump.far`; feet that travel farther are pulled up no more
Goals = list[tuple[Array, float]]  # ball (2,) and yaw without toe-out, of the left and the right foot


@dataclass(frozen=True, slots=True)
class Flight:
    """Both feet in the air from `take_off` to `land`, seconds.

    turned : degrees that the line between them turns
    first : when each foot leaves the ground, if before the take-off of both
    mined : mines pass meanwhile, over which feet are pulled up however short the flight
    """

    take_off: float
    land: float
    turned: float = 0.0
    first: tuple[float, float] = (np.inf, np.inf)
    mined: bool = False


def flown(footing: Footing, flight: Flight, goals: Goals, pitches: list[Pitches]) -> Footing:
    """The footing after both feet have gone to their goals, on ways that keep the shoes apart."""
    jump, feet = footing.settings.jump, footing.feet
    starts, ends = np.array([f.ball for f in feet]), np.array([ball for ball, _ in goals])
    before = np.array([footing.toes(f) for f in feet])
    after = np.array([footing.toes(f, yaw) for f, (_, yaw) in zip(feet, goals, strict=True)])
    turn = float(np.radians(flight.turned))
    share, aside = jump_ways(starts, before, ends, after, turn, footing.settings)
    far = float(np.linalg.norm(ends - starts, axis=1).max())
    tuck = tuck_for(far, jump.tuck_full if flight.mined else flight.land - flight.take_off, jump)
    middles = pair(starts.mean(axis=0)), pair(ends.mean(axis=0))
    for side, foot in enumerate(feet):
        lift = min(flight.first[side], flight.take_off)
        height = GRAVITY * (flight.land - lift) ** 2 / 8
        # heels that have just come down do not get up so far again
        up = float(np.clip((lift - foot.landed) / jump.heel_time, 0.0, 1.0))
        leave, most, land_pitch, rest = pitches[side]
        rise = (up * leave, most, land_pitch, rest)
        bulge = Bulge(*pair(aside[side]))
        swing = Jump(
            lift, flight.land, pair(ends[side]), float(after[side]), rise, height, bulge, tuck, turn, middles, share,
        )  # fmt: skip
        footing = footing.with_foot(foot.moved(swing, ends[side], goals[side][1]))
    return footing


def hop(
    row: Row, footing: Footing, take_off: float, goals: Goals, columns: list[list[int]], turned: float = 0.0
) -> Proposal:
    """Both feet in the air from `take_off` until the row.

    columns : that each foot stands over then; turned : degrees that the line between the feet turns
    """
    jump, step = footing.settings.jump, footing.settings.step
    eased = 1.0 - jump.quick_flat * row.hurry
    lift, land = eased * jump.lift_pitch, eased * jump.land_pitch
    heel = Heel((lift, lift, land), (jump.lift_flat, jump.swing_flat))
    pitches = [heel_up(step, row.jump_cut, heel, c) for c in columns]
    flight = Flight(take_off, row.time, turned, _first(row, footing, take_off, goals), _mined(row, footing, take_off))
    return Proposal(flown(footing, flight, goals, pitches), take_off)


def _mined(row: Row, footing: Footing, take_off: float) -> bool:
    """Whether mines pass from a little before a take-off until the row's landing, or a little after it."""
    rows, around = row.play.rows, footing.settings.mines.before
    near = slice(*np.searchsorted(rows.second, (take_off - around, row.time + around)).tolist())
    return bool(rows.mines[near].any())


def _first(row: Row, footing: Footing, take_off: float, goals: Goals) -> tuple[float, float]:
    """When each foot leaves the ground in a quick jump: the one with the longer way before both take off."""
    step, feet, time = footing.settings.step, footing.feet, row.time
    ways = [float(np.linalg.norm(ball - f.ball)) for (ball, _), f in zip(goals, feet, strict=True)]
    side = int(ways[1] > ways[0])
    foot, (target, yaw) = feet[side], goals[side]
    out = [take_off, take_off]
    early = max(foot.earliest(time), time - row.duration * (1.0 - step.double_support_fast))
    straight = around(footing, foot, (early, time), target, yaw, feet[1 - side]) == STRAIGHT
    if straight and ways[side] > ways[1 - side] + footing.settings.jump.farther:
        out[side] -= row.cut * max(take_off - early, 0.0)
    return out[0], out[1]


def take_off_for(footing: Footing, time: float, flight: float) -> float:
    """When both feet take off to land at `time`, if they would fly for so many seconds."""
    feet = footing.feet
    latest = (f.latest(time, footing.settings.step.let_go) for f in feet)
    take_off = min(max(time - flight, *(f.earliest(time) for f in feet)), *latest)
    return max(take_off, *(f.rested(time) for f in feet))


def tuck_for(distance: float, seconds: float, jump: JumpSettings) -> float:
    """How much more feet are pulled up that go so far in a flight of so many seconds: not in short, low ones.

    Knees that fold and open again within a tenth of a second throw the body. In the shortest of all feet rise a little
    more than the body does, or nobody could say when they come down.
    """
    share = float(np.clip((seconds - jump.tuck_from) / max(jump.tuck_full - jump.tuck_from, 1e-3), 0.0, 1.0))
    more = share * jump.tuck * (1.0 + jump.tuck_far * min(distance / jump.far, FARTHER) ** 2)
    return max(more, jump.least - GRAVITY * seconds**2 / 8)
