"""Where things are in the world: panels on the ground, and where on a panel a foot comes down."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from dancetutor_cli.pads import Pad

Array = NDArray[np.float64]
PANEL = 0.28  # metres, width of one panel
HALF_PANEL = PANEL / 2
BALL_AHEAD = 0.046  # the ball of the foot lies so far before the middle of the sole
BALL_MARGIN = 0.042  # the ball stays so far inside the panel: half of its width


def panels_on_ground(pad: Pad) -> Array:
    """World (x, z) of every panel's centre, (c, 2); the pad's centre is the origin and +Z the screen."""
    centre = np.asarray(pad.centre, dtype=np.float64)
    panels = np.asarray(pad.panels, dtype=np.float64) - centre
    return np.asarray(panels * np.array([-PANEL, PANEL]))


def heading(yaw: float) -> Array:
    """Unit vector (x, z) that somebody turned by `yaw` radians looks along."""
    return np.array([np.sin(yaw), np.cos(yaw)])


def ball_of(middle: Array, yaw: float) -> Array:
    """The ball of a foot whose sole has its middle there."""
    return np.asarray(middle + BALL_AHEAD * heading(yaw))


def middle_of(ball: Array, yaw: float) -> Array:
    """The middle of the sole of a foot whose ball is there."""
    return np.asarray(ball - BALL_AHEAD * heading(yaw))


def landing_ball(panel: Array, yaw: float, other: Array | None, cut: float, edge_margin: float, clear: float) -> Array:
    """Where the ball of a foot lands on a panel.

    Parameters
    ----------
    panel : (2,) centre of the panel; yaw : of the foot; other : (2,) middle of the other foot, or None
    cut : 0 for the centre of the panel, 1 for the edge nearest to the other foot (less `edge_margin`)
    clear : the middles of the feet stay this far apart, where the panel is wide enough
    """
    middle = panel.copy()
    if other is not None:
        away = other - panel
        distance = float(np.linalg.norm(away))
        if distance > 1e-6:
            direction = away / distance
            to_edge = HALF_PANEL / max(abs(direction[0]), abs(direction[1])) - edge_margin
            middle = panel + direction * min(cut * to_edge, max(distance - clear, 0.0))
        if distance < clear:
            middle = _beside(panel, other, yaw, clear)
    ball = ball_of(middle, yaw)
    room = HALF_PANEL - BALL_MARGIN
    return np.asarray(np.clip(ball, panel - room, panel + room))


def _beside(panel: Array, other: Array, yaw: float, clear: float) -> Array:
    """A place on a panel that the other foot stands on: as far from it as the panel allows."""
    away = panel - other
    if np.linalg.norm(away) < 1e-3:
        away = np.array([np.cos(yaw), -np.sin(yaw)])
    target = other + away / np.linalg.norm(away) * clear
    return np.asarray(np.clip(target, panel - HALF_PANEL + 0.03, panel + HALF_PANEL - 0.03))
