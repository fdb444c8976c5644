"""The charts that `analyze` is given: files, folders that are searched, or one on standard input."""

from __future__ import annotations

import sys
from pathlib import Path

from dancetutor_cli.errors import UsageError

Source = tuple[Path, bytes | None]  # a chart file, and what standard input had of it


def sources(paths: tuple[Path, ...], stdin_filename: Path | None) -> list[Source]:
    """The chart files that the paths mean; standard input with its bytes."""
    from dancetutor_cli.library import find_files

    if any(str(path) == "-" for path in paths):
        if len(paths) > 1:
            raise UsageError("standard input (-) goes alone, without other paths")
        if sys.stdin is None:
            raise UsageError("standard input (-) is closed; send a chart to it, or name a file")
        data = sys.stdin.buffer.read()
        name = "stdin.ssc" if b"#NOTEDATA" in data.upper() else "stdin.sm"
        return [(stdin_filename or Path(name), data)]
    if stdin_filename is not None:
        raise UsageError("--stdin-filename names the chart on standard input: give - as PATH")
    return [(path, None) for path in find_files(paths)]
