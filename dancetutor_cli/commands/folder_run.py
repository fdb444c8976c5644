"""The messages of a run over many files: errors, and warnings that several files share as one line."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.reports.terminal import failures_table
from dancetutor_cli.run.errors import DancetutorError, UsageError
from dancetutor_cli.run.files import make_folder
from dancetutor_cli.run.foreign_text import safe, safe_path

if TYPE_CHECKING:
    from dancetutor_cli.chart.selection import UnreadableFile


# Warnings of a run: a warning that several files share is one line, with a count and their names.

_NAMED = 4  # limit of the files that a warning names
_PLACE = re.compile(r"(:\d+)*:\s*")
_CHART = re.compile(r"[a-z]+-[a-z-]+ \S+ -?\d+: ")  # "dance-single Hard 9: "
_NUMBER = re.compile(r"\d+")


class JoinedWarnings:
    """The warnings of a run, collected for its end.

    every : whether each warning is a line of its own
    """

    def __init__(self, *, every: bool = False) -> None:
        self._every = every
        self._kinds: dict[tuple[Path, str] | str, list[tuple[Path, str]]] = {}

    def add(self, path: Path, warning: str) -> None:
        """Add a warning about a file, which may begin with the file's name; repeated warnings are counted."""
        if not warning.startswith(str(path)):
            warning = f"{path}: {warning}"
        kind = _NUMBER.sub("0", _CHART.sub("", _PLACE.sub("", warning.removeprefix(str(path)), count=1)))
        self._kinds.setdefault((path, warning) if self._every else kind, []).append((path, warning))

    def lines(self) -> Iterator[str]:
        """Yield the first warning of each kind, with the other files that have the same one."""
        for found in self._kinds.values():
            path, warning = found[0]
            others = list(dict.fromkeys(other for other, _ in found if other != path))
            more = ""
            if others:
                named = others if len(others) <= _NAMED else others[: _NAMED - 1]
                names = ", ".join(safe_path(str(other)) for other in named)
                rest = f" and {len(others) - len(named)} others" if len(named) < len(others) else ""
                more = f"; the same for {len(others)} more: {names}{rest}"
            elif len(found) > 1:
                times = "once" if len(found) == 2 else f"{len(found) - 1} times"
                more = f"; the same {times} more in this file"
            yield f"warning: {safe(warning)}{more}" + (" (-v prints each)" if more and not self._every else "")


# A run over the charts of a folder, for films (`render`) and pages (`page`).


@dataclass
class FolderRun:
    """The messages of a run. count : number of charts; unreadable : files that could not be read"""

    count: int
    unreadable: Sequence[UnreadableFile]
    warnings: JoinedWarnings
    done: int = 0

    def begin(self, source: Path, target: Path, no_match: str) -> None:
        """Make the folder `target`. Raises UsageError `no_match` without charts, or why `source` is unreadable."""
        if not self.count and not self.unreadable:
            raise UsageError(no_match)
        if not self.count and [bad.path for bad in self.unreadable] == [source]:  # without chart files, or unreadable
            raise DancetutorError(self.unreadable[0].error)
        if self.count:
            make_folder(target)

    def add(self, path: Path, warnings: Iterable[str]) -> str:
        """Count a chart that is done, and keep its warnings; returns its number for a message, "[3/12]"."""
        self.done += 1
        for warning in warnings:
            self.warnings.add(path, warning)
        return f"[{self.done}/{self.count}]"

    def warn(self, say: Callable[[str], object]) -> None:
        """Print the joined warnings so far, also of an interrupted run. say : prints a line"""
        for line in self.warnings.lines():
            say(line)

    def end(self, failed: Iterable[tuple[str, str, str]]) -> None:
        """Print the table of failures, and exit with 2 if there are any. failed : (file, chart, error) of each"""
        rows = [*((str(path), "", error) for path, error in self.unreadable), *failed]
        if rows:
            failures_table(rows)
            sys.exit(2)
