"""Hashes of what results depend on: of all fields of a request, so that none can be forgotten, and of the program.

The same hash, the same result. A file counts by its content, whatever it is called.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Collection, Iterator
from dataclasses import fields, is_dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import dancetutor_cli
from dancetutor_cli.run.reading import PACKAGE, config_path

if TYPE_CHECKING:
    from hashlib import _Hash

# Metadata of a field whose value is a name or else a file. A folder of configs/ (a string) or a collection has the
# names, of which the hash takes the text; of a file it takes the bytes. A function gives what is hashed in its place.
NAMED = "named"
_PARTS = (".py", ".glb", ".yaml", ".glsl", ".vert", ".frag")  # files of the program that make results
_TEXT = "utf-8", "surrogateescape"


def fingerprint(*values: Any) -> str:
    """Hash (hex) of values: dataclasses with all of their fields, tuples, dictionaries, arrays, files, text."""
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
    """Names of a dataclass' fields, each with what `NAMED` says of it."""
    return tuple((field.name, field.metadata.get(NAMED)) for field in fields(kind))


def _names(named: str | Collection[str]) -> Collection[str]:
    """Values of a field that are names of parts of the program."""
    return {path.stem for path in config_path(named).glob("*.yaml")} if isinstance(named, str) else named


def file_hash(path: Path) -> str:
    """SHA-256 of a file's content."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


@cache
def program_hash() -> str:
    """Hash of the program's own sources, models and configuration: what it makes may change with any of them."""
    out = hashlib.sha256()
    for root in (PACKAGE, config_path("")):
        for path, _ in _files(str(root)):
            out.update(os.path.relpath(path, root).encode(*_TEXT) + file_hash(Path(path)).encode())
    return out.hexdigest()


@cache
def program_stamp() -> str:
    """The same by sizes and times of the files, which is quick: for what is kept on this machine only."""
    parts = [dancetutor_cli.__version__]
    for root in (PACKAGE, config_path("")):
        parts += [f"{path}{stat.st_size}{stat.st_mtime_ns}" for path, stat in _files(str(root))]
    return hashlib.sha256("".join(parts).encode(*_TEXT)).hexdigest()


def _files(folder: str) -> Iterator[tuple[str, os.stat_result]]:
    for entry in sorted(os.scandir(folder), key=lambda e: e.name):
        if entry.is_dir():
            if entry.name != "__pycache__":
                yield from _files(entry.path)
        elif entry.name.endswith(_PARTS):
            yield entry.path, entry.stat()
