"""The shoes of `--gait heels`: ankle boots on block heels, within the outline of the flat shoes.

The foot's joints stay where they are: the boot is cut out below the arch, and a heel stands under what is left.
"""

from __future__ import annotations

import numpy as np
from build_character_body import FRONT, HIP, UP
from build_character_loft import Lofted, joined, loft
from build_character_sdf import Array, Shape, blend, carve, common, cone, ellipsoid, half_space, stack
from build_character_trims import around, outline

THICK = 0.007  # metres of the sole
WELT = 0.0030  # metres that it stands out from the boot: flush with it both show through each other


def _under(at: Array) -> Array:
    """Height of the sole's upper side at places along the foot: low at the ball, an arch, high over the heel."""
    z = [-0.09, -0.030, -0.005, 0.030, 0.060, 0.085, 0.15, 0.19]
    y = [0.043, 0.043, 0.0410, 0.0290, 0.0130, 0.0085, 0.0085, 0.0130]
    return np.interp(at, z, y)


def _whole() -> Shape:
    """The boot without its lower end, pointed at the toes."""
    x = HIP[0]
    toe = blend(
        0.02,
        ellipsoid((x + 0.001, 0.022, 0.108), (0.0385, 0.030, 0.060)),
        ellipsoid((x, 0.018, 0.145), (0.0200, 0.018, 0.036)),
    )
    middle = cone((x, 0.044, 0.070), (x, 0.072, -0.005), 0.0310, 0.0345)
    heel = ellipsoid((x, 0.052, -0.030), (0.0330, 0.040, 0.040))
    rows = [
        (0.045, 0.0355, 0.045, 0.045, -0.012),
        (0.09, 0.0380, 0.044, 0.044, -0.017),
        (0.142, 0.0425, 0.046, 0.048, -0.019),
    ]
    collar = common(stack((x, 0, 0), UP, FRONT, rows), half_space((0, 0.132, 0), (0, 1, -0.12)), 0.004)
    last = ellipsoid((x, 0.028, 0.040), (0.0340, 0.030, 0.100))
    return blend(0.03, blend(0.03, toe, middle), heel, collar, last)


def upper() -> Shape:
    """The boot, in the foot's colour; its lower edge is inside the sole."""
    hollow = ellipsoid((HIP[0], 0.148, -0.019), (0.0365, 0.026, 0.040))
    boot = carve(_whole(), hollow, 0.004)
    return lambda p: np.maximum(boot(p), (_under(p[:, 2]) - 0.004 - p[:, 1]) * 0.85)


def sole() -> Lofted:
    """The thin sole along the arch, and the heel."""
    ring = outline() + np.array([HIP[0], 0.0])
    boot = _whole()
    z = ring[:, 1]
    for _ in range(3):  # the arch is where the line around the boot is
        line = around(boot, ring, _under(z))
        z = line[:, 2]
    top = _under(z)
    rings = [_wider(line, by, top - down) for by, down in ((-0.003, THICK), (WELT, THICK - 0.001), (WELT, 0.0005))]
    turn = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    round_ = np.stack([np.sin(turn), np.zeros(16), np.cos(turn)], axis=1)
    heel = [
        np.array([HIP[0], y, z]) + round_ * [wide, 0, long]
        for y, z, wide, long in (
            (0.0, -0.047, 0.0150, 0.0150), (0.0015, -0.047, 0.0165, 0.0165), (0.016, -0.045, 0.0190, 0.0200),
            (0.039, -0.041, 0.0265, 0.0280),
        )
    ]  # fmt: skip
    return joined(loft([*rings, _wider(line, -0.002, top + 0.002)]), loft(heel))


def _wider(line: Array, by: float, y: Array) -> Array:
    """The line around the boot moved out by so many metres on the floor, at heights y."""
    way = np.roll(line, -1, 0) - np.roll(line, 1, 0)
    out = np.stack([way[:, 2], np.zeros(len(way)), -way[:, 0]], axis=1)
    out *= np.sign((out * (line - line.mean(0))).sum()) / np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-9)
    moved = line + by * out
    return np.stack([moved[:, 0], y, moved[:, 2]], axis=1)
