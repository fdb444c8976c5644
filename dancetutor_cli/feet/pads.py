"""The geometry of a pad: its panels, the pairs of panels that one foot can press together, and the place where the
dancer waits.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.schema import Entries, MarkedYaml, Meaning, Text, convert
from dancetutor_cli.run.yaml_files import read

MAX_PANELS = 10  # a row of the solver packs into 64 bits
SQUARE = 3  # panels
HOME_WIDTH = 0.25  # panel widths from the centre to a foot that stands on no panel (docs/cost-model.md)


@dataclass(frozen=True)
class Pad:
    """The pad of a steps type: c panels in column order, lengths in panel widths, x to the right, y towards the screen.

    steps_type : "dance-single"
    names : c names of panels
    panels : float64 (c, 2), middle of each panel
    arrows : float64 (c, 2), direction of the arrow on each panel; (0, 0) for a panel without an arrow
    centre : (x, y) where the dancer waits
    home : columns on which the left and the right foot start
    reach : greatest distance between the middles of neighbouring panels
    """

    steps_type: str
    names: tuple[str, ...]
    panels: NDArray[np.float64]
    arrows: NDArray[np.float64]
    centre: tuple[float, float]
    home: tuple[int, int]
    reach: float

    def __len__(self) -> int:
        return len(self.names)

    @cached_property
    def distances(self) -> NDArray[np.float64]:
        """The distances between the middles of all pairs of panels, (c, c)."""
        difference = self.panels[:, None] - self.panels[None]
        return np.hypot(difference[..., 0], difference[..., 1])

    @cached_property
    def width(self) -> float:
        """The distance along x between the middles of the outermost panels."""
        return float(np.ptp(self.panels[:, 0]))

    @cached_property
    def neighbours(self) -> NDArray[np.bool_]:
        """Whether one foot can press two panels at once, (c, c); no panel is its own neighbour."""
        near: NDArray[np.bool_] = (self.distances <= self.reach + 1e-6) & ~np.eye(len(self), dtype=bool)
        return near

    @cached_property
    def squares(self) -> NDArray[np.float64]:
        """The middle of each square of three by three panels, (s, 2): one square for single, two for double."""
        low, high = self.panels.min(axis=0), self.panels.max(axis=0)
        count = int(np.floor((high[0] - low[0] + 1e-6) / SQUARE)) + 1
        along = (low[0] + high[0]) / 2 + SQUARE * (np.arange(count) - (count - 1) / 2)
        return np.column_stack((along, np.full(count, (low[1] + high[1]) / 2)))

    @property
    def directions(self) -> tuple[float | None, ...]:
        """The direction of each panel's arrow, degrees clockwise from up (to the screen); None for a middle panel."""
        return tuple(math.degrees(math.atan2(x, y)) % 360 if x or y else None for x, y in self.arrows.tolist())

    def mirror_columns(self, *, left_right: bool) -> NDArray[np.int64] | None:
        """Return the column (c,) of each column's mirror image, left-right or up-down; None without symmetry."""
        sign = np.array([-1.0, 1.0] if left_right else [1.0, -1.0])
        image = np.array(self.centre) + (self.panels - self.centre) * sign
        apart = np.abs(image[:, None] - self.panels[None]).max(axis=2)
        if (apart.min(axis=1) > 1e-6).any():
            return None
        return np.asarray(apart.argmin(axis=1), dtype=np.int64)


def load_pad(steps_type: str, path: Path | None = None) -> Pad | None:
    """Return the pad of a steps type, or None if the steps type has no pad.

    Parameters
    ----------
    steps_type : the name as in chart files; case is ignored
    path : another file in the format of configs/pads.yaml

    Raises FileError if the file is wrong; the message has the line and the valid names.
    """
    return load_pads(path or config_path("pads.yaml")).get(steps_type.lower())


_Panel = Annotated[tuple[Text, float, float, tuple[float, float]], Meaning("a panel, [name, x, y, [arrow x, arrow y]]")]


@dataclass(frozen=True, slots=True)
class _PadEntry:
    """A pad in the file. panels : name, x, y and arrow of each panel; home : names of two of the panels"""

    panels: Annotated[tuple[_Panel, ...], Entries(2, MAX_PANELS)]
    centre: tuple[float, float]
    home: tuple[Text, Text]
    reach: float


@cache
def load_pads(path: Path) -> dict[str, Pad]:
    """Load all pads of a file in the format of configs/pads.yaml, by steps type. Raises FileError."""
    source = read(path)
    return {name.lower(): _pad(source, name, pad) for name, pad in convert(source, dict[Text, _PadEntry]).items()}


def _pad(source: MarkedYaml, steps_type: str, pad: _PadEntry) -> Pad:
    names = tuple(name for name, *_ in pad.panels)
    places = [place for _, *place, _ in pad.panels]
    for number, (name, place) in enumerate(zip(names, places, strict=True)):
        if names.index(name) != number or places.index(place) != number:
            keys = (steps_type, "panels", number)
            raise source.error(keys, f"{steps_type}: two panels have the same name or place ({name})")
    if pad.home[0] == pad.home[1] or not set(pad.home) <= set(names):
        there = ", ".join(names)
        raise source.error((steps_type, "home"), f"{steps_type}: 'home' must be two different panels of {there}")
    return Pad(
        steps_type=steps_type.lower(),
        names=names,
        panels=np.array(places),
        arrows=np.array([arrow for *_, arrow in pad.panels]),
        centre=pad.centre,
        home=(names.index(pad.home[0]), names.index(pad.home[1])),
        reach=pad.reach,
    )
