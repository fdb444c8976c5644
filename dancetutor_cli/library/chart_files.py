"""Which chart files a path means: files as given, folders with all below them, .sm and .ssc of one song."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path

from dancetutor_cli.suffixes import SONG_SUFFIXES

_RESOURCE_FORK = "._"  # what macOS leaves beside files on foreign disks; the games skip it too


def find_files(paths: Sequence[Path]) -> list[Path]:
    """The chart files that paths name: a file as it is, a folder with every .sm and .ssc below it, sorted; none twice.

    Symbolic links to folders are not followed. What cannot be looked into stands for itself in the list (a path that
    is not there, a folder that cannot be read or holds no charts): `chart.load` says what is wrong with it, and the
    other files go on.
    """
    found: dict[str, Path] = {}
    for path in paths:
        for file in _below(path) if os.path.isdir(path) else (path,):  # noqa: PTH112 (Path.is_dir may raise)
            found.setdefault(os.path.normcase(os.path.abspath(file)), file)  # noqa: PTH100 (links stay links)
    return list(found.values())


def _below(folder: Path) -> Iterable[Path]:
    closed: list[Path] = []
    files: list[Path] = []
    for root, folders, names in os.walk(folder, onerror=lambda error: closed.append(Path(error.filename or folder))):
        folders.sort()
        files.extend(Path(root) / name for name in sorted(names) if is_chart_name(name))
    return [*files, *sorted(closed)] or [folder]


def without_links_out(paths: Sequence[Path], files: Sequence[Path]) -> tuple[list[Path], list[Path]]:
    """Of what `find_files` has found: files to write, and links by which a search would leave its folders.

    A folder of songs may be a stranger's, and a link in it lead to any file of the user's. Who names a link means it.
    """
    named = {os.path.abspath(path) for path in paths}  # noqa: PTH100 (links stay links)
    folders = [path.resolve() for path in paths if os.path.isdir(path)]  # noqa: PTH112 (Path.is_dir may raise)
    out = {
        file
        for file in files
        if file.is_symlink() and os.path.abspath(file) not in named and _is_outside(file, folders)  # noqa: PTH100
    }
    return [file for file in files if file not in out], sorted(out)


def _is_outside(link: Path, folders: Sequence[Path]) -> bool:
    """Whether a link leads to a file outside of all folders; one to nowhere or to a device is an error of its own."""
    try:
        target = link.resolve(strict=True)
    except (OSError, RuntimeError):
        return False
    return target.is_file() and not any(target.is_relative_to(folder) for folder in folders)


def is_chart_name(name: str) -> bool:
    """Whether a file of this name in a song's folder is a chart file."""
    return name.lower().endswith(SONG_SUFFIXES) and not name.startswith(_RESOURCE_FORK)


def twin(path: Path) -> Path | None:
    """The .ssc beside a .sm of the same name, or the .sm beside a .ssc; None if there is none. Games load the .ssc."""
    other = ".sm" if path.suffix.lower() == ".ssc" else ".ssc"
    for candidate in (path.with_suffix(other), path.with_suffix(other.upper())):
        if os.path.isfile(candidate):  # noqa: PTH113 (Path.is_file may raise)
            return candidate
    return None


def one_song(path: Path) -> Path:
    """The chart file a folder of one song stands for: its .ssc or .sm. Any other path is given back as it is."""
    if not os.path.isdir(path):  # noqa: PTH112 (Path.is_dir may raise)
        return path
    found = find_files([path])
    songs = [file for file in found if file.suffix.lower() == ".ssc" or (twin(file) is None and file != path)]
    return songs[0] if len(songs) == 1 else path
