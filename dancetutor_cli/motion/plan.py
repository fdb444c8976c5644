"""What the dancer will do, before any joint is turned: where and when each foot stands and swings, hands, turns."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.baked import Contact, Grip
from dancetutor_cli.motion.foot_moves import Move, Swing
from dancetutor_cli.play.let_go import LetGo

Array = NDArray[np.float64]
# seconds, a frame of a film: in streams feet leave so long before the other one lands, and nobody sees that as a flight
LEAST_FLIGHT = 0.0166


@dataclass(frozen=True, slots=True)
class FootTrack:
    """All moves of a foot in order of time, never overlapping, and where it stood before the first: on what level."""

    start: tuple[float, float]
    start_yaw: float
    moves: tuple[Move, ...]
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
class Route:
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
    """Everything that the chart asks of the dancer.

    touches : what presses which panel from when on, until when at the latest, in order
    first, last : seconds at which the first contact of the song begins and the last one ends
    grips : when her hands rest on the bar behind her, as in `Motion`; walks : in order of time
    lead : the foot that leads, 0 left or 1 right: it decides where both sides are equal, so that the mirror image of a
        play is danced as the mirror image
    let_go : notes that she does not play, in order of time
    """

    feet: tuple[FootTrack, FootTrack]
    turns: tuple[Turn, ...]
    presses: tuple[Press, ...]
    touches: tuple[Contact, ...]
    first: float
    last: float
    grips: tuple[Grip, ...] = ()
    walks: tuple[Route, ...] = ()
    lead: int = 0
    let_go: tuple[LetGo, ...] = ()

    @property
    def hand(self) -> float:
        """1 for a plan that the left foot leads, -1 for its mirror image: the sign of what is chosen for variety."""
        return 1.0 - 2.0 * self.lead

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """What presses which panel, and how long: until the foot leaves, at the latest until its touch ends."""
        lifts = [np.array([move.lift for move in track.moves if isinstance(move, Swing)]) for track in self.feet]
        return tuple(_ended(touch, lifts[touch.limb]) if touch.limb < len(lifts) else touch for touch in self.touches)

    @property
    def flights(self) -> Array:
        """Intervals (n, 2) of seconds in which neither foot is on the ground, in order."""
        return airborne(self.feet)


def _ended(touch: Contact, lifts: Array) -> Contact:
    k = int(np.searchsorted(lifts, touch.start))
    return replace(touch, end=min(touch.end, float(lifts[k]))) if k < len(lifts) else touch


def airborne(feet: tuple[FootTrack, FootTrack]) -> Array:
    """Intervals (n, 2) of seconds in which neither foot is on the ground, in order."""
    out = []
    left, right = ([m for m in f.moves if isinstance(m, Swing)] for f in feet)
    i = j = 0
    while i < len(left) and j < len(right):
        start, end = max(left[i].lift, right[j].lift), min(left[i].land, right[j].land)
        if end - start > LEAST_FLIGHT:
            out.append((start, end))
        if left[i].land <= right[j].land:
            i += 1
        else:
            j += 1
    return np.array(out, dtype=np.float64).reshape(-1, 2)
