"""Music files: heads against the decoder, clicks where the games hear them, and strangers' files."""

from __future__ import annotations

import os
import struct
import wave
from pathlib import Path

import numpy as np
import pytest

from dancetutor_cli.chart.audio import LONGEST, decode_music, read_head
from dancetutor_cli.run import ffmpeg
from dancetutor_cli.run.errors import DancetutorError, FileError

DEMO = Path(__file__).resolve().parent.parent.parent / "charts" / "two_left_feet" / "two_left_feet.ogg"
SECONDS, FIRST = 4.0, 1.25  # of the file; of its only click
ENCODINGS = {
    ".ogg": ("-c:a", "libvorbis", "-q:a", "5"),
    ".cbr.mp3": ("-c:a", "libmp3lame", "-b:a", "160k"),
    ".vbr.mp3": ("-c:a", "libmp3lame", "-q:a", "3"),
    ".bare.mp3": ("-c:a", "libmp3lame", "-b:a", "160k", "-write_xing", "0"),
    ".flac": ("-c:a", "flac"),
    ".opus": ("-c:a", "libopus"),
}
# Samples by which the games hear MP3 late (spec of the sync): LAME's delay; before it a first frame that says Info.
DELAY, FRAME = 1105, {44100: 1152, 48000: 1152, 22050: 576}


