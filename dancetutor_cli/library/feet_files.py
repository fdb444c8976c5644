"""The one list of files in which people say whose foot it is: for the solver, for caches and for films.

Imports neither numpy nor the reader of charts: a cached result is told without them.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator
from pathlib import Path

from dancetutor_cli.bounded import CHART_LIMIT, read_bytes
from dancetutor_cli.errors import FileError
from dancetutor_cli.library.settings_file import find_settings_file, places_of_settings_file
from dancetutor_cli.suffixes import SONG_SUFFIXES

EDITOR_FILE = "data.sme"  # SMEditor's, in the song's folder


def places_of_feet(song: Path) -> Iterator[Path]:
    """Every file, there or not, that may say whose feet step the charts of the file `song`: to be watched.

    The file itself comes first (pinned measures); of the places of dancetutor.yaml the first one that is there counts.
    """
    yield song
    yield song.parent / EDITOR_FILE
    yield from places_of_settings_file(song.parent)


def feet_fingerprint(song: Path) -> str:
    """Hash (hex) of all that people say about the feet of a song's charts: another hash, perhaps other feet.

    What a file is called counts where its name does: `data.sme` is only used for the one song of a folder, and
    entries of dancetutor.yaml are for paths below its folder.
    """
    out = hashlib.sha256()
    for part in _parts(song):
        out.update(len(part).to_bytes(8, "little"))
        out.update(part)
    return out.hexdigest()


def _parts(song: Path) -> Iterator[bytes]:
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
    """The names, without suffix, of the chart files in a folder; more than one means several songs."""
    songs = (path for path in folder.iterdir() if path.suffix.lower() in SONG_SUFFIXES)
    return {path.stem.lower() for path in songs if not path.name.startswith(".")}
