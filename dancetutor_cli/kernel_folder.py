"""Where compiled kernels are kept: found out without importing numba.

Beside the modules where that can be written, else in the user's cache, else in a temporary folder of the user's own:
compiling takes the better part of a minute, and an installation may be read-only and its user without a home.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from dancetutor_cli.kernel_target import fits_shipped, maker
from dancetutor_cli.resources import PACKAGE
from dancetutor_cli.run.trust import TREES, fault_of, read_file, temporary_folder, use_folder, users_folder

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
    """Where this process keeps its kernels: in the first place that nobody else can write, and this user can."""
    named, users = _named(), users_folder("dancetutor")
    places = [named, PACKAGE / "__pycache__", users and users / "kernels"]
    called = [f"{named} ({VARIABLE})", f"the installation ({PACKAGE})", f"the user's cache ({places[2]})"]
    refused: list[str] = []
    for place, words in zip(places, called, strict=True):
        if place is None:
            continue
        fault = _use_folder(place, os.environ.get(TREES, ""))
        if not fault:
            return KernelFolder(None if place == places[1] else place, fault=refused[0] if named and refused else "")
        refused.append(f"{words} {fault}")
    temporary = temporary_folder("dancetutor-kernels")
    return KernelFolder(temporary, temporary is not None, " and ".join(refused))


@cache
def _use_folder(place: Path, trees: str) -> str:
    """What `use_folder` says, which writes there; asked once."""
    return use_folder(place)


def places_of(source: Path) -> Iterator[Path]:
    """Where kernels of a module may have been kept, the likeliest first. Only the last is tried by writing there."""
    named, users = _named(), users_folder("dancetutor")
    beside = KernelFolder(None).of_module(source)
    places = [KernelFolder(place).of_module(source) for place in (named, users and users / "kernels") if place]
    for place in (*places[: named is not None], beside, *places[named is not None :]):
        if not fault_of(place):
            yield place
    yield kernel_folder().of_module(source)


def _named() -> Path | None:
    """The folder that the user has named; resolved, so that what has been looked at is what is used."""
    named = os.environ.get(VARIABLE)
    if not named:
        return None
    return Path(os.path.realpath(named)) if Path(named).is_absolute() else Path(named)


def shipped_folder(source: Path) -> Path | None:
    """Where kernels of a module lie that came compiled with the package; None if none fits here.

    It is never written, and no folder but the package's own is looked at: nobody else gives machine code.
    """
    folder = source.resolve().parent
    if not folder.is_relative_to(PACKAGE) or not shipped_root().is_dir() or not fits_shipped():
        return None
    shipped = shipped_root() / folder.relative_to(PACKAGE)
    return None if fault_of(shipped) else shipped


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
    return _head_of(index) == head(stamp)


def _is_readable(index: Path) -> bool:
    """Whether what is installed now made the kernels of an index file, of whichever code."""
    return _head_of(index)[CHECKSUM:] == maker()


def _head_of(file: Path) -> bytes:
    try:
        return read_file(file)[CHECKSUM : 3 * CHECKSUM]
    except OSError:
        return b""
