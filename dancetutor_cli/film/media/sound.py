"""The film's sound: the song's music, cut to the clock and slowed without a change of pitch, with clicks if wanted."""

from __future__ import annotations

import math
import wave
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.film.clock import Clock, Pass, Practice
from dancetutor_cli.run import ffmpeg

RATE = 48000
FADE = 0.02  # seconds; prevents clicks at the cuts of the music
# rubberband moves onsets forward by this many seconds times (1 / rate - 1): measured with clicks, rates 0.4 to 2.
STRETCH_LEAD = 0.0155

Samples = NDArray[np.float32]  # (n, 2)


@dataclass(frozen=True, slots=True)
class Click:
    """A short sound at a second of the music. pitch : Hz; gain : 0..1."""

    second: float
    pitch: float
    gain: float


@dataclass(frozen=True, slots=True)
class SoundPlan:
    """The parts of the sound. music : the song's file or None

    shift : seconds by which the music is later than the notes
    """

    music: Path | None
    shift: float = 0.0
    clicks: tuple[Click, ...] = ()
    fade_out: float = 0.0  # seconds at the end of the film


def decode(music: Path, start: float, end: float) -> Samples:
    """Return the samples of a music file from `start` to `end` (seconds), float32 (n, 2); silence outside of the file.

    The file is opened as a local file whatever its name; ffmpeg removes the encoder delay of MP3. EncoderError if the
    file is not music.
    """
    count = round((end - start) * RATE)
    out = np.zeros((count, 2), dtype=np.float32)
    lead = max(0.0, -start)
    if end <= 0:
        return out
    cut = f"aresample={RATE}:async=0,atrim=start={max(0.0, start):.9f}:end={end:.9f}"
    arguments = (*ffmpeg.music_input(music), "-vn", "-sn", "-dn", "-map", "0:a:0")
    raw = ("-af", cut, "-ac", "2", "-f", "f32le", "-c:a", "pcm_f32le", "pipe:1")
    with ffmpeg.Process((*arguments, *raw), f"reading {music.name}", read=True) as process:
        data = process.read()
        process.finish()
    samples = np.frombuffer(data[: len(data) // 8 * 8], dtype="<f4").reshape(-1, 2)
    first = round(lead * RATE)
    samples = samples[: max(0, count - first)]
    out[first : first + len(samples)] = samples
    return out


def seconds_of(music: Path) -> float:
    """Return the duration of a music file, seconds; EncoderError if the file is not music."""
    rate = 1000
    arguments = (*ffmpeg.music_input(music), "-vn", "-sn", "-dn", "-map", "0:a:0")
    raw = ("-ac", "1", "-ar", str(rate), "-f", "u8", "-c:a", "pcm_u8", "pipe:1")
    with ffmpeg.Process((*arguments, *raw), f"reading {music.name}", read=True) as process:
        data = process.read()
        process.finish()
    return len(data) / rate


def stretch(samples: Samples, rate: float) -> Samples:
    """Change the speed of samples, but not the pitch; the error of onsets is at most a few milliseconds."""
    count = round(len(samples) / rate)
    lead = STRETCH_LEAD * (1 / rate - 1)
    lag = round(max(0.0, lead) * RATE)
    # "mixed" keeps attacks as sharp and as well timed as "crisp", which lets held tones drift by up to 3 %.
    tempo = f"rubberband=tempo={rate:.6f}:transients=mixed:window=short"
    pad = np.zeros((RATE // 2, 2), dtype=np.float32)
    source = ("-f", "f32le", "-ar", str(RATE), "-ac", "2", "-i", "pipe:0", "-af", tempo, "-f", "f32le", "pipe:1")
    data = _through(source, np.concatenate([samples, pad]).astype("<f4").tobytes())
    heard = np.frombuffer(data, dtype="<f4").reshape(-1, 2)
    if lead < 0:
        heard = heard[round(-lead * RATE) :]
    out = np.zeros((count, 2), dtype=np.float32)
    part = heard[: count - lag]
    out[lag : lag + len(part)] = part
    return out


def _through(arguments: tuple[str, ...], data: bytes) -> bytes:
    """Pass `data` through ffmpeg and return the output; a thread writes, so that neither pipe can block the other."""
    from concurrent.futures import ThreadPoolExecutor

    with ffmpeg.Process(arguments, "changing the speed of the music", write=True, read=True) as process:
        with ThreadPoolExecutor(1) as pool:

            def feed() -> None:
                process.write(data)
                process.process.stdin.close()

            writing = pool.submit(feed)
            result = process.read()
            writing.result()
        process.finish()
    return result


def click_sound(pitch: float) -> NDArray[np.float32]:
    """Return a short dry click that starts at its onset."""
    t = np.arange(int(0.05 * RATE)) / RATE
    body = np.sin(2 * np.pi * pitch * t + 0.8) * np.exp(-t * 110)
    return body.astype(np.float32)


def mix(plan: SoundPlan, clock: Clock) -> Samples:
    """Return the whole sound track, as long as the frames of the film last; float32 (n, 2) within -1..1."""
    parts = [_pass(plan, one) for one in clock.passes]
    track = np.concatenate(parts) if len(parts) > 1 else parts[0]
    total = round(clock.frames / clock.fps * RATE)
    if len(track) < total:
        track = np.concatenate([track, np.zeros((total - len(track), 2), dtype=np.float32)])
    if plan.fade_out > 0:
        count = min(len(track), round(plan.fade_out * RATE))
        track[len(track) - count :] *= np.linspace(1, 0, count, dtype=np.float32)[:, None] ** 2
    peak = float(np.abs(track).max(initial=0.0))
    if peak > 1.0:
        track /= peak
    return track


def _pass(plan: SoundPlan, one: Pass) -> Samples:
    count = round(one.seconds * RATE)
    track = np.zeros((count, 2), dtype=np.float32)
    begin = max(one.start, one.sound_from)
    if plan.music is not None and begin < one.end:
        music = decode(plan.music, begin - plan.shift, one.end - plan.shift)
        if one.rate != 1.0:
            music = stretch(music, one.rate)
        edge = min(round(FADE * RATE), len(music))
        if begin > plan.shift:  # cut in the middle of the music
            music[:edge] *= np.linspace(0, 1, edge, dtype=np.float32)[:, None]
        at = round(one.film_seconds(begin) * RATE)
        music = music[: count - at]
        track[at : at + len(music)] += music * (0.8 if plan.clicks else 1.0)
    for click in plan.clicks:
        if one.start <= click.second < one.end:
            _add(track, click_sound(click.pitch) * click.gain, one.film_seconds(click.second))
    return track


def _add(track: Samples, sound: NDArray[np.float32], second: float) -> None:
    at = math.ceil(second * RATE)
    sound = sound[: len(track) - at]
    track[at : at + len(sound)] += sound[:, None]


def write_wav(samples: Samples, path: Path) -> None:
    """Write samples as 16 bit stereo at `RATE`."""
    with wave.open(str(path), "wb") as out:
        out.setnchannels(2)
        out.setsampwidth(2)
        out.setframerate(RATE)
        out.writeframes(np.rint(np.clip(samples, -1, 1) * 32767).astype("<i2").tobytes())


# Sounds in addition to the music: claps on steps, ticks on beats, and the count before each run.

CLAP, TICK, ACCENT = 1150.0, 1600.0, 2200.0  # Hz


def clicks_of(practice: Practice, one: Pass, timing: Timing, steps: NDArray[np.float64]) -> tuple[Click, ...]:
    """Return the sounds in addition to the music.

    practice : the aids that the user asked for; one : the first run
    steps : float64 (s,), seconds at which panels are pressed
    """
    out: list[Click] = []
    if practice.claps:
        out += [Click(float(second), CLAP, 0.55) for second in np.unique(steps)]
    if one.count:
        pulse = (one.sound_from - one.start) / one.count
        counted = range(one.count, 0, -1)
        out += [Click(one.sound_from - n * pulse, ACCENT if n % 4 == 0 else TICK, 0.4) for n in counted]
    if practice.metronome:
        span = timing.beats(np.array([max(one.start, one.sound_from), one.until]))
        beats = np.arange(math.ceil(span[0] - 1e-6), math.ceil(span[1] - 1e-6))
        seconds = timing.seconds_of_beats(beats.astype(np.float64))
        out += [Click(float(s), ACCENT if b % 4 == 0 else TICK, 0.4) for b, s in zip(beats, seconds, strict=True)]
    return tuple(out)
