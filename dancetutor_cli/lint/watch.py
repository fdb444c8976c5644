"""Wait for files to be saved, on every system alike: by looking at their times."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path

Stamp = tuple[int, int]
INTERVAL = 0.3  # seconds between two looks
_SETTLED = 0.15  # an editor may still be writing; a file counts as saved when it did not change for so long


def changes(
    files: Callable[[], Sequence[Path]],
    needs: Callable[[Path], Iterable[Path]] = lambda _: (),
    wait: Callable[[float], None] = time.sleep,
) -> Iterator[tuple[list[Path], list[Path]]]:
    """Yield (all files, those that are new or saved) at once, then after every change; ends with KeyboardInterrupt.

    files : finds the files again, so that charts that are added later are seen
    needs : what else the result for a file depends on, whether it is there or not: a change of these counts as one of
        the file
    wait : how to sleep
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
    """Whether one of the paths has another stamp than before; one that was not watched before has not changed."""
    return any(path in known and known[path] != seen[path] for path in paths)


def _stamp(path: Path) -> Stamp:
    try:
        status = path.stat()
    except OSError:
        return (-1, -1)
    return status.st_mtime_ns, status.st_size
