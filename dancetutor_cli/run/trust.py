"""The check of folders and files from which machine code is loaded: only this user or root may be able to write them.

Loaded machine code and pickles can do anything, and a user who can write a file can write its checksum. So the owners
of a file and of every folder above it are checked (as for ssh's keys). No such file may be in a folder of songs. On
Windows, Python cannot check permissions, so only paths are checked.
"""

from __future__ import annotations

import json
import os
import stat
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from threading import get_ident

from dancetutor_cli.run.reading import PACKAGE

CACHE_VARIABLE = "DANCETUTOR_CACHE"  # the user's choice of a folder for stored results
TREES = "_DANCETUTOR_TREES"  # JSON list of the folders whose charts are read; worker processes inherit it
_FLAGS = [getattr(os, name, 0) for name in ("O_NOFOLLOW", "O_NONBLOCK", "O_CLOEXEC", "O_BINARY")]
_TEMPORARY = (Path("/tmp"), Path("/var/tmp"))  # if the environment has no folder for temporary files
_OTHERS = stat.S_IWGRP | stat.S_IWOTH


def exclude(path: Path) -> None:
    """Exclude a folder whose charts are read, or the folder of a chart file, as a source of code."""
    try:
        real = os.path.realpath(path)
    except OSError:  # the current folder has been removed, so no chart in it can be read
        return
    tree = real if os.path.isdir(real) else os.path.dirname(real)  # noqa: PTH112, PTH120
    os.environ[TREES] = json.dumps(sorted({*_trees(), tree}))


def fault_of(folder: Path) -> str:
    """Return why a folder is not trusted, such as "cannot be written", or ""; the folder need not exist."""
    if not folder.is_absolute():
        return "is not an absolute path"
    real = Path(os.path.realpath(folder))
    if not real.is_relative_to(PACKAGE) and any(real.is_relative_to(tree) for tree in _trees()):
        return "is in a folder whose charts are read"
    for place in (real, *real.parents):
        try:
            status = place.lstat()
        except (FileNotFoundError, NotADirectoryError):
            continue
        except OSError as error:
            return f"cannot be checked: {error.strerror}"
        if not stat.S_ISDIR(status.st_mode):
            return "cannot be written"
        if fault := _fault(status, may_be_shared=place != real):
            return fault if place == real else f"{fault}, by its folder {place}"
    return ""


def use_folder(folder: Path) -> str:
    """Make a folder for this user only, if it does not exist, and check that it is writable; returns as `fault_of`."""
    if fault := fault_of(folder):
        return fault
    probe = folder / f".dancetutor-{os.getpid()}-{get_ident()}.tmp"
    try:
        for place in (*reversed(folder.parents), folder):
            with suppress(FileExistsError):
                if not place.is_dir():
                    place.mkdir(mode=0o700)
        os.close(os.open(probe, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600))
        probe.unlink()
    except OSError:
        return "cannot be written"
    return fault_of(folder)


def read_file(path: Path) -> bytes:
    """Return the content of a regular file that nobody else can write.

    Raises OSError for links, pipes and other files.
    """
    descriptor = os.open(path, os.O_RDONLY | sum(_FLAGS))
    with open(descriptor, "rb") as file:  # noqa: PTH123
        status = os.fstat(descriptor)
        if not stat.S_ISREG(status.st_mode) or _fault(status):
            raise PermissionError(f"{path} can be changed by other users")
        return file.read()


def write_file(path: Path, data: bytes) -> None:
    """Write or replace a file that only this user can write. Raises OSError."""
    beside = path.with_name(f"{path.name}.{os.getpid()}-{get_ident()}.tmp")
    try:
        with suppress(FileNotFoundError):
            beside.unlink()
        with open(os.open(beside, os.O_WRONLY | os.O_CREAT | os.O_EXCL | sum(_FLAGS), 0o600), "wb") as file:  # noqa: PTH123
            file.write(data)
        beside.replace(path)
    except OSError:
        with suppress(OSError):
            beside.unlink(missing_ok=True)
        raise


def users_folder(name: str) -> Path | None:
    """Return a folder in the place of user caches; None for a user without a home, as in a container."""
    try:
        if sys.platform == "win32":
            folder = _absolute("LOCALAPPDATA") or Path.home() / "AppData" / "Local"
        elif sys.platform == "darwin":
            folder = Path.home() / "Library" / "Caches"
        else:
            folder = _absolute("XDG_CACHE_HOME") or Path.home() / ".cache"
    except RuntimeError:
        return None
    return folder / name if folder.is_absolute() else None


def results_folder() -> tuple[Path | None, str]:
    """Return the folder of results (DANCETUTOR_CACHE or the user's cache), or None and why, "" without a home."""
    named = os.environ.get(CACHE_VARIABLE)
    folder = Path(named) if named else users_folder("dancetutor")
    fault = "" if folder is None else fault_of(folder)
    return (None, f"{folder} {fault}") if fault else (folder, "")


def kept_folder(name: str) -> Path | None:
    """Return a folder in `results_folder`, made if it does not exist; None if it cannot be used."""
    folder, _ = results_folder()
    return None if folder is None or use_folder(folder / name) else folder / name


def temporary_folder(name: str) -> Path | None:
    """Return a folder for temporary files of this user only, made if needed; it is never in the current folder."""
    if sys.platform == "win32":
        from tempfile import gettempdir

        places = [Path(gettempdir())]
    else:
        named = [_absolute(variable) for variable in ("TMPDIR", "TEMP", "TMP")]
        places = [place for place in (*named, *_TEMPORARY) if place is not None]
    try:
        here = os.path.realpath(os.curdir)
    except OSError:
        here = ""
    owner = os.getuid() if hasattr(os, "getuid") else "user"
    for place in places:
        if place.is_dir() and os.path.realpath(place) != here:
            folder = place / f"{name}-{owner}"
            if not use_folder(folder):
                return folder
    return None


def _absolute(variable: str) -> Path | None:
    """Return the folder in an environment variable, or None; relative paths are ignored, as in the XDG standard."""
    folder = Path(os.environ.get(variable, ""))
    return folder if folder.is_absolute() else None


def _trees() -> list[str]:
    trees: list[str] = json.loads(os.environ.get(TREES, "[]"))
    return trees


def _fault(status: os.stat_result, *, may_be_shared: bool = False) -> str:
    """Return how other users can change a file or folder, or "".

    may_be_shared : whether a sticky folder such as /tmp is allowed
    """
    if not hasattr(os, "geteuid"):
        return ""
    if status.st_uid not in (0, os.geteuid()):
        return "belongs to another user"
    if not status.st_mode & _OTHERS or (may_be_shared and status.st_mode & stat.S_ISVTX):
        return ""
    if not status.st_mode & stat.S_IWOTH and _is_private_group(status.st_gid):
        return ""
    return "can be written by others"


def _is_private_group(number: int) -> bool:
    """Whether a group has this user (not root) as its only member and the user's name, as on Debian."""
    try:
        import grp
        import pwd

        user, group = pwd.getpwuid(os.geteuid()), grp.getgrgid(number)
    except (ImportError, KeyError):
        return False
    is_own = user.pw_uid != 0 and user.pw_gid == number and group.gr_name == user.pw_name
    return is_own and set(group.gr_mem) <= {user.pw_name}


def programs(name: str, path: str) -> Iterator[Path]:
    """Yield programs of a name in the folders of PATH, in order; relative folders may be packs, and are skipped."""
    for folder in path.split(os.pathsep):
        program = Path(folder) / name
        with suppress(OSError, ValueError):
            if Path(folder).is_absolute() and program.is_file() and os.access(program, os.X_OK):
                yield program
