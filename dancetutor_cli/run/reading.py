"""Reading of untrusted files, with limits of kind, size and depth, and the paths of the program's own configs."""

from __future__ import annotations

import errno
import json
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache, lru_cache
from math import isfinite
from pathlib import Path
from typing import Any, BinaryIO

from dancetutor_cli.run.errors import FileError, MissingFileError, UnavailableError, UsageError, choose_text

# Reading of untrusted files: only regular files of limited size, and JSON of limited depth with unique names.
#
# A folder of songs may hold anything: named pipes that never end, devices, circular links, and malicious files. Errors
# are one line and do not quote a file's content.

MEGABYTE = 1_000_000
CHART_LIMIT = 64 * MEGABYTE  # the largest charts of real packs have 4 MB
SETTINGS_LIMIT = MEGABYTE  # presets, layouts, dancetutor.yaml
JSON_LIMIT = 256 * MEGABYTE  # plays and baselines of whole packs
FONT_LIMIT = 128 * MEGABYTE  # fonts for all of East Asia have half of that
MAX_DEPTH = 48  # levels of nested mappings and lists
_FLAGS = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0) | getattr(os, "O_CLOEXEC", 0)
_KINDS = (
    (stat.S_ISDIR, "is a folder; it cannot be read as a file"),
    (stat.S_ISFIFO, "is a named pipe, not a file; it is not read"),
    (stat.S_ISSOCK, "is a socket, not a file; it is not read"),
    (stat.S_ISCHR, "is a device, not a file; it is not read"),
    (stat.S_ISBLK, "is a device, not a file; it is not read"),
)


def read_bytes(path: Path, limit: int) -> bytes:
    """Return the content of a regular file of at most `limit` bytes.

    Raises MissingFileError if the file does not exist. Raises FileError for a pipe, a device, a folder, circular links,
    too many bytes, or an error of the system.
    """
    with _opened(path) as (file, size):
        data = b""
        if size <= limit:
            data = file.read(size + 1)  # reading up to the limit would allocate a buffer of that size
            if len(data) > size:
                data += file.read(limit + 1 - len(data))
        if max(size, len(data)) > limit:  # the file has grown, or reports no size, as files of /proc do
            raise FileError(path, f"is larger than {limit / MEGABYTE:.3g} MB; it is not read")
        return data


def read_ends(path: Path, first: int, last: int) -> tuple[bytes, bytes, int]:
    """Return up to `first` bytes of the start and `last` of the end of a file, and its size; errors as `read_bytes`."""
    with _opened(path) as (file, size):
        head = file.read(first)
        file.seek(max(size - last, 0))
        return head, file.read(last), size


@contextmanager
def _opened(path: Path) -> Iterator[tuple[BinaryIO, int]]:
    """Open a regular file and yield it with its size; errors in the block are raised as by `read_bytes`."""
    try:
        descriptor = os.open(path, _FLAGS)
    except FileNotFoundError:
        reason = "is a link to a file that is not there" if os.path.islink(path) else "no such file or folder"  # noqa: PTH114
        raise MissingFileError(path, reason) from None
    except (OSError, ValueError) as error:
        reason = f"cannot be read: {getattr(error, 'strerror', None) or error}"
        is_too_long = getattr(error, "errno", None) == errno.ENAMETOOLONG  # so no file can have that name
        raise (MissingFileError if is_too_long else FileError)(path, reason) from None
    try:
        status = os.fstat(descriptor)
        for is_kind, what in _KINDS:
            if is_kind(status.st_mode):
                raise FileError(path, what)
        with open(descriptor, "rb", closefd=False) as file:
            yield file, status.st_size
    except (OSError, MemoryError) as error:
        raise FileError(path, f"cannot be read: {getattr(error, 'strerror', None) or 'out of memory'}") from None
    finally:
        os.close(descriptor)


def is_regular(path: Path) -> bool:
    """Whether a path is a regular file, with links resolved. Never raises."""
    try:
        return stat.S_ISREG(path.stat().st_mode)
    except (OSError, ValueError):
        return False


def is_outside(path: Path, folder: Path) -> bool:
    """Whether a path is outside a folder, by its name or by a link."""
    try:
        return not path.resolve().is_relative_to(folder.resolve())
    except (OSError, RuntimeError, ValueError):  # RuntimeError: a circle of links, before Python 3.13
        return True


