#!/usr/bin/env python3
"""Make the demo song in charts/: synthesise the music and write its charts as .ssc and .sm.

usage: .venv/bin/python research/make_demo_song.py [--charts-only]

The charts are written out below, one measure a line, in a short notation: panels `L D U R` of a single pad; `l d u r`
and `L D U R` of the left and the right pad in doubles; `.` an empty row; behind a panel `(` starts a hold, `<` a roll,
`)` ends either, `*` makes it a mine. The text behind `#` becomes a comment in the files, on the line that starts the
measure: it names the pattern that stands there, so that the output of `dancetutor analyze` can be checked by reading.
"""

from __future__ import annotations

import sys
from pathlib import Path

from demo_music import BPM, LEAD_IN, MEASURES, write_music

HERE = Path(__file__).resolve().parent.parent / "charts" / "two_left_feet"
TITLE, ARTIST, CREDIT = "Two Left Feet", "dancetutor", "the dancetutor authors"

BEGINNER = """
. . . .             # count-in
L . R .
L . R .
D . U .
L . R .
L . . R
D . U .
L . R .
LR . . .            # jump
L( . . L)           # hold
R( . . R)           # hold
L . R .
D . U .
L . R .
L . R .
U . D .
L . R .
LR . . .            # jump
L . R .
L . R .
LR . . .            # jump, the end
"""

EASY = """
. . . .             # count-in
L R L R
D U L R
L R D U
LR . DU .           # jumps
L( . . L)           # hold
R( D . R)           # hold, the free foot taps
R . L R
LR . LR .           # jumps on the same panels
L D R D             # crossover behind: the left foot goes to the right panel
L U R U             # crossover in front
L R L R
L L R R             # jacks
L R . D*            # mine between the feet
D U L R
L< . . L)           # roll
R . L R
D U D U
LR . DU .           # jumps
L R L R
LR . . .            # jump, the end
"""

MEDIUM = """
. . . . . . . .                 # count-in
L . R . L . R .
L D U R L . R .
D . U . L . R .
LR . . . DU . LR .              # jumps
L( . D . U . . L)               # hold, the free foot taps: a forced doublestep
L R( . U . D . R)               # hold, the free foot taps: a forced doublestep
R . L . U D R .
LR . UR . LR . . .              # jumps
L . D . R . D .                 # crossover behind
L . U . R . U .                 # crossover in front
L . R . D . U .
L . L . R . R .                 # jacks
L . R . L* . . .                # mine: lift the left foot
U . D . L . R .
L< . . . . . L) .               # roll
R . L . R . L .
U L D L U L D L                 # candles
LR . DU . LR . DU .             # jumps
L . R . L D U R
LR . . . . . . .                # jump, the end
"""

HARD = """
. . . . . . . .                                 # count-in
L R L R D U L R
L D U R L U D R
L R L D U R L R
LR . DU . L . R .                               # jumps
L( D U D U D . L)                               # hold, the free foot taps: forced doublesteps
L R( . U . D . R)                               # hold, the free foot taps: a forced doublestep
R L D U R L U D
LR . UR . LR . LD .                             # jumps
L D R D L U R U                                 # crossovers, behind and in front
L R D U L R L R
L U R D L . LR .                                # spin
L R U L R L R L                                 # doublestep: without it all that follows is crossed
R L R L R L R .
L . R . L* . . .                                # mine: lift the left foot
L . . . DU . . . L R . . . . . .                # gallop: two feet a 16th apart
L< . . . . . . . R . . . L) . . .               # roll, a tap beside it
U L D L U L D L                                 # candles
L( . . . R( . . . U . . . LR) . . .             # hand (preset itg: a bracket): both feet hold, a third panel
L R L R D U L R
LR . . . . . . .                                # jump, the end
"""

CHALLENGE = """
. . . .                                         # count-in
L R D U L D U R L R L R D U L R                 # stream
L D U R L U D R L R U D L R D U                 # stream
L R D U L D U R L . . . R . . .
LR . . . DU . . . L . R . LR . . .              # jumps
L( . D . U . D . U . D . . . L) .               # hold, the free foot taps: forced doublesteps
L . R( . U . D . U . D . R) . . .               # hold, the free foot taps: forced doublesteps
R . R . L . L . U . U . D . D .                 # jacks
LR . DU . LR . DU . LR . . . . . . .            # jumps in a row
L D R D L U R U L D R D L U R U                 # crossovers, behind and in front
L U R D L . R U L D R . L . R .                 # spins, to the left and to the right
L . R . U . L . R . L . R . L .                 # doublestep: without it all that follows is crossed
R . L . R . L . R . L . R . . .
L . R . LR* . . . D . U . . . . .               # mines under both feet: a hop to the centre
L R . . D U . . L R . . D U . .                 # gallops
L< . . . . . . . R . . . L) . . .               # roll, a tap beside it
LDR . . . . . . . LUR . . . . . . .             # hands (preset itg: brackets): three panels at once
U L D L U L D L R L R L R L R L                 # candles, then a drill
L( . . . R( . . . U . D . LR) . . .             # hands (preset itg: brackets): both feet hold
L R D U L D U R L D U R L U D R                 # stream
LR . . .                                        # jump, the end
"""

