"""Warnings of a run over many files: a warning that several files share is one line, with a count and their names."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from dancetutor_cli.reports.terminal import safe, safe_path

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
