"""Running ffmpeg: messages in a file, failures in one line; from the suffix of a file to how it is encoded."""

from __future__ import annotations

import contextlib
import json
import math
import os
import re
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import TracebackType
from typing import IO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.run.errors import DancetutorError, UnavailableError, UsageError, install_command
from dancetutor_cli.run.files import one_of, write_atomic
from dancetutor_cli.run.pictures import read_palette, write_gif, write_webp
from dancetutor_cli.run.reading import MEGABYTE, read_json
from dancetutor_cli.run.trust import kept_folder, programs

# Which ffmpeg is run: the system's where it can all that films need, else the one of the package imageio-ffmpeg.
#
# `IMAGEIO_FFMPEG_EXE` names another one. What the system's can is asked once and kept in the user's cache, until the
# file changes. A folder of PATH that is not absolute is passed over: a pack of songs may hold a program called ffmpeg,
# too.

VARIABLE = "IMAGEIO_FFMPEG_EXE"
NAME = "ffmpeg.exe" if os.name == "nt" else "ffmpeg"
ENCODERS = ("libx264", "libx264rgb", "aac")
FILTERS = ("rubberband", "palettegen", "paletteuse")
MEND = f"Debian/Ubuntu: apt-get install ffmpeg; or {install_command('ffmpeg')}"
_PATIENCE = 20.0  # seconds for an answer


def ffmpeg_program() -> str:
    """Path of the ffmpeg to run. Raises UnavailableError, one line, if there is none."""
    return _find_executable(os.environ.get(VARIABLE), os.environ.get("PATH", os.defpath))


@cache
def _find_executable(named: str | None, path: str) -> str:
    if named:
        return named
    systems = list(programs(NAME, path))
    for program in systems:
        if not lacking(program):
            return str(program)
    with suppress(ImportError, RuntimeError):
        import imageio_ffmpeg

        return str(imageio_ffmpeg.get_ffmpeg_exe())
    if systems:
        return str(systems[0])  # better than none: what it cannot do, it says itself
    raise UnavailableError(f"no ffmpeg found; {MEND}")


def lacking(program: Path) -> list[str]:
    """What films need and an ffmpeg cannot: names of encoders and filters; kept in the user's cache."""
    kept, key = _capability_file(), _fingerprint(program)
    with suppress(DancetutorError):
        found = read_json(kept, MEGABYTE) if kept else None
        if isinstance(found, dict) and found.get("key") == key and isinstance(found.get("lacking"), list):
            return [str(name) for name in found["lacking"]]
    missing = _ask(program)
    if kept is not None:
        with suppress(DancetutorError, OSError):
            write_atomic(kept, json.dumps({"key": key, "lacking": missing}).encode())
    return missing


def _capability_file() -> Path | None:
    folder = kept_folder("programs")
    return None if folder is None else folder / "ffmpeg.json"


def _fingerprint(program: Path) -> list[object]:
    status = program.stat()
    return [str(program.resolve()), status.st_size, status.st_mtime_ns, *ENCODERS, *FILTERS]


def _ask(program: Path) -> list[str]:
    return [
        name
        for option, names in (("-encoders", ENCODERS), ("-filters", FILTERS))
        for listed in [_listed(program, option)]
        for name in names
        if name not in listed
    ]


def _listed(program: Path, option: str) -> set[str]:
    """The names in ffmpeg's table of encoders or filters: flags, the name, what it is."""
    command = [str(program), "-nostdin", "-hide_banner", option]
    try:
        done = subprocess.run(
            command, stdin=subprocess.DEVNULL, capture_output=True, timeout=_PATIENCE, encoding="utf-8",
            errors="replace", check=False,
        )  # fmt: skip
    except (OSError, subprocess.SubprocessError):
        return set()
    return {words[1] for words in map(str.split, done.stdout.splitlines()) if len(words) > 1}


# Running ffmpeg: its messages go to a file, its failures become one line, nothing from a chart becomes an option.

