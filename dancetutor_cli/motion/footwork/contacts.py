"""What touches which panel and for how long, and the ways of the palms down to theirs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.motion.footwork.footing import SHORTEST, Footing, pair
from dancetutor_cli.motion.model import Contact
from dancetutor_cli.motion.moves import Swing
from dancetutor_cli.motion.plan import Press
from dancetutor_cli.play.model import Limb, Play, StepKind

Array = NDArray[np.float64]


class Touches:
    """Touches of panels and presses, collected row by row. `second(tick)` : seconds of the music."""

    def __init__(self, play: Play, second: Callable[[int], float], footing: Footing) -> None:
        self.play, self.panels, self.second, self.footing = play, footing.context.panels, second, footing
        self.presses: list[Press] = []
        self.touches: list[Contact] = []

    def add(self, i: int, time: float, limb: int, column: int) -> None:
        """A limb comes down on a column at row i; a foot on a hold may not leave before its end."""
        kind = int(self.play.rows.steps[i, column])
        end = np.inf
        if kind == StepKind.HOLD:
            end = self.second(int(self.play.rows.hold_end[i, column]))
            if limb in (Limb.LEFT_FOOT, Limb.RIGHT_FOOT):
                foot = self.footing.feet[limb]
                foot.free = max(foot.free, end)
                foot.holds = {c: e for c, e in foot.holds.items() if e > time - 1.0} | {column: end}
        panel = pair(self.panels[column])
        if limb in (Limb.LEFT_HAND, Limb.RIGHT_HAND):
            end = self._press(time, end, limb - Limb.LEFT_HAND, panel)
        self.touches.append(Contact(time, end, limb, column, kind, int(self.play.part[i, column]), i, panel))

    def _press(self, time: float, end: float, side: int, panel: tuple[float, float]) -> float:
        """A palm's press; returns its end."""
        hands = self.footing.settings.hands
        end = max(time + hands.press, end if end < np.inf else 0.0)
        before = [p.end for p in self.presses if p.side == side]
        lead = min(hands.reach_down, max(time - before[-1], SHORTEST) if before else np.inf)
        self.presses.append(Press(time, end, side, panel, self._turn_to_panel(side, panel), lead))
        return end

    def _turn_to_panel(self, side: int, panel: tuple[float, float]) -> float:
        """How far the body turns to the hand's side, radians, for a panel that is not before it."""
        hands, feet = self.footing.settings.hands, self.footing.feet
        away = np.array(panel) - (feet[0].ball + feet[1].ball) / 2
        off = (np.arctan2(away[0], away[1]) - self.footing.turned_to() + np.pi) % (2 * np.pi) - np.pi
        beyond = np.clip(abs(np.degrees(off)) - hands.turn_from, 0.0, hands.turn_most)
        return float(np.radians(beyond) * (1.0 if side == 0 else -1.0))

    def all(self) -> tuple[Contact, ...]:
        """All touches, in order, each until it must end; a foot that is not needed any more stays a while."""
        self.touches.sort(key=lambda c: (c.start, c.limb, c.column))
        lifts = [[m.lift for m in f.moves if isinstance(m, Swing)][-1:] for f in self.footing.feet]
        stays = self.footing.settings.step.longest

        def ended(touch: Contact) -> Contact:
            left = touch.end < np.inf or any(lift >= touch.start for lift in lifts[touch.limb])
            return touch if left else replace(touch, end=touch.start + stays)

        return tuple(ended(touch) for touch in self.touches)
