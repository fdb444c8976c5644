"""The folders and files of compiled kernels, found without importing numba.

Kernels are stored beside the modules if that folder can be written, else in the user's cache, else in a temporary
folder of the user. Compiling takes most of a minute, an installation may be read-only, and its user may have no home.
Only folders that `run.trust` accepts are read or written. A wheel may contain kernels, also beside the modules.

A file holds one kernel for one kind of arguments. It begins with the SHA-256 of everything after it, so that a cut or
damaged file is not used. The digest of the source follows, and then that of the compiler and the processor.
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
    """The folder for new kernels. root : the folder, or None: in the `__pycache__` beside the modules

    is_writable : whether kernels can be stored; if not, each run compiles them again
    fault : why the usual folder is not used, in words for people; "" if it is used
    """

    root: Path | None
    is_writable: bool = True
    fault: str = ""

    def of_module(self, source: Path) -> Path:
        """Return the folder for the kernels of a module. source : its file"""
        if self.root is None:
            return source.parent / "__pycache__"
        digest = hashlib.sha1(str(source.parent).encode("utf-8", "surrogateescape"), usedforsecurity=False)
        return self.root / f"{source.parent.name}_{digest.hexdigest()}"


@dataclass(frozen=True, slots=True)
class StoredCode:
    """The stored machine code of a function. source : its module's file"""

    source: Path
    function: str

    def read(self, kinds: str) -> Iterator[bytes]:
        """Yield the stored code for some kinds of arguments, from the likeliest folder first."""
        for folder in places_of(self.source):
            with suppress(OSError):
                data = read_file(folder / self._name(kinds))
                is_whole = hashlib.sha256(data[CHECKSUM:]).digest() == data[:CHECKSUM]
                if is_whole and data[CHECKSUM:HEAD] == self._source_digest():
                    yield data[HEAD:]

    def write(self, kinds: str, body: bytes) -> None:
        """Store code if there is a folder for it. On a full disk, the kernel works, but is not stored."""
        folder = kernel_folder().of_module(self.source)
        with suppress(OSError):
            if kernel_folder().is_writable and not use_folder(folder):
                data = self._source_digest() + body
                write_file(folder / self._name(kinds), hashlib.sha256(data).digest() + data)

    def is_there(self) -> bool:
        """Whether code of the current source is stored, for any kinds of arguments; True if that cannot be known."""
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
    """Return the folder for the kernels of this process: the first one that only this user can write."""
    refused: list[str] = []
    for root, words in _roots():
        fault = _use_folder(root or PACKAGE / "__pycache__", os.environ.get(TREES, ""))
        if not fault:
            return KernelFolder(root, fault=refused[0] if refused and os.environ.get(VARIABLE) else "")
        refused.append(f"{words} {fault}")
    temporary = temporary_folder("dancetutor-kernels")
    return KernelFolder(temporary, temporary is not None, " and ".join(refused))


def places_of(source: Path) -> Iterator[Path]:
    """Yield the folders that may have kernels of a module, the likeliest first.

    No file is written to test a folder, except the last one, which `kernel_folder` tests.
    """
    for root, _ in _roots():
        place = KernelFolder(root).of_module(source)
        if not fault_of(root or place) and not fault_of(place):
            yield place
    place = kernel_folder().of_module(source)
    if not fault_of(place):
        yield place


def _roots() -> Iterator[tuple[Path | None, str]]:
    """Yield folders for new kernels (None: beside the modules), each with its name in messages.

    Links are resolved, so that the checked folder is the one that is used. A relative folder stays relative, and is
    refused later.
    """
    if named := os.environ.get(VARIABLE):
        yield Path(os.path.realpath(named) if Path(named).is_absolute() else named), f"{named} ({VARIABLE})"
    yield None, f"the installation ({PACKAGE})"
    if users := users_folder("dancetutor"):
        yield Path(os.path.realpath(users)) / "kernels", f"the user's cache ({users})"


def count_kernels(folder: Path) -> tuple[int, int]:
    """Return the number of usable kernels in a folder and below it, and of those that another version compiled."""
    kernels = {(path.parent, *path.name.split(".")[:2]): path for path in folder.rglob(f"*{SUFFIX}")}
    fits = [_head_of(path)[CHECKSUM:] == maker() for path in kernels.values()]
    return sum(fits), len(fits) - sum(fits)


