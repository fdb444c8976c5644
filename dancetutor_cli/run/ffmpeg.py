"""How ffmpeg is found and run: messages go to a file, failures are one line, and no file name can become an option."""

from __future__ import annotations

import json
import os
import re
import subprocess
import tempfile
from collections.abc import Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path
from types import TracebackType
from typing import IO

from dancetutor_cli.run.errors import DancetutorError, UnavailableError, install_command
from dancetutor_cli.run.reading import MEGABYTE, read_json
from dancetutor_cli.run.stored_files import StoredFiles
from dancetutor_cli.run.trust import kept_folder, programs

# The choice of ffmpeg: the system's if it has everything that films need, else the one in the package imageio-ffmpeg.
#
# `IMAGEIO_FFMPEG_EXE` names another one. The abilities of the system's ffmpeg are cached until its file changes.
# Relative folders in PATH are skipped, because a pack of songs may contain a program called ffmpeg.

VARIABLE = "IMAGEIO_FFMPEG_EXE"
NAME = "ffmpeg.exe" if os.name == "nt" else "ffmpeg"
ENCODERS = ("libx264", "libx264rgb", "aac")
FILTERS = ("rubberband", "palettegen", "paletteuse")
MEND = f"Debian/Ubuntu: apt-get install ffmpeg; or {install_command('ffmpeg')}"
_PATIENCE = 20.0  # seconds for an answer


def executable() -> str:
    """Return the path of the ffmpeg to run. Raises UnavailableError if there is none."""
    return _find_executable(os.environ.get(VARIABLE), os.environ.get("PATH", os.defpath))


@cache
def _find_executable(named: str | None, path: str) -> str:
    if named:
        return named
    systems = list(programs(NAME, path))
    for program in systems:
        if not missing_abilities(program):
            return str(program)
    with suppress(ImportError, RuntimeError):
        import imageio_ffmpeg

        return str(imageio_ffmpeg.get_ffmpeg_exe())
    if systems:
        return str(systems[0])  # ffmpeg itself reports what it cannot do
    raise UnavailableError(f"no ffmpeg found; {MEND}")


def missing_abilities(program: Path) -> list[str]:
    """Return the names of the encoders and filters for films that an ffmpeg does not have; cached for the user."""
    kept, key = _capability_file(), _fingerprint(program)
    with suppress(DancetutorError):
        found = read_json(kept, MEGABYTE) if kept else None
        if isinstance(found, dict) and found.get("key") == key and isinstance(found.get("lacking"), list):
            return [str(name) for name in found["lacking"]]
    missing = _ask(program)
    if kept is not None:
        StoredFiles(kept.parent).write(kept.name, json.dumps({"key": key, "lacking": missing}).encode())
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
    """Return the names in ffmpeg's table of encoders or filters (each line has flags, a name and a description)."""
    command = [str(program), "-nostdin", "-hide_banner", option]
    try:
        done = subprocess.run(
            command, stdin=subprocess.DEVNULL, capture_output=True, timeout=_PATIENCE, encoding="utf-8",
            errors="replace", check=False,
        )  # fmt: skip
    except (OSError, subprocess.SubprocessError):
        return set()
    return {words[1] for words in map(str.split, done.stdout.splitlines()) if len(words) > 1}


# Only local files and pipes are opened, whatever the content or the name of a file.
INPUT_GUARD = ("-protocol_whitelist", "file,pipe")
# The formats of music, whatever the file's name: a disguised playlist would make ffmpeg open other files.
_MUSIC_ONLY = ("-format_whitelist", "ogg,mp3,wav,w64,flac,aiff")
PIPE = 1 << 20  # size of a pipe to ffmpeg, bytes
_START = ("-nostdin", "-hide_banner", "-loglevel", "error")


def music_input(path: Path, *options: str) -> tuple[str, ...]:
    """Return ffmpeg's arguments for reading a music file. options : arguments before the file's name"""
    return (*INPUT_GUARD, *_MUSIC_ONLY, *options, "-i", local(path))


class EncoderError(UnavailableError):
    """ffmpeg ended before its work was done; the message has ffmpeg's last message."""


def local(path: Path) -> str:
    """Return a path in a form in which ffmpeg cannot mistake the name for a protocol or an option."""
    return f"file:{path.resolve()}"


def _options() -> dict[str, object]:
    """Return options that keep Ctrl-C from reaching ffmpeg, because the program decides when its children end."""
    if os.name == "nt":
        return {"creationflags": getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0) | 0x08000000}  # no window
    return {"start_new_session": True}


def _widen(pipe: IO[bytes]) -> None:
    """Enlarge a pipe if the system allows it, so that both ends wait less often for each other."""
    with suppress(ImportError, AttributeError, OSError):
        import fcntl

        fcntl.fcntl(pipe, fcntl.F_SETPIPE_SZ, PIPE)  # type: ignore[attr-defined,unused-ignore]


def _last_words(log: IO[bytes]) -> str:
    log.seek(0)
    lines = [line.strip() for line in log.read().decode("utf-8", "replace").splitlines() if line.strip()]
    lines = [re.sub(r"\[[^\]]*\]\s*", "", line) for line in lines]
    telling = [line for line in lines if "No space left" in line or "Permission denied" in line]
    if telling or not lines:
        return telling[0] if telling else "it printed no message"
    return lines[0] if lines[0] == lines[-1] else f"{lines[0]}; {lines[-1]}"  # the cause and its consequence


class Process:
    """A running ffmpeg whose input or output is a pipe to this program. Use it as a context manager."""

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
        """Write bytes to ffmpeg. Raises EncoderError with ffmpeg's message if it has died."""
        try:
            self.process.stdin.write(data)
        except (BrokenPipeError, OSError) as error:
            raise self._failure() from error

    def read(self, size: int = -1) -> bytes:
        """Return the next `size` bytes of ffmpeg's output, fewer only at its end; by default all of it."""
        data: bytes = self.process.stdout.read(size)
        return data

    def finish(self) -> None:
        """Wait for the end of ffmpeg. Raises EncoderError if it failed."""
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
                with suppress(OSError):  # unflushed data has no reader any more
                    pipe.close()
        self.log.close()


def run(arguments: Sequence[str], what: str) -> None:
    """Run ffmpeg to its end. Raises EncoderError with ffmpeg's message if it fails."""
    with Process(arguments, what) as process:
        process.finish()
