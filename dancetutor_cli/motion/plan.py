"""What the dancer will do, before any joint is turned: where and when each foot stands and swings, hands, turns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.model import Contact, Grip

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Swing:
    """One foot leaves the ground at `lift` and comes down at `land` (seconds).

    target : (x, z) of the ball of the foot at landing; yaw : radians at landing, positive left
    height : peak of the sole in metres, `tuck` more in a jump: the first part rises and falls as the body does
    pitches : heel up, radians, at lift, at most, at landing, then standing
    bulge : (x, z) added at the middle of the path, to go around the other foot
    kind : "step", "jump", "evade" (over a mine), "gallop" (the second foot of one),
        "pivot" (turning on the ball, which stays down), "aside" (in a wait, to the other pad) or "walk"
    level : height of the ground where it lands
    turn : for jumps, how far the line between the feet turns, radians; middle0, middle1 : its middle before and after
    turning : the part of a jump's way that goes round that middle; the rest is straight
    """

    lift: float
    land: float
    target: tuple[float, float]
    yaw: float
    height: float
    pitches: tuple[float, float, float, float]
    bulge: tuple[float, float] = (0.0, 0.0)
    kind: str = "step"
    tuck: float = 0.0
    turn: float = 0.0
    middle0: tuple[float, float] = (0.0, 0.0)
    middle1: tuple[float, float] = (0.0, 0.0)
    level: float = 0.0
    turning: float = 0.5


@dataclass(frozen=True, slots=True)
class FootTrack:
    """All swings of a foot in order of time, never overlapping, and where it stood before the first: on what level."""

    start: tuple[float, float]
    start_yaw: float
    swings: tuple[Swing, ...]
    start_level: float = 0.0


@dataclass(frozen=True, slots=True)
class Turn:
    """The body turns from where it was to `yaw` (radians, unwrapped) between `start` and `end` (seconds)."""

    start: float
    end: float
    yaw: float


@dataclass(frozen=True, slots=True)
class Press:
    """A palm is on a panel from `start` to `end`; side 0 left, 1 right; target (x, z).

    turn : radians that the body turns to the hand's side for it, because the panel lies behind; positive left
    lead : seconds that the hand has for the way down, after its last panel
    """

    start: float
    end: float
    side: int
    target: tuple[float, float]
    turn: float = 0.0
    lead: float = 1.0


@dataclass(frozen=True, slots=True)
class Walk:
    """A walk from `start` to `end`, seconds, with the landings in between, the first one of foot `first`.

    gait : "flat" or "heels"; share : 0 to 1, how much of its quick form is in it
    """

    start: float
    end: float
    landings: tuple[float, ...]
    first: int
    share: float
    gait: str


@dataclass(frozen=True, slots=True)
class Plan:
    """Everything that the chart asks of the dancer. `first`, `last` : seconds of the first and last contact.

    grips : when her hands rest on the bar behind her, as in `Motion`; walks : in order of time
    lead : the foot that leads, 0 left or 1 right: it decides where both sides are equal, so that the mirror image of a
        play is danced as the mirror image
    """

    feet: tuple[FootTrack, FootTrack]
    turns: tuple[Turn, ...]
    presses: tuple[Press, ...]
    contacts: tuple[Contact, ...]
    first: float
    last: float
    grips: tuple[Grip, ...] = ()
    walks: tuple[Walk, ...] = ()
    lead: int = 0

    @property
    def hand(self) -> float:
        """1 for a plan that the left foot leads, -1 for its mirror image: the sign of what is chosen for variety."""
        return 1.0 - 2.0 * self.lead


def airborne(feet: tuple[FootTrack, FootTrack]) -> Array:
    """Intervals (n, 2) of seconds in which neither foot is on the ground, in order."""
    out = []
    left, right = ([s for s in f.swings if s.kind != "pivot"] for f in feet)
    i = j = 0
    while i < len(left) and j < len(right):
        start, end = max(left[i].lift, right[j].lift), min(left[i].land, right[j].land)
        if start < end:
            out.append((start, end))
        if left[i].land <= right[j].land:
            i += 1
        else:
            j += 1
    return np.array(out, dtype=np.float64).reshape(-1, 2)