@cache
def _use_folder(place: Path, trees: str) -> str:
    """Return the result of `use_folder`, which writes there. trees : the folders of charts, a key of the cache"""
    return use_folder(place)


def _head_of(file: Path) -> bytes:
    try:
        return read_file(file)[CHECKSUM:HEAD]
    except OSError:
        return b""


@cache
def source_digest(source: Path) -> bytes:
    """Return a digest of a module with kernels, and of all modules whose code its kernels may contain."""
    return hashlib.sha256(b"".join(path.read_bytes() for path in source_modules(source))).digest()


def source_modules(source: Path, package: Path = PACKAGE) -> list[Path]:
    """Return the modules whose code a module's kernels may contain.

    These are the module itself, the modules whose kernels or constants it imports or that it imports whole, and so on.
    """
    found, new = {source.resolve(): source.read_text("utf-8")}, [source.resolve()]
    while new:
        for name, names in _IMPORT.findall(found[new.pop()]):
            room = package / name.replace(".", "/")
            module = room.with_suffix(".py")
            is_module = module in found or module.is_file()  # else a folder, and the names are its modules
            for path in [module] if is_module else (room / f"{word}.py" for word in _WORD.findall(names)):
                if path in found or name.startswith("run.") or not path.is_file():
                    continue
                text = path.read_text("utf-8")
                if not is_module or _CONSTANT.search(names) or _KERNEL.search(text):
                    found[path] = text
                    new.append(path)
    return sorted(found)


# The processor for which kernels are compiled, and their compiler, found without importing numba.
#
# numba compiles for exactly the processor that it runs on, so that the code fits few others. Here, all processors with
# the abilities of most since 2013 get the same code. So kernels in a wheel fit, a cache in a shared folder fits every
# node, and all machines compute the same numbers.

COMPILERS = ("numba", "llvmlite")
_FORM = 7  # version of the form of stored code and of the compiler's options; increase it with changes of either
LEVEL = "x86-64-v3"  # LLVM's name of the processor
_ABILITIES = (
    *("avx", "avx2", "bmi", "bmi2", "cx16", "f16c", "fma", "lzcnt", "movbe", "popcnt", "sahf"),
    *("sse3", "sse4.1", "sse4.2", "ssse3", "xsave"),
)
_NAME, _FEATURES = "NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES"
_PORTABLE = (LEVEL, ",".join(f"+{one}" for one in _ABILITIES))
# numba's settings that change the code for the same source
_SETTINGS = tuple(
    f"NUMBA_{one}" for one in ("OPT", "BOUNDSCHECK", "DEBUGINFO", "LOOP_VECTORIZE", "SLP_VECTORIZE", "ENABLE_AVX")
)


def pin(config: Any) -> None:
    """Make numba compile for the portable processor, in this process and its workers, unless the user has named one.

    Call this before the first kernel is made. config : `numba.core.config`
    """
    if processor() == _PORTABLE:
        os.environ.update(zip((_NAME, _FEATURES), _PORTABLE, strict=True))
        config.reload_config()


def processor() -> tuple[str, str]:
    """Return LLVM's names of the processor, and of its abilities, for which kernels are compiled."""
    name, features = os.environ.get(_NAME), os.environ.get(_FEATURES)
    if name is None and features is None and _is_able():
        return _PORTABLE
    from llvmlite import binding

    if features is None:
        features = "" if name is not None and name.lower() == "generic" else _host_features()
    return (binding.get_host_cpu_name() if name is None else name), features


def is_portable() -> bool:
    """Whether this process compiles kernels that work elsewhere: for the portable processor, with no numba settings."""
    return not _settings() and processor() == _PORTABLE


@cache
def maker() -> bytes:
    """Return a digest of the compiler, its settings and the processor. Code with another digest is not used."""
    versions = [(name, _version(name)) for name in COMPILERS]
    words = repr((_FORM, versions, sys.implementation.cache_tag, processor(), _settings(), sys.platform))
    return hashlib.sha256(words.encode()).digest()


def _settings() -> dict[str, str]:
    return {name: os.environ[name] for name in _SETTINGS if name in os.environ}


def _version(name: str) -> str:
    """Return the version of a compiler, from its unique `.dist-info` folder if possible: an import takes longer."""
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
