"""A pack's `Pack.ini`, as ITGmania reads it: what the sync of its songs is."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from dancetutor_cli.bounded import SETTINGS_LIMIT, read_bytes
from dancetutor_cli.errors import FileError

NAME = "pack.ini"
SYNCS = ("NULL", "ITG")  # what the game knows: no bias, and the 9 ms of In The Groove's machines


@dataclass(frozen=True, slots=True)
class PackIni:
    """What the file says. sync : of its group, as written; "" where it says none; problem : one line, or None"""

    path: Path
    sync: str = ""
    problem: str | None = None


def pack_folder(song: Path) -> Path:
    """The folder of the pack of a song's file: that above the song's own."""
    return song.parent.parent


def read_pack_ini(folder: Path) -> PackIni | None:
    """The `Pack.ini` of a pack's folder, whatever its case; None without one. What cannot be read is its problem."""
    try:
        path = next((one for one in sorted(folder.iterdir()) if one.name.lower() == NAME), None)
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
        return PackIni(path, problem="says no SyncOffset: the game takes the machine's own")
    if sync.upper() not in SYNCS:
        return PackIni(path, sync, f"SyncOffset is '{sync[:40]}', and the game knows {' and '.join(SYNCS)}")
    return PackIni(path, sync)
