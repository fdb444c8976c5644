"""The limbs of a dancer, as every room names them."""

from __future__ import annotations

from enum import IntEnum


class Limb(IntEnum):
    """Who presses a panel. `NONE`: there is no step in that cell; `UNPLAYED`: no limb is left for the step."""

    LEFT_FOOT = 0
    RIGHT_FOOT = 1
    LEFT_HAND = 2
    RIGHT_HAND = 3
    NONE = -1
    UNPLAYED = -2


class Part(IntEnum):
    """Which part of a foot: only brackets (one foot on two panels) tell heel and toe apart."""

    WHOLE = 0
    HEEL = 1
    TOE = 2
