"""Charts for two who dance: the pad under both, and where on it each of them stands."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.chart.players import ONE_PAD, OWN_PADS
from dancetutor_cli.pads import load_pad

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart
    from dancetutor_cli.pads import Pad

# Steps type as it is written -> the pad on which both stand: of a couple each has half of it. Else it is its own.
_WHOLE = {**ONE_PAD, **{kind: f"{kind.partition('-')[0]}-double" for kind in OWN_PADS}}


def pad_of_both(steps_type: str) -> Pad:
    """The pad under both who dance a chart for two. steps_type : as the chart is written"""
    pad = load_pad(_WHOLE.get(steps_type, steps_type))
    assert pad is not None
    return pad


def place_on(whole: Pad, part: Chart, pad: Pad) -> tuple[float, float]:
    """How far a player's own pad stands from the middle of that of both: (x, z) in metres of the world.

    Panels' x goes to her right, the world's to her left.
    """
    from dancetutor_cli.video.scene.stage import PANEL

    away = whole.panels[part.first_column] - pad.panels[0] + np.array(pad.centre) - np.array(whole.centre)
    return float(-away[0] * PANEL), float(away[1] * PANEL)
