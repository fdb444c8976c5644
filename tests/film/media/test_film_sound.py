"""The sound track: clicks stay where they belong through decoding, cutting, stretching and mixing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from click_track import write_clicks
from numpy.typing import NDArray

from dancetutor_cli.film.clock import Clock, Pass
from dancetutor_cli.film.media import sound
from dancetutor_cli.run import ffmpeg
from dancetutor_cli.run.errors import DancetutorError

CLICKS = np.arange(1, 16) * 0.5 + 0.0137


def onsets(samples: NDArray[np.float32], threshold: float = 0.4) -> NDArray[np.float64]:
    """Seconds at which the sound rises above a share of its peak, at most one per 0.2 s."""
    loud = np.flatnonzero(np.abs(samples[:, 0]) > threshold * np.abs(samples).max())
    first = loud[np.insert(np.diff(loud) > 0.2 * sound.RATE, 0, True)]
    return first / sound.RATE


@pytest.fixture(scope="module")
def clicks(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("sound") / "clicks.wav"
    write_clicks(path, CLICKS, 9.0, 44100, 1)
    return path


@pytest.mark.parametrize("codec", ["pcm_s16le/wav", "libvorbis/ogg", "libmp3lame/mp3", "flac/flac"])
def test_every_format_is_in_time(clicks: Path, tmp_path: Path, codec: str) -> None:
    name, suffix = codec.split("/")
    music = tmp_path / f"song.{suffix}"
    ffmpeg.run(("-i", str(clicks), "-c:a", name, str(music)), "making a test file")
    heard = onsets(sound.decode(music, 0.0, 8.5))
    assert len(heard) == len(CLICKS)
    assert np.abs(heard - CLICKS).max() < 0.0005  # MP3 encoders put 25 ms before the music: they must be gone


def test_before_the_music_there_is_silence(clicks: Path) -> None:
    samples = sound.decode(clicks, -1.5, 3.0)
    assert len(samples) == 4.5 * sound.RATE
    assert np.abs(onsets(samples)[:2] - 1.5 - CLICKS[:2]).max() < 0.0005


def test_after_the_music_there_is_silence(clicks: Path) -> None:
    samples = sound.decode(clicks, 8.0, 30.0)
    assert len(samples) == 22 * sound.RATE and not samples[2 * sound.RATE :].any()


@pytest.mark.parametrize("rate", [0.5, 0.75, 1.5])
def test_stretched_music_is_within_5_ms(clicks: Path, rate: float) -> None:
    heard = onsets(sound.stretch(sound.decode(clicks, 0.0, 8.5), rate), 0.5)
    assert len(heard) == len(CLICKS)
    assert np.abs(heard - CLICKS / rate).max() < 0.005


@pytest.mark.parametrize(("rate", "pitch"), [(0.5, 440), (0.75, 440), (0.6, 220), (1.25, 220)])
def test_stretching_keeps_the_pitch(rate: float, pitch: float) -> None:
    t = np.arange(6 * sound.RATE) / sound.RATE
    tone = np.repeat(np.sin(2 * np.pi * pitch * t)[:, None], 2, axis=1).astype(np.float32)
    heard = sound.stretch(tone, rate)[sound.RATE : 4 * sound.RATE, 0] * np.hanning(3 * sound.RATE)
    spectrum = np.abs(np.fft.rfft(heard, 16 * sound.RATE))
    peak = spectrum.argmax() / 16
    assert peak == pytest.approx(pitch, rel=0.0015)  # 2.6 cents; one hears 5


def test_the_track_follows_the_clock(clicks: Path) -> None:
    clock = Clock((Pass(-0.5, 2.0), Pass(1.0, 3.2)), 30)
    track = sound.mix(sound.SoundPlan(clicks), clock)
    assert len(track) == pytest.approx(clock.frames / 30 * sound.RATE, abs=1)
    first = CLICKS[CLICKS < 2.0] + 0.5
    second = CLICKS[(CLICKS > 1.0) & (CLICKS < 3.2)] - 1.0 + 2.5
    heard = onsets(track)
    assert len(heard) == len(first) + len(second)
    assert np.abs(heard - np.concatenate([first, second])).max() < 0.001


def test_sync_offset_plays_the_music_late(clicks: Path) -> None:
    clock = Clock((Pass(0.0, 3.0),), 30)
    plain = onsets(sound.mix(sound.SoundPlan(clicks), clock))
    late = onsets(sound.mix(sound.SoundPlan(clicks, shift=0.009), clock))
    assert late - plain == pytest.approx(0.009, abs=0.0003)


def test_clicks_of_our_own_are_on_time() -> None:
    plan = sound.SoundPlan(None, clicks=(sound.Click(1.0, 1000, 0.5), sound.Click(2.25, 1000, 0.5)))
    track = sound.mix(plan, Clock((Pass(0.5, 3.0, 0.5),), 30))
    assert onsets(track, 0.2) == pytest.approx([1.0, 3.5], abs=0.001)


def test_music_that_is_none_is_one_line(tmp_path: Path) -> None:
    fake = tmp_path / "song.ogg"
    fake.write_text("no music at all")
    with pytest.raises(DancetutorError, match=r"song\.ogg") as caught:
        sound.decode(fake, 0.0, 1.0)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "text",
    [
        "ffconcat version 1.0\nfile clicks.wav\n",
        "ffconcat version 1.0\nfile '{target}'\n",
        "#EXTM3U\n#EXT-X-TARGETDURATION:9\n#EXTINF:9,\n{target}\n#EXT-X-ENDLIST\n",
    ],
)
def test_a_playlist_named_as_music_opens_nothing_else(clicks: Path, tmp_path: Path, text: str) -> None:
    (tmp_path / "clicks.wav").write_bytes(clicks.read_bytes())
    playlist = tmp_path / "song.ogg"
    playlist.write_text(text.format(target=clicks))
    with pytest.raises(DancetutorError):
        sound.decode(playlist, 0.0, 2.0)
