"""Results of `analyze` that need not be found again: one small file each, by the hash of all that a result depends on.

Imports neither numpy nor numba: an unchanged file is reported without them.
"""

from __future__ import annotations

import hashlib
import os
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from dancetutor_cli.chart.pack_files import feet_fingerprint
from dancetutor_cli.lint.analysis import AnalyzeTask
from dancetutor_cli.lint.results import FileResult, from_bytes, to_bytes
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.files import CHART_SUFFIXES, SONG_SUFFIXES
from dancetutor_cli.run.fingerprint import program_stamp
from dancetutor_cli.run.reading import CHART_LIMIT, read_bytes
from dancetutor_cli.run.trust import results_folder

_LARGEST = CHART_LIMIT  # bytes of a kept result
_KEEP_SECONDS = 30 * 24 * 3600  # results nobody asked for in so long are removed


class ResultCache:
    """A folder of results, see `result_file`. One that cannot be read or written is no result, never an error."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._listings: dict[Path, str] = {}

    def key(self, task: AnalyzeTask) -> str | None:
        """The hash of what the task's result depends on, or None if it cannot be kept."""
        if task.want_rows or task.data is not None:
            return None
        try:
            data = read_bytes(task.path, CHART_LIMIT)
        except FileError:
            return None
        digest = hashlib.sha256(data)
        wanted = f"{task.path}|{task.path.absolute()}|{(task.presets, task.selection, task.options())}"
        for part in (program_stamp(), wanted, task.settings.fingerprint(), *self._dependencies(task.path)):
            digest.update(b"\0" + part.encode("utf-8", "surrogateescape"))
        return digest.hexdigest()

    def get(self, key: str) -> FileResult | None:
        """The result kept under a key."""
        path = self._path(key)
        try:
            content = read_bytes(path, _LARGEST)
            if time.time() - path.stat().st_mtime > _KEEP_SECONDS / 2:
                path.touch()
        except (FileError, OSError):
            return None
        return from_bytes(content, key)

    def put(self, key: str, result: FileResult) -> None:
        """Keep a result."""
        import tempfile  # which takes long, and an unchanged file does without

        path = self._path(key)
        with suppress(OSError):
            path.parent.mkdir(parents=True, exist_ok=True)
            handle, name = tempfile.mkstemp(dir=path.parent)
            try:
                with os.fdopen(handle, "wb") as file:
                    file.write(to_bytes(result, key))
                Path(name).replace(path)
            except OSError:  # a full disk
                Path(name).unlink(missing_ok=True)

    def prune(self) -> None:
        """Remove what nobody asked for in a long time."""
        with suppress(OSError):
            for path in self._folder.glob("*/*"):
                if time.time() - path.stat().st_mtime > _KEEP_SECONDS:
                    path.unlink(missing_ok=True)

    def _dependencies(self, path: Path) -> Iterator[str]:
        """What else beside it a result depends on: music and pictures by size and time, feet, the other format."""
        if path.parent not in self._listings:
            self._listings[path.parent] = _listing(path.parent)
        yield self._listings[path.parent]
        yield feet_fingerprint(path)
        for suffix in SONG_SUFFIXES:
            other = path.with_suffix(suffix)
            if other != path:
                with suppress(FileError):
                    yield hashlib.sha256(read_bytes(other, CHART_LIMIT)).hexdigest()

    def _path(self, key: str) -> Path:
        return self._folder / key[:2] / key[2:]


def default_folder() -> Path | None:
    """Where this system keeps caches; DANCETUTOR_CACHE names another folder. None: nowhere."""
    folder, _ = results_folder()
    return None if folder is None else folder / "analyze"


def _listing(folder: Path) -> str:
    lines = []
    for entry in sorted(os.scandir(folder), key=lambda e: e.name):
        with suppress(OSError):  # a circle of links
            if entry.is_file() and not entry.name.lower().endswith(CHART_SUFFIXES):
                stat = entry.stat()
                lines.append(f"{entry.name} {stat.st_size} {stat.st_mtime_ns}")
    return "\n".join(lines)