def click(path: Path, rate: int, channels: int = 1) -> Path:
    samples = np.zeros((round(SECONDS * rate), channels))
    body = np.random.default_rng(3).standard_normal(rate // 50) * np.exp(-np.arange(rate // 50) / rate / 0.004)
    samples[round(FIRST * rate) :][: len(body)] += 0.5 * body[:, None]
    with wave.open(str(path), "wb") as out:
        out.setnchannels(channels)
        out.setsampwidth(2)
        out.setframerate(rate)
        out.writeframes((np.clip(samples, -1, 1) * 32767).astype("<i2").tobytes())
    return path


def encoded(source: Path, kind: str) -> Path:
    if kind == ".wav":
        return source
    target = source.with_suffix(kind)
    ffmpeg.run(("-y", "-i", ffmpeg.local(source), *ENCODINGS[kind], ffmpeg.local(target)), "encoding")
    return target


def heard(path: Path) -> float:
    """Second at which the click is heard: the first sample that is a tenth of the loudest."""
    sound = decode_music(path, read_head(path))
    loud = np.abs(sound.samples)
    return float(sound.start + int((loud > 0.1 * loud.max()).argmax()) / sound.rate)


@pytest.mark.parametrize("rate", [44100, 48000, 22050])
@pytest.mark.parametrize("kind", [".wav", ".ogg", ".flac"])
def test_a_click_is_heard_where_it_is(tmp_path: Path, kind: str, rate: int) -> None:
    assert heard(encoded(click(tmp_path / "c.wav", rate), kind)) == pytest.approx(FIRST, abs=0.003)


@pytest.mark.parametrize("rate", [44100, 48000, 22050])
def test_mp3_is_late_as_the_games_play_it(tmp_path: Path, rate: int) -> None:
    source = click(tmp_path / "c.wav", rate)
    assert heard(encoded(source, ".vbr.mp3")) == pytest.approx(FIRST + DELAY / rate, abs=0.003)
    late = (DELAY + FRAME[rate]) / rate
    assert heard(encoded(source, ".cbr.mp3")) == pytest.approx(FIRST + late, abs=0.003)


@pytest.mark.parametrize("kind", [".wav", *ENCODINGS])
@pytest.mark.parametrize("channels", [1, 2])
def test_the_head_reports_what_a_decoder_finds(tmp_path: Path, kind: str, channels: int) -> None:
    path = encoded(click(tmp_path / "c.wav", 44100, channels), kind)
    head = read_head(path)
    assert head.kind == {".ogg": "vorbis", ".opus": "opus"}.get(kind, kind.rsplit(".", 1)[-1])
    assert (head.rate, head.channels) == (48000 if kind == ".opus" else 44100, channels)
    sound = decode_music(path, head)
    assert head.seconds == pytest.approx(sound.start + len(sound.samples) / sound.rate, abs=0.03)


# Names in `RageSoundReader_WAV::Open` of StepMania 5 and ITGmania: the format tags 1 to 3 are read, others refused.
EXTENSIBLE = "WAV with an extensible head"
WAVES = {
    "pcm_u8": "wav", "pcm_s16le": "wav", "pcm_f32le": "wav", "adpcm_ms": "wav", "pcm_alaw": "another codec in WAV",
    "pcm_s24le": EXTENSIBLE, "pcm_s32le": EXTENSIBLE, "pcm_f64le": "WAV of 64-bit floats",
}  # fmt: skip


@pytest.mark.parametrize("codec", WAVES)
def test_the_forms_of_wav_that_games_read(tmp_path: Path, codec: str) -> None:
    source, path = click(tmp_path / "c.wav", 44100), tmp_path / "other.wav"
    ffmpeg.run(("-y", "-i", ffmpeg.local(source), "-c:a", codec, ffmpeg.local(path)), "encoding")
    head = read_head(path)
    tag = struct.unpack_from("<H", path.read_bytes(), 20)[0]
    assert (head.kind == "wav") == (tag in (1, 2, 3) and codec != "pcm_f64le")
    assert head.kind == WAVES[codec]
    assert head.seconds == pytest.approx(SECONDS, abs=0.05)
    if WAVES[codec] == EXTENSIBLE:
        path.write_bytes(path.read_bytes()[:20] + b"\1\0" + path.read_bytes()[22:])
        assert read_head(path).kind == "wav"


def test_cut_music_is_as_long_as_what_is_left(tmp_path: Path) -> None:
    for kind in (".wav", ".cbr.mp3"):
        path = encoded(click(tmp_path / "c.wav", 44100), kind)
        half = path.with_name(f"half{kind}")
        half.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
        assert read_head(half).seconds == pytest.approx(SECONDS / 2, abs=0.15), kind


def test_tags_before_and_behind_mp3_are_no_music(tmp_path: Path) -> None:
    path = encoded(click(tmp_path / "c.wav", 44100), ".bare.mp3")
    tagged = path.with_name("tagged.mp3")
    picture = b"\xff\xfb\x90\x64" * 500  # looks like frames
    size = bytes((len(picture) >> 7 * place & 127) for place in (3, 2, 1, 0))
    tagged.write_bytes(b"ID3\x04\0\0" + size + picture + path.read_bytes() + b"TAG" + bytes(125))
    bare, found = read_head(path), read_head(tagged)
    assert bare.seconds is not None and found.seconds is not None
    assert found.seconds == pytest.approx(bare.seconds, abs=0.06)


def test_counting_frames_ends_in_what_are_none(tmp_path: Path) -> None:
    path = encoded(click(tmp_path / "c.wav", 44100), ".bare.mp3")
    bare = read_head(path).seconds
    path.write_bytes(path.read_bytes() + b"\xff" * 60_000_000)
    assert read_head(path).seconds == bare  # at once: a look at each byte would take a minute


def strangers() -> dict[str, bytes]:
    good, dice = DEMO.read_bytes(), np.random.default_rng(4)
    wav = b"RIFF\x24\0\0\0WAVEfmt " + struct.pack("<IHHIIHH", 16, 1, 1, 44100, 88200, 2, 16)
    data = b"data\xff\xff\0\0" + bytes(5000)
    return {
        "empty.ogg": b"",
        "short.ogg": good[:40],
        "page.ogg": good[:200],
        "some.ogg": good[:9000],
        "noise.ogg": dice.bytes(40_000),
        "noise.mp3": dice.bytes(40_000),
        "playlist.mp3": b"#EXTM3U\nhttp://x/y\n",
        "list.mp3": b"ffconcat version 1.0\nfile '/etc/hostname'\n",
        "frames.mp3": b"\xff\xfb" * 50_000,
        "tag.mp3": b"ID3\x04\0\0" + b"\x7f" * 4 + bytes(50),
        "riff.wav": b"RIFF",
        "long.wav": wav + b"data\xf0\xff\xff\xff" + bytes(5000),
        "rate.wav": wav[:24] + b"\xff" * 4 + wav[28:] + data,
        "channels.wav": wav[:22] + b"\xff\xff" + wav[24:] + data,
        "nothing.wav": wav[:22] + bytes(6) + wav[28:] + data,
        "flac.flac": b"fLaC" + b"\xff" * 60,
    }


@pytest.mark.parametrize("name", sorted(strangers()))
def test_strangers_files_are_one_line_or_little_music(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    path.write_bytes(strangers()[name])
    try:
        sound = decode_music(path, read_head(path))
    except DancetutorError as error:
        assert "\n" not in str(error)
    else:
        assert len(sound.samples) <= 10 * sound.rate and np.isfinite(sound.samples).all()


@pytest.mark.skipif(os.name == "nt", reason="no named pipes")
def test_a_pipe_and_a_folder_are_not_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.ogg")
    for path in (tmp_path / "pipe.ogg", tmp_path, tmp_path / "nothing.ogg"):
        with pytest.raises(FileError):
            read_head(path)


def test_what_is_decoded_is_bounded(tmp_path: Path) -> None:
    path = tmp_path / "long.wav"
    with wave.open(str(path), "wb") as out:
        out.setnchannels(1)
        out.setsampwidth(1)
        out.setframerate(8000)
        out.writeframes(bytes(8000 * (round(LONGEST) + 60)))
    head = read_head(path)
    assert head.seconds == pytest.approx(LONGEST + 60)
    sound = decode_music(path, head, seconds=LONGEST * 2)
    assert len(sound.samples) / sound.rate == pytest.approx(LONGEST, abs=0.01)
    assert len(decode_music(path, head, seconds=2.0).samples) / sound.rate == pytest.approx(2.0, abs=0.01)


def test_silence_and_clipping_are_counted(tmp_path: Path) -> None:
    path = tmp_path / "loud.wav"
    samples = np.concatenate([np.zeros(44100), np.full(44100, 32767), np.full(88200, 100)])
    with wave.open(str(path), "wb") as out:
        out.setnchannels(1)
        out.setsampwidth(2)
        out.setframerate(44100)
        out.writeframes(samples.astype("<i2").tobytes())
    sound = decode_music(path, read_head(path))
    assert sound.silence == pytest.approx(1.0, abs=0.001) and sound.clipped == pytest.approx(0.25, abs=0.001)
