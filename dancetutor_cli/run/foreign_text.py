"""Untrusted text made harmless: for a terminal, for a cell of a spreadsheet, for the log of a CI job."""

from __future__ import annotations

import io
import os
import re
from typing import IO

# Text from untrusted files, made safe to print: no control characters, no escapes, one line.

# Controls (C0, DEL, C1), line and paragraph separators, and characters that change the direction of text.
_UNSAFE = re.compile("[\x00-\x1f\x7f-\x9f\u2028\u2029\u200e\u200f\u202a-\u202e\u2066-\u2069\ufeff\ufffe\uffff]+")


def safe(text: str) -> str:
    """Return `text` on one line, without characters that move a cursor, change a colour or hide text."""
    return _UNSAFE.sub(" ", text).encode("utf-8", "replace").decode("utf-8").strip()


def safe_path(path: str) -> str:
    """Return a path for printing: as by `safe`, and bytes that are not UTF-8 become "�"."""
    try:
        name = os.fsencode(path)
    except UnicodeEncodeError:  # a name from a cache, written under an encoding with more letters
        name = path.encode("utf-8", "surrogateescape")
    return _UNSAFE.sub("?", name.decode("utf-8", "replace"))


# Cells of a CSV file that a spreadsheet reads as text, whatever they begin with, and their conversion back.

# A cell that begins with one of these is a formula in a spreadsheet (OWASP); some spreadsheets accept wide forms.
_FORMULA = ("=", "+", "-", "@", "\t", "\r", "\uff1d", "\uff0b", "\uff0d", "\uff20")


def as_text(cell: str) -> str:
    """Return text as a cell; an apostrophe is put before text that would be a formula, even after blanks."""
    return f"'{cell}" if _is_formula(cell) else cell


def text_of(cell: str) -> str:
    """Return the text from which `as_text` made a cell."""
    return cell[1:] if cell.startswith("'") and _is_formula(cell[1:]) else cell


def _is_formula(cell: str) -> bool:
    return cell.lstrip(" ").startswith(_FORMULA)


# Escaping of commands in the log of a CI job.
#
# GitHub's runner reads a line as a command if it begins with "::" after blanks, or has "##[" anywhere. So a file called
# "::error::gone" would make an annotation, and other names could end the masking of secrets.

_OLD = "##["
_ENDS = "\n\r\v\f\x1c\x1d\x1e\x85\u2028\u2029"  # line breaks of any log reader
_AT_START = re.compile(rf"(^|[{_ENDS}])(\s*):(?=:)")


def without_commands(text: str, *, from_start: bool = True) -> str:
    """Return text in which no line is a command, by a blank inside "::" and "##[".

    from_start : whether the text begins a line, or continues a line of blanks only
    """
    if _OLD in text:
        text = text.replace(_OLD, "# #[")
    if "::" not in text:
        return text
    return _AT_START.sub(lambda at: at[0] if not from_start and not at.start() and not at[1] else f"{at[0]} ", text)


def json_without_commands(text: str) -> str:
    """Return equivalent JSON without "##["; no line of JSON begins with a colon."""
    return text.replace(_OLD, "\\u0023#[") if _OLD in text else text


def xml_without_commands(text: str) -> str:
    """Return equivalent XML in which no line is a command; these characters must occur only in its texts."""
    return _AT_START.sub(r"\1\2&#58;", text.replace(_OLD, "&#35;#["))


class GuardedText(io.TextIOWrapper):
    """A text stream in which no line is a command."""

    _blank = True  # whether the line so far has only blanks

    def write(self, text: str, /) -> int:
        """Write text; returns its length."""
        super().write(without_commands(text, from_start=self._blank))
        self._remember(text)
        return len(text)

    def write_command(self, text: str) -> None:
        """Write lines that are intended as commands."""
        super().write(text)
        self._remember(text)

    def _remember(self, text: str) -> None:
        begin = max(map(text.rfind, _ENDS)) + 1  # of the last line
        self._blank = (self._blank or begin > 0) and not text[begin:].strip()


def write_command(stream: IO[str], text: str) -> None:
    """Write lines that are intended as commands to a guarded or plain stream."""
    if isinstance(stream, GuardedText):
        stream.write_command(text)
    else:
        stream.write(text)
