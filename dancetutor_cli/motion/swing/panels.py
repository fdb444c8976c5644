"""Where things are in the world: panels on the ground, and where on a panel a foot comes down."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.settings import StepSettings
from dancetutor_cli.rig.dimensions import BALL_AHEAD

if TYPE_CHECKING:
    from dancetutor_cli.pads import Pad

Array = NDArray[np.float64]
PANEL = 0.28  # metres, width of one panel
HALF_PANEL = PANEL / 2


def panels_on_ground(pad: Pad) -> Array:
    """World (x, z) of every panel's centre, (c, 2); the pad's centre is the origin and +Z the screen."""
    centre = np.asarray(pad.centre, dtype=np.float64)
    panels = np.asarray(pad.panels, dtype=np.float64) - centre
    return np.asarray(panels * np.array([-PANEL, PANEL]))


def squares_on_ground(pad: Pad) -> Array:
    """World (x, z) of the middle of each square of three by three panels, (s, 2)."""
    return np.asarray((pad.squares - np.asarray(pad.centre, dtype=np.float64)) * np.array([-PANEL, PANEL]))


def heading(yaw: float) -> Array:
    """Unit vector (x, z) that somebody turned by `yaw` radians looks along."""
    return np.array([np.sin(yaw), np.cos(yaw)])


def ball_of(middle: Array, yaw: float) -> Array:
    """The ball of a foot whose sole has its middle there."""
    return np.asarray(middle + BALL_AHEAD * heading(yaw))


def middle_of(ball: Array, yaw: float) -> Array:
    """The middle of the sole of a foot whose ball is there."""
    return np.asarray(ball - BALL_AHEAD * heading(yaw))


@dataclass(frozen=True, slots=True)
class Spot:
    """Where a foot may be: a centre (2,), and how far (2,) along x and z its ball and its sole's middle may be off."""

    centre: Array
    room: Array
    middle_room: Array | float = np.inf


def room_on(panels: Array, column: int, step: StepSettings) -> Array:
    """How far (2,) along x and z the ball of a foot may be from a panel's centre; panels (c, 2)."""
    away = np.abs(panels - panels[column])
    beside = [((np.abs(away[:, k] - PANEL) < 0.01) & (away[:, 1 - k] < HALF_PANEL)).any() for k in (0, 1)]
    return HALF_PANEL - np.where(beside, step.neighbour_margin, step.ball_margin)


def on_panel(ball: Array, toes: float, spot: Spot) -> Array:
    """The place of a ball (2,) near this one from which it and the middle of the sole are where they may be."""
    centre, room, ahead = spot.centre, spot.room, BALL_AHEAD * heading(toes)
    ball = np.minimum(np.maximum(ball, centre - room), centre + room)  # np.clip takes three times as long
    low, high = centre - spot.middle_room, centre + spot.middle_room
    return np.asarray(np.minimum(np.maximum(ball - ahead, low), high) + ahead)
