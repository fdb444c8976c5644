"""A music file as the games play it: the data of its header, and its samples, decoded by ffmpeg."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import MEGABYTE, read_bytes, read_ends

# The data of a file's header: kind, sample rate, channels and length, found without decoding.

_HEAD, _TAIL = 65_536, 131_072  # bytes read from the start and the end of a file; an Ogg page has at most 65,307 bytes
_MP3_LIMIT = 256 * MEGABYTE  # limit of an MP3 file, which is read whole, because its frames are counted
_BITRATES = {  # kbit/s by the index in a frame's header, for (MPEG 1, layer) and (MPEG 2 and 2.5, layer)
    (True, 1): (0, 32, 64, 96, 128, 160, 192, 224, 256, 288, 320, 352, 384, 416, 448),
    (True, 2): (0, 32, 48, 56, 64, 80, 96, 112, 128, 160, 192, 224, 256, 320, 384),
    (True, 3): (0, 32, 40, 48, 56, 64, 80, 96, 112, 128, 160, 192, 224, 256, 320),
    (False, 1): (0, 32, 48, 56, 64, 80, 96, 112, 128, 144, 160, 176, 192, 224, 256),
    (False, 2): (0, 8, 16, 24, 32, 40, 48, 56, 64, 80, 96, 112, 128, 144, 160),
    (False, 3): (0, 8, 16, 24, 32, 40, 48, 56, 64, 80, 96, 112, 128, 144, 160),
}
_RATES = {3: (44100, 48000, 32000), 2: (22050, 24000, 16000), 0: (11025, 12000, 8000)}  # by the bits of the version
_MOST_GAPS = 1000  # limit of gaps between frames; a file with more gaps is read only up to the last one
_LEAST_FRAMES = 3  # consecutive frames that show that a file is MP3


@dataclass(frozen=True, slots=True)
class AudioHead:
    """The header of a music file. kind : "vorbis", "opus", "mp3", "wav", "flac" or another codec's name

    rate : samples per second; seconds : length as the games play it, None if the file does not have it
    lead : seconds of silence that the games play before the first decoded sample
    """

    kind: str
    rate: int
    channels: int
    seconds: float | None
    lead: float = 0.0


def read_head(path: Path) -> AudioHead:
    """Read the header of a music file of any name. Raises FileError if it is not music, is empty or cannot be read."""
    head, tail, size = read_ends(path, _HEAD, _TAIL)
    if not size:
        raise FileError(path, "is empty")
    try:
        found = _head_of(path, head, tail, size)
    except (struct.error, IndexError):
        found = None
    if found is None or found.rate <= 0 or found.channels <= 0:
        raise FileError(path, "cannot be read: it is not Ogg, MP3, WAV or FLAC, or it is damaged")
    return found


def _head_of(path: Path, head: bytes, tail: bytes, size: int) -> AudioHead | None:
    if head.startswith(b"OggS"):
        return _ogg(head, tail)
    if head[:4] in (b"RIFF", b"RF64") and head[8:12] == b"WAVE":
        return _wav(head, size)
    if head.startswith(b"fLaC"):
        return _flac(head[8:])
    return _mp3(read_bytes(path, _MP3_LIMIT))


def _ogg(head: bytes, tail: bytes) -> AudioHead | None:
    """Read the first packet of the first stream; the length is the position of the stream's last page."""
    packet = head[27 + head[26] :]
    serial = head[14:18]
    if packet.startswith(b"\x01vorbis"):
        kind, channels, rate, skipped = "vorbis", packet[11], struct.unpack_from("<I", packet, 12)[0], 0
    elif packet.startswith(b"OpusHead"):
        kind, channels, rate, skipped = "opus", packet[9], 48000, struct.unpack_from("<H", packet, 10)[0]
    elif packet.startswith(b"\x7fFLAC"):
        found = _flac(packet[17:])
        kind, channels, rate, skipped = "flac in Ogg", found.channels, found.rate, 0
    else:
        return AudioHead("another codec in Ogg", 1, 1, None)
    at, position = len(tail), -1
    while position < 0 and (at := tail.rfind(b"OggS", 0, at)) >= 0:
        if tail[at + 14 : at + 18] == serial and len(tail) >= at + 18:
            position = struct.unpack_from("<q", tail, at + 6)[0]
    seconds = None if position < 0 or rate == 0 else max(position - skipped, 0) / rate
    return AudioHead(kind, rate, channels, seconds)


