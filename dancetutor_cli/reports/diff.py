"""A unified diff for people: in colours where reports have them."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator

from dancetutor_cli.reports.terminal import terminal_of

_STYLES = {"+": "green", "-": "red", "@": "cyan"}


def coloured(diff: Iterable[str]) -> Iterator[str]:
    """Its lines, as standard output shows them."""
    paint = terminal_of(sys.stdout).paint
    for line in diff:
        style = _STYLES.get(line[:1])
        yield paint(line, style) if style else line
