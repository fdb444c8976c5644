"""A pad: where its panels are, which of them one foot can press together, and where the dancer waits."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.yaml_files import MarkedYaml, read

MAX_PANELS = 10  # a row of the solver packs into 64 bits
SQUARE = 3  # panels
HOME_WIDTH = 0.25  # a foot on no panel stands so far beside the centre (docs/cost-model.md)
_KEYS = ("panels", "centre", "home", "reach")


@dataclass(frozen=True)
class Pad:
    """Geometry of a steps type; c panels in column order, lengths in panel widths, x right and y to the screen.

    steps_type : "dance-single"
    names : c names of panels
    panels : float64 (c, 2), middle of each panel
    arrows : float64 (c, 2), where the arrow on each panel points; (0, 0) where there is none
    centre : (x, y) where the dancer waits
    home : columns on which the left and the right foot start
    reach : panels at most so far apart are neighbours
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
        """Distance between the middles of any two panels, (c, c)."""
        difference = self.panels[:, None] - self.panels[None]
        return np.hypot(difference[..., 0], difference[..., 1])

    @cached_property
    def neighbours(self) -> NDArray[np.bool_]:
        """Whether one foot can press two panels, (c, c); no panel is its own neighbour."""
        near: NDArray[np.bool_] = (self.distances <= self.reach + 1e-6) & ~np.eye(len(self), dtype=bool)
        return near

    @cached_property
    def squares(self) -> NDArray[np.float64]:
        """Middle of each square of three by three panels, (s, 2): one of single, two of double."""
        low, high = self.panels.min(axis=0), self.panels.max(axis=0)
        count = int(np.floor((high[0] - low[0] + 1e-6) / SQUARE)) + 1
        along = (low[0] + high[0]) / 2 + SQUARE * (np.arange(count) - (count - 1) / 2)
        return np.column_stack((along, np.full(count, (low[1] + high[1]) / 2)))

    @property
    def directions(self) -> tuple[float | None, ...]:
        """Where each panel's arrow points, degrees clockwise from up (to the screen); None for a middle panel."""
        return tuple(math.degrees(math.atan2(x, y)) % 360 if x or y else None for x, y in self.arrows.tolist())

    def mirrored(self, *, left_right: bool) -> NDArray[np.int64] | None:
        """For each column the column of the mirrored panel, left-right or up-down; None if the pad is not symmetric."""
        sign = np.array([-1.0, 1.0] if left_right else [1.0, -1.0])
        image = np.array(self.centre) + (self.panels - self.centre) * sign
        apart = np.abs(image[:, None] - self.panels[None]).max(axis=2)
        if (apart.min(axis=1) > 1e-6).any():
            return None
        return np.asarray(apart.argmin(axis=1), dtype=np.int64)


def load_pad(steps_type: str, path: Path | None = None) -> Pad | None:
    """The pad of a steps type, or None if there is none for it.

    Parameters
    ----------
    steps_type : as in chart files; case does not count
    path : another file in the form of configs/pads.yaml

    Raises FileError for a file that is wrong, with line and the names that exist.
    """
    return load_pads(path or config_path("pads.yaml")).get(steps_type.lower())


@cache
def load_pads(path: Path) -> dict[str, Pad]:
    """Every pad of a file in the form of configs/pads.yaml, by steps type. Raises FileError."""
    source = read(path)
    return {str(name).lower(): _pad(source, str(name)) for name in source.data}


def _pad(source: MarkedYaml, steps_type: str) -> Pad:
    source.only((steps_type,), _KEYS)
    data = source.data[steps_type]
    for key in _KEYS:
        if key not in data:
            raise source.error((steps_type,), f"{steps_type}: key '{key}' is missing")
    names, places, arrows = _panels(source, steps_type, data["panels"])
    home = data["home"]
    if not isinstance(home, list) or len(home) != 2 or home[0] == home[1] or not all(h in names for h in home):
        raise source.error(
            (steps_type, "home"), f"{steps_type}: 'home' must be two different panels of {', '.join(names)}"
        )
    return Pad(
        steps_type=steps_type.lower(),
        names=names,
        panels=np.array(places),
        arrows=np.array(arrows),
        centre=_pair(source, (steps_type, "centre"), data["centre"]),
        home=(names.index(home[0]), names.index(home[1])),
        reach=_number(source, (steps_type, "reach"), data["reach"]),
    )


def _panels(source: MarkedYaml, steps_type: str, data: Any) -> tuple[tuple[str, ...], list[Any], list[Any]]:
    if not isinstance(data, list) or not 2 <= len(data) <= MAX_PANELS:
        raise source.error((steps_type, "panels"), f"{steps_type}: 'panels' must be a list of 2 to {MAX_PANELS} panels")
    names, places, arrows = [], [], []
    for number, entry in enumerate(data):
        keys = (steps_type, "panels", number)
        if not isinstance(entry, list) or len(entry) != 4:
            raise source.error(keys, f"{steps_type}: a panel is [name, x, y, [arrow x, arrow y]]")
        names.append(str(entry[0]))
        places.append((_number(source, keys, entry[1]), _number(source, keys, entry[2])))
        arrows.append(_pair(source, keys, entry[3]))
        if names.index(names[-1]) != number or places.index(places[-1]) != number:
            raise source.error(keys, f"{steps_type}: two panels have the same name or place ({names[-1]})")
    return tuple(names), places, arrows


def _pair(source: MarkedYaml, keys: tuple[str | int, ...], value: Any) -> tuple[float, float]:
    if not isinstance(value, list) or len(value) != 2:
        raise source.error(keys, f"{keys[0]}: {value!r} must be [x, y]")
    return _number(source, keys, value[0]), _number(source, keys, value[1])


def _number(source: MarkedYaml, keys: tuple[str | int, ...], value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise source.error(keys, f"{keys[0]}: {value!r} must be a number")
    return float(value)
