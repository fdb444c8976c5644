"""Wait until files are saved, in the same way on every system, by checking their times and sizes."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path

Stamp = tuple[int, int]
INTERVAL = 0.3  # seconds between two checks
_SETTLED = 0.15  # seconds; a file counts as saved if it has not changed for so long, because editors write in parts


def changes(
    files: Callable[[], Sequence[Path]],
    needs: Callable[[Path], Iterable[Path]] = lambda _: (),
    wait: Callable[[float], None] = time.sleep,
) -> Iterator[tuple[list[Path], list[Path]]]:
    """Yield (all files, new or saved files) at once, then after every change; ends with KeyboardInterrupt.

    files : function that finds the files again, so that new charts are found
    needs : function that returns the other files on which a file's result depends, existing or not; a change of these
        counts as a change of the file
    wait : function that sleeps for some seconds
    """
    known: dict[Path, Stamp] = {}
    before: list[Path] | None = None
    while True:
        found = list(files())
        watched = {path: [path, *needs(path)] for path in found}
        seen = {path: _stamp(path) for path in {path for group in watched.values() for path in group}}
        changed = [path for path, group in watched.items() if path not in known or _differ(group, known, seen)]
        if changed and before is not None:
            wait(_SETTLED)
            if any(_stamp(path) != stamp for path, stamp in seen.items()):
                continue  # still being written
        known = seen
        if changed or before is None or set(before) - set(found):
            before = found
            yield found, changed
        wait(INTERVAL)


def _differ(paths: Collection[Path], known: Mapping[Path, Stamp], seen: Mapping[Path, Stamp]) -> bool:
    """Whether one of the paths has another stamp than before. A path that was not watched before does not count."""
    return any(path in known and known[path] != seen[path] for path in paths)


def _stamp(path: Path) -> Stamp:
    try:
        status = path.stat()
    except OSError:
        return (-1, -1)
    return status.st_mtime_ns, status.st_size
