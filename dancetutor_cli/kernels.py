"""How kernels are compiled, and their machine code kept: `njit` of this module in place of numba's.

numba gives up where it finds no folder that it can write, and where a file that it has written is cut short. Here both
only mean that a kernel is compiled again: what is kept has a checksum, and a folder that can only be read is read. So
is what came compiled with the package (`tools/wheel_kernels.py` puts it there).
"""

from __future__ import annotations

import gc
import hashlib
import pickle
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from dancetutor_cli.quick_numba import without_current_folder

with without_current_folder():
    import numba as numba
    from numba import float32 as float32
    from numba import int32 as int32
    from numba import int64 as int64
    from numba import uint32 as uint32
    from numba import uint64 as uint64
from numba.core import caching as _caching
from numba.core import event as _event
from numba.core.runtime.nrt import rtsys as _runtime

from dancetutor_cli import kernel_target
from dancetutor_cli.kernel_folder import CHECKSUM, head, kernel_folder, shipped_folder
from dancetutor_cli.quick_compiling import compile_quicker
from dancetutor_cli.quick_numba import look_for_blas, without_scipy
from dancetutor_cli.resources import PACKAGE
from dancetutor_cli.run.trust import fault_of, read_file, use_folder, write_file

caching: Any = _caching  # have types in some versions only, or in none
event: Any = _event
runtime: Any = _runtime
_plain: Any = numba.njit  # what it says of its options has not all that are used here
kernel_target.pin()


def _njit(function: Callable[..., Any] | None = None, **options: Any) -> Any:
    """`numba.njit`; with `cache=True` the kernel is kept as this module's first lines say."""
    if function is None:
        return lambda later: _njit(later, **options)
    kept = options.pop("cache", False)
    compiled = _plain(no_cfunc_wrapper=True, **options)(function)  # that one is for ctypes
    _without_literals(compiled)
    if kept and (kernel_folder().kept or shipped_folder(Path(function.__code__.co_filename))):
        compiled._cache = _KernelCache(function)
    return compiled


def _without_literals(kernel: Any) -> None:
    """Compile a kernel for whole numbers, not once more for each that stands in a call of it.

    Also what is 0 before a loop and counts in it is such a number at first: numba has compiled what is called with it
    by the time that it sees the loop.
    """
    asked: Any = getattr(kernel, "get_call_template", None)
    plain: Any = numba.types.unliteral

    def get_call_template(args: Any, kws: Any) -> Any:
        return asked([plain(one) for one in args], {name: plain(one) for name, one in kws.items()})

    if asked is not None:  # there is none where NUMBA_DISABLE_JIT is set
        kernel.get_call_template = get_call_template


F = TypeVar("F")


def inner_kernel(function: F) -> F:
    """A kernel that only kernels call, never Python: there it would crash.

    It is compiled into each of them, and they are kept. tests/test_kernels.py looks at all modules for such calls.
    """
    made: F = _njit(no_cpython_wrapper=True)(function)
    return made


def uncounted(function: Callable[..., Any] | None = None, **options: Any) -> Any:
    """`njit` for a kernel that makes no arrays and only looks at those it is given: references to them are not counted.

    numba counts one up and down wherever an array is taken out of a tuple or handed on, by a call each, also inside of
    loops: in the solver's rules that took half of the time.
    """
    if function is None:
        return lambda later: uncounted(later, **options)
    try:
        return _njit(function, _nrt=False, **options)
    except (KeyError, TypeError):  # the option may go
        return _njit(function, **options)


if TYPE_CHECKING:
    from numba import njit as njit  # a kernel has the types that it says, as with numba's own
else:
    njit = _njit


class _NoCollecting(event.Listener):  # type: ignore[misc]
    """No garbage is collected while numba compiles: it makes millions of objects and keeps most of them."""

    def __init__(self) -> None:
        self._depth, self._was_on = 0, False

    def on_start(self, event: Any) -> None:
        """A kernel is compiled, maybe for another one."""
        if self._depth == 0:
            look_for_blas()
            compile_quicker()
            self._was_on = gc.isenabled()
            gc.disable()
        self._depth += 1

    def on_end(self, event: Any) -> None:
        """It is done, or has failed."""
        self._depth -= 1
        if self._depth == 0 and self._was_on:
            gc.freeze()  # to look through all that for garbage takes a tenth of the time that compiling took
            gc.enable()


event.register("numba:compile", _NoCollecting())


