"""The words for moves in films, by language: names, which callouts and subtitles share, and the phrases of calls.

`configs/languages` has the words of all moves. `configs/highway.yaml` names the moves that are called out
(`overlay.sprites.callout_words`), `configs/subtitles.yaml` those of subtitles (`media.subtitles.subtitle_words`).
`overlay.callouts` and `media.subtitles` fill in limbs and panels with the functions below; `overlay.announce` and
`overlay.highway` draw the calls.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from dancetutor_cli.feet.limbs import LABELS
from dancetutor_cli.feet.solver.techniques import side_of_half_turn
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


def fill_words(words: str, name: str, at: tuple[Play, int], view: PanelNames) -> list[str]:
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


# The phrases of calls, which say more than the name of a move: the foot, in front or behind, and the reason.

FRONT, BACK, JUMP = "crossover-front", "crossover-back", "crossover-jump"
TURN_FRONT, TURN_BEHIND, TURN_ROUND = "half-turn-front", "half-turn-behind", "half-turn-round"
JUST = 2.0  # the longest time since a foot "has just stepped", seconds


class Phrase(NamedTuple):
    """A move in words. move : name for people, the same for all moves of a kind; text : words with foot and direction

    tag : words for the place beside the notes; why : a reason, or ""
    several : template for a count of moves with different words
    """

    move: str
    text: str
    tag: str
    why: str = ""
    several: str = ""

    def text_of(self, count: int, alike: bool) -> str:
        """Return the words for `count` of these moves in a row; alike : whether all have the same words."""
        if count == 1:
            return self.text
        if alike or not self.several:
            return f"{self.text if alike else self.move} ×{count}"
        return self.several.replace("{move}", self.move).replace("{count}", str(count)).replace("{said}", self.text)


def plain_phrase(text: str) -> Phrase:
    """Return a phrase that uses the same words everywhere."""
    return Phrase(text, text, short_words(text))


def standing_tags(language: Language) -> tuple[str, ...]:
    """Return the tags that are the same in every film."""
    return tuple(language.calls[f"{name}-tag"] for name in (FRONT, BACK, JUMP))


def stepped_phrase(move: str, name: str, limbs: list[int], language: Language) -> Phrase:
    """Return the phrase of a move of one foot, for example a footswitch. limbs : the limbs of its row"""
    feet = {limb for limb in limbs if limb in (0, 1)}
    text = language.calls.get(name)
    if text is None or len(feet) != 1:
        return plain_phrase(move)
    return Phrase(move, text.replace("{who}", language.limbs[LABELS[feet.pop()]]), short_words(move))


def crossing_phrase(move: str, at: tuple[Play, int], pad: Pad, language: Language) -> Phrase:
    """Return the phrase of a crossover: the foot that crosses, in front or behind, and the reason.

    `feet.solver` decides whether the foot is in front, which is towards the screen. In a jump, the foot nearer to the
    screen is in front.

    move : name of the move for people; at : the play and the first row of the crossover
    """
    (play, row), calls = at, language.calls
    feet = [foot for foot in (0, 1) if foot in play.limb[row]]
    if len(feet) == 2:
        ahead = np.asarray(pad.panels)[play.feet[row]][:, 1]
        name, foot = JUMP, int(np.argmax(ahead))
        if ahead[0] == ahead[1]:
            return plain_phrase(move)
    else:
        names = [name for name in (FRONT, BACK) if name in play.moves[row]]
        if not feet or not names:
            return plain_phrase(move)
        (foot,), name = feet, names[0]
    who, other = language.limbs[LABELS[foot]], language.limbs[LABELS[1 - foot]]
    reason = "" if name == JUMP else _reason(play, row, foot)
    why = calls[reason].replace("{other}", other) if reason else ""
    return Phrase(move, calls[name].replace("{who}", who), calls[f"{name}-tag"], why, calls["several"])


def turning_phrase(move: str, at: tuple[Play, int], pad: Pad, language: Language) -> Phrase:
    """Return the phrase of a half turn: the foot that goes round, its place before or behind the other, and the reason.

    In front is towards the screen. In a jump, the phrase names the foot in front. The same words are used for feet
    that cross so far that the dancer's back is to the screen.

    move : name of the move for people, which says where the dancer then looks
    at : the play and the row that turns her
    """
    (play, row), calls = at, language.calls
    feet = [foot for foot in (0, 1) if foot in play.limb[row]]
    if not feet or (play.feet[row] < 0).any():
        return plain_phrase(move)
    depth = np.asarray(pad.panels)[play.feet[row]][:, 1]
    if len(feet) == 2 and depth[0] == depth[1]:
        return plain_phrase(move)
    foot = feet[0] if len(feet) == 1 else int(np.argmax(depth))
    ahead = _ahead(play, row, foot, pad)
    name = TURN_FRONT if ahead > 0 else TURN_BEHIND if ahead < 0 else TURN_ROUND
    where = calls[name].replace("{who}", language.limbs[LABELS[foot]])
    reason = _reason(play, row, foot) if len(feet) == 1 else ""
    why = calls[reason].replace("{other}", language.limbs[LABELS[1 - foot]]) if reason else ""
    return Phrase(move, f"{move}, {where}", short_words(move), why, calls["several"].replace("{said}", where))


def _ahead(play: Play, row: int, foot: int, pad: Pad) -> float:
    """Return how far, in panels, this foot is nearer to the screen than the other one after a half turn.

    If both are equally near, the foot's way decides; if that is level, too, the side to which the body turns.
    """
    depth = np.asarray(pad.panels)[:, 1]
    here, other = depth[play.feet[row, foot]], depth[play.feet[row, 1 - foot]]
    if here == other and row > 0 and (before := int(play.feet[row - 1, foot])) >= 0:
        here = (here + depth[before]) / 2
    if here == other and row > 0:
        turn = (float(play.facing[row] - play.facing[row - 1]) + 180.0) % 360.0 - 180.0
        side = side_of_half_turn(play.facing[row:], 2.0 * foot - 1.0) if abs(turn) == 180.0 else turn
        return float(np.sign(side)) * (2 * foot - 1)
    return float(here - other)


def _reason(play: Play, row: int, foot: int) -> str:
    """Return the reason why this foot crosses or turns the dancer: a label in the language's `calls`, or ""."""
    rows, other = play.rows, 1 - foot
    before = slice(0, row)
    if ((play.limb[before] == other) & (rows.hold_end[before] > rows.tick[row])).any():
        return "why-hold"
    stepped = np.flatnonzero((play.limb[before] >= 0).any(axis=1))
    if len(stepped) == 0 or rows.second[row] - rows.second[stepped[-1]] > JUST:
        return ""
    last = play.limb[stepped[-1]]
    return "why-turn" if other in last and foot not in last else ""
