"""How wide and in which colours a stream is written to; rich is asked only where it may be a terminal."""

from __future__ import annotations

import os
from typing import IO, TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from rich.color import ColorSystem
    from rich.console import Console

_WITHOUT_TERMINAL = 100  # characters of a line
_SAY_MORE = ("FORCE_COLOR", "TTY_COMPATIBLE", "COLUMNS")  # variables that rich looks at for any stream


class Terminal(NamedTuple):
    """What a report is written for. colours : None without any; plain : whether it has no letters but ASCII's"""

    width: int = _WITHOUT_TERMINAL
    colours: ColorSystem | None = None
    plain: bool = False

    def paint(self, text: str, style: str) -> str:
        """Text in a style of rich's, such as "bold red", where there are colours."""
        if self.colours is None or not text:
            return text
        from rich.style import Style

        return Style.parse(style).render(text, color_system=self.colours)


def terminal_of(stream: IO[str]) -> Terminal:
    """What a stream leads to: without colours if it is no terminal or NO_COLOR is set, and then of our width."""
    plain = not can_encode(stream, "─")
    if not stream.isatty() and not any(name in os.environ for name in _SAY_MORE):
        return Terminal(plain=plain)
    console = _console(stream)
    return Terminal(console.width, _colours(console), plain)


def can_encode(stream: IO[str], text: str) -> bool:
    """Whether a stream's encoding has these letters."""
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
