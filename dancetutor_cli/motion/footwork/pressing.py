"""Palms that come down on panels: how long they press, and how far the body turns for a panel that is not before it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from dancetutor_cli.motion.footwork.footing import SHORTEST, Footing
from dancetutor_cli.motion.plan import Press


def press(
    footing: Footing, side: int, panel: tuple[float, float], span: tuple[float, float], earlier: Sequence[Press]
) -> Press:
    """A palm on a panel.

    side : 0 left, 1 right; span : when it comes down, and when a hold ends, infinite for a tap, seconds
    earlier : all presses so far
    """
    hands, (time, end) = footing.settings.hands, span
    end = max(time + hands.press, end if end < np.inf else 0.0)
    before = [p.end for p in earlier if p.side == side]
    lead = min(hands.reach_down, max(time - before[-1], SHORTEST) if before else np.inf)
    return Press(time, end, side, panel, _turn_to_panel(footing, side, panel), lead)


def _turn_to_panel(footing: Footing, side: int, panel: tuple[float, float]) -> float:
    """How far the body turns to the hand's side, radians, for a panel that is not before it."""
    hands, feet = footing.settings.hands, footing.feet
    away = np.array(panel) - (feet[0].ball + feet[1].ball) / 2
    off = (np.arctan2(away[0], away[1]) - footing.turned_to() + np.pi) % (2 * np.pi) - np.pi
    beyond = np.clip(abs(np.degrees(off)) - hands.turn_from, 0.0, hands.turn_most)
    return float(np.radians(beyond) * (1.0 if side == 0 else -1.0))
