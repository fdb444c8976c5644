"""The dancer's moves, before any joint is turned: moves of feet and hands, turns, and the plan of a song."""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from dancetutor_cli.dance.motion import Contact, Grip
from dancetutor_cli.dance.units import Array
from dancetutor_cli.feet.unplayable import DroppedNote

# The moves of a foot. Each kind of move is a type, and has only the fields that it needs.

Place = tuple[float, float]


class Bulge(NamedTuple):
    """How the path of a foot goes around the other foot. x, z : metres added at the middle of the path

    late : part of the straight path by which the foot is behind at a quarter of the time and ahead at three quarters.
    The foot moves aside first, then past, then in
    """

    x: float = 0.0
    z: float = 0.0
    late: float = 0.0


STRAIGHT = Bulge()


@dataclass(frozen=True, slots=True)
class Move:
    """One foot moves from `lift` to `land` (seconds), and then stands at `target`.

    target : (x, z) of the ball of the foot at landing; yaw : radians at landing, positive left
    pitches : how far the heel is up, radians: at lift, the most in the air, at landing, then standing
    """

    lift: float
    land: float
    target: Place
    yaw: float
    pitches: tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Pivot(Move):
    """A turn of a standing foot on its ball, which stays down."""


@dataclass(frozen=True, slots=True)
class Swing(Move):
    """A move in which the foot leaves the ground. height : peak of the sole, metres

    bulge : how the path goes around the other foot
    """

    height: float
    bulge: Bulge = STRAIGHT


@dataclass(frozen=True, slots=True)
class Step(Swing):
    """A step to a note while the other foot stands."""


@dataclass(frozen=True, slots=True)
class Sidestep(Swing):
    """A step in a wait, towards the other pad."""


@dataclass(frozen=True, slots=True)
class Hover(Swing):
    """A swing over a mine: the foot rises soon and lands late."""


@dataclass(frozen=True, slots=True)
class Gallop(Swing):
    """The step of the second foot of a gallop. It lands later than the first foot, and stays up as over a mine."""


@dataclass(frozen=True, slots=True)
class Shake(Swing):
    """A shake of a foot in a wait: the foot is in the air behind the dancer for a while, and returns to its place.

    behind : metres that the foot goes back; hangs : radians by which its toes hang down meanwhile
    rate : shakes per second; far : metres to and fro along `heading` (radians), and half as far up and down
    flap : radians that the foot flaps
    """

    behind: float = 0.0
    hangs: float = 0.0
    rate: float = 0.0
    far: float = 0.0
    flap: float = 0.0
    heading: float = 0.0


@dataclass(frozen=True, slots=True)
class WalkStep(Swing):
    """A step of a walk. level : height of the ground at the landing, metres"""

    level: float = 0.0


@dataclass(frozen=True, slots=True)
class Jump(Swing):
    """The move of one foot in a jump with both feet: the sole rises and falls as the body does.

    tuck : metres that the foot is pulled up in addition; middles : (x, z) between the feet before and after the jump
    line_turn : radians that the line between the feet turns; round : the part of the path that goes around the middle;
    the rest is straight
    """

    tuck: float = 0.0
    line_turn: float = 0.0
    middles: tuple[Place, Place] = ((0.0, 0.0), (0.0, 0.0))
    round: float = 0.5


# seconds, one frame of a film: in streams feet leave this long before the other foot lands, which is not a visible
# flight
LEAST_FLIGHT = 0.0166


@dataclass(frozen=True, slots=True)
class FootTrack:
    """All moves of a foot in order of time, never overlapping; its place and level before the first move."""

    start: tuple[float, float]
    start_yaw: float
    moves: tuple[Move, ...]
    start_level: float = 0.0


@dataclass(frozen=True, slots=True)
class Turn:
    """A turn of the body from its yaw before to `yaw` (radians, unwrapped) between `start` and `end` (seconds)."""

    start: float
    end: float
    yaw: float


@dataclass(frozen=True, slots=True)
class Press:
    """A palm is on a panel from `start` to `end`; side 0 left, 1 right; target (x, z).

    turn : radians that the body turns to the side of the hand, because the panel lies behind it; positive left
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
    """A walk from `start` to `end`, seconds, with the landings in between. The first landing is by foot `first`.

    gait : "flat" or "heels"; share : 0 to 1, how much of the quick form of the gait the walk has
    """

    start: float
    end: float
    landings: tuple[float, ...]
    first: int
    share: float
    gait: str


def chance_of(*numbers: int) -> np.random.Generator:
    """Return a random generator that is always the same for the same whole numbers, which may be negative."""
    return np.random.default_rng([number & 0xFFFFFFFF for number in numbers])


@dataclass(frozen=True, slots=True)
class Plan:
    """The plan of a dance: everything that the chart asks of the dancer.

    touches : the limb on each panel, its first second and its latest last second, in order
    first, last : seconds at which the first contact of the song begins and the last one ends
    grips : when the dancer's hands rest on the bar behind her, as in `Motion`; walks : in order of time
    lead : the foot that leads, 0 left or 1 right. It decides where both sides are equal, so that the mirror image of a
    play is danced as the mirror image
    dropped : notes that the dancer does not play, in order of time
    """

    feet: tuple[FootTrack, FootTrack]
    turns: tuple[Turn, ...]
    presses: tuple[Press, ...]
    touches: tuple[Contact, ...]
    first: float
    last: float
    grips: tuple[Grip, ...] = ()
    walks: tuple[Walk, ...] = ()
    lead: int = 0
    dropped: tuple[DroppedNote, ...] = ()

    @property
    def song(self) -> tuple[int, int]:
        """Milliseconds of the first and the last contact: the seed of random choices for a song, mirrored
        or in pieces.
        """
        return round(1000 * self.first), round(1000 * self.last)

    @property
    def hand(self) -> float:
        """1 for a plan that the left foot leads, -1 for its mirror image: the handedness of the plan, not a hand.

        Random choices (to sway left or right) are multiplied by it, so that a mirrored play is danced mirrored.
        """
        return 1.0 - 2.0 * self.lead

    @property
    def swings(self) -> tuple[Swing, ...]:
        """All swings of the left foot, then of the right one, without the steps of walks."""
        moves = (move for track in self.feet for move in track.moves)
        return tuple(move for move in moves if isinstance(move, Swing) and not isinstance(move, WalkStep))

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """The limb on each panel, and how long: until the foot leaves, or at the latest until its touch ends."""
        lifts = [[move.lift for move in track.moves if isinstance(move, Swing)] for track in self.feet]
        return tuple(_ended(touch, lifts[touch.limb]) if touch.limb < len(lifts) else touch for touch in self.touches)

    @property
    def flights(self) -> Array:
        """The intervals (n, 2) of seconds in which neither foot is on the ground, in order."""
        return airborne(self.feet)


def _ended(touch: Contact, lifts: list[float]) -> Contact:
    k = bisect_left(lifts, touch.start)
    return touch if k == len(lifts) or touch.end <= lifts[k] else replace(touch, end=float(lifts[k]))


def airborne(feet: tuple[FootTrack, FootTrack]) -> Array:
    """Return the intervals (n, 2) of seconds in which neither foot is on the ground, in order."""
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
