#!/usr/bin/env python3
"""Make the demo song in charts/: synthesise the music and write its charts as .ssc and .sm.

usage: .venv/bin/python tools/make_demo_song.py [--charts-only]

The charts are written out below, one measure a line, in a short notation: panels `L D U R` of a single pad; `l d u r` and
`L D U R` of the left and the right pad in doubles; `.` an empty row; behind a panel `(` starts a hold, `<` a roll, `)` ends
either, `*` makes it a mine. The text behind `#` becomes a comment in the files, on the line that starts the measure: it
names the pattern that stands there, so that the output of `dancetutor analyze` can be checked by reading.
"""

from __future__ import annotations

import subprocess
import sys
import wave
from pathlib import Path

import imageio_ffmpeg
import numpy as np
from numpy.typing import NDArray

HERE = Path(__file__).resolve().parent.parent / "charts" / "two_left_feet"
TITLE, ARTIST, CREDIT = "Two Left Feet", "dancetutor", "the dancetutor authors"
BPM = 128.0
MEASURES = 21
LEAD_IN = 0.5  # seconds of music before beat 0
RATE = 44100
BEAT = 60.0 / BPM

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
L . U R
LR . LR .           # jumps on the same panels
L D R .             # crossover: the left foot goes to the right panel
L U R .             # crossover in front
L R L R
L L R R             # jacks
L . . D*            # mine beside the feet
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
L( . D . U . L) .               # hold, the free foot taps
R( . U . D . R) .               # hold, the free foot taps
L . R . U D L .
LR . UR . LR . . .              # jumps
L . D . R . D .                 # crossover behind
L . U . R . U .                 # crossover in front
L . R . D . U .
L . L . R . R .                 # jacks
L . R . L* . . .                # mine: lift the left foot
U . D . L . R .
L< . . . . . L) .               # roll
R . L . R . L .
D . U . D . U .                 # candles
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
L( D U D U D L) R                               # hold, the free foot taps: forced doublesteps
R( . U . D . R) .                               # hold, the free foot taps: forced doublesteps
L R D U L D U R
LR . UR . LR . LD .                             # jumps
L D R D L U R U                                 # crossovers: half, behind and in front
L D R . L U R .                                 # crossovers again
L U R D L . R .                                 # spin
L R U L R L R L                                 # doublestep: without it all that follows is crossed
R L R L R L R .
L . R . L* . . .                                # mine: lift the left foot
L . . . DU . . . L R . . . . . .                # gallop: two feet a 16th apart
L< . . . . . . . R . . . L) . . .               # roll, a tap beside it
D U D U D U L R                                 # candles
L( . . . R( . . . U . . . LR) . . .             # hand: both feet hold, a hand taps up
L R L R D U L R
LR . . . . . . .                                # jump, the end
"""

CHALLENGE = """
. . . .                                         # count-in
L R D U L D U R L R L R D U L R                 # stream
L D U R L U D R L R U D L R D U                 # stream
L R D U L D U R L . . . R . . .
LR . . . DU . . . L . R . LR . . .              # jumps
L( . D . U . D . U . D . L) . R .               # hold, the free foot taps: forced doublesteps
R( U . D . U . . R) . L . D . U .               # hold, the free foot taps: forced doublesteps
L . L . R . R . D . D . U . U .                 # jacks
LR . DU . LR . DU . LR . . . . . . .            # jumps in a row
L D R D L U R U L D R D L U R .                 # crossovers: half, behind and in front
L U R D L . . . R U L D R . . .                 # spins, to the left and to the right
L . R . U . L . R . L . R . L .                 # doublestep: without it all that follows is crossed
R . L . R . L . R . L . R . . .
L . R . LR* . . . D . U . . . . .               # mines under both feet: a hop to the centre
L R . . D U . . L R . . D U . .                 # gallops
L< . . . . . . . R . . . L) . . .               # roll, a tap beside it
LDR . . . . . . . LUR . . . . . . .             # hands: three panels at once
D U D U L R L R D U D U L R L R                 # candles and drills
L( . . . R( . . . U . D . LR) . . .             # hands: both feet hold
L R D U L D U R L D U R L U D R                 # stream
LR . . .                                        # jump, the end
"""

DOUBLE = """
. . . . . . . .                                 # count-in
r L r L r L r L
l u r . L U R .                                 # over to the right pad
R U L . r u l .                                 # and back
lr . uL . LR . rL .                             # jumps
l( d u d u d l) r                               # hold, the free foot taps: forced doublesteps
R( . U . D . R) .                               # hold, the free foot taps: forced doublesteps
l d r . L D R .
rL . uU . dD . rL .                             # jumps across both pads
l d r d l u r u                                 # crossovers on the left pad
L D R . L U R .                                 # crossovers on the right pad
r u L D R . L .                                 # run through the middle
r L u r L r L r                                 # doublestep: without it all that follows is crossed
L r L r L r L .
r . L . r* . . .                                # mine: lift the left foot
r . . . uU . . . r L . . . . . .                # gallop: two feet a 16th apart
r< . . . . . . . L . . . r) . . .               # roll, a tap beside it
u U u U d D d D
r( . . . L( . . . U . . . rL) . . .             # hand: both feet hold, a hand taps up
l u r L U R . .                                 # run through all panels
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


# --- the music: drums, bass, chords and a tune, all from numpy ---------------------------------------------------------

Sound = NDArray[np.float64]
CHORDS = ("Am", "F", "C", "G")
ROOTS = {"Am": 57, "F": 53, "C": 60, "G": 55}
TRIADS = {"Am": (57, 60, 64), "F": (53, 57, 60), "C": (52, 55, 60), "G": (50, 55, 59)}
# The tune: per measure of a phrase of four, (eighth, midi note, eighths long).
TUNE = (
    ((0, 76, 1), (1, 74, 1), (2, 72, 1), (3, 69, 2), (5, 72, 1), (6, 74, 2)),
    ((0, 76, 2), (2, 77, 1), (3, 76, 1), (4, 74, 1), (5, 72, 2), (7, 69, 1)),
    ((0, 67, 1), (1, 72, 1), (2, 76, 2), (4, 79, 2), (6, 76, 1), (7, 74, 1)),
    ((0, 74, 2), (2, 71, 1), (3, 74, 2), (5, 79, 1), (6, 77, 1), (7, 74, 1)),
)


def hertz(midi: float) -> float:
    return 440.0 * 2.0 ** ((midi - 69) / 12)


def saw(frequency: float, seconds: float, detune: float = 0.0) -> Sound:
    """Band-limited saw: harmonics up to 9 kHz, fading with height so that it stays soft."""
    t = np.arange(int(seconds * RATE)) / RATE
    f = frequency * 2.0 ** (detune / 1200)
    harmonics = np.arange(1, max(2, int(9000 / f)))
    wave_sum = np.zeros_like(t)
    for h in harmonics:
        wave_sum += np.sin(2 * np.pi * f * h * t + 0.7 * h) / h * np.exp(-h * f / 5000)
    return wave_sum * (2 / np.pi)


def envelope(n: int, attack: float, decay: float, release: float = 0.02) -> Sound:
    t = np.arange(n) / RATE
    out = np.minimum(1.0, t / attack) * np.exp(-t / decay)
    tail = min(n, int(release * RATE))
    out[n - tail :] *= np.linspace(1, 0, tail)
    return out


def kick() -> Sound:
    t = np.arange(int(0.28 * RATE)) / RATE
    phase = 2 * np.pi * np.cumsum(46 + 150 * np.exp(-t * 36)) / RATE
    return np.sin(phase) * np.exp(-t * 11) + 0.4 * np.exp(-t * 400) * np.sin(2 * np.pi * 1800 * t)


def clap(rng: np.random.Generator) -> Sound:
    t = np.arange(int(0.22 * RATE)) / RATE
    noise = np.diff(rng.standard_normal(len(t) + 1))
    bursts = sum(np.where(t >= d, np.exp(-(t - d) * 120), 0) for d in (0.0, 0.011, 0.021))
    return noise * (0.5 * bursts + np.exp(-t * 22)) * 0.35


def hat(rng: np.random.Generator, decay: float) -> Sound:
    t = np.arange(int(0.12 * RATE)) / RATE
    noise = np.diff(rng.standard_normal(len(t) + 2), n=2)
    return noise * np.exp(-t / decay) * 0.16


def pluck(midi: float, seconds: float) -> Sound:
    body = saw(hertz(midi), seconds, 4) + saw(hertz(midi), seconds, -4) + 0.5 * saw(hertz(midi + 12), seconds)
    return body * envelope(len(body), 0.004, 0.22)


def put(track: Sound, sound: Sound, second: float, gain: float) -> None:
    start = int(round(second * RATE))
    end = min(len(track), start + len(sound))
    track[start:end] += gain * sound[: end - start]


def music() -> NDArray[np.int16]:
    """The whole song, stereo, 16 bit. Measure 0 counts in; the arrangement grows every four measures."""
    rng = np.random.default_rng(7)
    n = int((LEAD_IN + MEASURES * 4 * BEAT + 1.2) * RATE)
    drums, bass, left, right, lead = (np.zeros(n) for _ in range(5))
    a_kick, a_clap, closed, opened = kick(), clap(rng), hat(rng, 0.02), hat(rng, 0.07)
    pump = np.ones(n)  # the kick ducks chords and bass
    for measure in range(MEASURES):
        at = LEAD_IN + measure * 4 * BEAT
        last = measure == MEASURES - 1
        chord = "Am" if last else CHORDS[measure % 4 - 1]
        for beat in range(1 if last else 4):
            second = at + beat * BEAT
            if measure == 0:
                put(drums, closed, second, 1.6)
                put(lead, pluck(81 if beat == 0 else 76, 0.12), second, 0.5)
                continue
            put(drums, a_kick, second, 0.95)
            duck = np.arange(int(0.2 * RATE)) / (0.2 * RATE)
            start = int(second * RATE)
            pump[start : start + len(duck)] = np.minimum(pump[start : start + len(duck)], 0.35 + 0.65 * duck)
            if beat % 2 and measure >= 3:
                put(drums, a_clap, second, 0.8)
            put(drums, opened, second + BEAT / 2, 0.8)
            if measure >= 5:
                for quarter in (0.25, 0.75):
                    put(drums, closed, second + quarter * BEAT, 0.55)
            for eighth in (0.0, 0.5):
                note = saw(hertz(ROOTS[chord] - 24 + (12 if eighth and measure >= 9 else 0)), BEAT * 0.45)
                put(bass, note * envelope(len(note), 0.005, 0.3), second + eighth * BEAT, 0.62)
        long = 4 * BEAT if not last else 1.9
        for voice, midi in enumerate(TRIADS[chord]):
            for side, track in ((-1, left), (1, right)):
                sound = saw(hertz(midi), long, side * (5 + 2 * voice)) * envelope(int(long * RATE), 0.05, 6.0, 0.08)
                put(track, sound, at, 0.13)
        if measure >= 1 and not last:
            phrase = TUNE[(measure - 1) % 4]
            rest = 9 <= measure < 11  # two measures of air before the crossovers
            for eighth, midi, eighths in phrase:
                if not (rest and eighth % 2):
                    shift = 12 if 17 <= measure < 20 else 0
                    put(lead, pluck(midi + shift, eighths * BEAT / 2 + 0.15), at + eighth * BEAT / 2, 0.42)
        elif last:
            put(lead, pluck(81, 1.4), at, 0.6)
    echo = np.zeros(n)
    delay = int(0.75 * BEAT * RATE)
    echo[delay:] = 0.3 * lead[:-delay]
    centre = drums + pump * bass + lead
    stereo = np.stack([centre + pump * left + 0.9 * echo, centre + pump * right + 0.5 * echo], axis=1)
    stereo = np.tanh(1.15 * stereo / np.abs(stereo).max() * 1.6)
    fade = min(n, int(0.5 * RATE))
    stereo[-fade:] *= np.linspace(1, 0, fade)[:, None]
    return (stereo / np.abs(stereo).max() * 0.89 * 32767).astype(np.int16)


def write_music(path: Path) -> None:
    raw = path.with_suffix(".wav")
    with wave.open(str(raw), "wb") as out:
        out.setnchannels(2)
        out.setsampwidth(2)
        out.setframerate(RATE)
        out.writeframes(music().tobytes())
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-y", "-loglevel", "error", "-i", str(raw), "-map_metadata", "-1"]
    subprocess.run([*command, "-fflags", "+bitexact", "-c:a", "libvorbis", "-q:a", "3", str(path)], check=True)
    raw.unlink()


def main() -> None:
    HERE.mkdir(parents=True, exist_ok=True)
    (HERE / "two_left_feet.ssc").write_text(ssc(), encoding="utf-8", newline="\n")
    (HERE / "two_left_feet.sm").write_text(sm(), encoding="utf-8", newline="\n")
    if "--charts-only" not in sys.argv[1:]:
        write_music(HERE / "two_left_feet.ogg")


if __name__ == "__main__":
    main()