# Only local files and pipes, whatever a file's content or name asks for.
INPUT_GUARD = ("-protocol_whitelist", "file,pipe")
PIPE = 1 << 20  # bytes that a pipe to ffmpeg shall hold
_START = ("-nostdin", "-hide_banner", "-loglevel", "error")


class EncoderError(UnavailableError):
    """ffmpeg ended before its work was done; carries its own last message."""


def executable() -> str:
    """Path of the ffmpeg that is run; UnavailableError if there is none."""
    return ffmpeg_program()


def local(path: Path) -> str:
    """A path as ffmpeg takes it without reading a protocol or an option out of the name."""
    return f"file:{path.resolve()}"


def _options() -> dict[str, object]:
    """Keep Ctrl-C from reaching ffmpeg: the program decides when its children end."""
    if os.name == "nt":
        return {"creationflags": getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0) | 0x08000000}  # no window
    return {"start_new_session": True}


def _widen(pipe: IO[bytes]) -> None:
    """Let a pipe hold more, where the system allows it: both ends wait less often for each other."""
    with contextlib.suppress(ImportError, AttributeError, OSError):
        import fcntl

        fcntl.fcntl(pipe, fcntl.F_SETPIPE_SZ, PIPE)  # type: ignore[attr-defined,unused-ignore]


def _last_words(log: IO[bytes]) -> str:
    log.seek(0)
    lines = [line.strip() for line in log.read().decode("utf-8", "replace").splitlines() if line.strip()]
    lines = [re.sub(r"\[[^\]]*\]\s*", "", line) for line in lines]
    telling = [line for line in lines if "No space left" in line or "Permission denied" in line]
    if telling or not lines:
        return telling[0] if telling else "it gave no message"
    return lines[0] if lines[0] == lines[-1] else f"{lines[0]}; {lines[-1]}"  # the cause, and what came of it


class Process:
    """An ffmpeg that reads its input from us, or writes its output to us. Use as a context manager."""

    def __init__(self, arguments: Sequence[str], what: str, write: bool = False, read: bool = False) -> None:
        self.what = what
        self.log = tempfile.TemporaryFile()  # noqa: SIM115  (closed in __exit__; a pipe could fill up and deadlock)
        command = [executable(), *_START, *arguments]
        try:
            self.process = subprocess.Popen(  # type: ignore[call-overload]
                command,
                stdin=subprocess.PIPE if write else subprocess.DEVNULL,
                stdout=subprocess.PIPE if read else subprocess.DEVNULL,
                stderr=self.log,
                **_options(),
            )
        except OSError as error:
            self.log.close()
            raise EncoderError(f"ffmpeg cannot be started ({error.strerror}): {command[0]}") from error
        if write:
            _widen(self.process.stdin)

    def write(self, data: object) -> None:
        """Give ffmpeg bytes; EncoderError with its own message if it has died."""
        try:
            self.process.stdin.write(data)
        except (BrokenPipeError, OSError) as error:
            raise self._failure() from error

    def read(self, size: int = -1) -> bytes:
        """Everything ffmpeg writes, or the next so many bytes of it; fewer only at its end."""
        data: bytes = self.process.stdout.read(size)
        return data

    def finish(self) -> None:
        """Wait for the end; EncoderError if it was not a good one."""
        try:
            if self.process.stdin is not None:
                self.process.stdin.close()
        except OSError as error:
            raise self._failure() from error
        if self.process.wait() != 0:
            raise self._failure()

    def _failure(self) -> EncoderError:
        self.process.kill()
        status = self.process.wait()
        words = _last_words(self.log)
        return EncoderError(f"ffmpeg failed while {self.what} (status {status}): {words}")

    def __enter__(self) -> Process:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        for pipe in (self.process.stdin, self.process.stdout):
            if pipe is not None:
                with contextlib.suppress(OSError):  # what it still wanted to flush has no reader any more
                    pipe.close()
        self.log.close()


