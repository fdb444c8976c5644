"""The types that the parts of a picture share: the frame on which they draw, the pad, and a foot seen from above."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Frame = NDArray[np.uint8]


class PadLike(Protocol):
    """The parts of a `feet.pads.Pad` that the picture needs, in panel widths, x to the right, y to the screen."""

    @property
    def panels(self) -> NDArray[np.float64]:
        """The centre of each panel, (c, 2), in column order."""

    @property
    def arrows(self) -> NDArray[np.float64]:
        """The direction of the arrow on each panel, (c, 2); (0, 0) for a panel without an arrow."""

    @property
    def centre(self) -> tuple[float, float]:
        """The point at which the dancer stands at the start."""

    @property
    def squares(self) -> NDArray[np.float64]:
        """The middle of each square of panels, (s, 2)."""


@dataclass(frozen=True, slots=True)
class FootFromAbove:
    """A foot seen from above. heel, toe : (x, y) in panel widths, x to the right, y to the screen; height : metres."""

    heel: tuple[float, float]
    toe: tuple[float, float]
    height: float


def darkened(frame: Frame, dark: tuple[int, int, int], light: float) -> Frame:
    """Blend a picture over a dark colour; light : the share of the picture, 0 to 1."""
    if light >= 1.0:
        return frame
    keep = round(256 * light)
    return np.asarray((frame * np.uint16(keep) + np.array(dark, np.uint16) * (256 - keep)) >> 8, dtype=np.uint8)
