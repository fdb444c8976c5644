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
    """The limb that presses a panel. `NONE`: the cell has no step; `UNPLAYED`: no limb is free for the step."""

    LEFT_FOOT = 0
    RIGHT_FOOT = 1
    LEFT_HAND = 2
    RIGHT_HAND = 3
    NONE = -1
    UNPLAYED = -2


NAMES = ("left foot", "right foot", "left hand", "right hand")  # by `Limb`
LABELS = tuple(name.replace(" ", "-") for name in NAMES)  # their labels in configs/languages


class Part(IntEnum):
    """The part of a foot; only brackets (one foot on two panels) distinguish the heel from the toe."""

    WHOLE = 0
    HEEL = 1
    TOE = 2


# The letters of feet in markers, such as `{dt1 LR(Lr)}`.
#
# One token stands for each row of note data that holds a step: one letter, or the letters of several steps from left to
# right in parentheses. `L` and `R` are the feet (in a bracket, the heels), `l` and `r` the toes, `<` and `>` the hands.
# `.` is an unknown limb.

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

# A marker inside a comment. With "!", the author has pinned the measure, and the solver keeps its letters. A marker
# that begins with `{dt1 ` belongs to this program, even if somebody has edited its letters.
MARKER = re.compile(rb"\{dt1(?:(?P<pin>!)[ \t]*|[ \t]+)(?P<text>[^{}\r\n]*)\}")
_TOKEN = re.compile(r"[ \t]*(?:\((?P<group>[^()]*)\)|(?P<letter>[^()]))")


@dataclass(frozen=True, slots=True)
class Token:
    """The letters of one row. places : offset of each letter in the marker's text"""

    letters: str
    places: tuple[int, ...]

    @property
    def at(self) -> int:
        """The offset at which the letters of the row begin."""
        return self.places[0]


class NotationError(ValueError):
    """A marker's text that cannot be parsed; `at` is the offset of the first wrong character."""

    def __init__(self, message: str, at: int) -> None:
        super().__init__(message)
        self.at = at


def letter(limb: int, part: int) -> str:
    """Return the letter of a limb and its part that press a panel."""
    return _LETTERS.get((limb, part), UNKNOWN)


def limb_and_part(letter: str, letters: str) -> tuple[Limb, Part]:
    """Return what a letter of `MEANING` means among the `letters` of its row: beside the foot's toe, a heel."""
    limb, part = MEANING[letter]
    return limb, Part.HEEL if letter.isupper() and letter.lower() in letters else part


def marker_text(tokens: Iterable[str]) -> bytes:
    """Return the marker of a measure; `tokens` holds the letters of each row with a step."""
    text = "".join(letters if len(letters) == 1 else f"({letters})" for letters in tokens)
    return b"{dt1 " + text.encode("ascii") + b"}"


def parse_marker(text: bytes) -> list[Token]:
    """Return the tokens of a marker's text; blanks between tokens are ignored. Raises NotationError."""
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


# The colours of the left foot, the right foot and the hands, everywhere in the program (configs/colours.yaml).


@dataclass(frozen=True, slots=True)
class LimbColours:
    """The sRGB colours, 0..255, of the limbs that press panels."""

    left_foot: RGB
    right_foot: RGB
    left_hand: RGB
    right_hand: RGB

    @property
    def by_limb(self) -> tuple[RGB, RGB, RGB, RGB]:
        """The colours in the order of `feet.limbs.Limb`: left foot, right foot, left hand, right hand."""
        return (self.left_foot, self.right_foot, self.left_hand, self.right_hand)


LIMBS = frozenset(field.name for field in fields(LimbColours))  # names of parts that have the colour of a limb


@dataclass(frozen=True, slots=True)
class PartnerColours:
    """How the clothes of the second of two dancers are recoloured.

    hues : first and last hue of the clothes, degrees on the colour circle; turn : degrees by which these hues are
    shifted
    least : least saturation of a colour that is shifted, 0..1
    tint : sRGB colour with which a character without these hues is tinted
    """

    hues: tuple[float, float]
    turn: float
    least: Share
    tint: RGB


def hex_colour(rgb: RGB) -> str:
    """Return a colour as HTML writes it: ``(255, 138, 31)`` as ``"#ff8a1f"``."""
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
    """Return the colours of configs/colours.yaml."""
    return read_limb_colours(config_path("colours.yaml"))


@cache
def partner_colours() -> PartnerColours:
    """Return the colours of the second of two dancers in configs/colours.yaml; FileError names what is wrong."""
    return load(config_path("colours.yaml"), _Colours).partner
