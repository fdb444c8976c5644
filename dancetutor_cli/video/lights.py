"""How brightly a panel or receptor is lit: at once at its note, fading after a tap, steady while it is held.

A note that nobody plays lights nothing."""

from __future__ import annotations

from dataclasses import fields

import numpy as np

from dancetutor_cli.chart.model import Kind
from dancetutor_cli.play.played import Limb
from dancetutor_cli.video.notes import NoteTrack, Presses

HELD = 0.62  # brightness while held, after the flash of the start
EPSILON = 1e-6  # seconds; a frame that falls on a note shows it


def lighting(track: NoteTrack, presses: Presses) -> Presses:
    """What lights panels: the presses, and the mines that a foot is on as they pass."""
    mines = (track.kind == Kind.MINE) & (track.limb >= 0)
    if not mines.any():
        return presses
    own = Presses(track.second[mines], track.second[mines], track.column[mines], track.limb[mines])
    order = np.argsort(np.concatenate((presses.start, own.start)), kind="stable")
    both = (np.concatenate((getattr(presses, one.name), getattr(own, one.name))) for one in fields(Presses))
    return Presses(*(values[order] for values in both))


class PanelLights:
    """Light of each column over time; fade : seconds from full light to none."""

    def __init__(self, presses: Presses, columns: int, fade: float) -> None:
        self.presses, self.fade = presses, fade
        pressed = presses.limb != Limb.UNPLAYED
        self._columns = [np.flatnonzero((presses.column == c) & pressed) for c in range(columns)]
        self._starts = [presses.start[mine] for mine in self._columns]

    def at(self, column: int, second: float) -> tuple[float, int]:
        """Brightness 0..1 at `second` of the music, and the limb of the last press (-1: none or unknown)."""
        last = int(np.searchsorted(self._starts[column], second + EPSILON, side="right")) - 1
        if last < 0:
            return 0.0, -1
        press = self._columns[column][last]
        start, end = float(self.presses.start[press]), float(self.presses.end[press])
        fresh = _left((second - start) / self.fade)
        if second < end:
            level = max(HELD, fresh)
        else:
            level = _left((second - end) / self.fade) * (1.0 if end == start else HELD)
        return min(1.0, level), int(self.presses.limb[press])


def _left(share: float) -> float:
    """What is left of a light when so much of its time is over: it is bright and goes out, and does not linger."""
    return max(0.0, 1.0 - share * share)
