"""What does not change while a song is danced: handed on as one to every stage."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.baked import Bar, Ground
from dancetutor_cli.motion.settings import MotionSettings
from dancetutor_cli.motion.swing.panels import HALF_PANEL, panels_on_ground, squares_on_ground
from dancetutor_cli.rig.skeleton import Skeleton, dancer_skeleton

if TYPE_CHECKING:
    from dancetutor_cli.pads import Pad

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Context:
    """Who dances, how, and where. Pickles.

    skeleton : hers; settings : the numbers of her motion
    panels : (c, 2) world x and z of every panel's centre; squares : (s, 2) of the middle of each square of nine panels
    ground : the pad as a rectangle, and the floor around it
    beats : seconds of the song's beats, in order; bar : what she holds on to, None for no bar
    stays : she does not walk off after the last step
    sides : from which she comes and to which she goes, 0 left or 1 right, None: as the notes say
    """

    skeleton: Skeleton
    settings: MotionSettings
    panels: Array
    squares: Array
    ground: Ground
    beats: tuple[float, ...] = ()
    bar: Bar | None = None
    sides: tuple[int, int] | None = None
    stays: bool = False


def context_of(pad: Pad, settings: MotionSettings, beats: tuple[float, ...] = (), bar: Bar | None = None) -> Context:
    """The context of the project's own dancer on a pad."""
    panels = panels_on_ground(pad)
    low, high = panels.min(axis=0) - HALF_PANEL, panels.max(axis=0) + HALF_PANEL
    ground = Ground((float(low[0]), float(low[1])), (float(high[0]), float(high[1])), settings.walk.floor)
    return Context(dancer_skeleton(), settings, panels, squares_on_ground(pad), ground, beats, bar)
