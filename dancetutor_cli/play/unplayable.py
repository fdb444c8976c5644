"""Why no person plays a note, and how quick is too quick. Needs no numpy: the linter's rules name these."""

from __future__ import annotations

from enum import IntEnum

LEAP = 0.08  # seconds: a foot that stepped so shortly before goes to no panel apart from the one it is on
HAND = 0.40  # and a hand that came down so shortly before does not come down again


class Why(IntEnum):
    """Why a note is let go."""

    LIMBS = 0  # more panels at once than limbs
    LEAP = 1  # a foot that has just stepped on a panel apart from it
    HAND = 2  # a hand that has just been on the floor
