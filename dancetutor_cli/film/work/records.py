"""The records that a batch keeps between runs: finished films, and digests of the segments of unfinished films.

Records are in the user's own cache and never beside the films, because a folder of charts and its contents may come
from anybody. Unfinished films are beside the output, so that the last step is a rename and the machines of a cluster
see them. Each run makes a new folder for them, under a name that nobody can guess. A segment of an interrupted run is
moved from the folder of that run, and counts only with the digest in the record.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import secrets
import shutil
import stat
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.files import encoded, write_atomic
from dancetutor_cli.run.reading import read_json
from dancetutor_cli.run.trust import exclude, kept_folder, results_folder

WORK = ".dancetutor-"  # beginning of the name of a work folder, before 32 random hexadecimal digits
_WORK_NAME = re.compile(re.escape(WORK) + "[0-9a-f]{32}")
_DIGEST = re.compile("[0-9a-f]{64}")
_NO_LINK = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)


@dataclass(frozen=True, slots=True)
class FilmRecord:
    """The record of a film from earlier runs.

    key : hash of everything that the film is made of, see `film_key`; folders : names of its work folders
    digests : SHA-256 of each finished segment, by number; size : size of the finished film, None for an unfinished film
    """

    key: str = ""
    folders: tuple[str, ...] = ()
    digests: dict[int, str] = field(default_factory=dict)
    size: int | None = None


class FilmRecords:
    """The records of films, one file for each film in a private folder.

    Without a folder nothing is kept, and a second run begins again.
    """

    def __init__(self, folder: Path | None) -> None:
        self._folder = folder

    @property
    def kept(self) -> bool:
        """Whether a later run will find the records."""
        return self._folder is not None

    def read(self, output: Path) -> FilmRecord:
        """Return the record of the film of that name; an empty record if there is no usable one."""
        if self._folder is None:
            return FilmRecord()
        try:
            return _checked(read_json(self._path(output)))
        except (FileError, KeyError, TypeError, ValueError, AttributeError):
            return FilmRecord()

    def write(self, output: Path, record: FilmRecord) -> None:
        """Write a record. A record that cannot be written is left out, because the film itself does not need it."""
        if self._folder is None:
            return
        data = {
            "schema": 1,
            "output": os.path.realpath(output.parent) + os.sep + output.name,
            "key": record.key,
            "size": record.size,
            "folders": record.folders,
            "digests": record.digests,
        }
        path = self._path(output)
        with suppress(OSError, FileError):
            path.parent.mkdir(mode=0o700, exist_ok=True)
            write_atomic(path, encoded(json.dumps(data, ensure_ascii=False, indent=1) + "\n"))

    def _path(self, output: Path) -> Path:
        assert self._folder is not None
        return self._folder / _hash(os.path.realpath(output.parent)) / f"{_hash(output.name)}.json"


def _hash(text: str) -> str:
    return hashlib.sha256(os.fsencode(text)).hexdigest()[:32]


def _checked(data: Any) -> FilmRecord:
    """Return a record from its data; any error in them raises an exception."""
    digests = {int(number): digest for number, digest in data["digests"].items() if _DIGEST.fullmatch(digest)}
    folders = tuple(name for name in data["folders"] if _WORK_NAME.fullmatch(name))
    return FilmRecord(str(data["key"]), folders, digests, None if data["size"] is None else int(data["size"]))


def find_records(foreign: tuple[Path, ...] = ()) -> tuple[FilmRecords, str]:
    """Return the records of this user, and "" or the reason why there are no records.

    foreign : folders whose contents others may have written, such as a pack; a cache inside them is not used
    """
    for path in foreign:
        exclude(path)
    return FilmRecords(kept_folder("films")), results_folder()[1]


def new_work_name() -> str:
    """Return a new name of a work folder."""
    return f"{WORK}{secrets.token_hex(16)}"


def remove_work(folder: Path) -> None:
    """Remove a work folder, or a file or link of this name; the target of a link stays."""
    try:
        folder.unlink()
    except OSError:
        shutil.rmtree(folder, ignore_errors=True)


def move_segment(source: Path, target: Path, digest: str) -> bool:
    """Move a segment of an earlier run into the folder of this run; whether it is unchanged since that run."""
    with suppress(OSError):
        source.rename(target)  # moves a link itself, not its target
        if digest_of(target) == digest:
            return True
    remove_work(target)
    return False


def digest_of(path: Path) -> str:
    """Return the SHA-256 of an ordinary file; OSError for a link, and "" for a device, a pipe or a folder."""
    with open(os.open(path, os.O_RDONLY | _NO_LINK), "rb") as file:  # noqa: PTH123
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            return ""
        return hashlib.file_digest(file, "sha256").hexdigest()
