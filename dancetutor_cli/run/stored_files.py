"""Files of a store in the user's cache: whole files or nothing, and old ones are removed."""

from __future__ import annotations

import os
import stat
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import read_bytes
from dancetutor_cli.run.trust import write_file

DAY = 24 * 3600  # seconds


@dataclass(frozen=True, slots=True)
class StoredFiles:
    """A folder of files that can be made again. A file that cannot be read, written or removed is never an error.

    The caller checks the folder (`run.trust`) and the content of the files, which are not code.

    longest : seconds; `prune` removes files that have not been written or read for so long
    largest : bytes of all files; above it, `prune` removes the oldest
    """

    folder: Path
    longest: float | None = None
    largest: int | None = None

    def read(self, name: str, limit: int) -> bytes | None:
        """Return the content of a file of at most `limit` bytes, which is then younger; None if it cannot be read."""
        path = self.folder / name
        try:
            data = read_bytes(path, limit)
            if self.longest is None or time.time() - path.stat().st_mtime > self.longest / 2:
                path.touch()
        except (FileError, OSError):
            return None
        return data

    def write(self, name: str, data: bytes) -> None:
        """Write or replace a file in one step. On a full disk, nothing is stored."""
        path = self.folder / name
        with suppress(OSError):
            path.parent.mkdir(parents=True, exist_ok=True)
            write_file(path, data)

    def prune(self) -> None:
        """Remove files that are too old, or the oldest if there are too many bytes."""
        now, size = time.time(), 0
        for status, path in sorted(self._files(), key=lambda one: -one[0].st_mtime):
            size += status.st_size
            is_old = self.longest is not None and now - status.st_mtime > self.longest
            if is_old or (self.largest is not None and size > self.largest):
                with suppress(OSError):
                    path.unlink(missing_ok=True)

    def _files(self) -> Iterator[tuple[os.stat_result, Path]]:
        """Yield the regular files and links in the folder and the folders in it; links are not followed."""
        for root, _, names in os.walk(self.folder):
            for name in names:
                path = Path(root, name)
                with suppress(OSError):
                    status = path.lstat()
                    if stat.S_ISREG(status.st_mode) or stat.S_ISLNK(status.st_mode):
                        yield status, path
