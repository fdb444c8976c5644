"""The base classes of all errors that a user may see. Each is one line with what happened, where, and what to do."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Literal


class DancetutorError(Exception):
    """Base of every expected error. `str(error)` is the one line printed; `exit_status` ends the process."""

    exit_status = 2


class UsageError(DancetutorError):
    """The command line, a preset or a configuration has an unknown name; the message has the valid names."""


class FileError(DancetutorError):
    """A file could not be read or written.

    Parameters
    ----------
    path : the file
    message : cause and, where there is one, what to do
    line, column : 1-based place in the file, if known
    """

    def __init__(self, path: Path | str, message: str, line: int | None = None, column: int | None = None) -> None:
        message = " ".join(message.splitlines())  # a quoted part of a file may have several lines
        super().__init__(path, message, line, column)  # all arguments, so that the error survives pickling
        self.path = Path(path)
        self.message = message
        self.line = line
        self.column = column

    def __str__(self) -> str:
        place = "".join(f":{n}" for n in (self.line, self.column) if n is not None)
        return f"{self.path}{place}: {self.message}"


class MissingFileError(FileError):
    """A file that another file names does not exist; callers that do not need it may continue."""


class ChartError(FileError):
    """A chart file that cannot be understood."""


class NoChartsError(ChartError):
    """A song's file with tags but without notes, such as the music of a menu."""


class UnavailableError(DancetutorError):
    """Something outside the project is missing: OpenGL, an encoder, disk space. The message says how to repair it."""


_MANY = 12  # a message does not list more names than this if one name is near


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return " (did you mean NAME?)" with the known name nearest to a wrong word, or "" if no name is near."""
    from difflib import get_close_matches

    names = {name.lower(): name for name in known}
    near = get_close_matches(word.strip().lower(), names, n=1)
    return f" (did you mean {names[near[0]]}?)" if near else ""


def choose_text(word: str, known: Iterable[str], *others: str) -> str:
    """Return the text to put after a wrong word: " (did you mean NAME?); choose A, B, or a .yaml file".

    If there are many names and one is near, only that name is listed. others : alternatives to the names
    """
    names = list(known)
    near = did_you_mean(word, names)
    if not names:
        return "; no name is allowed here"
    if near and len(names) > _MANY:
        return near
    return f"{near}; choose {', '.join([*names, *(f'or {other}' for other in others)])}"


# Extras are large parts that not every user needs: their packages, and the command that installs them.
#
# The command names the packages themselves: `pip install NAME` works however dancetutor was installed, and cannot fetch
# an unrelated package called dancetutor.

Extra = Literal["physics", "gl", "ffmpeg", "cluster"]
PACKAGES: Mapping[Extra, str] = {
    "physics": "mujoco-core",
    "gl": "pyrender==0.1.45",
    "ffmpeg": "imageio-ffmpeg",
    "cluster": "distributed",
}


def install_command(extra: Extra) -> str:
    """Return the command that installs an extra, for the end of a message."""
    return f"pip install {PACKAGES[extra]}"


def plural(count: int, noun: str) -> str:
    """Return a count with its noun: "1 chart", "2 charts"."""
    return f"{count} {noun}{'' if count == 1 else 's'}"
