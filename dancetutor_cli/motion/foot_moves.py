"""What a foot does, one type for each kind of move; each carries only what it needs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

Place = tuple[float, float]


class Bulge(NamedTuple):
    """How a way goes around the other foot. x, z : metres added at its middle

    late : part of the straight way by which it is behind that at a quarter, and ahead of it at three quarters: first
    aside, then past, then in
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
    """In a wait, and back to where it was: up behind her for a while, loosely shaken.

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
