"""Atomic writing of files, checks of output paths, and the suffixes of chart files."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import re
import stat
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import BinaryIO

from dancetutor_cli.run.errors import FileError, UsageError

# The suffixes of chart files, in lower case.

SONG_SUFFIXES = (".sm", ".ssc")
UCS_SUFFIX = ".ucs"  # Pump's format: one chart, without the tags of a song
CHART_SUFFIXES = (*SONG_SUFFIXES, UCS_SUFFIX)
EDIT_SUFFIX = ".edit"  # in .sm or .ssc form; the difficulty of its charts is always Edit


# Write a file whole or not at all, in a way that another process, a crash or a full disk cannot spoil.
#
# The new bytes go to a temporary file beside the old one, reach the disk, and take its place by a rename. The temporary
# file has a name made from the name of the file. It is locked while it is written, so it is the lock between processes.
# The next process finds a temporary file that a killed process has left, sees that it is not locked, and removes it.

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

_LONE = re.compile("[\ud800-\udfff]")
SUFFIX = ".dancetutor.tmp"
_LONGEST_NAME = 255 - len(SUFFIX) - 1  # bytes; a longer file name is hashed
_NO_LINK = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0) | getattr(os, "O_CLOEXEC", 0)
PATIENCE = 10.0  # seconds to wait for another process that writes the same file
_ABANDONED = 600.0  # seconds after which a leftover counts as abandoned, on file systems without locks


class BusyError(FileError):
    """Another process is writing the same file."""


class ChangedError(FileError):
    """The file has changed since the new content was made from it."""


def write_atomic(path: Path, data: bytes | Callable[[BinaryIO], object], *, expect: bytes | None = None) -> None:
    """Replace `path` by `data` in one step; the file's mode, owner and a link that leads to it stay.

    Parameters
    ----------
    path : the file; a symbolic link is written through to the file that it names
    data : the new bytes, or a function that writes them to the open file it is given
    expect : the required content of the file; if it differs, another program has changed the file, and it is not
    written

    Raises
    ------
    ChangedError : the file does not hold `expect`; BusyError : another process is writing it
    FileError : nothing was written, for the reason in the message; in every case the file is unchanged
    """
    target = _target(path)
    old = _status(path, target)
    with _explained(path, old is not None), _locked_temporary(path, target) as (temporary, file):
        if old is not None:
            _keep_owner_and_mode(path, target, file.fileno(), old)
        if callable(data):
            data(file)
        else:
            file.write(data)
        file.flush()
        os.fsync(file.fileno())
        if expect is not None and _content(target) != expect:
            raise ChangedError(
                path, "was changed by another program in the meantime; nothing was written, run it again"
            )
        if fcntl is None:
            file.close()  # Windows cannot rename an open file
        temporary.replace(target)
    _sync_folder(target.parent)


def encode_json(text: str) -> bytes:
    """Encode JSON text in UTF-8. Undecodable bytes of a file name are written as \\udcXX, which reading restores."""
    return _LONE.sub(lambda found: f"\\u{ord(found[0]):04x}", text).encode("utf-8")


def back_up(path: Path) -> Path:
    """Copy a file beside itself as NAME.bak, NAME.bak2, ..., unless such a copy exists; return the path of the copy."""
    data = path.read_bytes()
    number = 1
    while True:
        copy = path.with_name(f"{path.name}.bak{'' if number == 1 else number}")
        if not copy.exists():
            write_atomic(copy, data)
            with contextlib.suppress(OSError):
                copy.chmod(stat.S_IMODE(path.stat().st_mode))
            return copy
        if _content(copy) == data:
            return copy
        number += 1


def remove_leftovers(folder: Path) -> int:
    """Remove the temporary files that killed processes have left in a folder (not below it); return their number.

    A temporary file that a living process is writing stays.
    """
    try:
        found = [entry for entry in folder.iterdir() if entry.name.startswith(".") and entry.name.endswith(SUFFIX)]
    except OSError:
        return 0
    count = 0
    for entry in found:
        with contextlib.suppress(OSError):
            count += _discard(entry)
    return count


def temporary_name(target: Path) -> Path:
    """Return the path of the temporary file for the new content of `target`."""
    name = target.name
    if len(os.fsencode(name)) > _LONGEST_NAME:
        name = hashlib.sha256(os.fsencode(name)).hexdigest()
    return target.with_name(f".{name}{SUFFIX}")


def place_of(path: Path) -> Path:
    """Return the file that writing to `path` changes, with links resolved.

    Raises FileError if it must not be replaced.
    """
    target = _target(path)
    _status(path, target)
    return target


def _target(path: Path) -> Path:
    """Return the file itself, with links resolved."""
    try:
        return path.resolve(strict=True) if path.is_symlink() else path
    except FileNotFoundError:
        raise FileError(path, "is a link to a file that is not there") from None
    except (OSError, RuntimeError) as error:  # the latter is how Python before 3.13 reports a circle of links
        if isinstance(error, OSError) and error.errno == errno.ENAMETOOLONG:
            raise FileError(path, "cannot be written: its name is too long for the file system") from error
        raise FileError(path, "is a link that leads nowhere") from error


def _status(path: Path, target: Path) -> os.stat_result | None:
    """Return the status of the file, or None if it does not exist. Raises FileError if it must not be replaced."""
    try:
        status = target.stat()
    except FileNotFoundError:
        if not target.parent.is_dir():
            raise FileError(path, f"its folder '{target.parent}' does not exist") from None
        return None
    except OSError as error:
        raise FileError(path, f"cannot be written: {error.strerror}") from error
    if not stat.S_ISREG(status.st_mode):
        raise FileError(path, "is a folder" if stat.S_ISDIR(status.st_mode) else "is not a regular file")
    # A rename checks only the folder's permissions; a read-only file is respected, even for root.
    if not status.st_mode & 0o222 or not os.access(target, os.W_OK):
        raise FileError(path, "is read-only; nothing was written")
    return status


@contextlib.contextmanager
def _explained(path: Path, is_there: bool) -> Iterator[None]:
    """Turn errors of the system into FileError with one line about the file and its state."""
    unchanged = "; the old file is unchanged" if is_there else ""
    try:
        yield
    except PermissionError as error:
        raise FileError(path, f"cannot be written: {error.strerror} (is its folder read-only?)") from error
    except OSError as error:
        raise FileError(path, f"cannot be written: {error.strerror or error}{unchanged}") from error


@contextlib.contextmanager
def _locked_temporary(path: Path, target: Path) -> Iterator[tuple[Path, BinaryIO]]:
    """Yield a new, open and locked temporary file for `target`; it is removed at the end if it was not renamed."""
    temporary = temporary_name(target)
    descriptor = _claim(path, temporary)
    renamed = False
    try:
        with open(descriptor, "wb", closefd=True) as file:  # noqa: PTH123
            yield temporary, file
            renamed = True
            # The lock ends with the file, after the rename: anyone who waited for it sees the new content.
    finally:
        if not renamed:
            with contextlib.suppress(OSError):
                temporary.unlink()


def _claim(path: Path, temporary: Path) -> int:
    """Create and lock the temporary file; wait while another process holds it, and remove an abandoned one."""
    deadline = time.monotonic() + PATIENCE
    while True:
        try:
            descriptor = os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL | _NO_LINK, 0o666)
        except FileExistsError:
            if not _discard(temporary):
                if time.monotonic() > deadline:
                    raise BusyError(path, "is being written by another process; nothing was written") from None
                time.sleep(0.02)
            continue
        if _lock(descriptor) is not False and _is_at(descriptor, temporary):
            return descriptor
        os.close(descriptor)  # another process took the file for a leftover before it was locked


def _discard(temporary: Path) -> bool:
    """Remove a temporary file unless a living process holds it; return whether it was removed."""
    if fcntl is None:  # Windows does not remove open files
        try:
            temporary.unlink(missing_ok=True)
        except PermissionError:
            return False
        return True
    try:
        descriptor = os.open(temporary, os.O_RDONLY | os.O_NONBLOCK | _NO_LINK)
    except FileNotFoundError:
        return False
    try:
        locked = _lock(descriptor)
        if locked is None:
            locked = time.time() - os.fstat(descriptor).st_mtime > _ABANDONED
        if not locked:
            return False
        if _is_at(descriptor, temporary):
            temporary.unlink()
        return True
    finally:
        os.close(descriptor)


def _lock(descriptor: int) -> bool | None:
    """Lock an open file; return whether this succeeded, or None if the file system has no locks."""
    if fcntl is None:
        return None
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return None  # then only `expect` detects a second writer
    return True


def _is_at(descriptor: int, path: Path) -> bool:
    """Whether the open file still has this path."""
    if fcntl is None:
        return True
    try:
        there = path.lstat()
    except OSError:
        return False
    return os.path.samestat(there, os.fstat(descriptor))


def _keep_owner_and_mode(path: Path, target: Path, descriptor: int, old: os.stat_result) -> None:
    if os.name == "nt":
        return
    new = os.fstat(descriptor)
    if (new.st_uid, new.st_gid) != (old.st_uid, old.st_gid):
        try:
            os.chown(descriptor, old.st_uid, old.st_gid)
        except PermissionError:
            raise FileError(path, "belongs to another user; writing it would change its owner") from None
    os.chmod(descriptor, stat.S_IMODE(old.st_mode))
    for name in _attributes(target):
        with contextlib.suppress(OSError):
            os.setxattr(descriptor, name, os.getxattr(target, name))  # type: ignore[attr-defined,unused-ignore]


def _attributes(target: Path) -> list[str]:
    """Return the names of a file's extended attributes, including access lists; Python supports them only on Linux."""
    try:
        return list(os.listxattr(target))  # type: ignore[attr-defined,unused-ignore]
    except (AttributeError, OSError):
        return []


