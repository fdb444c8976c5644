"""Files beside charts: dancetutor.yaml, a pack's Pack.ini, and the list of all files that can set feet."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.files import SONG_SUFFIXES
from dancetutor_cli.run.reading import CHART_LIMIT, SETTINGS_LIMIT, is_outside, read_bytes

SETTINGS_FILE = "dancetutor.yaml"


def find_settings_file(start: Path) -> Path | None:
    """Return the nearest dancetutor.yaml in the folder `start` or above it; it need not be a regular file."""
    return next((Path(place) for place in _places(start) if os.path.exists(place)), None)  # noqa: PTH110 (quicker)


def check_not_a_link_out(path: Path) -> None:
    """Raise FileError if a dancetutor.yaml is a link out of its folder.

    An error message would otherwise describe a file that the chart's author may not read.
    """
    if path.is_symlink() and is_outside(path, path.parent):
        raise FileError(path, "is a link to a file outside its folder; put a copy there, or name it with --config")


def _places(start: Path) -> Iterator[str]:
    """Yield the paths at which a dancetutor.yaml for the charts of the folder `start` may be, nearest first."""
    folder, below = os.path.abspath(start), ""  # noqa: PTH100 (links stay links)
    while folder != below:
        yield os.path.join(folder, SETTINGS_FILE)  # noqa: PTH118
        folder, below = os.path.dirname(folder), folder  # noqa: PTH120


# The files in which authors set feet; the solver, caches and films use this list.
#
# This module imports neither numpy nor the chart reader, so that a cached result is reported without them.

EDITOR_FILE = "data.sme"  # SMEditor's, in the song's folder


def places_of_feet(song: Path) -> Iterator[Path]:
    """Yield every file, existing or not, that may set feet for the charts of the file `song`.

    The file itself comes first (pinned measures). Of the paths of dancetutor.yaml, the first that exists is used.
    """
    yield song
    yield song.parent / EDITOR_FILE
    yield from map(Path, _places(song.parent))


def feet_fingerprint(song: Path) -> str:
    """Return a hash (hex) of all settings for the feet of a song's charts; if it changes, the feet may change.

    File names are hashed if they matter. For example, `data.sme` is only used in a folder with one song, and the
    entries of dancetutor.yaml are for paths below its folder.
    """
    out = hashlib.sha256()
    for part in _hashed_bytes(song):
        out.update(len(part).to_bytes(8, "little"))
        out.update(part)
    return out.hexdigest()


def _hashed_bytes(song: Path) -> Iterator[bytes]:
    yield _content(song)
    editor = _content(song.parent / EDITOR_FILE)
    yield editor
    yield "\n".join(sorted(song_stems(song.parent))).encode("utf-8", "surrogateescape") if editor else b""
    settings = find_settings_file(song.parent)
    if settings is not None:
        place = os.path.relpath(os.path.abspath(song), settings.parent)  # noqa: PTH100 (links stay links)
        yield place.encode("utf-8", "surrogateescape")
        yield _content(settings)


def _content(path: Path) -> bytes:
    try:
        return read_bytes(path, CHART_LIMIT)
    except FileError:
        return b""


def song_stems(folder: Path) -> set[str]:
    """Return the names, without suffix, of the chart files in a folder; more than one name means several songs."""
    songs = (path for path in folder.iterdir() if path.suffix.lower() in SONG_SUFFIXES)
    return {path.stem.lower() for path in songs if not path.name.startswith(".")}


# A pack's `Pack.ini`, as ITGmania reads it: the sync of its songs.

PACK_INI = "pack.ini"
PACK_SYNCS = ("NULL", "ITG")  # the game's values: no bias, or the 9 ms of In The Groove's machines


@dataclass(frozen=True, slots=True)
class PackIni:
    """The contents of a Pack.ini. sync : its SyncOffset as written, "" if there is none; problem : one line, or None"""

    path: Path
    sync: str = ""
    problem: str | None = None


def pack_folder(song: Path) -> Path:
    """Return the folder of the pack of a song's file: the parent of the song's folder."""
    return song.parent.parent


def read_pack_ini(folder: Path) -> PackIni | None:
    """Return the `Pack.ini` of a pack's folder, in upper or lower case; None if there is none.

    A file that cannot be read is returned with a `problem`.
    """
    try:
        path = next((one for one in sorted(folder.iterdir()) if one.name.lower() == PACK_INI), None)
    except OSError:
        return None
    if path is None:
        return None
    try:
        text = read_bytes(path, SETTINGS_LIMIT).decode("utf-8-sig", "replace")
    except FileError as error:
        return PackIni(path, problem=error.message)
    group, sync = "", None
    for line in text.splitlines():
        stripped = line.strip()
        if stripped.startswith("[") and stripped.endswith("]"):
            group = stripped[1:-1].strip().lower()
        elif group == "group" and not stripped.startswith((";", "#", "//")):
            key, equals, value = stripped.partition("=")
            if equals and key.strip().lower() == "syncoffset":
                sync = value.strip()
    if sync is None:
        return PackIni(path, problem="has no SyncOffset: the game uses that of the machine")
    if sync.upper() not in PACK_SYNCS:
        return PackIni(path, sync, f"SyncOffset is '{sync[:40]}', but the game knows only {' and '.join(PACK_SYNCS)}")
    return PackIni(path, sync)
