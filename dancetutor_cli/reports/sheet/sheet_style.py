"""Sizes and colours of the chart sheet: configs/sheet.yaml, with the colours of notes and feet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cache
from typing import Any

from dancetutor_cli.chart.model import TICKS_PER_MEASURE
from dancetutor_cli.colours import hex_colour, limb_colours
from dancetutor_cli.errors import FileError
from dancetutor_cli.marked_yaml import read
from dancetutor_cli.resources import config_path

LETTERS = ("L", "R", "<", ">")  # by limb


@dataclass(frozen=True, slots=True)
class SheetStyle:
    """Sizes in CSS pixels, colours as "#rrggbb".

    unsure : per cent; rows whose feet are less sure are marked
    beat : least and greatest height of a beat; limbs : by `play.played.Limb`
    quantisation : colour of a note by the coarsest grid it stands on (4 for 4ths ...)
    """

    page_width: float
    page_height: float
    heading: float
    lane: float
    arrow: float
    mark: float
    row_spacing: float
    beat: tuple[float, float]
    margin: float
    gutter: float
    density: float
    unsure: float
    colours: Mapping[str, str]
    quantisation: Mapping[int, str]
    limbs: tuple[str, ...]

    def note_colour(self, tick: int) -> str:
        """Colour of a note at a tick."""
        finest = max(self.quantisation)
        fits = (q for q in sorted(self.quantisation) if tick % max(TICKS_PER_MEASURE // q, 1) == 0)
        return self.quantisation[next(fits, finest)]


@cache
def sheet_style() -> SheetStyle:
    """The style of the project's configuration; FileError names what is missing or unknown."""
    path = config_path("sheet.yaml")
    data: dict[str, Any] = read(path).data
    notes = read(config_path("highway.yaml")).data
    data["quantisation"] = {int(grid): str(colour) for grid, colour in notes["quantisation"].items()}
    data["limbs"] = tuple(hex_colour(rgb) for rgb in limb_colours().by_limb)
    names = [field.name for field in fields(SheetStyle)]
    if sorted(data) != sorted(names):
        own = [name for name in names if name not in ("quantisation", "limbs")]
        raise FileError(path, f"must have exactly these keys: {', '.join(own)}")
    data["beat"] = (float(data["beat"][0]), float(data["beat"][1]))
    return SheetStyle(**data)
