"""Songs made of known events: drums, bass, melody and pads with swing, reverb and noise, and charts that step them."""

from __future__ import annotations

import wave
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

RATE = 44100
METERS = {"Easy": 3, "Medium": 5, "Hard": 8}
COLUMNS = ("1000", "0100", "0010", "0001")
Samples = NDArray[np.float64]


@dataclass(frozen=True)
class SyntheticSong:
    """music : float64 (n,) at RATE; beat 0 sounds at `lead` seconds; charts : by difficulty, tick -> row"""

    music: Samples
    bpm: float
    lead: float
    charts: dict[str, dict[int, str]]

    def text(self, offset_ms: float = 0.0, bpm: float | None = None, more: str = "") -> str:
        """The .sm file, its #OFFSET raised by so many milliseconds."""
        head = f"#TITLE:T;\n#ARTIST:A;\n#CREDIT:C;\n#MUSIC:song.wav;\n#OFFSET:{offset_ms / 1000 - self.lead:.6f};\n"
        head += f"#BPMS:0={bpm or self.bpm:.6f};\n{more}\n"
        return head + "".join(_notes(name, rows) for name, rows in self.charts.items())

    def write(self, folder: Path, offset_ms: float = 0.0, bpm: float | None = None, more: str = "") -> Path:
        """The song in a folder of its own."""
        folder.mkdir(parents=True, exist_ok=True)
        write_wave(folder / "song.wav", self.music)
        (folder / "song.sm").write_text(self.text(offset_ms, bpm, more), encoding="utf-8")
        return folder / "song.sm"


def write_wave(path: Path, samples: Samples, rate: int = RATE) -> None:
    with wave.open(str(path), "wb") as out:
        out.setnchannels(1)
        out.setsampwidth(2)
        out.setframerate(rate)
        out.writeframes((np.clip(samples, -1, 1) * 32767).astype("<i2").tobytes())


def _notes(difficulty: str, rows: dict[int, str]) -> str:
    lines = [rows.get(tick, "0000") for tick in range(0, (max(rows) // 192 + 1) * 192, 12)]
    measures = ["\n".join(lines[first : first + 16]) for first in range(0, len(lines), 16)]
    return f"#NOTES:dance-single::{difficulty}:{METERS[difficulty]}::\n" + "\n,\n".join(measures) + "\n;\n"


def _bell(count: int, attack: float, decay: float) -> Samples:
    seconds = np.arange(count) / RATE
    return np.minimum(seconds / attack, 1) * np.exp(-np.maximum(seconds - attack, 0) / decay)


def _sounds(dice: np.random.Generator) -> dict[str, Samples]:
    """One sound of each instrument; attacks of 0.5 to 8 ms."""
    seconds = np.arange(int(0.3 * RATE)) / RATE
    count, pitch = len(seconds), dice.uniform(100, 220)
    noise = dice.standard_normal(count)
    kick = np.sin(2 * np.pi * (50 * seconds + 2 * (1 - np.exp(-seconds / 0.03))))
    tone = sum(np.sin(2 * np.pi * pitch * 2 * n * seconds) / n for n in range(1, 6))
    return {
        "kick": 1.0 * kick * _bell(count, 0.002, 0.1),
        "snare": 0.5 * (noise + np.sin(2 * np.pi * 190 * seconds)) * _bell(count, 0.001, 0.08),
        "hat": 0.3 * np.diff(noise, append=0) * _bell(count, 0.0005, 0.02),
        "bass": 0.3 * np.sign(np.sin(np.pi * pitch * seconds)) * _bell(count, 0.004, 0.1),
        "melody": 0.3 * tone * _bell(count, dice.uniform(0.002, 0.008), 0.15),
    }


def song(seed: int, seconds: float = 40.0, bpm: float | None = None) -> SyntheticSong:
    """A song that is the same for a seed. Its bass plays off-beats, as much dance music does."""
    dice = np.random.default_rng(seed)
    bpm = bpm or round(float(dice.uniform(95, 185)), 2)
    lead, swing = float(dice.uniform(0.3, 1.5)), float(dice.choice([0.0, 0.0, 0.03]))
    sounds, beat = _sounds(dice), 60 / bpm
    music = np.zeros(int((seconds + 3) * RATE))
    charts: dict[str, dict[int, str]] = {"Easy": {}, "Medium": {}, "Hard": {}}
    pattern = dice.random((4, 16)) < 0.45
    for sixteenth in range(int((seconds - lead) / beat) * 4):
        bar, place = divmod(sixteenth, 16)
        played = _played(place, bool(pattern[bar // 4 % 4, place]))
        at = round((lead + (sixteenth / 4 + (swing if place % 2 else 0)) * beat) * RATE)
        for name in played:
            sound = sounds[name]
            music[at : at + len(sound)] += sound[: len(music) - at]
        if bar >= 1:
            _step(charts, sixteenth, played, dice)
    tail = dice.standard_normal(RATE // 2) * np.exp(-np.arange(RATE // 2) / RATE / 0.1)
    size = 1 << (len(music) + len(tail)).bit_length()
    wet = np.fft.irfft(np.fft.rfft(music, size) * np.fft.rfft(tail, size), size)[: len(music)]
    music += dice.uniform(0.0, 0.4) * wet / np.sqrt((tail**2).sum())
    music = 0.9 * music / np.abs(music).max() + dice.standard_normal(len(music)) * 10 ** dice.uniform(-4, -2.5)
    return SyntheticSong(music, bpm, lead, charts)


def _played(place: int, melody: bool) -> list[str]:
    out = ["kick"] if place % 4 == 0 else []
    out += ["snare"] if place in (4, 12) else []
    out += ["hat"] if place % 2 == 0 else []
    out += ["bass"] if place % 4 == 2 else []
    return [*out, "melody"] if melody else out


def _step(charts: dict[str, dict[int, str]], sixteenth: int, played: list[str], dice: Any) -> None:
    rows = [name for name, here in (
        ("Easy", sixteenth % 4 == 0),
        ("Medium", sixteenth % 2 == 0 and {"snare", "melody", "kick"} & set(played)),
        ("Hard", {"snare", "melody", "kick"} & set(played)),
    ) if here and dice.random() < 0.9]  # fmt: skip
    for name in rows:
        charts[name][sixteenth * 12] = COLUMNS[dice.integers(4)]