def _content(target: Path) -> bytes | None:
    try:
        return target.read_bytes()
    except FileNotFoundError:
        return None


def _sync_folder(folder: Path) -> None:
    """Write a rename to the disk; not every system can, but the file is complete in any case."""
    if os.name == "nt":
        return
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


# Checks of output paths before the work: the folder of a file must exist, but an output folder is made with its
# parents.

_DENIED = os.strerror(errno.EACCES)


def check_file(path: Path, suffixes: Sequence[str] = (), *, or_device: bool = False) -> None:
    """Raise the error that writing a file here would raise; nothing is created.

    suffixes : allowed suffixes, in lower case; empty: any suffix
    or_device : whether the path may also be a device or a pipe of any name
    """
    suffix = path.suffix.lower()
    if suffix in (*CHART_SUFFIXES, EDIT_SUFFIX):
        raise FileError(path, "is the name of a chart, which would be overwritten; give another name")
    device = or_device and path.exists() and not path.is_file() and not path.is_dir()
    if suffixes and suffix not in suffixes and not device:
        raise UsageError(f"{path}: the name must end in {one_of(suffixes)}")
    if path.is_dir():
        raise FileError(path, "is a folder; give a file name")
    if not path.parent.is_dir():
        raise FileError(path, f"its folder '{path.parent}' does not exist; make it first")
    if path.is_file() or not path.exists():  # a device or a pipe is written directly
        folder = (path.resolve() if path.is_symlink() else path).parent
        if folder.is_dir() and not _can_be_written(folder):
            raise FileError(path, f"its folder '{folder}' cannot be written: {_DENIED}")


