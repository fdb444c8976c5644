"""Warnings of a run over many files: what is the same of several is one line, with a count and the first names."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from dancetutor_cli.reports.safe import safe, safe_path

_NAMED = 4  # files at most
_PLACE = re.compile(r"(:\d+)*:\s*")
_CHART = re.compile(r"[a-z]+-[a-z-]+ \S+ -?\d+: ")  # "dance-single Hard 9: "
_NUMBER = re.compile(r"\d+")


class JoinedWarnings:
    """Takes warnings as they come, and tells them at the end.

    every : each of them is a line of its own
    """

    def __init__(self, *, every: bool = False) -> None:
        self._every = every
        self._kinds: dict[tuple[Path, str] | str, list[tuple[Path, str]]] = {}

    def add(self, path: Path, warning: str) -> None:
        """Take note of what is said of a file, which may name it first; what is said twice is counted."""
        if not warning.startswith(str(path)):
            warning = f"{path}: {warning}"
        kind = _NUMBER.sub("0", _CHART.sub("", _PLACE.sub("", warning.removeprefix(str(path)), count=1)))
        self._kinds.setdefault((path, warning) if self._every else kind, []).append((path, warning))

    def lines(self) -> Iterator[str]:
        """The first of each kind, and of which files the same is true."""
        for found in self._kinds.values():
            path, warning = found[0]
            others = list(dict.fromkeys(other for other, _ in found if other != path))
            more = ""
            if others:
                named = others if len(others) <= _NAMED else others[: _NAMED - 1]
                names = ", ".join(safe_path(str(other)) for other in named)
                rest = f" and {len(others) - len(named)} others" if len(named) < len(others) else ""
                more = f"; the same of {len(others)} more: {names}{rest}"
            elif len(found) > 1:
                times = "once" if len(found) == 2 else f"{len(found) - 1} times"
                more = f"; the same {times} more in this file"
            yield f"warning: {safe(warning)}{more}" + (" (-v tells each)" if more and not self._every else "")
