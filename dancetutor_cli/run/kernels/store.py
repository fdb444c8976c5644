"""Where compiled kernels are kept, and in which form: found out without importing numba.

Beside the modules where that can be written, else in the user's cache, else in a temporary folder of the user's own:
compiling takes the better part of a minute, and an installation may be read-only and its user without a home. Only
places that `run.trust` lets pass are read or written. What came compiled with the package lies in `_data/kernels`.

A file holds one kernel for one kind of arguments. It begins with the SHA-256 of all that follows (a cut or damaged file
is none), the digest of the source that it was made of, and the digest of what made it, for which processor.
"""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from dancetutor_cli.run.kernels.target import fits_shipped, maker
from dancetutor_cli.run.reading import PACKAGE
from dancetutor_cli.run.trust import (
    TREES,
    fault_of,
    read_file,
    temporary_folder,
    use_folder,
    users_folder,
    write_file,
)  # fmt: skip

CHECKSUM = 32  # bytes of SHA-256
HEAD = 3 * CHECKSUM
SUFFIX = ".kernel"
MADE_BY = "made_by.txt"  # beside the kernels that came with the package: by what, for people
VARIABLE = "NUMBA_CACHE_DIR"  # numba's own name for a folder of the user's choice


@dataclass(frozen=True, slots=True)
class KernelFolder:
    """Where new kernels go. root : a folder, or None: beside the modules, in their `__pycache__`

    is_writable : False if nothing can be written anywhere, so that each run compiles again
    fault : why the usual place is not used, in words for people; "" if it is
    """

    root: Path | None
    is_writable: bool = True
    fault: str = ""

    def of_module(self, source: Path) -> Path:
        """The folder for the kernels of a module's file."""
        if self.root is None:
            return source.parent / "__pycache__"
        digest = hashlib.sha1(str(source.parent).encode("utf-8", "surrogateescape"), usedforsecurity=False)
        return self.root / f"{source.parent.name}_{digest.hexdigest()}"


@dataclass(frozen=True, slots=True)
class StoredCode:
    """The kept machine code of a function. source : its module's file; stamp : a digest of the code it is made of."""

    source: Path
    function: str
    stamp: str

    def read(self, kinds: str) -> Iterator[bytes]:
        """What is kept for some kinds of arguments, in the likeliest place first."""
        for folder in places_of(self.source):
            with suppress(OSError):
                data = read_file(folder / self._name(kinds))
                if (
                    data[CHECKSUM:HEAD] == self._source_digest()
                    and hashlib.sha256(data[CHECKSUM:]).digest() == data[:CHECKSUM]
                ):
                    yield data[HEAD:]

    def write(self, kinds: str, body: bytes) -> None:
        """Keep something, if there is a place for it; on a full disk the kernel is there, only not kept."""
        folder = kernel_folder().of_module(self.source)
        with suppress(OSError):
            if kernel_folder().is_writable and not use_folder(folder):
                data = self._source_digest() + body
                write_file(folder / self._name(kinds), hashlib.sha256(data).digest() + data)

    def is_there(self) -> bool:
        """Whether anything is kept for the code as it is now, for whichever kinds; True if that cannot be known."""
        try:
            return any(
                _head_of(path) == self._source_digest()
                for folder in places_of(self.source)
                for path in folder.glob(f"{self.source.stem}.{self.function}.*{SUFFIX}")
            )
        except OSError:
            return True

    def _source_digest(self) -> bytes:
        return bytes.fromhex(self.stamp) + maker()

    def _name(self, kinds: str) -> str:
        digest = hashlib.sha256(kinds.encode()).hexdigest()[:16]
        return f"{self.source.stem}.{self.function}.{digest}.{sys.implementation.cache_tag}{SUFFIX}"


def kernel_folder() -> KernelFolder:
    """Where this process keeps its kernels: in the first place that nobody else can write, and this user can."""
    refused: list[str] = []
    for root, words in _roots():
        fault = _use_folder(root or PACKAGE / "__pycache__", os.environ.get(TREES, ""))
        if not fault:
            return KernelFolder(root, fault=refused[0] if refused and os.environ.get(VARIABLE) else "")
        refused.append(f"{words} {fault}")
    temporary = temporary_folder("dancetutor-kernels")
    return KernelFolder(temporary, temporary is not None, " and ".join(refused))


def places_of(source: Path) -> Iterator[Path]:
    """Where kernels of a module may lie, the likeliest first. Only the last but one is tried by writing there."""
    for root, _ in _roots():
        place = KernelFolder(root).of_module(source)
        if not fault_of(root or place) and not fault_of(place):
            yield place
    place = kernel_folder().of_module(source)
    if not fault_of(place):
        yield place
    if shipped := shipped_folder(source):
        yield shipped


def _roots() -> Iterator[tuple[Path | None, str]]:
    """Folders for new kernels, None for those beside the modules, and what they are called.

    Resolved, so that what has been looked at is what is used; a relative one stays that, and is refused.
    """
    if named := os.environ.get(VARIABLE):
        yield Path(os.path.realpath(named) if Path(named).is_absolute() else named), f"{named} ({VARIABLE})"
    yield None, f"the installation ({PACKAGE})"
    if users := users_folder("dancetutor"):
        yield Path(os.path.realpath(users)) / "kernels", f"the user's cache ({users})"


def shipped_folder(source: Path) -> Path | None:
    """Where kernels of a module lie that came compiled with the package; None if none fits here. Only read."""
    folder = source.resolve().parent
    if not folder.is_relative_to(PACKAGE) or not shipped_root().is_dir() or not fits_shipped():
        return None
    shipped = shipped_root() / folder.relative_to(PACKAGE)
    return None if fault_of(shipped) else shipped


def shipped_root() -> Path:
    """The folder of all kernels that came compiled with the package, if they did."""
    return PACKAGE / "_data" / "kernels"


def came_compiled() -> bool:
    """Whether the package brought kernels that are used here, of whichever code."""
    if shipped_folder(PACKAGE / "x.py") is None:
        return False
    return any(_head_of(path)[CHECKSUM:] == maker() for path in kernels_in(shipped_root()))


def kernels_in(folder: Path) -> Iterator[Path]:
    """One file for each kernel that is kept in a folder and below it."""
    yield from {(path.parent, *path.name.split(".")[:2]): path for path in folder.rglob(f"*{SUFFIX}")}.values()


@cache
def _use_folder(place: Path, trees: str) -> str:
    """What `use_folder` says, which writes there; asked once for what is read."""
    return use_folder(place)


def _head_of(file: Path) -> bytes:
    try:
        return read_file(file)[CHECKSUM:HEAD]
    except OSError:
        return b""
