"""Where compiled kernels are kept, and in which form: found out without importing numba.

Beside the modules where that can be written, else in the user's cache, else in a temporary folder of the user's own:
compiling takes the better part of a minute, and an installation may be read-only and its user without a home. Only
places that `run.trust` lets pass are read or written. A wheel may bring kernels, beside the modules as well.

A file holds one kernel for one kind of arguments. It begins with the SHA-256 of all that follows (a cut or damaged file
is none), the digest of the source that it was made of, and the digest of what made it, for which processor.
"""

from __future__ import annotations

import hashlib
import os
import re
import sys
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from dancetutor_cli.run.kernels.target import maker
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
VARIABLE = "NUMBA_CACHE_DIR"  # numba's own name for a folder of the user's choice
_KERNEL = re.compile(r"njit|@kernel\b|@inner_kernel\b")
_IMPORT = re.compile(r"^from dancetutor_cli\.([\w.]+) import (\([^)]*\)|.*)", re.MULTILINE)
_WORD = re.compile(r"\w+")
_CONSTANT = re.compile(r"\b[A-Z][A-Z0-9_]+\b")


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
    """The kept machine code of a function. source : its module's file"""

    source: Path
    function: str

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
        return source_digest(self.source) + maker()

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


def _roots() -> Iterator[tuple[Path | None, str]]:
    """Folders for new kernels, None for those beside the modules, and what they are called.

    Resolved, so that what has been looked at is what is used; a relative one stays that, and is refused.
    """
    if named := os.environ.get(VARIABLE):
        yield Path(os.path.realpath(named) if Path(named).is_absolute() else named), f"{named} ({VARIABLE})"
    yield None, f"the installation ({PACKAGE})"
    if users := users_folder("dancetutor"):
        yield Path(os.path.realpath(users)) / "kernels", f"the user's cache ({users})"


def count_kernels(folder: Path) -> tuple[int, int]:
    """How many kernels a folder and those below it hold that fit here, and how many that something else compiled."""
    kernels = {(path.parent, *path.name.split(".")[:2]): path for path in folder.rglob(f"*{SUFFIX}")}
    fits = [_head_of(path)[CHECKSUM:] == maker() for path in kernels.values()]
    return sum(fits), len(fits) - sum(fits)


@cache
def _use_folder(place: Path, trees: str) -> str:
    """What `use_folder` says, which writes there; asked once for what is read."""
    return use_folder(place)


def _head_of(file: Path) -> bytes:
    try:
        return read_file(file)[CHECKSUM:HEAD]
    except OSError:
        return b""


@cache
def source_digest(source: Path) -> bytes:
    """A digest of a module with kernels and of what else of the package they may be made of."""
    return hashlib.sha256(b"".join(path.read_bytes() for path in source_modules(source))).digest()


def source_modules(source: Path, package: Path = PACKAGE) -> list[Path]:
    """The modules whose code is in a module's kernels: its own, those whose kernels or constants it has, and theirs."""
    found, new = {source.resolve()}, [source.resolve()]
    while new:
        for name, names in _IMPORT.findall(new.pop().read_text("utf-8")):
            room = package / name.replace(".", "/")
            modules = [room.with_suffix(".py"), *(room / f"{word}.py" for word in _WORD.findall(names))]
            for path in modules:
                if path in found or name.startswith("run.") or not path.is_file():
                    continue
                if _CONSTANT.search(names) or _KERNEL.search(path.read_text("utf-8")):
                    found.add(path)
                    new.append(path)
    return sorted(found)
