"""The one base of all errors that a user may see: one line each, saying what, where and what to do."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Literal


class DancetutorError(Exception):
    """Base of every expected error. `str(error)` is the one line printed; `exit_status` ends the process."""

    exit_status = 2


class UsageError(DancetutorError):
    """The command line, a preset or a configuration asks for something that does not exist; names what does."""


class FileError(DancetutorError):
    """A file could not be read or written.

    Parameters
    ----------
    path : the file
    message : cause and, where there is one, what to do
    line, column : 1-based place in the file, if known
    """

    def __init__(self, path: Path | str, message: str, line: int | None = None, column: int | None = None) -> None:
        message = " ".join(message.splitlines())  # what it quotes of a file may have several
        super().__init__(path, message, line, column)  # all arguments, so that the error survives pickling
        self.path = Path(path)
        self.message = message
        self.line = line
        self.column = column

    def __str__(self) -> str:
        place = "".join(f":{n}" for n in (self.line, self.column) if n is not None)
        return f"{self.path}{place}: {self.message}"


class MissingFileError(FileError):
    """A file that another one names is not there; anyone who can do without it may go on."""


class ChartError(FileError):
    """A chart file that cannot be understood."""


class NoChartsError(ChartError):
    """A file of a song that nobody meant to be danced, such as the music of a menu: it has tags, but no notes."""


class UnavailableError(DancetutorError):
    """Something outside the project is missing: OpenGL, an encoder, disk space. Says how to repair it."""


_MANY = 12  # names that a message does not list if it knows the one that was meant


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """To be put behind a wrong word in a message: " (did you mean NAME?)" with the nearest name, "" if none is near."""
    from difflib import get_close_matches

    names = {name.lower(): name for name in known}
    near = get_close_matches(word.strip().lower(), names, n=1)
    return f" (did you mean {names[near[0]]}?)" if near else ""


def choice(word: str, known: Iterable[str], *others: str) -> str:
    """To be put behind a wrong word: " (did you mean NAME?); choose A, B, or a .yaml file".

    Of many names only the nearest one is said, if one is near. others : what may be written besides the names
    """
    names = list(known)
    near = did_you_mean(word, names)
    if not names:
        return "; no name is allowed here"
    if near and len(names) > _MANY:
        return near
    return f"{near}; choose {', '.join([*names, *(f'or {other}' for other in others)])}"


# Large parts that not everybody needs are extras: the packages of each, and the message if they are missing.
#
# A message names the packages themselves: `pip install NAME` works in whatever way dancetutor itself was installed, and
# fetches no stranger's package that happens to be called dancetutor.

Extra = Literal["physics", "gl", "ffmpeg", "cluster"]
PACKAGES: Mapping[Extra, str] = {
    "physics": "mujoco-core",
    "gl": "pyrender==0.1.45",
    "ffmpeg": "imageio-ffmpeg",
    "cluster": "distributed",
}


def install_command(extra: Extra) -> str:
    """The command that adds an extra, for the end of a message."""
    return f"pip install {PACKAGES[extra]}"


def plural(count: int, noun: str) -> str:
    """A count for people: "1 chart", "2 charts"."""
    return f"{count} {noun}{'' if count == 1 else 's'}"