def run(arguments: Sequence[str], what: str) -> None:
    """Run ffmpeg to its end; EncoderError with its own message if it fails."""
    with Process(arguments, what) as process:
        process.finish()


def bare_start() -> None:
    """Check that ffmpeg starts at all; raises otherwise."""
    run(["-version"], "starting")


# The formats of `render`: from the suffix of a file to how its pictures are encoded and joined.
#
# A new format is an entry of `FORMATS` with a function that joins segments; options and defaults follow.


class JoinJob(NamedTuple):
    """What a film is joined of. listing : a list of segments for ffmpeg; sound : a WAV file or None

    work : folder for what that needs; output : the film, of `size` (width, height) and so many frames a second
    quick : a little noise in the sound for a third of the time
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
        """ffmpeg's options for the pictures."""
        return (*INPUT_GUARD, "-f", "concat", "-safe", "0", "-i", local(self.listing))


@dataclass(frozen=True, slots=True)
class FilmFormat:
    """A kind of film.

    join : makes the film of its segments; None: there is nothing to join, pictures lie in a folder
    segment : suffix of a segment's file
    h264 : segments are H.264 with colours as players want them, sizes even; else without loss, RGB, until joined
    fps : frames a second unless something else is asked for; side : so long is the longer side then at most, pixels
    largest : seconds of film after which the file is said to be very large
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
    """ffmpeg chooses the colours and dithers, `pictures` writes."""
    palette = parts.work / "palette.png"
    run(("-y", *parts.source, "-vf", "palettegen=stats_mode=diff", local(palette)), "choosing colours")
    mix = "[0:v][1:v]paletteuse=dither=bayer:bayer_scale=4:diff_mode=rectangle"
    images = (*parts.source, "-i", local(palette), "-lavfi", mix)
    colors = read_palette(palette)
    write_gif(parts.output, _frames(parts, images, "pal8"), colors, parts.fps)


def _webp(parts: JoinJob) -> None:
    listed = ("-map", "0:v", "-c", "copy", "-f", "framecrc", "pipe:1")  # a line for each frame, below lines with a #
    with Process((*parts.source, *listed), "counting frames", read=True) as process:
        count = sum(not line.startswith(b"#") for line in process.read().splitlines())
        process.finish()
    write_webp(parts.output, _frames(parts, parts.source, "rgb24"), count, parts.fps)


def _frames(parts: JoinJob, images: tuple[str, ...], pixels: str) -> Iterator[NDArray[np.uint8]]:
    """What ffmpeg makes of the segments, frame by frame."""
    width, height = parts.size
    shape = (height, width) if pixels == "pal8" else (height, width, 3)
    raw = ("-fps_mode", "passthrough", "-f", "rawvideo", "-pix_fmt", pixels, "pipe:1")
    with Process((*images, *raw), "reading the segments", read=True) as process:
        size = math.prod(shape) + (1024 if pixels == "pal8" else 0)  # the palette follows each frame
        while len(data := process.read(size)) == size:
            yield np.frombuffer(data, np.uint8, math.prod(shape)).reshape(shape)
        process.finish()


PICTURES = "png"  # not a file but a folder of them
FORMATS: Mapping[str, FilmFormat] = {
    "mp4": FilmFormat(_mp4, ".mp4", h264=True, has_sound=True),
    "gif": FilmFormat(_gif, ".mkv", fps=25, side=720, largest=20.0),
    "webp": FilmFormat(_webp, ".mkv", fps=25, side=720, largest=20.0),
    PICTURES: FilmFormat(None, ""),
}
FILES = tuple(f".{name}" for name, form in FORMATS.items() if form.join is not None)


def target_of(path: Path) -> str:
    """The format that the name of an output file asks for; UsageError lists what there is."""
    if path.suffix.lower() not in FILES:
        raise UsageError(f"{path}: cannot write '{path.suffix or path.name}'; give a name that ends in {one_of(FILES)}")
    return path.suffix.lower().removeprefix(".")
