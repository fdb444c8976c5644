"""The limbs of a dancer: their names, the letters of feet in markers (`{dt1 LR(Lr)}`), and the colours they have."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, fields
from enum import IntEnum
from functools import cache
from pathlib import Path

from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.schema import RGB, Share
from dancetutor_cli.run.yaml_files import load


class Limb(IntEnum):
    """Who presses a panel. `NONE`: there is no step in that cell; `UNPLAYED`: no limb is left for the step."""

    LEFT_FOOT = 0
    RIGHT_FOOT = 1
    LEFT_HAND = 2
    RIGHT_HAND = 3
    NONE = -1
    UNPLAYED = -2


class Part(IntEnum):
    """Which part of a foot: only brackets (one foot on two panels) distinguish heel and toe."""

    WHOLE = 0
    HEEL = 1
    TOE = 2


# The letters of feet, `{dt1 LR(Lr)}`: how markers in files are written and read.
#
# One token stands for each row of note data that holds a step: a letter, or for several steps their letters from left
# to right in brackets. `L` and `R` are the feet (of a bracket: the heel), `l` and `r` their toes, `<` and `>` the left
# and right hand, `.` is unknown.

UNKNOWN = "."
_LETTERS: dict[tuple[int, int], str] = {
    (Limb.LEFT_FOOT, Part.WHOLE): "L",
    (Limb.LEFT_FOOT, Part.HEEL): "L",
    (Limb.LEFT_FOOT, Part.TOE): "l",
    (Limb.RIGHT_FOOT, Part.WHOLE): "R",
    (Limb.RIGHT_FOOT, Part.HEEL): "R",
    (Limb.RIGHT_FOOT, Part.TOE): "r",
    (Limb.LEFT_HAND, Part.WHOLE): "<",
    (Limb.RIGHT_HAND, Part.WHOLE): ">",
}
MEANING: dict[str, tuple[Limb, Part]] = {
    "L": (Limb.LEFT_FOOT, Part.WHOLE),
    "l": (Limb.LEFT_FOOT, Part.TOE),
    "R": (Limb.RIGHT_FOOT, Part.WHOLE),
    "r": (Limb.RIGHT_FOOT, Part.TOE),
    "<": (Limb.LEFT_HAND, Part.WHOLE),
    ">": (Limb.RIGHT_HAND, Part.WHOLE),
}
LETTERS = frozenset(MEANING) | {UNKNOWN}

# A marker inside a comment; the "!" pins the measure: its letters are the author's word. `{dt1 ` is our own, whatever
# an edit by hand has made of the letters.
MARKER = re.compile(rb"\{dt1(?:(?P<pin>!)[ \t]*|[ \t]+)(?P<text>[^{}\r\n]*)\}")
_TOKEN = re.compile(r"[ \t]*(?:\((?P<group>[^()]*)\)|(?P<letter>[^()]))")


@dataclass(frozen=True, slots=True)
class Token:
    """The letters of one row. places : offset of each in the marker's text"""

    letters: str
    places: tuple[int, ...]

    @property
    def at(self) -> int:
        """Where the row's letters begin."""
        return self.places[0]


class NotationError(ValueError):
    """Text that is not a row of tokens; `at` is where it stops making sense."""

    def __init__(self, message: str, at: int) -> None:
        super().__init__(message)
        self.at = at


def letter(limb: int, part: int) -> str:
    """The letter of the limb that presses a panel."""
    return _LETTERS.get((limb, part), UNKNOWN)


def marker(tokens: Iterable[str]) -> bytes:
    """The marker of a measure; `tokens` has the letters of each row with a step."""
    text = "".join(letters if len(letters) == 1 else f"({letters})" for letters in tokens)
    return b"{dt1 " + text.encode("ascii") + b"}"


def parse(text: bytes) -> list[Token]:
    """The tokens of a marker's text; blanks between them do not count. Raises NotationError."""
    return list(_tokens(text.decode("latin-1").rstrip(" \t")))


def _tokens(text: str) -> Iterator[Token]:
    at = 0
    while at < len(text):
        match = _TOKEN.match(text, at)
        if match is None:
            raise NotationError(f"'{text[at]}' without its other bracket", at)
        name = "letter" if match["group"] is None else "group"
        places = []
        for place, character in enumerate(match[name], match.start(name)):
            if character in LETTERS:
                places.append(place)
            elif character not in " \t":
                raise NotationError(f"'{_printable(character)}' is not a foot; use {' '.join('LRlr<>.')}", place)
        if not places:
            raise NotationError("brackets without letters", match.start(name))
        yield Token("".join(text[place] for place in places), tuple(places))
        at = match.end()


def _printable(character: str) -> str:
    return character if character.isprintable() else f"\\x{ord(character):02x}"


# The colours that mean left foot, right foot and the hands, everywhere in the program (configs/colours.yaml).


@dataclass(frozen=True, slots=True)
class LimbColours:
    """sRGB colours, 0..255, of what presses a panel."""

    left_foot: RGB
    right_foot: RGB
    left_hand: RGB
    right_hand: RGB

    @property
    def by_limb(self) -> tuple[RGB, RGB, RGB, RGB]:
        """In the order of `feet.limbs.Limb`: left foot, right foot, left hand, right hand."""
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
    least: Share
    tint: RGB


def hex_colour(rgb: RGB) -> str:
    """``(255, 138, 31)`` to ``"#ff8a1f"``."""
    return "#{:02x}{:02x}{:02x}".format(*rgb)


@dataclass(frozen=True, slots=True)
class _Colours:
    """configs/colours.yaml."""

    limbs: LimbColours
    partner: PartnerColours


def read_limb_colours(path: Path) -> LimbColours:
    """Read and check the colours of one file; FileError names what is wrong and which names exist."""
    return load(path, _Colours).limbs


@cache
def limb_colours() -> LimbColours:
    """The colours of configs/colours.yaml."""
    return read_limb_colours(config_path("colours.yaml"))


@cache
def partner_colours() -> PartnerColours:
    """The entry of configs/colours.yaml for the second of two dancers; FileError names what is wrong."""
    return load(config_path("colours.yaml"), _Colours).partner
