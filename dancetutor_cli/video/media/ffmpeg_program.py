"""Which ffmpeg is run: the system's where it can all that films need, else the one of the package imageio-ffmpeg.

`IMAGEIO_FFMPEG_EXE` names another one. What the system's can is asked once and kept in the user's cache, until the file
changes. A folder of PATH that is not absolute is passed over: a pack of songs may hold a program called ffmpeg, too.
"""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path

from dancetutor_cli.bounded import MEGABYTE, read_json
from dancetutor_cli.errors import DancetutorError, UnavailableError
from dancetutor_cli.extras import how_to_add
from dancetutor_cli.files import write_atomic
from dancetutor_cli.run.trust import kept_folder

VARIABLE = "IMAGEIO_FFMPEG_EXE"
NAME = "ffmpeg.exe" if os.name == "nt" else "ffmpeg"
ENCODERS = ("libx264", "libx264rgb", "aac")
FILTERS = ("rubberband", "palettegen", "paletteuse")
MEND = f"Debian/Ubuntu: apt-get install ffmpeg; or {how_to_add('ffmpeg')}"
_PATIENCE = 20.0  # seconds for an answer


def ffmpeg_program() -> str:
    """Path of the ffmpeg to run. Raises UnavailableError, one line, if there is none."""
    return _chosen(os.environ.get(VARIABLE), os.environ.get("PATH", os.defpath))


@cache
def _chosen(named: str | None, path: str) -> str:
    if named:
        return named
    systems = list(on_path(path))
    for program in systems:
        if not lacking(program):
            return str(program)
    with suppress(ImportError, RuntimeError):
        import imageio_ffmpeg

        return str(imageio_ffmpeg.get_ffmpeg_exe())
    if systems:
        return str(systems[0])  # better than none: what it cannot do, it says itself
    raise UnavailableError(f"no ffmpeg found; {MEND}")


def on_path(path: str) -> Iterator[Path]:
    """Programs called ffmpeg in the absolute folders of PATH, in order."""
    for folder in path.split(os.pathsep):
        program = Path(folder) / NAME
        with suppress(OSError, ValueError):
            if Path(folder).is_absolute() and program.is_file() and os.access(program, os.X_OK):
                yield program


def lacking(program: Path) -> list[str]:
    """What films need and an ffmpeg cannot: names of encoders and filters; kept in the user's cache."""
    kept, key = _kept_in(), _fingerprint(program)
    with suppress(DancetutorError):
        found = read_json(kept, MEGABYTE) if kept else None
        if isinstance(found, dict) and found.get("key") == key and isinstance(found.get("lacking"), list):
            return [str(name) for name in found["lacking"]]
    missing = _ask(program)
    if kept is not None:
        with suppress(DancetutorError, OSError):
            write_atomic(kept, json.dumps({"key": key, "lacking": missing}).encode())
    return missing


def _kept_in() -> Path | None:
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
