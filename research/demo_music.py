"""The music of the demo song: drums, bass, chords and a tune, all from numpy, the same bytes on every run."""

from __future__ import annotations

import subprocess
import wave
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.run.ffmpeg import executable

BPM = 128.0
MEASURES = 21
LEAD_IN = 0.5  # seconds of music before beat 0
RATE = 44100
BEAT = 60.0 / BPM

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
    start = round(second * RATE)
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
    command = [executable(), "-y", "-loglevel", "error", "-i", str(raw), "-map_metadata", "-1"]
    subprocess.run([*command, "-fflags", "+bitexact", "-c:a", "libvorbis", "-q:a", "3", str(path)], check=True)
    raw.unlink()
