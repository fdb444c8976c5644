"""What StepF2, a game for Pump charts, writes beside the other games' notes.

`{note|look|fake|0}` is one note of one column, however it looks; a 1 in the third place makes it a fake. X, Y and Z are
steps, and x, y and z heads of holds, of the first, second and third player of a chart for several.
"""

from __future__ import annotations

import re

PLAYERS = b"XYZxyz"
SAID = {
    "{": "notes in {...} are StepF2's: here each is one note, the other games read them letter by letter",
    "X": "X, Y and Z are steps of several players in StepF2: no notes here, nor in the other games",
}
_NOTE = re.compile(rb"\{([0-4MLFKXYZxyz])\|[A-Za-z]\|([01])\|[0-9]\}")
# As what a fake counts: a hold's head as another player's, so that its end goes with it.
_FAKED = {b"0": "0", b"2": "x", b"3": "3", b"4": "x", b"x": "x", b"y": "x", b"z": "x"}
_COLUMNS = (5, 6, 10)  # of Pump's pads


def note_at(text: bytes, at: int, columns: int) -> tuple[int, int, str] | None:
    """The letter of StepF2's note at an offset of a row, where it ends, which of `SAID` it is; None if it is none."""
    if found := _NOTE.match(text, at):
        letter = _FAKED.get(found[1], "F") if found[2] == b"1" else found[1].decode("ascii")
        return ord(letter), found.end(), "{"
    if columns in _COLUMNS and text[at] in PLAYERS:
        return text[at], at + 1, "X"
    return None