_PCM, _ADPCM, _FLOAT, _EXTENSIBLE = 1, 2, 3, 0xFFFE


def _wav(head: bytes, size: int) -> AudioHead | None:
    at, form, frames = 12, None, 1
    while at + 8 <= len(head):
        name, length = head[at : at + 4], struct.unpack_from("<I", head, at + 4)[0]
        if name == b"fmt ":
            form = struct.unpack_from("<HHIIHH", head, at + 8)
            frames = struct.unpack_from("<H", head, at + 26)[0] if form[0] == _ADPCM else 1  # per block
        elif name == b"data" and form is not None:
            code, channels, rate, _, block, bits = form
            there = min(length, size - at - 8)
            seconds = there // block * frames / rate if block and rate else None
            return AudioHead(_kind_of_wav(code, bits), rate, channels, seconds)
        at += 8 + length + length % 2
    return None


def _kind_of_wav(code: int, bits: int) -> str:
    """Return "wav" for the formats that StepMania and ITGmania play: integers of 1 to 4 bytes, floats of 4 bytes,
    4-bit ADPCM. For other formats, return a description.
    """
    if code == _EXTENSIBLE:
        return "WAV with an extensible head"
    if (code == _PCM and 0 < bits <= 32) or (code == _FLOAT and bits == 32) or (code == _ADPCM and bits == 4):
        return "wav"
    return f"WAV of {bits}-bit floats" if code == _FLOAT else "another codec in WAV"


def _flac(block: bytes) -> AudioHead:
    """Read the STREAMINFO: 20 bits of rate, 3 of channels minus one, 5 of the depth, 36 of samples."""
    bits = int.from_bytes(block[10:18], "big")
    rate, channels, samples = bits >> 44, (bits >> 41 & 7) + 1, bits & (1 << 36) - 1
    return AudioHead("flac", rate, channels, samples / rate if samples and rate else None)


class _Frame(NamedTuple):
    """The header of an MP3 frame. length : bytes; samples : number of samples that the frame plays"""

    length: int
    samples: int
    rate: int
    channels: int
    side: int  # bytes between the header and the Xing or Info tag of a first frame without music


