"""Where compiled kernels are kept: found out without importing numba.

Beside the modules where that can be written, else in the user's cache, else in a temporary folder of the user's own:
compiling takes the better part of a minute, and an installation may be read-only and its user without a home.
"""

from __future__ import annotations

import hashlib
import os
import stat
import sys
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from threading import get_ident

from dancetutor_cli.kernel_target import fits_shipped, maker
from dancetutor_cli.resources import PACKAGE

CHECKSUM = 32  # bytes of SHA-256
SUFFIX = ".door"  # of what `kernel_door` keeps; the rest is numba's: .nbi and .nbc
MADE_BY = "made_by.txt"  # beside the kernels that came with the package: by what, for people
VARIABLE = "NUMBA_CACHE_DIR"  # numba's own name for a folder of the user's choice


@dataclass(frozen=True, slots=True)
class KernelFolder:
    """Where new kernels go. root : a folder, or None: beside the modules, in their `__pycache__`

    kept : False if nothing can be written anywhere, so that each run compiles again
    fault : why the usual place is not used, in words for people; "" if it is
    """

    root: Path | None
    kept: bool = True
    fault: str = ""

    def of_module(self, source: Path) -> Path:
        """The folder for the kernels of a module's file; below a root the folder that numba gives it."""
        if self.root is None:
            return source.parent / "__pycache__"
        digest = hashlib.sha1(str(source.parent).encode("utf-8", "surrogateescape"), usedforsecurity=False)
        return self.root / f"{source.parent.name}_{digest.hexdigest()}"


def kernel_folder() -> KernelFolder:
    """Where this process keeps its kernels; looked for once, as long as `NUMBA_CACHE_DIR` stays what it is."""
    return _kernel_folder(os.environ.get(VARIABLE))


@cache
def _kernel_folder(named: str | None) -> KernelFolder:
    users = users_folder("dancetutor")
    places = [Path(named) if named else None, PACKAGE / "__pycache__", users and users / "kernels"]
    for place in places:
        if place is not None and _usable(place):
            fault = f"{named} ({VARIABLE}) cannot be written" if named and place != places[0] else ""
            return KernelFolder(None if place == places[1] else place, fault=fault)
    refused = [f"{named} ({VARIABLE})"] if named else []
    refused += [f"the installation ({PACKAGE})", f"the user's cache ({places[2] or 'no home folder'})"]
    temporary = _temporary()
    return KernelFolder(temporary, temporary is not None, f"{' and '.join(refused)} cannot be written")


def places_of(source: Path) -> Iterator[Path]:
    """Where kernels of a module may have been kept, the likeliest first. Only the last is tried by writing there."""
    named, users = os.environ.get(VARIABLE), users_folder("dancetutor")
    if named:
        yield KernelFolder(Path(named)).of_module(source)
    yield source.parent / "__pycache__"
    if users is not None:
        yield KernelFolder(users / "kernels").of_module(source)
    yield kernel_folder().of_module(source)


def shipped_folder(source: Path) -> Path | None:
    """Where kernels of a module lie that came compiled with the package; None if none fits here.

    It is never written, and no folder but the package's own is looked at: nobody else gives machine code.
    """
    folder = source.resolve().parent
    if not folder.is_relative_to(PACKAGE) or not shipped_root().is_dir() or not fits_shipped():
        return None
    return shipped_root() / folder.relative_to(PACKAGE)


def shipped_root() -> Path:
    """The folder of all kernels that came compiled with the package, if they did."""
    return PACKAGE / "_data" / "kernels"


def came_compiled() -> bool:
    """Whether the package brought kernels that are used here."""
    return shipped_folder(PACKAGE / "kernels.py") is not None and any(map(_is_readable, kernels_in(shipped_root())))


def kernels_in(folder: Path) -> Iterator[Path]:
    """One file for each kernel that is kept in a folder and below it."""
    yield from folder.rglob("*.nbi")
    yield from folder.rglob(f"*{SUFFIX}")


def head(stamp: str) -> bytes:
    """What a kept file begins with, behind its checksum: of which code it was made, and by what."""
    return bytes.fromhex(stamp) + maker()


def is_current(index: Path, stamp: str) -> bool:
    """Whether the kernels of an index file were made of this code, and by what is installed now."""
    with index.open("rb") as file:
        return file.read(3 * CHECKSUM)[CHECKSUM:] == head(stamp)


def _is_readable(index: Path) -> bool:
    """Whether what is installed now made the kernels of an index file, of whichever code."""
    with index.open("rb") as file:
        return file.read(3 * CHECKSUM)[2 * CHECKSUM :] == maker()


def users_folder(name: str) -> Path | None:
    """Where this system keeps a user's caches; None for a user without a home, as in a container."""
    try:
        if sys.platform == "win32":
            return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local") / name
        if sys.platform == "darwin":
            return Path.home() / "Library" / "Caches" / name
        return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / name
    except RuntimeError:
        return None


def _usable(folder: Path) -> bool:
    """Whether files can be put there; makes the folder. Without `tempfile`, whose import takes as long as a chart."""
    probe = folder / f".dancetutor-{os.getpid()}-{get_ident()}.tmp"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe.touch()
        probe.unlink(missing_ok=True)
        return True
    except OSError:
        return False


def _temporary() -> Path | None:
    """A folder for temporary files that only this user can write: the machine code of others must not be run."""
    import tempfile

    owner = os.getuid() if hasattr(os, "getuid") else "user"
    try:
        folder = Path(tempfile.gettempdir()) / f"dancetutor-kernels-{owner}"
        with suppress(FileExistsError):
            folder.mkdir(mode=0o700)
        return folder if _is_ours(folder) and _usable(folder) else None
    except OSError:
        return None


def _is_ours(folder: Path) -> bool:
    status = folder.lstat()
    if not stat.S_ISDIR(status.st_mode):
        return False
    return not hasattr(os, "getuid") or (status.st_uid == os.getuid() and not status.st_mode & 0o077)
