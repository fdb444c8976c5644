"""Both feet leave the ground at once and come down at once: jumps, leaps and hops over mines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.footwork.foothold import Pitches
from dancetutor_cli.motion.footwork.footing import Footing, pair
from dancetutor_cli.motion.moves import Jump
from dancetutor_cli.motion.swing.jump_ways import jump_ways
from dancetutor_cli.rig.mass import GRAVITY

Array = NDArray[np.float64]
HEEL_UP = 0.12  # seconds on the ground that a heel needs to come down and rise again for a jump
Goals = list[tuple[Array, float]]  # ball (2,) and yaw without toe-out, of the left and the right foot


@dataclass(frozen=True, slots=True)
class Flight:
    """Both feet in the air from `take_off` to `land`, seconds.

    turned : degrees that the line between them turns; eased : the part of the usual tuck that there is time for
    first : when each foot leaves the ground, if before the take-off of both
    """

    take_off: float
    land: float
    turned: float = 0.0
    eased: float = 1.0
    first: tuple[float, float] = (np.inf, np.inf)


def fly(footing: Footing, flight: Flight, goals: Goals, pitches: list[Pitches]) -> None:
    """Move both feet to their goals, on ways that keep the shoes apart."""
    jump, feet = footing.settings.jump, footing.feet
    starts, ends = np.array([f.ball for f in feet]), np.array([ball for ball, _ in goals])
    before = np.array([footing.toes(f) for f in feet])
    after = np.array([footing.toes(f, yaw) for f, (_, yaw) in zip(feet, goals, strict=True)])
    turn = float(np.radians(flight.turned))
    share, aside = jump_ways(starts, before, ends, after, turn, footing.settings.step.apart)
    far = float(np.linalg.norm(ends - starts, axis=1).max())
    tuck = flight.eased * tuck_for(far, jump.tuck, jump.far)
    middles = pair(starts.mean(axis=0)), pair(ends.mean(axis=0))
    for side, foot in enumerate(feet):
        lift = min(flight.first[side], flight.take_off)
        height = GRAVITY * (flight.land - lift) ** 2 / 8
        # heels that have just come down do not get up so far again
        up = float(np.clip((lift - foot.landed) / HEEL_UP, 0.0, 1.0))
        leave, most, land_pitch, rest = pitches[side]
        rise = (up * leave, most, land_pitch, rest)
        swing = Jump(
            lift, flight.land, pair(ends[side]), float(after[side]), rise, height, pair(aside[side]), tuck, turn,
            middles, share,
        )  # fmt: skip
        foot.move(swing, ends[side], goals[side][1])


def tuck_for(distance: float, tuck: float, far: float) -> float:
    """How much more feet are pulled up that go so far: legs that reach far must not lock."""
    return tuck * (1.0 + 1.5 * min(distance / far, 1.5) ** 2)
