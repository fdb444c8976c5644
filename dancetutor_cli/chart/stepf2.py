"""What StepF2, a game for Pump charts, writes beside the other games' notes.

`{note|look|fake|0}` is one note of one column, however it looks; a 1 in the third place makes it a fake. X, Y and Z are
steps, and x, y and z heads of holds, of the first, second and third player of a chart for several; the game shows each
player's in a colour of their own. A chart with steps of the first and the second player and none of a third one is read
as one for two. What else stands in it (the third one's holds, plain notes) is for whoever has that half of the pad. One
with steps of all three is for them and more, see `chart.marked`.
"""

from __future__ import annotations

import re

PLAYERS = b"XYZxyz"
SAID = {
    "{": "notes in {...} are StepF2's: here each is one note, the other games read them letter by letter",
    "X": "X, Y and Z are steps of several players in StepF2, of whom the first or the second has none here: no notes",
}
_SEVERAL = "the chart is for {} players ({} mark their notes, as in StepF2); each has feet of their own"
_NOTE = re.compile(rb"\{([0-4MLFKXYZxyz])\|[A-Za-z]\|([01])\|[0-9]\}")
FAKE_HEAD = ord("f")  # of a hold that is none, so that its end goes with it
_FAKED = {b"0": "0", b"2": "f", b"3": "3", b"4": "f", b"x": "f", b"y": "f", b"z": "f"}
_COLUMNS = (5, 6, 10)  # of Pump's pads
_BOTH_PADS = 10


def letters_of(text: bytes, columns: int) -> bytes:
    """The letters that mark players' notes, XY or XYZ, in note data without its comments; none if it is for one."""
    if columns != _BOTH_PADS or b"X" not in text or b"Y" not in text:
        return b""
    return b"XYZ" if b"Z" in text else b"XY"


def for_several(players: int, letters: bytes) -> str:
    """That a chart is for several, in a sentence."""
    return _SEVERAL.format("two" if players == 2 else players, "X and Y" if len(letters) == 2 else "X, Y and Z")


def player_of(letter: int) -> int:
    """Whose a letter is, from 1; 0: nobody's in particular."""
    return PLAYERS.find(letter) % 3 + 1 if letter in PLAYERS else 0


def note_at(text: bytes, at: int, columns: int) -> tuple[int, int, str] | None:
    """The letter of StepF2's note at an offset of a row, where it ends, which of `SAID` it is; None if it is none."""
    if found := _NOTE.match(text, at):
        letter = _FAKED.get(found[1], "F") if found[2] == b"1" else found[1].decode("ascii")
        return ord(letter), found.end(), "{"
    if columns in _COLUMNS and text[at] in PLAYERS:
        return text[at], at + 1, "X"
    return None
