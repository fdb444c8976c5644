"""The names of moves in films: a table of words for each language, which callouts and subtitles share."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from dancetutor_cli.feet.limbs import LABELS
from dancetutor_cli.run.errors import FileError, choose_text

if TYPE_CHECKING:
    from pathlib import Path

    from dancetutor_cli.feet.pads import Pad
    from dancetutor_cli.feet.play import Play
    from dancetutor_cli.run.languages import Language


HOLD, MINE = "hold", "mine"  # a hold, and a mine under a foot; `EVENTS` does not have them, nor half turns
IMPLIED_BY_BRACKET = {"doublestep", "forced-doublestep"}  # not named, because a bracket's words already name the foot
_OPPOSITE = {"left": "right", "right": "left", "up": "down", "down": "up"}


def move_words(names: Iterable[str], path: Path, language: Language) -> dict[str, str]:
    """Return the words of these moves, in their order; FileError for a move without words.

    path : the file that names the moves, for the error
    """
    table, names = language.moves, tuple(names)
    if unknown := set(names) - set(table):
        raise FileError(path, f"there is no move '{min(unknown)}'{choose_text(min(unknown), sorted(table))}")
    return {name: table[name] for name in names}


def filled(words: str, name: str, at: tuple[Play, int], view: PanelNames) -> list[str]:
    """Return a move's words with limb and place, "right foot: heel on right, toe on up"; one text for each limb.

    at : the play and the row
    """
    if "{" not in words:
        return [words]
    play, row = at
    limbs = play.limb[row].tolist()
    texts = []
    for who in _doers(name, limbs):
        heel = int(play.feet[row, who]) if 0 <= who < 2 else -1
        columns = [column for column, limb in enumerate(limbs) if limb == who]
        film, limb = view.language.film, view.language.limbs[LABELS[who] if who >= 0 else "foot"]
        parts = sorted((column != heel, view.name(column)) for column in columns)
        places = ", ".join(film["toe" if toe else "heel"].replace("{panel}", panel) for toe, panel in parts)
        texts.append(words.replace("{who}", limb).replace("{places}", places))
    return texts


def _doers(name: str, limbs: list[int]) -> list[int]:
    """Return the limbs of a move.

    They are each foot on two panels for a bracket, the hands for a hand, otherwise the first foot that steps.
    """
    feet = [limb for limb in range(2) if limb in limbs][:1]
    if name == "bracket":
        return [limb for limb in range(4) if limbs.count(limb) > 1] or feet or [-1]
    if name == "hand":
        return [limb for limb in range(2, 4) if limb in limbs] or [-1]
    return feet or [-1]


def short_words(text: str) -> str:
    """Return a move's words without its limb and its reason, for the narrow place beside the notes: "toe on up"."""
    return (text.partition(": ")[2] or text).partition(" (")[0]


@dataclass(frozen=True, slots=True)
class PanelNames:
    """The names of a pad's panels. turned : the dancer faces the viewer, from whose side the panels are named"""

    pad: Pad
    turned: bool
    language: Language

    def name(self, column: int) -> str:
        """Return the name of a column's panel, "up-left"; it is the same on both pads of a double.

        A panel without a name in the language has the pad's own name.
        """
        plain = re.sub(r"-\d+$", "", self.pad.names[column])
        seen = "-".join(_OPPOSITE.get(word, word) for word in plain.split("-")) if self.turned else plain
        return self.language.panels.get(seen, seen)
