"""Standard output and standard error as this program needs them: their names in errors, letters that they lack."""

from __future__ import annotations

import errno
import io
import os
import sys
from typing import Any

from dancetutor_cli.workflow_commands import GuardedText

OUTPUT = "standard output"
_FULL = (errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC), errno.EFBIG)


class _NamedOutput(io.FileIO):
    """Standard output, whose errors say that it is it: Python's own name no file."""

    def write(self, data: Any) -> int:
        try:
            return super().write(data)
        except OSError as error:
            raise OSError(error.errno, error.strerror, OUTPUT) from None


class _Errors(io.FileIO):
    """Standard error: where nothing can be said (a full disk), the run goes on, and its exit status tells."""

    def write(self, data: Any) -> int:
        try:
            return super().write(data)
        except BrokenPipeError:
            raise
        except OSError:
            return len(data)


def open_streams() -> bool:
    """Make both ready; False if standard output is closed."""
    if sys.stderr is None:  # closed, as by `2>&-`
        sys.stderr = open(os.devnull, "w", encoding="utf-8")  # noqa: PTH123, SIM115
    if sys.stdout is None:
        return False
    sys.stdout, sys.stderr = _written_by(_NamedOutput, sys.stdout), _written_by(_Errors, sys.stderr)
    for stream in (sys.stdout, sys.stderr):
        _say_what_it_can(stream)
    return True


def _written_by(kind: type[io.FileIO], stream: Any) -> Any:
    """The same stream on a file of this kind, in which no text of others is a command for CI.

    A console of Windows, which is never full, stays as it is.
    """
    if not isinstance(stream, io.TextIOWrapper):
        return stream
    has_buffer = type(stream.buffer) is io.BufferedWriter
    if type(stream.buffer.raw if has_buffer else stream.buffer) is not io.FileIO:
        return stream
    raw = kind(stream.fileno(), "wb", closefd=False)
    return GuardedText(
        io.BufferedWriter(raw) if has_buffer else raw, stream.encoding, stream.errors,
        line_buffering=stream.line_buffering, write_through=stream.write_through,
    )  # fmt: skip


def _say_what_it_can(stream: object) -> None:
    """On a console that is not UTF-8, letters that it lacks come as \\uXXXX: a title must not end the run."""
    encoding = str(getattr(stream, "encoding", None) or "utf-8").lower().replace("_", "-")
    if encoding not in ("utf-8", "utf8", "utf-16") and isinstance(stream, io.TextIOWrapper):
        stream.reconfigure(errors="backslashreplace")


def leave_output() -> None:
    """Nothing more goes to standard output: what is left in its buffer would fail once more as the process ends."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def told(error: OSError) -> str:
    """What the system said, in one line: where, what, and what to do about a full disk."""
    where = f"{error.filename}: " if error.filename else ""
    line = f"{where}{error.strerror or error}"
    if error.filename == OUTPUT and error.errno in _FULL:
        line += "; what was written is cut short: make room, or send it elsewhere"
    return line
