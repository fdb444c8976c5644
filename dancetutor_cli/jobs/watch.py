"""Wait for chart files to be saved, on every system alike: by looking at their times."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

Stamp = tuple[int, int]
INTERVAL = 0.3  # seconds between two looks
_SETTLED = 0.15  # an editor may still be writing; a file counts as saved when it did not change for so long


def changes(
    files: Callable[[], Sequence[Path]], wait: Callable[[float], None] = time.sleep
) -> Iterator[tuple[list[Path], list[Path]]]:
    """Yield (all files, those that are new or saved) at once, then after every change; ends with KeyboardInterrupt.

    files : finds the files anew, so that charts that are added later are seen; wait : how to sleep
    """
    known: dict[Path, Stamp] = {}
    while True:
        found = list(files())
        seen = {path: _stamp(path) for path in found}
        changed = [path for path in found if known.get(path) != seen[path]]
        if changed and known:
            wait(_SETTLED)
            if any(_stamp(path) != seen[path] for path in changed):
                continue  # still being written
        if changed or set(known) - set(seen):
            known = seen
            yield found, changed
        wait(INTERVAL)


def _stamp(path: Path) -> Stamp:
    try:
        status = path.stat()
    except OSError:
        return (-1, -1)
    return status.st_mtime_ns, status.st_size
