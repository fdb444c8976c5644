"""Files written whole or not at all, where results go, and what the files of charts are called."""

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

# What the files of charts are called, in lower case.

SONG_SUFFIXES = (".sm", ".ssc")
UCS_SUFFIX = ".ucs"  # of Pump: one chart, without a song's tags
CHART_SUFFIXES = (*SONG_SUFFIXES, UCS_SUFFIX)
EDIT_SUFFIX = ".edit"  # either form; its charts are Edits, whatever it says


# Write a file whole or not at all, in a way that another process, a crash or a full disk cannot spoil.
#
# The new bytes go to a temporary file beside the old one, reach the disk, and take its place by a rename. The temporary
# file has a name made from the file's own, and is locked while it is written: so it is the lock between two processes,
# and what a killed process left behind is found, seen to be nobody's, and removed by the next one.

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

_LONE = re.compile("[\ud800-\udfff]")
SUFFIX = ".dancetutor.tmp"
_LONGEST_NAME = 255 - len(SUFFIX) - 1  # bytes; a longer file name is hashed
_NO_LINK = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0) | getattr(os, "O_CLOEXEC", 0)
PATIENCE = 10.0  # seconds to wait for another process that writes the same file
_ABANDONED = 600.0  # seconds after which a leftover is nobody's, on file systems that have no locks to say


class BusyError(FileError):
    """Another process is writing the same file."""


class ChangedError(FileError):
    """The file is no longer what it was when the new content was made from it."""


def write_atomic(path: Path, data: bytes | Callable[[BinaryIO], object], *, expect: bytes | None = None) -> None:
    """Replace `path` by `data` in one step; the file's mode, owner and a link that leads to it stay.

    Parameters
    ----------
    path : the file; a symbolic link is written through to the file that it names
    data : the new bytes, or a function that writes them to the open file it is given
    expect : what the file must still hold; if it does not, somebody else has changed it and it is left alone

    Raises
    ------
    ChangedError : the file does not hold `expect`; BusyError : another process is writing it
    FileError : in one line why nothing was written; in every case the file is as it was
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
            file.close()  # Windows renames no open file
        temporary.replace(target)
    _sync_folder(target.parent)


def encoded(text: str) -> bytes:
    """JSON text in UTF-8. A file name that is no text stands in it as \\udcXX, and is the same name when it is read."""
    return _LONE.sub(lambda found: f"\\u{ord(found[0]):04x}", text).encode("utf-8")


def back_up(path: Path) -> Path:
    """Copy a file beside itself as NAME.bak, NAME.bak2, ...; an earlier copy of the same bytes will do. Returns it."""
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
    """Remove the temporary files that killed processes have left in a folder (not below it); how many there were.

    One that a living process is writing stays.
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
    """Where the new content of `target` is written before it takes its place."""
    name = target.name
    if len(os.fsencode(name)) > _LONGEST_NAME:
        name = hashlib.sha256(os.fsencode(name)).hexdigest()
    return target.with_name(f".{name}{SUFFIX}")


def place_of(path: Path) -> Path:
    """The place where `path` is really written, links followed. FileError for what must not be replaced."""
    target = _target(path)
    _status(path, target)
    return target


def _target(path: Path) -> Path:
    """The file itself, links followed."""
    try:
        return path.resolve(strict=True) if path.is_symlink() else path
    except FileNotFoundError:
        raise FileError(path, "is a link to a file that is not there") from None
    except (OSError, RuntimeError) as error:  # the latter is how Python before 3.13 reports a circle of links
        if isinstance(error, OSError) and error.errno == errno.ENAMETOOLONG:
            raise FileError(path, "cannot be written: its name is too long for the file system") from error
        raise FileError(path, "is a link that leads nowhere") from error


def _status(path: Path, target: Path) -> os.stat_result | None:
    """The status of the file now, None if it is not there; refuses what must not be replaced."""
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
    # A rename asks only the folder; the mark "read-only" of the file is the author's word, for root too.
    if not status.st_mode & 0o222 or not os.access(target, os.W_OK):
        raise FileError(path, "is read-only; nothing was written")
    return status


@contextlib.contextmanager
def _explained(path: Path, is_there: bool) -> Iterator[None]:
    """Turn what the system says into one line about the file that was meant, and about what is there of it."""
    unchanged = "; the old file is unchanged" if is_there else ""
    try:
        yield
    except PermissionError as error:
        raise FileError(path, f"cannot be written: {error.strerror} (is its folder read-only?)") from error
    except OSError as error:
        raise FileError(path, f"cannot be written: {error.strerror or error}{unchanged}") from error


@contextlib.contextmanager
def _locked_temporary(path: Path, target: Path) -> Iterator[tuple[Path, BinaryIO]]:
    """The temporary file of `target`, new, empty, open and ours alone; gone at the end if it was not renamed."""
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
    """Create the temporary file and lock it; wait for a process that has it, remove one that nobody has."""
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
        os.close(descriptor)  # between its creation and the lock another process took it for a leftover


def _discard(temporary: Path) -> bool:
    """Remove a temporary file that no living process holds; False if one does, True if the file is gone."""
    if fcntl is None:  # Windows removes no file that is open
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
    """Whether the open file is ours alone now; None where the file system has no locks."""
    if fcntl is None:
        return None
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return None  # then `expect` alone tells two writers apart
    return True


def _is_at(descriptor: int, path: Path) -> bool:
    """Whether the open file is still the one of that name."""
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
    """Extended attributes, access lists among them; only Linux has them in Python."""
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
    """Make the rename itself last; not every system can, and the file is whole either way."""
    if os.name == "nt":
        return
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


# The places of results, checked before the work: the folder of a file must exist, a folder is made with those above.

_DENIED = os.strerror(errno.EACCES)


def check_file(path: Path, suffixes: Sequence[str] = (), *, or_device: bool = False) -> None:
    """Raise what in the end would keep a file from being written here; nothing is made.

    suffixes : how its name may end, in lower case; none: anyhow
    or_device : or it may be a device or a pipe, whatever that is called
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
    if path.is_file() or not path.exists():  # a device or a pipe is written where it is
        folder = (path.resolve() if path.is_symlink() else path).parent
        if folder.is_dir() and not _can_be_written(folder):
            raise FileError(path, f"its folder '{folder}' cannot be written: {_DENIED}")


def _can_be_written(folder: Path) -> bool:
    return os.access(folder, os.W_OK | os.X_OK)


def one_of(names: Iterable[str]) -> str:
    """ ".svg or .png" for people."""
    *most, last = names
    return f"{', '.join(most)} or {last}" if most else last


def plain_name(text: str) -> str:
    """A name for a file, of any text: lower case, with "_" for whatever a file system might refuse; may be empty."""
    return re.sub(r"[^\w.-]+", "_", text.lower()).strip("._")[:120]


def check_folder(path: Path) -> None:
    """Raise if no folder can be here or be filled: a file is in its place or above it, or nobody may write there.

    Nothing is made.
    """
    for one in (path, *path.parents):
        if one.exists():
            if not one.is_dir():
                raise FileError(path, "is a file; give a folder" if one == path else f"'{one}' is a file, not a folder")
            if not _can_be_written(one):
                raise FileError(path, f"cannot be used as a folder: {_DENIED}")
            return


def make_folder(path: Path) -> None:
    """Make a folder and those above it, as far as they are not there."""
    check_folder(path)
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(path, f"cannot be used as a folder: {error.strerror}") from error
