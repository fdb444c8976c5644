"""What moves are called in films: one table of a dancer's words, for what is called out and for subtitles."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from dancetutor_cli.errors import FileError
from dancetutor_cli.play.turned import HALF_TURNS
from dancetutor_cli.play.vocabulary import EVENTS
from dancetutor_cli.resources import config_path
from dancetutor_cli.video.from_yaml import load

if TYPE_CHECKING:
    from pathlib import Path

    from dancetutor_cli.pads import Pad
    from dancetutor_cli.play.played import Play

HOLD, MINE = "hold", "mine"  # a note held, a mine that a foot is on: no `EVENTS`, as half turns are none
WHO = ("left foot", "right foot", "left hand", "right hand")  # by `play.played.Limb`
SAID_BY_A_BRACKET = {"doublestep", "forced-doublestep"}  # which foot it is, it says itself
_OPPOSITE = {"left": "right", "right": "left", "up": "down", "down": "up"}


@dataclass(frozen=True, slots=True)
class _Table:
    """configs/words.yaml. moves : name of a move -> its words, with {who} and {places} to be filled in"""

    moves: dict[str, str]


@cache
def _table() -> dict[str, str]:
    path = config_path("words.yaml")
    words = load(path, _Table).moves
    _check(path, words, (*EVENTS, *HALF_TURNS, HOLD, MINE))
    return words


def move_words(names: Iterable[str], path: Path) -> dict[str, str]:
    """The words of these moves, in their order; `path` : where they are named, for a FileError about one without."""
    table, names = _table(), tuple(names)
    _check(path, names, table)
    return {name: table[name] for name in names}


def _check(path: Path, names: Iterable[str], known: Iterable[str]) -> None:
    if unknown := set(names) - set(known):
        raise FileError(path, f"there is no move '{min(unknown)}'; there are: {', '.join(sorted(known))}")


def filled(words: str, name: str, at: tuple[Play, int], pad: Pad, turned: bool = False) -> list[str]:
    """A move's words with who does it and where: "right foot: heel on right, toe on up"; of several who do it, each's.

    at : the play and the row; turned : she faces who looks on, and panels are named as they are seen then
    """
    if "{" not in words:
        return [words]
    play, row = at
    limbs = play.limb[row].tolist()
    said = []
    for who in _doers(name, limbs):
        heel = int(play.feet[row, who]) if 0 <= who < 2 else -1
        columns = [column for column, limb in enumerate(limbs) if limb == who]
        parts = sorted((column != heel, panel_words(pad.names[column], turned)) for column in columns)
        places = ", ".join(f"{'toe' if toe else 'heel'} on {panel}" for toe, panel in parts)
        said.append(words.replace("{who}", WHO[who] if who >= 0 else "foot").replace("{places}", places))
    return said


def _doers(name: str, limbs: list[int]) -> list[int]:
    """Whose move it is: of a bracket each foot on two panels, of a hand the hands, else the first foot that steps."""
    feet = [limb for limb in range(2) if limb in limbs][:1]
    if name == "bracket":
        return [limb for limb in range(4) if limbs.count(limb) > 1] or feet or [-1]
    if name == "hand":
        return [limb for limb in range(2, 4) if limb in limbs] or [-1]
    return feet or [-1]


def short_words(said: str) -> str:
    """What is said of a move without whose it is or why, for the narrow place beside the notes: "toe on up"."""
    return (said.partition(": ")[2] or said).partition(" (")[0]


def panel_words(name: str, turned: bool = False) -> str:
    """A panel's name as it is said, whichever pad of a double it is on: "up-left"; turned : as seen from before her."""
    plain = re.sub(r"-\d+$", "", name)
    return "-".join(_OPPOSITE.get(word, word) for word in plain.split("-")) if turned else plain
