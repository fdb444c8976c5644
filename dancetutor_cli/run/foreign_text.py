"""Text of other people in a spreadsheet and in the log of a CI job: never a formula, never a command."""

from __future__ import annotations

import io
import re
from typing import IO

# Cells of a CSV file that a spreadsheet takes for text, whatever they begin with, and how they are read back.

# With these a spreadsheet takes a cell for a formula, says OWASP; some of them know the wide forms, too.
_FORMULA = ("=", "+", "-", "@", "\t", "\r", "\uff1d", "\uff0b", "\uff0d", "\uff20")


def as_text(cell: str) -> str:
    """A text of other people as a cell: what would be a formula begins with an apostrophe, also behind blanks."""
    return f"'{cell}" if _is_formula(cell) else cell


def text_of(cell: str) -> str:
    """The text of which `as_text` has made a cell."""
    return cell[1:] if cell.startswith("'") and _is_formula(cell[1:]) else cell


def _is_formula(cell: str) -> bool:
    return cell.lstrip(" ").startswith(_FORMULA)


# Keeps text of other people from being read as a command by the log of a CI job.
#
# GitHub's runner takes a line for a command that begins with "::", after blanks, and one that holds "##[" anywhere. A
# file that is called "::error::gone" would so make an annotation, or end the masking of secrets.

_OLD = "##["
_ENDS = "\n\r\v\f\x1c-\x1e\x85\u2028\u2029"  # of lines, for anyone who reads a log
_AT_START = re.compile(rf"(^|[{_ENDS}])(\s*):(?=:)")
_END_CHARACTERS = "\n\r\v\f\x1c\x1d\x1e\x85\u2028\u2029"


def without_commands(text: str, *, from_start: bool = True) -> str:
    """Text in which no line is a command: a blank stands within "::" and "##[".

    from_start : whether the text begins a line, or goes on in one that holds nothing but blanks
    """
    if _OLD in text:
        text = text.replace(_OLD, "# #[")
    if "::" not in text:
        return text
    return _AT_START.sub(lambda at: at[0] if not from_start and not at.start() and not at[1] else f"{at[0]} ", text)


def json_without_commands(text: str) -> str:
    """JSON of the same meaning without "##["; no line of JSON begins with a colon."""
    return text.replace(_OLD, "\\u0023#[") if _OLD in text else text


def xml_without_commands(text: str) -> str:
    """XML of the same meaning in which no line is a command, if these characters are only in its texts."""
    return _AT_START.sub(r"\1\2&#58;", text.replace(_OLD, "&#35;#["))


class GuardedText(io.TextIOWrapper):
    """A stream of text on which no line is a command."""

    _blank = True  # whether the line so far is empty but for blanks

    def write(self, text: str, /) -> int:
        """Write text; returns its length."""
        super().write(without_commands(text, from_start=self._blank))
        self._remember(text)
        return len(text)

    def write_command(self, text: str) -> None:
        """Write lines that are meant to be commands."""
        super().write(text)
        self._remember(text)

    def _remember(self, text: str) -> None:
        begin = max(map(text.rfind, _END_CHARACTERS)) + 1  # of the last line
        self._blank = (self._blank or begin > 0) and not text[begin:].strip()


def write_command(stream: IO[str], text: str) -> None:
    """Write lines that are meant to be commands, whether the stream is guarded or not."""
    if isinstance(stream, GuardedText):
        stream.write_command(text)
    else:
        stream.write(text)
