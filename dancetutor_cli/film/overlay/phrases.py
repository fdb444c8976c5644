"""The phrases of calls, which say more than the name of a move: the foot, in front or behind, and the reason.

The sentences themselves are data of the languages.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from dancetutor_cli.feet.limbs import LABELS
from dancetutor_cli.film.words import short_words

if TYPE_CHECKING:
    from dancetutor_cli.feet.pads import Pad
    from dancetutor_cli.feet.play import Play
    from dancetutor_cli.run.languages import Language

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

    def counted(self, count: int, alike: bool) -> str:
        """Return the words for `count` of these moves in a row; alike : whether all have the same words."""
        if count == 1:
            return self.text
        if alike or not self.several:
            return f"{self.text if alike else self.move} ×{count}"
        return self.several.replace("{move}", self.move).replace("{count}", str(count)).replace("{said}", self.text)


def plain(text: str) -> Phrase:
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
        return plain(move)
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
            return plain(move)
    else:
        names = [name for name in (FRONT, BACK) if name in play.moves[row]]
        if not feet or not names:
            return plain(move)
        (foot,), name = feet, names[0]
    who, other = language.limbs[LABELS[foot]], language.limbs[LABELS[1 - foot]]
    reason = "" if name == JUMP else _reason(play, row, foot)
    why = calls[reason].replace("{other}", other) if reason else ""
    return Phrase(move, calls[name].replace("{who}", who), calls[f"{name}-tag"], why, calls["several"])


def turning_phrase(move: str, at: tuple[Play, int], pad: Pad, language: Language) -> Phrase:
    """Return the phrase of a half turn: the foot that goes round, its place before or behind the other, and the reason.

    In front is towards the screen. In a jump, the phrase names the foot in front.

    move : name of the move for people, which says where the dancer then looks
    at : the play and the row that turns her
    """
    (play, row), calls = at, language.calls
    feet = [foot for foot in (0, 1) if foot in play.limb[row]]
    if not feet or (play.feet[row] < 0).any():
        return plain(move)
    ahead = np.asarray(pad.panels)[play.feet[row]][:, 1]
    if len(feet) == 2 and ahead[0] == ahead[1]:
        return plain(move)
    foot = feet[0] if len(feet) == 1 else int(np.argmax(ahead))
    over = float(ahead[foot] - ahead[1 - foot])
    name = TURN_FRONT if over > 0 else TURN_BEHIND if over < 0 else TURN_ROUND
    where = calls[name].replace("{who}", language.limbs[LABELS[foot]])
    reason = _reason(play, row, foot) if len(feet) == 1 else ""
    why = calls[reason].replace("{other}", language.limbs[LABELS[1 - foot]]) if reason else ""
    return Phrase(move, f"{move}, {where}", short_words(move), why, calls["several"].replace("{said}", where))


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
