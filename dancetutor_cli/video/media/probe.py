"""Which encoders work here: each is tried with one frame, since a driver may be listed and still be missing."""

from __future__ import annotations

from typing import TYPE_CHECKING

from dancetutor_cli.errors import UnavailableError
from dancetutor_cli.video.media import ffmpeg

if TYPE_CHECKING:
    from dancetutor_cli.video.media.encoder import Encoder

# What has to be said before the input for an encoder to find its device.
DEVICE: dict[str, tuple[str, ...]] = {
    "h264_vaapi": ("-vaapi_device", "/dev/dri/renderD128"),
}
_BEFORE_ENCODER: dict[str, tuple[str, ...]] = {"h264_vaapi": ("-vf", "format=nv12,hwupload")}
_SOUND = ("aac",)


def works(encoder: str) -> str | None:
    """None if ffmpeg encodes a frame (or a moment of sound) with it, else why not in one line."""
    source = "anullsrc=d=0.1" if encoder in _SOUND else "color=size=256x144:duration=0.04:rate=25"
    arguments = ("-f", "lavfi", "-i", source, *_BEFORE_ENCODER.get(encoder, ()))
    option = "-c:a" if encoder in _SOUND else "-c:v"
    try:
        ffmpeg.run((*DEVICE.get(encoder, ()), *arguments, option, encoder, "-f", "null", "-"), f"trying {encoder}")
    except ffmpeg.EncoderError as error:
        return str(error).partition("): ")[2] or str(error)
    return None


def choose(wanted: str) -> Encoder:
    """The encoder to use: "auto" takes NVENC where it works, else x264. UnavailableError if what is wanted does not."""
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
    """Whether NVIDIA's driver is there at all: asking ffmpeg costs a tenth of a second."""
    import ctypes

    for library in ("libcuda.so.1", "nvcuda.dll"):
        try:
            ctypes.CDLL(library)
        except OSError:
            continue
        return True
    return False
