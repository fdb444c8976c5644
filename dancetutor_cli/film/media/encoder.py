"""The way from frames to files: choose an encoder, encode the segments, join them without loss and add the music."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np

from dancetutor_cli.film.choices import Quality
from dancetutor_cli.film.media.film_formats import FORMATS, PICTURES, FilmFormat, JoinJob
from dancetutor_cli.run import ffmpeg
from dancetutor_cli.run.errors import FileError, UnavailableError
from dancetutor_cli.run.pictures import picture_bytes

if TYPE_CHECKING:
    from dancetutor_cli.film.picture import Frame


# The encoders that work here. Each is tried with one frame, because an encoder may be listed without its driver.

# Options before the input with which an encoder finds its device.
DEVICE: dict[str, tuple[str, ...]] = {
    "h264_vaapi": ("-vaapi_device", "/dev/dri/renderD128"),
}
_BEFORE_ENCODER: dict[str, tuple[str, ...]] = {"h264_vaapi": ("-vf", "format=nv12,hwupload")}
_SOUND = ("aac",)


def works(encoder: str) -> str | None:
    """Return None if ffmpeg encodes a frame (or a moment of sound) with this encoder, otherwise the reason."""
    source = "anullsrc=d=0.1" if encoder in _SOUND else "color=size=256x144:duration=0.04:rate=25"
    arguments = ("-f", "lavfi", "-i", source, *_BEFORE_ENCODER.get(encoder, ()))
    option = "-c:a" if encoder in _SOUND else "-c:v"
    try:
        ffmpeg.run((*DEVICE.get(encoder, ()), *arguments, option, encoder, "-f", "null", "-"), f"trying {encoder}")
    except ffmpeg.EncoderError as error:
        return str(error).partition("): ")[2] or str(error)
    return None


def choose(wanted: str) -> Encoder:
    """Choose the encoder: "auto" takes NVENC if it works, otherwise x264.

    UnavailableError if the wanted encoder does not work.
    """
    if wanted == "x264":
        return "x264"
    if wanted == "auto":
        return "nvenc" if _has_cuda() and works("h264_nvenc") is None else "x264"
    name: Encoder = "nvenc" if wanted == "nvenc" else "vaapi"
    failure = works(f"h264_{name}")
    if failure is not None:
        raise UnavailableError(f"the encoder {wanted} does not work here: {failure}; use --encoder x264")
    return name


def _has_cuda() -> bool:
    """Whether NVIDIA's driver is there; this check avoids a call of ffmpeg, which takes a tenth of a second."""
    import ctypes

    for library in ("libcuda.so.1", "nvcuda.dll"):
        try:
            ctypes.CDLL(library)
        except OSError:
            continue
        return True
    return False


Encoder = Literal["x264", "nvenc", "vaapi"]

_CRF = {"draft": "26", "good": "20", "best": "16"}
_PRESET = {"draft": "ultrafast", "good": "veryfast", "best": "medium"}
# Changes to the preset: flat, sharp pictures gain nothing from the longer search and the larger transform.
_TUNED = {"good": ":subme=1:me=dia:8x8dct=0:b-adapt=0"}
# The tags of the colours of `yuv.yuv420`. Without tags, players guess by size, and reds are wrong.
_BT709 = ("-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv")
_TAGGED = "setparams=range=tv:color_primaries=bt709:color_trc=bt709:colorspace=bt709"


@dataclass(frozen=True, slots=True)
class Encoding:
    """The settings of the encoder. target : a key of `film_formats.FORMATS`; size : (width, height), even for H.264."""

    target: str
    size: tuple[int, int]
    fps: int
    quality: Quality = "good"
    encoder: Encoder = "x264"

    @property
    def format(self) -> FilmFormat:
        """The format of the target."""
        return FORMATS[self.target]

    def _codec(self) -> Sequence[str]:
        if self.format.h264:
            scale = ("-video_track_timescale", str(self.fps * 512))
            return (*_h264(self.encoder, self.quality, 4 * self.fps), *scale, *_BT709)
        return ("-c:v", "libx264rgb", "-preset", "ultrafast", "-qp", "0")


