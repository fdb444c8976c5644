"""A pad: its panels with positions and arrows, and where the dancer stands at home."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray

from dancetutor_cli.errors import UsageError
from dancetutor_cli.resources import config_path

HOME_SIDE = 0.25  # a foot at home stands this far to its own side of the centre, panel widths
# Degrees, counter-clockwise from right; None: no direction (a centre panel).
ARROWS: dict[str, float | None] = {
    "right": 0, "up-right": 45, "up": 90, "up-left": 135, "left": 180, "down-left": 225, "down": 270,
    "down-right": 315, "centre": None,
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Panel:
    """x : panel widths to the dancer's right; y : towards the screen; arrow : a name of `ARROWS`."""

    x: float
    y: float
    arrow: str

    @property
    def angle(self) -> float | None:
        """Where the arrow points, degrees counter-clockwise from right seen from above; None for a centre panel."""
        return ARROWS[self.arrow]


@dataclass(frozen=True, slots=True)
class Pad:
    """The pad of a steps type. panels : in column order; centre : (x, y), panel widths."""

    steps_type: str
    panels: tuple[Panel, ...]
    centre: tuple[float, float]

    @property
    def positions(self) -> NDArray[np.float64]:
        """(columns, 2), panel widths."""
        return np.array([(p.x, p.y) for p in self.panels])

    @property
    def home(self) -> NDArray[np.float64]:
        """Where the left and the right foot stand at home, (2, 2), panel widths."""
        cx, cy = self.centre
        return np.array([(cx - HOME_SIDE, cy), (cx + HOME_SIDE, cy)])


def pad_names() -> tuple[str, ...]:
    """The steps types that have a pad."""
    return tuple(_entries())


@cache
def load_pad(steps_type: str) -> Pad | None:
    """The pad of a steps type, or None if it has none. Raises `UsageError` if the entry is wrong."""
    entry = _entries().get(steps_type)
    return None if entry is None else parse_pad(steps_type, entry)


@cache
def _entries() -> dict[str, Any]:
    path = config_path("pads.yaml")
    loaded = yaml.load(path.read_bytes(), Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    if not isinstance(loaded, dict):
        raise UsageError(f"{path}: a mapping of steps types is wanted")
    return loaded


def parse_pad(steps_type: str, entry: Any) -> Pad:
    """A pad from its entry. Raises `UsageError` naming what is wrong and what is allowed."""
    where = f"pads.yaml: {steps_type}"
    if not isinstance(entry, dict) or set(entry) != {"centre", "panels"}:
        raise UsageError(f"{where}: wants the keys centre and panels")
    panels = []
    for column, panel in enumerate(entry["panels"]):
        if not isinstance(panel, dict) or set(panel) != {"at", "arrow"}:
            raise UsageError(f"{where}: panel {column} wants the keys at and arrow")
        if panel["arrow"] not in ARROWS:
            raise UsageError(f"{where}: panel {column}: no arrow '{panel['arrow']}'; there are {', '.join(ARROWS)}")
        x, y = _pair(panel["at"], f"{where}: panel {column}")
        panels.append(Panel(x, y, panel["arrow"]))
    if not 1 <= len(panels) <= 16:
        raise UsageError(f"{where}: 1 to 16 panels are wanted, not {len(panels)}")
    if len({(p.x, p.y) for p in panels}) != len(panels):
        raise UsageError(f"{where}: two panels stand on the same place")
    return Pad(steps_type, tuple(panels), _pair(entry["centre"], where))


def _pair(value: Any, where: str) -> tuple[float, float]:
    if isinstance(value, list) and len(value) == 2 and all(isinstance(v, int | float) for v in value):
        return float(value[0]), float(value[1])
    raise UsageError(f"{where}: a position is two numbers [x, y], not {value!r}")
