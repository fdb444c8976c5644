"""The place and form of compiled kernels, found without importing numba.

Beside the modules where that can be written, else in the user's cache, else in a temporary folder of the user's own:
compiling takes the better part of a minute, and an installation may be read-only and its user without a home. Only
places that `run.trust` lets pass are read or written. A wheel may bring kernels, beside the modules as well.

A file holds one kernel for one kind of arguments. It begins with the SHA-256 of all that follows (a cut or damaged file
is none), the digest of the source that it was made of, and the digest of what made it, for which processor.
"""

from __future__ import annotations

import hashlib
import os
import platform
import re
import sys
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from dancetutor_cli.run.reading import PACKAGE
from dancetutor_cli.run.trust import TREES, fault_of, read_file, temporary_folder, use_folder, users_folder, write_file

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
                is_whole = hashlib.sha256(data[CHECKSUM:]).digest() == data[:CHECKSUM]
                if is_whole and data[CHECKSUM:HEAD] == self._source_digest():
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
    """Where kernels of a module may lie, the likeliest first. No file is written to try them, but for the last:
    `kernel_folder` has tried that.
    """
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
    """How many usable kernels a folder and those below it hold, and how many that another version compiled."""
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
    found, new = {source.resolve(): source.read_text("utf-8")}, [source.resolve()]
    while new:
        for name, names in _IMPORT.findall(found[new.pop()]):
            room = package / name.replace(".", "/")
            module = room.with_suffix(".py")
            is_module = module in found or module.is_file()  # else a folder, and names are those of its modules
            for path in [module] if is_module else (room / f"{word}.py" for word in _WORD.findall(names)):
                if path in found or name.startswith("run.") or not path.is_file():
                    continue
                text = path.read_text("utf-8")
                if _CONSTANT.search(names) or _KERNEL.search(text):
                    found[path] = text
                    new.append(path)
    return sorted(found)


# The processor for which kernels are compiled, and their compiler: known without importing numba.
#
# numba compiles for the very processor that it runs on, so what it has compiled fits few others. Here all of them that
# can do what most have done since 2013 get the same code: what came compiled with the package fits, a cache in a shared
# folder fits every node, and the same numbers come out everywhere.

COMPILERS = ("numba", "llvmlite")
_FORM = 7  # of what `store` keeps, and of the options by which it is compiled; count it up with either
LEVEL = "x86-64-v3"  # LLVM's name of the processor
_ABILITIES = (
    *("avx", "avx2", "bmi", "bmi2", "cx16", "f16c", "fma", "lzcnt", "movbe", "popcnt", "sahf"),
    *("sse3", "sse4.1", "sse4.2", "ssse3", "xsave"),
)
_NAME, _FEATURES = "NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES"
_PORTABLE = (LEVEL, ",".join(f"+{one}" for one in _ABILITIES))
# numba's settings that make other code of the same source
_SETTINGS = tuple(
    f"NUMBA_{one}" for one in ("OPT", "BOUNDSCHECK", "DEBUGINFO", "LOOP_VECTORIZE", "SLP_VECTORIZE", "ENABLE_AVX")
)


def pin(config: Any) -> None:
    """Let numba compile for the portable processor, in this process and its workers, unless the user has named one.

    config : `numba.core.config`; to be called before the first kernel is made
    """
    if processor() == _PORTABLE:
        os.environ.update(zip((_NAME, _FEATURES), _PORTABLE, strict=True))
        config.reload_config()


def processor() -> tuple[str, str]:
    """LLVM's names of the processor and of the abilities that are compiled for."""
    name, features = os.environ.get(_NAME), os.environ.get(_FEATURES)
    if name is None and features is None and _is_able():
        return _PORTABLE
    from llvmlite import binding

    if features is None:
        features = "" if name is not None and name.lower() == "generic" else _host_features()
    return (binding.get_host_cpu_name() if name is None else name), features


def is_portable() -> bool:
    """Whether the kernels that this process compiles work elsewhere: for the portable processor, without numba
    settings.
    """
    return not _settings() and processor() == _PORTABLE


@cache
def maker() -> bytes:
    """A digest of what makes machine code of a kernel's source, and for which processor. What differs is not read."""
    versions = [(name, _version(name)) for name in COMPILERS]
    words = repr((_FORM, versions, sys.implementation.cache_tag, processor(), _settings(), sys.platform))
    return hashlib.sha256(words.encode()).digest()


def _settings() -> dict[str, str]:
    return {name: os.environ[name] for name in _SETTINGS if name in os.environ}


def _version(name: str) -> str:
    """The version of a compiler, by the name of what pip leaves beside it if that is clear: an import takes longer."""
    spec = find_spec(name)
    beside = Path(spec.origin).parents[1].glob(f"{name}-*.dist-info") if spec and spec.origin else ()
    versions = [path.stem.removeprefix(f"{name}-") for path in beside]
    return versions[0] if len(versions) == 1 else str(import_module(name).__version__)


@cache
def _is_able() -> bool:
    """Whether this processor can run kernels for the portable one."""
    is_x86 = platform.machine().lower() in ("x86_64", "amd64")
    return is_x86 and {f"+{one}" for one in _ABILITIES} <= set(_host_features().split(","))


def _host_features() -> str:
    from llvmlite import binding

    try:
        return str(binding.get_host_cpu_features().flatten())
    except RuntimeError:  # LLVM does not know
        return ""
