"""Stored results: keys made of all their inputs, and files in the user's cache, of which old ones are removed."""

from __future__ import annotations

import hashlib
import os
import stat
import time
from collections.abc import Collection, Iterator
from contextlib import suppress
from dataclasses import dataclass, fields, is_dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import dancetutor_cli
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import PACKAGE, config_path, read_bytes
from dancetutor_cli.run.trust import write_file

if TYPE_CHECKING:
    from hashlib import _Hash


# Hashes of all inputs of a result: every field of a request, so that no field can be forgotten, and the program. The
# same hash means the same result. A file is hashed by its content, not by its name.

# Metadata key of a field whose value is a name or else a file. Its value is a folder of configs/ (a string) or a
# collection with the names: a name is hashed as text, a file by its bytes. It may also be a function that returns the
# value to hash.
NAMED = "named"
_PARTS = (".py", ".glb", ".yaml", ".vert", ".frag")  # suffixes of the program's files that affect results
_TEXT = "utf-8", "surrogateescape"


def fingerprint(*values: Any) -> str:
    """Return a hash (hex) of values: dataclasses with all fields, tuples, dictionaries, arrays, files, text."""
    digest = hashlib.sha256()
    for value in values:
        _add(digest, value)
    return digest.hexdigest()


def _add(digest: _Hash, value: Any) -> None:
    digest.update(type(value).__name__.encode())
    if type(value) in (float, int, str):
        digest.update(repr(value).encode(*_TEXT) + b"\0")
    elif is_dataclass(value):
        for name, named in _fields(value.__class__):
            one = getattr(value, name)
            digest.update(name.encode())
            if one is not None and named is not None:
                one = named(one) if callable(named) else one if one in _names(named) else Path(one)
            _add(digest, one)
    elif isinstance(value, tuple | list):
        digest.update(b"%d" % len(value))
        for part in value:
            _add(digest, part)
    elif isinstance(value, dict):
        _add(digest, list(value.items()))
    elif isinstance(value, Path):
        digest.update(file_hash(value).encode())
    elif hasattr(value, "tobytes"):
        digest.update(f"{value.shape}{value.dtype}".encode() + value.tobytes())
    else:
        digest.update(repr(value).encode(*_TEXT) + b"\0")


@cache
def _fields(kind: type) -> tuple[tuple[str, Any], ...]:
    """Return the names of a dataclass's fields, each with its metadata `NAMED`."""
    return tuple((field.name, field.metadata.get(NAMED)) for field in fields(kind))


def _names(named: str | Collection[str]) -> Collection[str]:
    """Return the values of a field that are names."""
    return {path.stem for path in config_path(named).glob("*.yaml")} if isinstance(named, str) else named


def file_hash(path: Path) -> str:
    """Return the SHA-256 of a file's content."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


@cache
def program_hash() -> str:
    """Return a hash of the program's sources, models and configuration, any of which may change a result."""
    out = hashlib.sha256()
    for root in (PACKAGE, config_path("")):
        for path, _ in _files(str(root)):
            out.update(os.path.relpath(path, root).encode(*_TEXT) + file_hash(Path(path)).encode())
    return out.hexdigest()


@cache
def program_stamp() -> str:
    """Return a faster hash of the program, from sizes and times of its files, for caches of this machine only."""
    parts = [dancetutor_cli.__version__]
    for root in (PACKAGE, config_path("")):
        parts += [f"{path}{found.st_size}{found.st_mtime_ns}" for path, found in _files(str(root))]
    return hashlib.sha256("".join(parts).encode(*_TEXT)).hexdigest()


def _files(folder: str) -> Iterator[tuple[str, os.stat_result]]:
    for entry in sorted(os.scandir(folder), key=lambda e: e.name):
        if entry.is_dir():
            if entry.name != "__pycache__":
                yield from _files(entry.path)
        elif entry.name.endswith(_PARTS):
            yield entry.path, entry.stat()


# The files of a store: whole files or nothing.

DAY = 24 * 3600  # seconds


@dataclass(frozen=True, slots=True)
class StoredFiles:
    """A folder of files that can be made again. A file that cannot be read, written or removed is never an error.

    The caller checks the folder (`run.trust`) and the content of the files, which are not code.

    longest : seconds; `prune` removes files that have not been written or read for so long
    largest : bytes of all files; above it, `prune` removes the oldest
    """

    folder: Path
    longest: float | None = None
    largest: int | None = None

    def read(self, name: str, limit: int) -> bytes | None:
        """Return the content of a file of at most `limit` bytes, which is then younger; None if it cannot be read."""
        path = self.folder / name
        try:
            data = read_bytes(path, limit)
            if self.longest is None or time.time() - path.stat().st_mtime > self.longest / 2:
                path.touch()
        except (FileError, OSError):
            return None
        return data

    def write(self, name: str, data: bytes) -> None:
        """Write or replace a file in one step. On a full disk, nothing is stored."""
        path = self.folder / name
        with suppress(OSError):
            path.parent.mkdir(parents=True, exist_ok=True)
            write_file(path, data)

    def prune(self) -> None:
        """Remove files that are too old, or the oldest if there are too many bytes."""
        now, size = time.time(), 0
        for status, path in sorted(self._files(), key=lambda one: -one[0].st_mtime):
            size += status.st_size
            is_old = self.longest is not None and now - status.st_mtime > self.longest
            if is_old or (self.largest is not None and size > self.largest):
                with suppress(OSError):
                    path.unlink(missing_ok=True)

    def _files(self) -> Iterator[tuple[os.stat_result, Path]]:
        """Yield the regular files and links in the folder and the folders in it; links are not followed."""
        for root, _, names in os.walk(self.folder):
            for name in names:
                path = Path(root, name)
                with suppress(OSError):
                    status = path.lstat()
                    if stat.S_ISREG(status.st_mode) or stat.S_ISLNK(status.st_mode):
                        yield status, path
