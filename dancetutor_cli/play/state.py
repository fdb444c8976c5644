"""The state of the dancer between rows: ten numbers that pack into one integer. Kernel code."""

from __future__ import annotations

from dancetutor_cli.play.jit import inner_kernel
from dancetutor_cli.play.tables import EPSILON

LEFT_AT, RIGHT_AT = 0, 1  # places of the feet, see `tables.Geometry`
SIDE = 2  # of a facing of 180 degrees: 1 reached as +180, 2 reached as -180, 0 otherwise
LAST = 3  # last leg: 0 none, 1 left, 2 right
LEFT_HELD, RIGHT_HELD = 4, 5  # parts of a foot that a hold reserves: bit 0 the heel or the whole foot, bit 1 the toe
LEFT_HOLDS, RIGHT_HOLDS = 6, 7  # panel + 1 that a hand holds, 0 none
LEFT_LIFTED, RIGHT_LIFTED = 8, 9  # 1 while a foot is off its panel because of a mine
NUMBERS = 10
PLACE_BITS = 5  # the places of the feet are the lowest bits of the packed state, then comes SIDE


@inner_kernel
def pack(s):  # type: ignore[no-untyped-def]
    """The ten numbers in one: 5 + 5 + 2 + 2 + 2 + 2 + 4 + 4 + 1 + 1 bits."""
    low = s[0] | s[1] << 5 | s[2] << 10 | s[3] << 12 | s[4] << 14 | s[5] << 16
    return low | s[6] << 18 | s[7] << 22 | s[8] << 26 | s[9] << 27


@inner_kernel
def unpack(key, s):  # type: ignore[no-untyped-def]
    """The numbers of a packed state into `s`."""
    s[0], s[1], s[2], s[3], s[4] = key & 31, key >> 5 & 31, key >> 10 & 3, key >> 12 & 3, key >> 14 & 3
    s[5], s[6], s[7], s[8], s[9] = key >> 16 & 3, key >> 18 & 15, key >> 22 & 15, key >> 26 & 1, key >> 27 & 1


@inner_kernel
def turn(before, side, after):  # type: ignore[no-untyped-def]
    """From one facing to another: degrees turned (unsigned), whether it is a spin, side of the new facing."""
    back = abs(before) >= 180.0 - EPSILON
    start = -180.0 if back and side == 2 else before
    delta = after - start
    while delta > 180.0 + EPSILON:
        delta -= 360.0
    while delta <= -180.0 - EPSILON:
        delta += 360.0
    if abs(delta) >= 180.0 - EPSILON:
        return 180.0, False, 0
    ends_back = abs(after) >= 180.0 - EPSILON
    if back and ends_back:
        return 0.0, False, side
    end = start + delta
    spin = abs(end) > 180.0 + EPSILON and not (back and side == 0)
    return abs(delta), spin, ((1 if end > 0 else 2) if ends_back else 0)