def _h264(encoder: Encoder, quality: Quality, group: int) -> Sequence[str]:
    """Return the filters and options of an H.264 encoder; group : the greatest distance of key frames, in frames."""
    if encoder == "nvenc":
        rate = ("-rc", "vbr", "-cq", _CRF[quality], "-b:v", "0", "-bf", "2", "-g", str(group))
        return ("-vf", _TAGGED, "-c:v", "h264_nvenc", "-preset", "p4", *rate)
    if encoder == "vaapi":
        upload = f"{_TAGGED},format=nv12,hwupload"
        return ("-vf", upload, "-c:v", "h264_vaapi", "-qp", _CRF[quality], "-bf", "0", "-g", str(group))
    level = ("-preset", _PRESET[quality], "-crf", _CRF[quality], "-bf", "2", "-g", str(group))
    return ("-vf", _TAGGED, "-c:v", "libx264", *level, "-x264-params", f"open-gop=0{_TUNED.get(quality, '')}")


def even_size(size: tuple[int, int]) -> tuple[int, int]:
    """Round a size up to even numbers, which H.264 needs."""
    return size[0] + size[0] % 2, size[1] + size[1] % 2


def encode_segment(frames: Iterable[Frame], encoding: Encoding, path: Path, first: int = 0) -> None:
    """Write frames, uint8 (h, w, 3), to one segment; or as pictures into the folder `path`, numbered from `first`.

    numba is imported only in this function, so that a mere description of an encoding does not import it.

    Raises EncoderError with ffmpeg's own words if ffmpeg fails, FileError if a picture cannot be written.
    """
    if encoding.target == PICTURES:
        path.mkdir(exist_ok=True)
        for number, frame in enumerate(frames, first):
            save_picture(frame, path / f"frame_{number:06d}.png")
        return
    from dancetutor_cli.film.media.yuv import yuv420

    width, height = encoding.size
    planes = encoding.format.h264
    pixels = "yuv420p" if planes else "rgb24"
    raw = ("-f", "rawvideo", "-pix_fmt", pixels, "-s", f"{width}x{height}", "-r", str(encoding.fps), "-i", "pipe:0")
    device = DEVICE.get("h264_vaapi", ()) if encoding.encoder == "vaapi" else ()
    arguments = ("-y", *device, *ffmpeg.INPUT_GUARD, *raw, "-an", *encoding._codec(), "-threads", "1")
    with ffmpeg.Process((*arguments, ffmpeg.local(path)), "encoding video", write=True) as process:
        spare = np.empty(width * height * 3 // 2, dtype=np.uint8)
        for frame in frames:
            process.write((yuv420(frame, spare) if planes else np.ascontiguousarray(frame)).data)
        process.finish()


def save_picture(frame: Frame, path: Path) -> None:
    """Write one frame as PNG."""

    try:
        path.write_bytes(picture_bytes(frame, compress_level=2))
    except OSError as error:
        raise FileError(path, f"cannot be written: {error.strerror or error}") from error


def join(segments: Sequence[Path], encoding: Encoding, sound: Path | None, work: Path, output: Path) -> None:
    """Make a film of its segments and its sound, a WAV file or None; work : a folder for temporary files."""
    listing = work / "segments.txt"
    lines = (f"file '{_quoted(segment)}'" for segment in segments)
    listing.write_text("\n".join(["ffconcat version 1.0", *lines]) + "\n", encoding="utf-8")
    assert encoding.format.join is not None, "pictures are not joined"
    encoding.format.join(
        JoinJob(listing, sound, work, output, encoding.size, encoding.fps, encoding.quality == "draft")
    )


def _quoted(path: Path) -> str:
    """Quote a path for ffmpeg's lists, for use inside single quotes."""
    return path.resolve().as_posix().replace("'", "'\\''")
