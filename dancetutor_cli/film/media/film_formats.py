"""The formats of films: for each suffix of a file, the encoding of the segments and the function that joins them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.run.errors import UsageError
from dancetutor_cli.run.ffmpeg import INPUT_GUARD, Process, local, run
from dancetutor_cli.run.files import one_of
from dancetutor_cli.run.pictures import read_palette, write_gif, write_webp

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
