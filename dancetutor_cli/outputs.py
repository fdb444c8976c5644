"""Where results go, asked before the work: a file wants its folder to be there, a folder is made with those above."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterable, Sequence
from pathlib import Path

from dancetutor_cli.errors import FileError, UsageError
from dancetutor_cli.suffixes import EDIT_SUFFIX, SONG_SUFFIXES

_DENIED = os.strerror(errno.EACCES)


def check_file(path: Path, suffixes: Sequence[str] = (), *, or_device: bool = False) -> None:
    """Raise what in the end would keep a file from being written here; nothing is made.

    suffixes : how its name may end, in lower case; none: anyhow
    or_device : or it may be a device or a pipe, whatever that is called
    """
    suffix = path.suffix.lower()
    if suffix in (*SONG_SUFFIXES, EDIT_SUFFIX):
        raise FileError(path, "is a chart's name, and this would take its place; give another")
    device = or_device and path.exists() and not path.is_file() and not path.is_dir()
    if suffixes and suffix not in suffixes and not device:
        raise UsageError(f"{path}: the name must end in {one_of(suffixes)}")
    if path.is_dir():
        raise FileError(path, "is a folder; give a file name")
    if not path.parent.is_dir():
        raise FileError(path, f"its folder '{path.parent}' does not exist; make it first")
    if path.is_file() or not path.exists():  # a device or a pipe is written where it is
        folder = (path.resolve() if path.is_symlink() else path).parent
        if folder.is_dir() and not _can_be_written(folder):
            raise FileError(path, f"its folder '{folder}' cannot be written: {_DENIED}")


def _can_be_written(folder: Path) -> bool:
    return os.access(folder, os.W_OK | os.X_OK)


def one_of(names: Iterable[str]) -> str:
    """ ".svg or .png" for people."""
    *most, last = names
    return f"{', '.join(most)} or {last}" if most else last


def check_folder(path: Path) -> None:
    """Raise if no folder can be here or be filled: a file is in its place or above it, or nobody may write there.

    Nothing is made.
    """
    for one in (path, *path.parents):
        if one.exists():
            if not one.is_dir():
                raise FileError(path, "is a file; give a folder" if one == path else f"'{one}' is a file, not a folder")
            if not _can_be_written(one):
                raise FileError(path, f"cannot be used as a folder: {_DENIED}")
            return


def make_folder(path: Path) -> None:
    """Make a folder and those above it, as far as they are not there."""
    check_folder(path)
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(path, f"cannot be used as a folder: {error.strerror}") from error
