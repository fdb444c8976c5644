"""What a call says of a move beside its name: which foot, in front or behind, and why; the sentences are data."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from dancetutor_cli.film.words import LIMBS, short_words

if TYPE_CHECKING:
    from dancetutor_cli.feet.pads import Pad
    from dancetutor_cli.feet.play import Play
    from dancetutor_cli.run.languages import Language

FRONT, BACK, JUMP = "crossover-front", "crossover-back", "crossover-jump"
TURN_FRONT, TURN_BEHIND, TURN_ROUND = "half-turn-front", "half-turn-behind", "half-turn-round"
JUST = 2.0  # seconds; the longest time since a foot "has just stepped"


class Phrase(NamedTuple):
    """A move in words. move : its name for people, the same for all of its kind; text : with foot and way

    tag : for the place beside the notes; why : a reason, or ""; several : how a count of different ones is written
    """

    move: str
    text: str
    tag: str
    why: str = ""
    several: str = ""

    def counted(self, count: int, alike: bool) -> str:
        """So many of them in a row; alike : all have the same words."""
        if count == 1:
            return self.text
        if alike or not self.several:
            return f"{self.text if alike else self.move} ×{count}"
        return self.several.replace("{move}", self.move).replace("{count}", str(count)).replace("{said}", self.text)


def plain(text: str) -> Phrase:
    """Words that stand for themselves."""
    return Phrase(text, text, short_words(text))


def standing_tags(language: Language) -> tuple[str, ...]:
    """The tags that are the same in every film."""
    return tuple(language.calls[f"{name}-tag"] for name in (FRONT, BACK, JUMP))


def stepped_phrase(move: str, name: str, limbs: list[int], language: Language) -> Phrase:
    """A move of the one foot that steps, for example a footswitch. limbs : of its row"""
    feet = {limb for limb in limbs if limb in (0, 1)}
    text = language.calls.get(name)
    if text is None or len(feet) != 1:
        return plain(move)
    return Phrase(move, text.replace("{who}", language.limbs[LIMBS[feet.pop()]]), short_words(move))


def crossing_phrase(move: str, at: tuple[Play, int], pad: Pad, language: Language) -> Phrase:
    """A crossover at its first row: which foot crosses, in front or behind, and why it is that foot.

    move : its name for people; at : the play and the row in which it begins. That it is in front, towards the screen,
    is said by `feet.solver`; of two feet that jump the one nearer to the screen is in front.
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
    who, other = language.limbs[LIMBS[foot]], language.limbs[LIMBS[1 - foot]]
    reason = "" if name == JUMP else _reason(play, row, foot)
    why = calls[reason].replace("{other}", other) if reason else ""
    return Phrase(move, calls[name].replace("{who}", who), calls[f"{name}-tag"], why, calls["several"])


def turning_phrase(move: str, at: tuple[Play, int], pad: Pad, language: Language) -> Phrase:
    """Half a turn: which foot goes round, whether it lands in front of the other one or behind it, and why.

    move : its name for people, which says where she looks then; at : the play and the row that turns her. In front is
    towards the screen; of two feet that jump it is reported which one is.
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
    where = calls[name].replace("{who}", language.limbs[LIMBS[foot]])
    reason = _reason(play, row, foot) if len(feet) == 1 else ""
    why = calls[reason].replace("{other}", language.limbs[LIMBS[1 - foot]]) if reason else ""
    return Phrase(move, f"{move}, {where}", short_words(move), why, calls["several"].replace("{said}", where))


def _reason(play: Play, row: int, foot: int) -> str:
    """The reason why this foot crosses or turns the dancer: its label in the language's `calls`, or ""."""
    rows, other = play.rows, 1 - foot
    before = slice(0, row)
    if ((play.limb[before] == other) & (rows.hold_end[before] > rows.tick[row])).any():
        return "why-hold"
    stepped = np.flatnonzero((play.limb[before] >= 0).any(axis=1))
    if len(stepped) == 0 or rows.second[row] - rows.second[stepped[-1]] > JUST:
        return ""
    last = play.limb[stepped[-1]]
    return "why-turn" if other in last and foot not in last else ""
