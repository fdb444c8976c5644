"""The colours that mean left foot, right foot and the hands, everywhere in the program (configs/colours.yaml)."""

from __future__ import annotations

import re
from dataclasses import dataclass, fields
from functools import cache
from pathlib import Path

from dancetutor_cli.errors import FileError
from dancetutor_cli.marked_yaml import read
from dancetutor_cli.resources import config_path

RGB = tuple[int, int, int]


@dataclass(frozen=True, slots=True)
class LimbColours:
    """sRGB colours, 0..255, of what presses a panel."""

    left_foot: RGB
    right_foot: RGB
    left_hand: RGB
    right_hand: RGB

    @property
    def by_limb(self) -> tuple[RGB, RGB, RGB, RGB]:
        """In the order of `play.played.Limb`: left foot, right foot, left hand, right hand."""
        return (self.left_foot, self.right_foot, self.left_hand, self.right_hand)


LIMBS = frozenset(field.name for field in fields(LimbColours))  # names that say: this wears a limb's colour


@dataclass(frozen=True, slots=True)
class PartnerColours:
    """Which colours the second of two dancers wears in place of the first one's.

    hues : degrees on the colour circle, from and to, that are clothes; turn : degrees by which they are others
    least : share of colour that one must have to count, 0..1
    tint : sRGB that a character without such colours is tinted with
    """

    hues: tuple[float, float]
    turn: float
    least: float
    tint: RGB


def hex_colour(rgb: RGB) -> str:
    """``(255, 138, 31)`` to ``"#ff8a1f"``."""
    return "#{:02x}{:02x}{:02x}".format(*rgb)


def read_limb_colours(path: Path) -> LimbColours:
    """Read and check the colours of one file; FileError names what is wrong and which names exist."""
    limbs = read(path).data.get("limbs")
    names = [field.name for field in fields(LimbColours)]
    if not isinstance(limbs, dict) or sorted(map(str, limbs)) != sorted(names):
        raise FileError(path, f"'limbs' must give a colour for each of: {', '.join(names)}")
    return LimbColours(*(_rgb(path, f"limbs.{name}", limbs[name]) for name in names))


@cache
def limb_colours() -> LimbColours:
    """The colours of configs/colours.yaml."""
    return read_limb_colours(config_path("colours.yaml"))


@cache
def partner_colours() -> PartnerColours:
    """What configs/colours.yaml says about the second of two dancers; FileError names what is wrong."""
    path = config_path("colours.yaml")
    said = read(path).data.get("partner")
    try:
        if not isinstance(said, dict):
            raise TypeError
        first, last = map(float, said["hues"])
        return PartnerColours(
            (first, last), float(said["turn"]), float(said["least"]), _rgb(path, "tint", said["tint"])
        )
    except (KeyError, TypeError, ValueError) as error:
        raise FileError(path, "'partner' must give hues (two degrees), turn (degrees), least (0 to 1), tint") from error


def _rgb(path: Path, name: str, value: object) -> RGB:
    if not isinstance(value, str) or not re.fullmatch(r"#[0-9a-fA-F]{6}", value):
        raise FileError(path, f'{name}: {value!r} is not a colour; write it as "#rrggbb"')
    return int(value[1:3], 16), int(value[3:5], 16), int(value[5:7], 16)
