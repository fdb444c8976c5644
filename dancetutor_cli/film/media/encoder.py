"""The way from frames to files: formats by suffix, encoders that work here, segments, and how they are joined."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.film.choices import Quality
from dancetutor_cli.run import ffmpeg
from dancetutor_cli.run.errors import FileError, UnavailableError, UsageError
from dancetutor_cli.run.ffmpeg import INPUT_GUARD, Process, local, run
from dancetutor_cli.run.files import one_of
from dancetutor_cli.run.pictures import picture_bytes, read_palette, write_gif, write_webp

if TYPE_CHECKING:
    from dancetutor_cli.film.picture import Frame


# The formats of `render`.
#
# To add a format, add an entry to `FORMATS` with a function that joins segments; options and defaults follow from it.


class JoinJob(NamedTuple):
    """The parts from which a film is joined. listing : a list of segments for ffmpeg; sound : a WAV file or None

    work : folder for temporary files; output : the film's file
    size : (width, height); fps : frames a second
    quick : faster sound encoding, with a little noise, in a third of the time
    """

    listing: Path
    sound: Path | None
    work: Path
    output: Path
    size: tuple[int, int]
    fps: int
    quick: bool = False

    @property
    def source(self) -> tuple[str, ...]:
        """The options of ffmpeg for the pictures."""
        return (*INPUT_GUARD, "-f", "concat", "-safe", "0", "-i", local(self.listing))


@dataclass(frozen=True, slots=True)
class FilmFormat:
    """A kind of film.

    join : makes the film of its segments; None for pictures in a folder, which are not joined
    segment : suffix of a segment's file
    h264 : whether segments are H.264, with even sizes and the colours that players expect; otherwise RGB without loss
    fps : default number of frames a second; side : greatest default length of the longer side, pixels
    largest : seconds of film from which a warning says that the file is very large
    """

    join: Callable[[JoinJob], None] | None
    segment: str
    h264: bool = False
    has_sound: bool = False
    fps: int = 30
    side: float = math.inf
    largest: float = math.inf


def _mp4(parts: JoinJob) -> None:
    sound = () if parts.sound is None else (*INPUT_GUARD, "-i", local(parts.sound))
    coder = ("-aac_coder", "fast") if parts.quick else ()
    codec = ("-c:v", "copy", "-c:a", "aac", *coder, "-b:a", "192k", "-threads", "1")
    tidy = ("-map_metadata", "-1", "-fflags", "+bitexact", "-movflags", "+faststart", "-f", "mp4")
    run(("-y", *parts.source, *sound, *codec, *tidy, local(parts.output)), "writing the film")


def _gif(parts: JoinJob) -> None:
    """Write a GIF: ffmpeg chooses the colours and dithers, `pictures` writes the file."""
    palette = parts.work / "palette.png"
    run(("-y", *parts.source, "-vf", "palettegen=stats_mode=diff", local(palette)), "choosing colours")
    mix = "[0:v][1:v]paletteuse=dither=bayer:bayer_scale=4:diff_mode=rectangle"
    images = (*parts.source, "-i", local(palette), "-lavfi", mix)
    colors = read_palette(palette)
    write_gif(parts.output, _frames(parts, images, "pal8"), colors, parts.fps)


def _webp(parts: JoinJob) -> None:
    listed = ("-map", "0:v", "-c", "copy", "-f", "framecrc", "pipe:1")  # one line for each frame, below lines with a #
    with Process((*parts.source, *listed), "counting frames", read=True) as process:
        count = sum(not line.startswith(b"#") for line in process.read().splitlines())
        process.finish()
    write_webp(parts.output, _frames(parts, parts.source, "rgb24"), count, parts.fps)


def _frames(parts: JoinJob, images: tuple[str, ...], pixels: str) -> Iterator[NDArray[np.uint8]]:
    """Read the segments through ffmpeg, frame by frame."""
    width, height = parts.size
    shape = (height, width) if pixels == "pal8" else (height, width, 3)
    raw = ("-fps_mode", "passthrough", "-f", "rawvideo", "-pix_fmt", pixels, "pipe:1")
    with Process((*images, *raw), "reading the segments", read=True) as process:
        size = math.prod(shape) + (1024 if pixels == "pal8" else 0)  # the palette follows each frame
        while len(data := process.read(size)) == size:
            yield np.frombuffer(data, np.uint8, math.prod(shape)).reshape(shape)
        process.finish()


PICTURES = "png"  # not a single file but a folder of pictures
FORMATS: Mapping[str, FilmFormat] = {
    "mp4": FilmFormat(_mp4, ".mp4", h264=True, has_sound=True),
    "gif": FilmFormat(_gif, ".mkv", fps=25, side=720, largest=20.0),
    "webp": FilmFormat(_webp, ".mkv", fps=25, side=720, largest=20.0),
    PICTURES: FilmFormat(None, ""),
}
FILES = tuple(f".{name}" for name, form in FORMATS.items() if form.join is not None)


def target_of(path: Path) -> str:
    """Return the format of an output name by its ending; UsageError lists the formats."""
    if path.suffix.lower() not in FILES:
        raise UsageError(f"{path}: the name must end in {one_of(FILES)}")
    return path.suffix.lower().removeprefix(".")


# The encoders that work here. Each is tried with one frame, because an encoder may be listed without its driver.

# Options before the input with which an encoder finds its device.
DEVICE: dict[str, tuple[str, ...]] = {
    "h264_vaapi": ("-vaapi_device", "/dev/dri/renderD128"),
}
_BEFORE_ENCODER: dict[str, tuple[str, ...]] = {"h264_vaapi": ("-vf", "format=nv12,hwupload")}
_SOUND = ("aac",)


def encoder_problem(encoder: str) -> str | None:
    """Return None if ffmpeg encodes a frame (or a moment of sound) with this encoder, otherwise the reason."""
    source = "anullsrc=d=0.1" if encoder in _SOUND else "color=size=256x144:duration=0.04:rate=25"
    arguments = ("-f", "lavfi", "-i", source, *_BEFORE_ENCODER.get(encoder, ()))
    option = "-c:a" if encoder in _SOUND else "-c:v"
    try:
        ffmpeg.run((*DEVICE.get(encoder, ()), *arguments, option, encoder, "-f", "null", "-"), f"trying {encoder}")
    except ffmpeg.EncoderError as error:
        return str(error).partition("): ")[2] or str(error)
    return None


def choose_encoder(wanted: str) -> Encoder:
    """Choose the encoder: "auto" takes NVENC if it works, otherwise x264.

    UnavailableError if the wanted encoder does not work.
    """
    if wanted == "x264":
        return "x264"
    if wanted == "auto":
        return "nvenc" if _has_cuda() and encoder_problem("h264_nvenc") is None else "x264"
    name: Encoder = "nvenc" if wanted == "nvenc" else "vaapi"
    failure = encoder_problem(f"h264_{name}")
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
    """The settings of the encoder. target : a key of `FORMATS`; size : (width, height), even for H.264."""

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


def join_segments(segments: Sequence[Path], encoding: Encoding, sound: Path | None, work: Path, output: Path) -> None:
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