DOUBLE = """
. . . . . . . .                                 # count-in
r L r L r L r L
l d u r d L r U                                 # run to the right pad
L R D U L R L R
LR . DU . rL . du .                             # jumps
l( d u d u d . l)                               # hold, the free foot taps: forced doublesteps
l r( . u . d . r)                               # hold, the free foot taps: a forced doublestep
r u L r U L R .                                 # run to the right pad
LR . DU . rL . du .                             # jumps
l d r d l u r u                                 # crossovers on the left pad
l d u r d L r U                                 # run to the right pad
L D R D L U R U                                 # crossovers on the right pad
L U R D L . LR .                                # spin
L R U L R L R L                                 # doublestep: without it all that follows is crossed
R L R L R L R .
L . R . L* . . .                                # mine: lift the left foot
L . . . DU . . . L R . . . . . .                # gallop: two feet a 16th apart
L< . . . . . . . R . . . L) . . .               # roll, a tap beside it
L( . . . R( . . . U . . . LR) . . .             # hand (preset itg: a bracket): both feet hold, a third panel
L R U D L U r L                                 # run to the left pad
rL . . . . . . .                                # jump, the end
"""

CHARTS = (
    ("dance-single", "Beginner", 1, BEGINNER),
    ("dance-single", "Easy", 3, EASY),
    ("dance-single", "Medium", 5, MEDIUM),
    ("dance-single", "Hard", 8, HARD),
    ("dance-single", "Challenge", 11, CHALLENGE),
    ("dance-double", "Hard", 8, DOUBLE),
)
MARKS = {"": "1", "(": "2", "<": "4", ")": "3", "*": "M"}


def row_text(token: str, panels: str) -> str:
    """One row of note data: "L(R" on "LDUR" is "2001"."""
    cells = ["0"] * len(panels)
    waiting: list[int] = []
    for letter in token.replace(".", ""):
        if letter in panels:
            waiting.append(panels.index(letter))
            cells[waiting[-1]] = "1"
        else:  # a mark belongs to all panels since the last mark: "LR)" ends two holds
            for column in waiting:
                cells[column] = MARKS[letter]
            waiting = []
    return "".join(cells)


def note_data(text: str, panels: str, first_line_prefix: str) -> str:
    """Note data with comments; `first_line_prefix` is what stands before the first measure's comment."""
    lines = text.strip().splitlines()
    if len(lines) != MEASURES:
        raise SystemExit(f"{len(lines)} measures, wanted {MEASURES}")
    out = []
    for number, line in enumerate(lines):
        body, _, comment = line.partition("#")
        rows = [row_text(token, panels) for token in body.split()]
        if len(rows) not in (4, 8, 16):
            raise SystemExit(f"{len(rows)} rows in {line!r}")
        note = f"measure {number}" + (f": {comment.strip()}" if comment.strip() else "")
        head = first_line_prefix if number == 0 else ","
        out.append(f"{head}  // {note}\n" + "\n".join(rows) + "\n")
    return "".join(out)


def panels_of(steps_type: str) -> str:
    return "LDUR" if steps_type == "dance-single" else "ldurLDUR"


SONG_TAGS = (
    ("TITLE", TITLE), ("SUBTITLE", ""), ("ARTIST", ARTIST), ("CREDIT", CREDIT), ("MUSIC", "two_left_feet.ogg"),
    ("BANNER", ""), ("BACKGROUND", ""), ("OFFSET", f"{-LEAD_IN:.3f}"), ("SAMPLESTART", "15.500"),
    ("SAMPLELENGTH", "12.000"), ("SELECTABLE", "YES"), ("BPMS", f"0.000={BPM:.3f}"), ("STOPS", ""),
)  # fmt: skip


def ssc() -> str:
    parts = ["#VERSION:0.83;\n", *(f"#{k}:{v};\n" for k, v in SONG_TAGS)]
    for steps_type, difficulty, meter, text in CHARTS:
        parts.append(f"\n//--------------- {steps_type} - {difficulty} {meter} ----------------\n#NOTEDATA:;\n")
        tags = (("STEPSTYPE", steps_type), ("DESCRIPTION", ""), ("DIFFICULTY", difficulty), ("METER", str(meter)))
        parts.extend(f"#{k}:{v};\n" for k, v in (*tags, ("CREDIT", CREDIT)))
        parts.append(note_data(text, panels_of(steps_type), "#NOTES:") + ";\n")
    return "".join(parts)


def sm() -> str:
    parts = [f"#{k}:{v};\n" for k, v in SONG_TAGS]
    for steps_type, difficulty, meter, text in CHARTS:
        parts.append(f"\n//--------------- {steps_type} - {difficulty} {meter} ----------------\n")
        parts.append(f"#NOTES:\n     {steps_type}:\n     {CREDIT}:\n     {difficulty}:\n     {meter}:\n")
        parts.append(note_data(text, panels_of(steps_type), "     0,0,0,0,0:") + ";\n")
    return "".join(parts)


def main() -> None:
    HERE.mkdir(parents=True, exist_ok=True)
    (HERE / "two_left_feet.ssc").write_text(ssc(), encoding="utf-8", newline="\n")
    (HERE / "two_left_feet.sm").write_text(sm(), encoding="utf-8", newline="\n")
    if "--charts-only" not in sys.argv[1:]:
        write_music(HERE / "two_left_feet.ogg")


if __name__ == "__main__":
    main()
