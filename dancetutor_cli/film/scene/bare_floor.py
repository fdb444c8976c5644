"""A motion without a chart: the bare floor under it, and the camera that follows the character from the side.

The film of a motion and the page of a capture show it alike.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.film.scene.scene import PANEL

EYE = np.array([1.5, 0.45, 3.1])  # place of the camera, from its target, metres
TARGET_HEIGHT = 0.9  # height of the camera's target, metres
FOCAL, FOLLOWED_BELOW = 1.35, 0.4  # focal length in picture heights; hertz below which the camera follows
ROOM = 2.0  # panels of floor around the character's path
FULL_RED = 10.0  # smallest distance of a point from the input that is drawn in full red, centimetres


@dataclass(frozen=True, slots=True)
class BareFloor:
    """A pad of tiles without arrows, as large as the character's path."""

    panels: NDArray[np.float64]
    arrows: NDArray[np.float64]
    centre: tuple[float, float]


def floor_under(root: NDArray[np.float64]) -> BareFloor:
    """Return a floor around the path (f, 3) of one or more roots, metres."""
    low, high = root[:, [0, 2]].min(axis=0) / PANEL, root[:, [0, 2]].max(axis=0) / PANEL
    corners = np.array([[-high[0] - ROOM, low[1] - ROOM], [-low[0] + ROOM, high[1] + ROOM]])
    return BareFloor(np.round(corners), np.zeros((2, 2)), (0.0, 0.0))
