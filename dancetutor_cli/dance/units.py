"""Types of the dance: arrays of numbers, poses, and the units of the motion's settings as types of their fields.

A number of a file outside its bounds is refused: bounds catch slips ("90" seconds for "0.90"), not styles.
"""

from __future__ import annotations

from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.run.schema import Bounds

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
PANEL = 0.28  # metres, width of one panel

Metres = Annotated[float, Bounds(0, 20, "metres")]
Seconds = Annotated[float, Bounds(0, 1000, "seconds")]  # as long as a song: a wait that never comes
Duration = Annotated[float, Bounds(0.001, 1000, "seconds")]  # of something that takes time
Degrees = Annotated[float, Bounds(0, 360, "degrees")]
PerSecond = Annotated[float, Bounds(0, 1000, "per second")]
MetresPerSecond = Annotated[float, Bounds(0, 100, "metres per second")]
MetresPerSecondSquared = Annotated[float, Bounds(0, 100, "metres per second squared")]
DegreesPerSecond = Annotated[float, Bounds(0, 1000, "degrees per second")]
DegreesPerMetre = Annotated[float, Bounds(0, 1000, "degrees per metre")]
Ratio = Annotated[float, Bounds(0, 1000)]  # a part of something, a factor, a weight: without a unit
Count = Annotated[float, Bounds(0, 1000)]  # of things


class Poses(NamedTuple):
    """A skeleton in f frames: local rotations (f, j, 4), unit quaternions, and the root's place (f, 3), metres."""

    rotations: Array
    root: Array
