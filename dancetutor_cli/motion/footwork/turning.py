"""How the body turns with the feet: by how much at a row, from when on, and which foot decides where both could."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.footwork.chart_row import Row
from dancetutor_cli.motion.footwork.footing import Footing
from dancetutor_cli.numerics.ease import STEEPEST
from dancetutor_cli.play.model import Limb, Play

Array = NDArray[np.float64]
AHEAD = 10.0  # degrees that a turning body is at most ahead of a foot that turns with it
WIDE, LATE = 120.0, 0.03  # degrees beyond which a turn begins later, and by how many seconds at most
NO_WAY = 1e-6  # metres
HALF_TURN = 1e-6  # degrees from half a turn
ASIDE = 15.0  # degrees from the feet normal from which on it matters how the feet really stand


def turn_of(row: Row, footing: Footing) -> float:
    """By how many degrees the feet normal turns at a row, positive left: the shorter way round."""
    turn = float((row.play.facing[row.index] - footing.normal + 180.0) % 360.0 - 180.0)
    if abs(abs(turn) - 180.0) < HALF_TURN:  # either way is as far: how the feet stand decides, or which foot steps
        stand = (footing.line() - footing.normal + 180.0) % 360.0 - 180.0
        first = row.feet[0] if len(row.feet) == 1 else footing.lead
        turn = 180.0 * float(np.sign(stand) if ASIDE < abs(stand) < 180.0 - ASIDE else 2 * first - 1)
    return turn


def turn_start(time: float, duration: float, leaves: float, far: float) -> float:
    """When the body begins to turn `far` degrees for a move: as that begins, but not so long before the foot leaves the
    ground that body and foot would ever be turned much farther from each other than they are anyway."""
    ahead = 2.0 * AHEAD / (STEEPEST * max(far, AHEAD)) * (time - leaves)
    late = LATE * float(np.clip(far / WIDE - 1.0, 0.0, 1.0))  # for the body's path is smooth: it turns before it begins
    return max(time - duration, leaves - ahead + late)


def leading_foot(play: Play, panels: Array) -> int:
    """The foot that steps first alone, 0 left or 1 right; else the first lopsided jump tells.

    It leads: wherever both sides are equal, what it asks for is done, so a mirrored play is danced mirrored.
    panels : (c, 2) on the ground. A play that is its own mirror image is led by the left foot.
    """
    feet = [(play.limb == side).any(axis=1) for side in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT)]
    alone = np.flatnonzero(feet[0] != feet[1])
    if len(alone):
        return int(feet[1][alone[0]])
    left, right = (np.asarray(play.limb == side) for side in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT))
    aside, ahead = (left | right) @ panels[:, 0], (left.astype(np.int8) - right) @ panels[:, 1]
    for x, z in zip(aside, ahead, strict=True):  # each changes its sign in the mirror
        if max(abs(x), abs(z)) > NO_WAY:
            return int(x < 0) if abs(x) > NO_WAY else int(z < 0)
    return 0