class _File(caching.IndexDataCacheFile):  # type: ignore[misc]
    """The index and the data of one kernel, each behind a checksum, the stamp of its code and who compiled it.

    What does not fit the three is not there; it is not even unpickled.
    """

    def _load_index(self) -> dict[Any, str]:
        overloads: dict[Any, str] = self._checked(Path(self._index_path)) or {}
        return overloads

    def _save_index(self, overloads: dict[Any, str]) -> None:
        self._write(self._index_path, overloads)

    def _load_data(self, name: str) -> Any:
        return self._checked(Path(self._data_path(name)))

    def _save_data(self, name: str, data: Any) -> None:
        self._write(self._data_path(name), data)

    def _write(self, path: str, content: Any) -> None:
        data = head(self._source_stamp) + self._dump(content)
        if not use_folder(Path(path).parent):
            write_file(Path(path), hashlib.sha256(data).digest() + data)

    def _checked(self, path: Path) -> Any:
        """What a file of ours holds; None if it is not there, not what was written, or made of other code."""
        try:
            whole = b"" if fault_of(path.parent) else read_file(path)
        except OSError:
            return None
        digest, data, ours = whole[:CHECKSUM], whole[CHECKSUM:], head(self._source_stamp)
        if not data.startswith(ours) or hashlib.sha256(data).digest() != digest:
            return None
        with without_scipy():
            return pickle.loads(data[len(ours) :])


class _Locator(caching.InTreeCacheLocator):  # type: ignore[misc]
    """Puts the kernels of a module where `kernel_folder` says."""

    def __init__(self, function: Any, source: str) -> None:
        super().__init__(function, source)
        self._cache_path = str(kernel_folder().of_module(Path(source)))
        self._source = Path(source)

    def get_source_stamp(self) -> str:
        """A digest of the code, not the time of its file: what is compiled outlives an installation anew."""
        return stamp_of(self._source)


_KERNEL = re.compile(r"njit|@kernel\b|@inner_kernel\b|\buncounted\b")  # the middle two are `video.scene.cpu.uncounted`
_IMPORT = re.compile(r"^from dancetutor_cli\.([\w.]+) import (\([^)]*\)|.*)", re.MULTILINE)
_WORD = re.compile(r"\w+")
_CONSTANT = re.compile(r"\b[A-Z][A-Z0-9_]+\b")


@cache
def stamp_of(source: Path) -> str:
    """A digest of a module with kernels and of what else of the package they may be made of."""
    if source.parent.name == "play":
        from dancetutor_cli.play.compiled import source_stamp

        return source_stamp()
    return hashlib.sha256(b"".join(path.read_bytes() for path in made_of(source))).hexdigest()


def made_of(source: Path, package: Path = PACKAGE) -> list[Path]:
    """The modules whose code is in a module's kernels: its own, those whose kernels or constants it has, and theirs."""
    found, new = {source.resolve()}, [source.resolve()]
    while new:
        for name, names in _IMPORT.findall(new.pop().read_text("utf-8")):
            room = package / name.replace(".", "/")
            modules = [room.with_suffix(".py"), *(room / f"{word}.py" for word in _WORD.findall(names))]
            for path in modules:
                if path in found or name == "kernels" or not path.is_file():
                    continue
                if _CONSTANT.search(names) or _KERNEL.search(path.read_text("utf-8")):
                    found.add(path)
                    new.append(path)
    return sorted(found)


class _Implementation(caching.CompileResultCacheImpl):  # type: ignore[misc]
    _locator_classes = (_Locator,)

    def reduce(self, cres: Any) -> Any:
        """Without the list of types in words: half of a file, which nobody reads."""
        return super().reduce(cres._replace(type_annotation=""))


class _KernelCache(caching.FunctionCache):  # type: ignore[misc]
    """The kept kernels of one function: in the folder that is written, or as they came with the installation."""

    _impl_class = _Implementation

    def __init__(self, function: Any) -> None:
        super().__init__(function)
        stamp, base = self._impl.locator.get_source_stamp(), self._impl.filename_base
        source = Path(function.__code__.co_filename)
        self._cache_file = _File(self._cache_path, base, stamp)
        places = (source.parent / "__pycache__", shipped_folder(source))
        others = [str(place) for place in places if place is not None and str(place) != self._cache_path]
        self._installed = [_File(place, base, stamp) for place in others]

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Kept machine code needs what arrays are made with, and nothing that numba knows of Python's functions.

        To gather that takes a process a sixth of a second, and where something must be compiled numba does it then.
        """
        runtime.initialize(target_context)
        with self._guard_against_spurious_io_errors():
            return self._load_overload(sig, target_context)

    def _load_overload(self, sig: Any, target_context: Any) -> Any:
        if not self._enabled:
            return None
        key = self._index_key(sig, target_context.codegen())
        for file in (self._cache_file, *self._installed):
            try:
                data = file.load(key)
                if data is not None:
                    return self._impl.rebuild(target_context, data)
            except Exception:  # whatever a damaged installation raises
                continue
        return None

    def _save_overload(self, sig: Any, data: Any) -> None:
        try:
            super()._save_overload(sig, data)
        except OSError:  # a full disk: the kernel is there, only not kept
            return


def is_kept(kernel: Any) -> bool:
    """Whether machine code of a kernel, as it is now, is there from an earlier run or came with the package."""
    cache = getattr(kernel, "_cache", None)
    files = (getattr(cache, "_cache_file", None), *getattr(cache, "_installed", ()))
    return any(file is not None and bool(file._load_index()) for file in files)