def read_json(path: Path, limit: int = JSON_LIMIT, writer: str = "") -> Any:
    """Read a JSON file. Raises FileError as `read_bytes` and `parse_json`."""
    return parse_json(read_bytes(path, limit), path, writer)


def parse_json(data: bytes, path: Path, writer: str = "") -> Any:
    """Parse JSON in UTF-8, with or without a BOM: at most `MAX_DEPTH` levels, only finite numbers, unique names.

    path, writer : for errors: the file, and what writes such files. Raises FileError with the place, never with
    the content.
    """
    try:
        value = json.loads(
            data.decode("utf-8-sig"), object_pairs_hook=_once, parse_float=_finite, parse_constant=_finite
        )
    except json.JSONDecodeError as error:
        advice = f"; give a file that {writer} wrote" if writer else ""
        raise FileError(path, f"is not JSON{advice}", error.lineno, error.colno) from None
    except UnicodeDecodeError:
        raise FileError(path, "is not JSON: the text is not UTF-8") from None
    except RecursionError:
        raise FileError(path, f"is nested deeper than {MAX_DEPTH} levels; it is not read") from None
    except _BadValueError as error:
        raise FileError(path, str(error)) from None
    except ValueError:
        raise FileError(path, "has a number of too many digits; it is not read") from None
    if any(depth > MAX_DEPTH for depth in _depths(value)):
        raise FileError(path, f"is nested deeper than {MAX_DEPTH} levels; it is not read")
    return value


class _BadValueError(ValueError):
    """A value that JSON allows but this program does not."""


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        seen: set[str] = set()
        twice = next(name for name, _ in pairs if name in seen or seen.add(name))  # type: ignore[func-returns-value]
        raise _BadValueError(f"has the name '{shown_key(twice)}' twice in one object; remove one")
    return found


def _finite(text: str) -> float:
    number = float(text)
    if not isfinite(number):
        raise _BadValueError("has a number that is infinite or not a number; write a finite one")
    return number


def _depths(value: Any) -> Iterator[int]:
    """Yield the depth of every mapping and list, without recursion."""
    open_values = [(value, 1)] if isinstance(value, dict | list) else []
    while open_values:
        one, depth = open_values.pop()
        yield depth
        inside = one.values() if isinstance(one, dict) else one
        open_values += [(below, depth + 1) for below in inside if isinstance(below, dict | list)]


def shown_key(key: object) -> str:
    """Return a key of an untrusted file for a message: short, on one line, without characters that harm a terminal."""
    text = str(key)
    plain = "".join(c if c.isprintable() else "?" for c in text[:40])
    return plain + ("..." if len(text) > 40 else "")


# The paths of the program's own data, `configs/` and `charts/`, in a checkout or in an installed wheel.

PACKAGE = Path(__file__).resolve().parent.parent


@cache
def _root(name: str) -> Path:
    for candidate in (PACKAGE / "_data" / name, PACKAGE.parent / name):
        if candidate.is_dir():
            return candidate
    raise UnavailableError(f"the installation is incomplete: folder '{name}' is missing; install dancetutor again")


@lru_cache(maxsize=256)
def config_path(name: str) -> Path:
    """Return the path of a file or folder in `configs/`, for example ``config_path("presets/thesis.yaml")``."""
    return _root("configs") / name


def config_names(folder: str) -> list[str]:
    """Return the names of the YAML files in a folder of `configs/`, such as the presets or layouts."""
    return sorted(path.stem for path in config_path(folder).glob("*.yaml"))


def named_file(folder: str, name: str | Path) -> Path:
    """Return the file in `configs/` with a name, or a file of the user.

    folder : the folder, such as "presets"; its name without the last letter is the noun in messages

    Raises UsageError for an unknown name.
    """
    names, path = config_names(folder), Path(name)
    if str(name) in names:
        return config_path(f"{folder}/{name}.yaml")
    if path.suffix.lower() in (".yaml", ".yml") or is_regular(path):
        return path
    raise UsageError(f"there is no {folder[:-1]} '{name}'{choose_text(str(name), names, 'a .yaml file')}")


def charts_path() -> Path:
    """Return the folder of the demo songs."""
    return _root("charts")
