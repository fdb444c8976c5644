"""Which chart files a path means: files as given, folders with all below them, .sm and .ssc of one song."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from dancetutor_cli.errors import FileError

SUFFIXES = (".sm", ".ssc")


def find_files(paths: Sequence[Path]) -> list[Path]:
    """The chart files that paths name: a file as it is, a folder with every .sm and .ssc below it, sorted; none twice.

    Raises `FileError` for a path that is not there, a folder that cannot be read and a folder without charts.
    """
    found: dict[Path, None] = {}
    for path in paths:
        if path.is_dir():
            below = _below(path)
            if not below:
                raise FileError(path, "no .sm or .ssc file in this folder or below it")
            found.update(dict.fromkeys(below))
        elif path.exists():
            found[path] = None
        else:
            raise FileError(path, "no such file or folder")
    return list(found)


def _below(folder: Path) -> list[Path]:
    def fail(error: OSError) -> None:
        raise FileError(Path(error.filename or folder), error.strerror or str(error))

    out: list[Path] = []
    for root, folders, names in os.walk(folder, onerror=fail):
        folders.sort()
        out.extend(Path(root) / name for name in sorted(names) if Path(name).suffix.lower() in SUFFIXES)
    return out


def twin(path: Path) -> Path | None:
    """The .ssc beside a .sm of the same name, or the .sm beside a .ssc; None if there is none. Games load the .ssc."""
    other = ".sm" if path.suffix.lower() == ".ssc" else ".ssc"
    for candidate in (path.with_suffix(other), path.with_suffix(other.upper())):
        if candidate.is_file():
            return candidate
    return None
