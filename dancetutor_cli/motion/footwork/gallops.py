"""Gallops: a step after a wait, and soon after it one of the other foot, are one jump whose second foot lands later."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from dancetutor_cli.motion.footwork.chart_row import Row
from dancetutor_cli.motion.footwork.footing import Footing, TakeOff
from dancetutor_cli.rig.mass import GRAVITY


def galloping(row: Row, side: int, footing: Footing) -> Footing:
    """The footing in which both feet are about to take off together, if a gallop begins with the row's step."""
    jump, rows, i = footing.settings.jump, row.play.rows, row.index
    if i + 1 >= len(rows) or row.duration < jump.gallop_wait:
        return footing
    gap = float(rows.second[i + 1]) - row.time
    following = row.play.limb[i + 1]
    steps = np.flatnonzero(following >= 0)
    if not (0.0 < gap <= jump.gallop and len(steps) == 1 and following[steps[0]] == 1 - side):
        return footing
    flight = min(float(np.sqrt(8 * jump.apex_near / GRAVITY)), jump.flight_share * row.duration)
    take_off = max(row.time - flight, *(f.earliest(row.time) for f in footing.feet))
    if take_off > row.time - jump.gallop_flight:
        return footing
    both = TakeOff(i, take_off), TakeOff(i + 1, take_off)
    return replace(footing, take_offs=both if side == 0 else both[::-1])
