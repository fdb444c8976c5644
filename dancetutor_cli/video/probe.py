"""Which encoders work here: each is tried with one frame, since a driver may be listed and still be missing."""

from __future__ import annotations

from dancetutor_cli.video import ffmpeg

_TRIES: dict[str, tuple[str, ...]] = {
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
        ffmpeg.run((*_TRIES.get(encoder, ()), *arguments, option, encoder, "-f", "null", "-"), f"trying {encoder}")
    except ffmpeg.EncoderError as error:
        return str(error).partition("): ")[2] or str(error)
    return None
