"""A WAV file with clicks, made without the code under test."""

import wave
from collections.abc import Iterable
from pathlib import Path

import numpy as np


def write_clicks(path: Path, seconds: Iterable[float], length: float, rate: int, channels: int) -> None:
    """Write `length` seconds of 16-bit sound, `rate` samples a second, with a short click at each of `seconds`."""
    track = np.zeros(int(length * rate))
    t = np.arange(int(0.02 * rate)) / rate
    for second in seconds:
        at = int(np.ceil(second * rate))
        track[at : at + len(t)] += 0.8 * np.sin(2 * np.pi * 1500 * t + 1) * np.exp(-t * 200)
    with wave.open(str(path), "wb") as out:
        out.setnchannels(channels)
        out.setsampwidth(2)
        out.setframerate(rate)
        out.writeframes(np.repeat((track * 32767).astype("<i2"), channels).tobytes())