def _can_be_written(folder: Path) -> bool:
    return os.access(folder, os.W_OK | os.X_OK)


def one_of(names: Iterable[str]) -> str:
    """Join names for a message: ".svg or .png"."""
    *most, last = names
    return f"{', '.join(most)} or {last}" if most else last


def plain_name(text: str) -> str:
    """Make a lower-case file name, which may be empty; "_" replaces characters that file systems may refuse."""
    return re.sub(r"[^\w.-]+", "_", text.lower()).strip("._")[:120]


class FreeNames:
    """Names of files in one folder, each given only once; file systems may ignore case."""

    def __init__(self, *taken: str) -> None:
        self._taken = {name.lower() for name in taken}

    def take(self, stem: str) -> str:
        """Return the stem, or the first of "STEM-2", "STEM-3" ... that is free."""
        name, number = stem, 2
        while name.lower() in self._taken:
            name, number = f"{stem}-{number}", number + 1
        self._taken.add(name.lower())
        return name


def check_folder(path: Path) -> None:
    """Raise if this cannot be a writable folder: a file has this path or that of a parent, or writing is not allowed.

    Nothing is created.
    """
    for one in (path, *path.parents):
        if one.exists():
            if not one.is_dir():
                raise FileError(path, "is a file; give a folder" if one == path else f"'{one}' is a file, not a folder")
            if not _can_be_written(one):
                raise FileError(path, f"cannot be used as a folder: {_DENIED}")
            return


def make_folder(path: Path) -> None:
    """Make a folder and its missing parents."""
    check_folder(path)
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(path, f"cannot be used as a folder: {error.strerror}") from error