def _frame(data: bytes, at: int) -> _Frame | None:
    head = int.from_bytes(data[at : at + 4], "big")
    version, layer = head >> 19 & 3, 4 - (head >> 17 & 3)
    index, rate_index = head >> 12 & 15, head >> 10 & 3
    if head >> 21 != 0x7FF or version == 1 or layer == 4 or index in (0, 15) or rate_index == 3:
        return None
    first = version == 3
    rate, bits = _RATES[version][rate_index], _BITRATES[first, layer][index] * 1000
    padding, is_mono = head >> 9 & 1, head >> 6 & 3 == 3
    if layer == 1:
        return _Frame((12 * bits // rate + padding) * 4, 384, rate, 2 - is_mono, 0)
    samples = 1152 if first or layer == 2 else 576
    side = (17 if is_mono else 32) if first else (9 if is_mono else 17)
    return _Frame(samples // 8 * bits // rate + padding, samples, rate, 2 - is_mono, side)


def _mp3(data: bytes) -> AudioHead | None:
    """Count the frames one by one.

    The games skip a first frame with a Xing tag, and play one with an Info tag as silence.
    """
    at = _after_id3(data)
    start = next((n for n in range(at, min(at + _HEAD, len(data))) if _are_frames(data, n)), None)
    if start is None:
        return None
    first = _frame(data, start)
    assert first is not None
    word = data[start + 4 + first.side : start + 8 + first.side]
    samples, at, gaps = (-first.samples if word == b"Xing" else 0), start, 0
    while at + 4 <= len(data):
        frame = _frame(data, at)
        if frame is None or frame.length < 4:
            at, gaps = data.find(b"\xff", at + 1), gaps + 1
            if at < 0 or gaps > _MOST_GAPS:
                break
            continue
        if at + frame.length <= len(data):
            samples += frame.samples
        at += frame.length
    lead = first.samples / first.rate if word == b"Info" else 0.0
    return AudioHead("mp3", first.rate, first.channels, max(samples, 0) / first.rate, lead)


def _after_id3(data: bytes) -> int:
    at = 0
    while data[at : at + 3] == b"ID3" and len(data) > at + 10:
        a, b, c, d = data[at + 6 : at + 10]
        at += 10 + ((a & 127) << 21 | (b & 127) << 14 | (c & 127) << 7 | d & 127)
    return at


def _are_frames(data: bytes, at: int) -> bool:
    for _ in range(_LEAST_FRAMES):
        frame = _frame(data, at)
        if frame is None:
            return False
        at += frame.length
        if at == len(data):
            return True
    return True


LONGEST = 900.0  # seconds; later music is not decoded
_NATIVE = (44100, 48000)  # Hz; music with another rate is resampled to the first of these
_HALVED = 2  # samples that are averaged into one of a `Sound`, because half the rate is enough for onsets
_FULL = 32767
_READ = 1 << 22  # bytes read from ffmpeg at once
_HEARD = 0.001  # share of full scale below which music is silent


@dataclass(frozen=True, slots=True)
class Sound:
    """Music with its channels mixed. samples : float32 (n,), within -1..1; rate : samples per second

    start : second at which the first sample is heard; clipped : share of the file's own samples that are at full scale
    """

    samples: NDArray[np.float32]
    rate: int
    start: float = 0.0
    clipped: float = 0.0

    @property
    def silence(self) -> float:
        """The seconds before the first audible sample; the whole length if all samples are silent."""
        loud = np.abs(self.samples) > _HEARD
        first = int(loud.argmax()) if loud.any() else len(loud)
        return self.start + first / self.rate


def decode_music(path: Path, head: AudioHead, seconds: float = LONGEST) -> Sound:
    """Decode the first `seconds` of a music file, at most `LONGEST`. Raises EncoderError if ffmpeg fails.

    ffmpeg would remove the samples by which MP3 encoders delay their music; `skip_manual` keeps them, as the games do.
    A first frame with an Info tag is silence in the games, but ffmpeg drops it, so the start is later.
    """
    from dancetutor_cli.run import ffmpeg

    rate, channels = head.rate if head.rate in _NATIVE else _NATIVE[0], min(head.channels, 2)
    as_it_is = ("-flags2", "+skip_manual") if head.kind == "mp3" else ()
    source = ffmpeg.music_input(path, "-threads", "1", *as_it_is)
    form = ("-map", "0:a:0", "-t", f"{min(seconds, LONGEST):g}", "-ac", str(channels), "-ar", str(rate), "-f", "s16le",
            "-c:a", "pcm_s16le", "pipe:1")  # fmt: skip
    parts, full, count = [], 0, 0
    with ffmpeg.Process((*source, *form), f"reading {path.name}", read=True) as process:
        while data := process.read(_READ):
            wave = np.frombuffer(data, "<i2", len(data) // 2 // channels // _HALVED * channels * _HALVED)
            full += int(np.count_nonzero(wave == _FULL) + np.count_nonzero(wave <= -_FULL))
            count += len(wave)
            parts.append(wave.reshape(-1, _HALVED * channels).mean(axis=1, dtype=np.float32) / np.float32(_FULL))
        process.finish()
    samples = np.concatenate(parts) if parts else np.zeros(0, np.float32)
    return Sound(samples, rate // _HALVED, head.lead, full / count if count else 0.0)
