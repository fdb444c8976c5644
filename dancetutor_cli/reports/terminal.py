"""Text for terminals: width and colours, coloured diffs, tables of failures."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterable, Iterator
from typing import IO, TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rich.color import ColorSystem
    from rich.console import Console


from dancetutor_cli.run.foreign_text import safe

# The width and colours of a stream; rich is used only if the stream may be a terminal.

_WITHOUT_TERMINAL = 100  # characters of a line
_SAY_MORE = ("FORCE_COLOR", "TTY_COMPATIBLE", "COLUMNS")  # environment variables that rich obeys for any stream


class Terminal(NamedTuple):
    """The properties of an output stream.

    width : characters of a line; colours : None for no colours; plain : whether it shows only ASCII characters
    """

    width: int = _WITHOUT_TERMINAL
    colours: ColorSystem | None = None
    plain: bool = False

    def paint(self, text: str, style: str) -> str:
        """Return text in a style of rich, such as "bold red"; unchanged if there are no colours."""
        if self.colours is None or not text:
            return text
        from rich.style import Style

        return Style.parse(style).render(text, color_system=self.colours)


def terminal_of(stream: IO[str]) -> Terminal:
    """Return the properties of a stream. It has no colours if it is not a terminal, or if NO_COLOR is set."""
    plain = not can_encode(stream, "─")
    if not stream.isatty() and not any(name in os.environ for name in _SAY_MORE):
        return Terminal(plain=plain)
    console = _console(stream)
    return Terminal(console.width, _colours(console), plain)


def can_encode(stream: IO[str], text: str) -> bool:
    """Whether a stream's encoding has all characters of a text."""
    try:
        text.encode(getattr(stream, "encoding", None) or "utf-8")
    except UnicodeEncodeError:
        return False
    return True


def _console(stream: IO[str]) -> Console:
    from rich.console import Console

    console = Console(file=stream, markup=False, emoji=False, highlight=False)
    if console.is_terminal and not os.environ.get("NO_COLOR"):
        return console
    width = None if console.is_terminal or os.environ.get("COLUMNS") else _WITHOUT_TERMINAL
    return Console(file=stream, markup=False, emoji=False, highlight=False, color_system=None, width=width)


def _colours(console: Console) -> ColorSystem | None:
    from rich.color import ColorSystem

    systems = {
        "standard": ColorSystem.STANDARD,
        "256": ColorSystem.EIGHT_BIT,
        "truecolor": ColorSystem.TRUECOLOR,
    }
    return systems.get(console.color_system or "") if not console.legacy_windows else None


# A unified diff for people, in colours if the terminal has them.

_STYLES = {"+": "green", "-": "red", "@": "cyan"}


def colour_diff(diff: Iterable[str]) -> Iterator[str]:
    """Yield the lines of a diff, in colours if standard output has them."""
    paint = terminal_of(sys.stdout).paint
    for line in diff:
        style = _STYLES.get(line[:1])
        yield paint(line, style) if style else line


# The table of failures of a run over many charts.


def failures_table(rows: Iterable[tuple[str, str, str]]) -> None:
    """Print rows of (file, chart, error) as a table to standard error."""
    from rich.console import Console
    from rich.table import Table

    table = Table(title="Failed", title_justify="left")
    for name in ("file", "chart", "why"):
        table.add_column(name, overflow="fold")
    for row in rows:
        table.add_row(*(safe(cell) for cell in row))
    Console(stderr=True, markup=False, highlight=False).print(table)


# Lines that fit the width of a terminal.

FIXED_BLANK = "\0"  # a blank at which `cut` does not end a line
_COLOUR = re.compile("\x1b\\[[0-9;]*m")
_LONGEST_WORD = 20


def cut(line: str, width: int) -> str:
    """Return the words of a line that fit in `width` characters without colours. Long words, as of paths, are cut."""
    plain = len(_COLOUR.sub("", line))
    if plain > width:
        line = line[: width - 1 + len(line) - plain]
        words, _, rest = line.rpartition(" ")
        line = f"{words.rstrip(';,:')} …" if words.strip() and len(rest) < _LONGEST_WORD else f"{line}…"
    return line.replace(FIXED_BLANK, " ")
