"""What the dancer will do, before any joint is turned: moves of feet, hands, turns, and the plan of a song."""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from dancetutor_cli.dance.motion import Contact, Grip
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.play import DroppedNote

# What a foot does, one type for each kind of move; each carries only what it needs.

Place = tuple[float, float]


class Bulge(NamedTuple):
    """How a way goes around the other foot. x, z : metres added at its middle

    late : part of the straight way by which the foot is behind at a quarter and ahead at three quarters: first aside,
    then past, then in
    """

    x: float = 0.0
    z: float = 0.0
    late: float = 0.0


STRAIGHT = Bulge()


@dataclass(frozen=True, slots=True)
class Move:
    """One foot moves from `lift` to `land` (seconds), and stands at `target` then.

    target : (x, z) of the ball of the foot at landing; yaw : radians at landing, positive left
    pitches : heel up, radians, at lift, at most, at landing, then standing
    """

    lift: float
    land: float
    target: Place
    yaw: float
    pitches: tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Pivot(Move):
    """A standing foot turns on its ball, which stays down."""


@dataclass(frozen=True, slots=True)
class Swing(Move):
    """The foot leaves the ground. height : peak of the sole, metres

    bulge : around the other foot
    """

    height: float
    bulge: Bulge = STRAIGHT


@dataclass(frozen=True, slots=True)
class Step(Swing):
    """To a note while the other foot stands."""


@dataclass(frozen=True, slots=True)
class Sidestep(Swing):
    """In a wait, towards the other pad."""


@dataclass(frozen=True, slots=True)
class Hover(Swing):
    """Over a mine: up soon and down late."""


@dataclass(frozen=True, slots=True)
class Gallop(Swing):
    """The second foot of a gallop, which lands later: it stays up as over a mine."""


@dataclass(frozen=True, slots=True)
class Shake(Swing):
    """In a wait, and back to its place: for a while the foot is up behind the dancer, loosely shaken.

    behind : metres that the foot goes back; hangs : radians that it hangs with its toes down meanwhile
    rate : per second; far : metres to and fro along `heading` (radians), and half as far up and down
    flap : radians that the foot flaps
    """

    behind: float = 0.0
    hangs: float = 0.0
    rate: float = 0.0
    far: float = 0.0
    flap: float = 0.0
    heading: float = 0.0


@dataclass(frozen=True, slots=True)
class Walk(Swing):
    """A step of a walk. level : height of the ground where it lands, metres"""

    level: float = 0.0


@dataclass(frozen=True, slots=True)
class Jump(Swing):
    """With the other foot, off the ground at once: the sole rises and falls as the body does.

    tuck : metres that the foot is pulled up more; middles : (x, z) between the feet before and after
    line_turn : radians that the line between the feet turns; round : the part of the way that goes round that middle,
    the rest is straight
    """

    tuck: float = 0.0
    line_turn: float = 0.0
    middles: tuple[Place, Place] = ((0.0, 0.0), (0.0, 0.0))
    round: float = 0.5


# seconds, a frame of a film: in streams feet leave so long before the other one lands, and nobody sees that as a flight
LEAST_FLIGHT = 0.0166


@dataclass(frozen=True, slots=True)
class FootTrack:
    """All moves of a foot in order of time, never overlapping; where it stood before the first, and on what level."""

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


def chance_of(*numbers: int) -> np.random.Generator:
    """Random numbers that are always the same for the same whole numbers, some of which may be negative."""
    return np.random.default_rng([number & 0xFFFFFFFF for number in numbers])


@dataclass(frozen=True, slots=True)
class Plan:
    """Everything that the chart asks of the dancer.

    touches : what presses which panel from when on, and until when at the latest, in order
    first, last : seconds at which the first contact of the song begins and the last one ends
    grips : when her hands rest on the bar behind her, as in `Motion`; walks : in order of time
    lead : the foot that leads, 0 left or 1 right. It decides where both sides are equal, so that the mirror image of a
    play is danced as the mirror image
    let_go : notes that the dancer does not play, in order of time
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
    let_go: tuple[DroppedNote, ...] = ()

    @property
    def song(self) -> tuple[int, int]:
        """Milliseconds of the first and the last contact: they identify a song for random choices, mirrored or in
        pieces.
        """
        return round(1000 * self.first), round(1000 * self.last)

    @property
    def hand(self) -> float:
        """1 for a plan that the left foot leads, -1 for its mirror image: the handedness, not a hand of the dancer's.

        What chance chooses (to sway left or right) is multiplied by it, so that a mirrored play is danced mirrored.
        """
        return 1.0 - 2.0 * self.lead

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """What presses which panel, and how long: until the foot leaves, or at the latest until its touch ends."""
        lifts = [[move.lift for move in track.moves if isinstance(move, Swing)] for track in self.feet]
        return tuple(_ended(touch, lifts[touch.limb]) if touch.limb < len(lifts) else touch for touch in self.touches)

    @property
    def flights(self) -> Array:
        """Intervals (n, 2) of seconds in which neither foot is on the ground, in order."""
        return airborne(self.feet)


def _ended(touch: Contact, lifts: list[float]) -> Contact:
    k = bisect_left(lifts, touch.start)
    return touch if k == len(lifts) or touch.end <= lifts[k] else replace(touch, end=float(lifts[k]))


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
