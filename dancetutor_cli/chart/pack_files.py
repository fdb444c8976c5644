"""Files that lie with charts: dancetutor.yaml, a pack's Pack.ini, and the list of those that speak of feet."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Annotated, Any, ClassVar

from dancetutor_cli.chart import names
from dancetutor_cli.run.errors import FileError, did_you_mean
from dancetutor_cli.run.files import SONG_SUFFIXES
from dancetutor_cli.run.reading import CHART_LIMIT, SETTINGS_LIMIT, is_outside, read_bytes, shown_key
from dancetutor_cli.run.schema import SEVERAL, Entries, Parsed, Texts

# dancetutor.yaml: where it is searched, which charts an entry is about, and mistakes in it.

FILE_NAME = "dancetutor.yaml"


def find_settings_file(start: Path) -> Path | None:
    """The nearest dancetutor.yaml in the folder of `start` or above it; the reader says so if it is no file."""
    return next((Path(place) for place in _places(start) if os.path.exists(place)), None)  # noqa: PTH110 (quicker)


def check_not_a_link_out(path: Path) -> None:
    """Raise FileError if a dancetutor.yaml that lies there is a link out of its folder: an error message
    would describe a file that the chart's author may not read."""
    if path.is_symlink() and is_outside(path, path.parent):
        raise FileError(path, "is a link to a file outside its folder; put a copy there, or name it with --config")


def _places(start: Path) -> Iterator[str]:
    """Where a dancetutor.yaml for the charts of the folder `start` may be, nearest first."""
    folder, below = os.path.abspath(start), ""  # noqa: PTH100 (links stay links)
    while folder != below:
        yield os.path.join(folder, FILE_NAME)  # noqa: PTH118
        folder, below = os.path.dirname(folder), folder  # noqa: PTH120


@dataclass(frozen=True, slots=True)
class Condition:
    """When a layer holds; an empty part always does.

    paths : shell patterns, relative to the folder of the configuration `root`
    steps_types : shell patterns in lower case; difficulties : names of today in lower case
    meters : least and greatest meter
    """

    root: str = ""
    paths: tuple[str, ...] = ()
    steps_types: tuple[str, ...] = ()
    difficulties: tuple[str, ...] = ()
    meters: tuple[int, int] | None = None

    @property
    def is_about_charts(self) -> bool:
        """Whether it can only be decided for a chart."""
        return bool(self.steps_types or self.difficulties or self.meters)

    def holds_for_path(self, path: Path) -> bool:
        """Whether one of the patterns fits; a pattern without a slash fits any part of the path, as in .gitignore."""
        if not self.paths:
            return True
        path = path.absolute()
        if path.is_relative_to(self.root):
            path = path.relative_to(self.root)
        whole = path.as_posix()
        return any(
            fnmatchcase(whole, pattern) if "/" in pattern else any(fnmatchcase(part, pattern) for part in path.parts)
            for pattern in self.paths
        )

    def holds_for_chart(self, steps_type: str, difficulty: str, meter: int) -> bool:
        """Whether steps type, difficulty and meter fit."""
        return (
            (not self.steps_types or any(fnmatchcase(steps_type.lower(), pattern) for pattern in self.steps_types))
            and (not self.difficulties or difficulty.lower() in self.difficulties)
            and (self.meters is None or self.meters[0] <= meter <= self.meters[1])
        )


def _steps_type(text: Any) -> str:
    """A steps type or a shell pattern of such, that fits one at least."""
    pattern = names.steps_type(str(text))
    if not any(fnmatchcase(known, pattern) for known in names.COLUMNS):
        near = did_you_mean(pattern, names.COLUMNS)
        there = ", ".join(sorted({f"{known.partition('-')[0]}-*" for known in names.COLUMNS}))
        raise ValueError(f"'{shown_key(text)}' is not a steps type{near}; choose {there}")
    return pattern


def _difficulty(text: Any) -> str:
    """A difficulty under today's name; old ones ("Heavy", "Oni") are known as everywhere."""
    name, known = names.difficulty(str(text), "", 0, old=True)
    if not known:
        near, there = did_you_mean(str(text), names.DIFFICULTIES), ", ".join(names.DIFFICULTIES)
        raise ValueError(f"'{shown_key(text)}' is not a difficulty{near}; choose {there}")
    return name.lower()


def _meters(value: Any) -> tuple[int, int]:
    """A meter, or a range written "1-7", "8-" or "-7"."""
    low, dash, high = str(value).partition("-")
    try:
        return int(low or 0), int(high or 1_000_000) if dash else int(low)
    except ValueError:
        raise ValueError(f'"{shown_key(value)}" is not a range of meters; write 8, "1-7", "8-" or "-7"') from None


@dataclass(eq=False, repr=False)
class _WhenKeys:
    """What `when` of an entry may say; each one value or a list, as in `Condition`."""

    HYPHENS: ClassVar[bool] = True
    path: Texts = ()
    steps_type: Annotated[tuple[Annotated[str, Parsed(_steps_type)], ...], SEVERAL] = ()
    difficulty: Annotated[tuple[Annotated[str, Parsed(_difficulty)], ...], SEVERAL] = ()
    meter: Annotated[tuple[int, int], Parsed(_meters, "a meter or a range of them")] | None = None


When = Annotated[_WhenKeys, Entries(1)]


def condition_of(when: When, folder: Path) -> Condition:
    """When an entry holds. folder : of the file, which its paths are relative to"""
    return Condition(str(folder.absolute()), when.path, when.steps_type, when.difficulty, when.meter)


# The list of files in which people set feet: for the solver, for caches and for films.
#
# Imports neither numpy nor the reader of charts: a cached result is reported without them.

EDITOR_FILE = "data.sme"  # SMEditor's, in the song's folder


def places_of_feet(song: Path) -> Iterator[Path]:
    """Every file, present or not, that may set feet for the charts of the file `song`: to be watched.

    The file itself comes first (pinned measures); of the places of dancetutor.yaml the first one that is there counts.
    """
    yield song
    yield song.parent / EDITOR_FILE
    yield from map(Path, _places(song.parent))


def feet_fingerprint(song: Path) -> str:
    """Hash (hex) of everything that people have set about the feet of a song's charts; another hash may mean other
    feet.

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


# A pack's `Pack.ini`, as ITGmania reads it: the sync of its songs.

NAME = "pack.ini"
SYNCS = ("NULL", "ITG")  # what the game knows: no bias, and the 9 ms of In The Groove's machines


@dataclass(frozen=True, slots=True)
class PackIni:
    """The contents of the file. sync : of its group, as written; "" if there is none; problem : one line, or None"""

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
        return PackIni(path, problem="has no SyncOffset: the game uses that of the machine")
    if sync.upper() not in SYNCS:
        return PackIni(path, sync, f"SyncOffset is '{sync[:40]}', but the game knows only {' and '.join(SYNCS)}")
    return PackIni(path, sync)
