"""Kernels that Python calls without numba, where their machine code is kept: `Door`.

To import numba takes longer than all else that a command does for a chart. A door hands a call's objects to machine
code of two parts: the kernel, and a small function that takes addresses and shapes out of the objects and calls it.
Both are kept in one file. Only what is not kept is compiled, by numba, as `kernel_making` says; LLVM alone loads it in
a few milliseconds. Where none of that goes, numba calls the kernel in its ordinary way, or Python does.
"""

from __future__ import annotations

import ctypes
import hashlib
import json
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from threading import Lock
from types import FunctionType
from typing import Any, TypeVar

import numpy as np

from dancetutor_cli.errors import DancetutorError
from dancetutor_cli.kernel_arguments import HEAD, ITEMS, is_known, kinds_of, plain, table_of
from dancetutor_cli.kernel_folder import CHECKSUM, SUFFIX, head, kernel_folder, places_of, shipped_folder
from dancetutor_cli.kernel_target import target
from dancetutor_cli.run.trust import read_file, use_folder, write_file

RESULTS = 2  # words in which a kernel's results stand, at most; behind them numba's word about an exception
MISFIT = -1000  # what the reading function gives if an object is not of the kind that it was made for
_OBJECT_FILES = (b"\x7fELF", b"\xcf\xfa\xed\xfe", b"\x64\x86", b"\x64\xaa")  # what those of the systems start with
_Results: Any = ctypes.c_int64 * (RESULTS + 1)
Run = Callable[[Any, Any, Any], int]

INNER: dict[FunctionType, dict[str, Any]] = {}  # kernels that kernels call, with options for `kernels.uncounted`
F = TypeVar("F", bound=Callable[..., Any])


def inner(function: F, **options: Any) -> F:
    """A kernel that kernels behind doors call; for everybody else it stays the function that it is."""
    assert isinstance(function, FunctionType)
    INNER[function] = options
    return function


@dataclass(frozen=True, slots=True)
class Code:
    """Machine code as it is kept. entry : name of the function that reads the objects; results : how many it gives

    needs : names of the functions that it calls and that this process must have; parts : object files
    """

    entry: str
    results: int
    needs: tuple[str, ...]
    parts: tuple[bytes, ...]


class Unfit(Exception):  # noqa: N818 - never leaves a door
    """Machine code that cannot be called here."""


class Door:
    """A kernel as Python calls it: with whole numbers, numpy arrays, and named tuples of those.

    What the arrays hold, their dimensions and order in memory choose the machine code, as with numba. The kernel gives
    nothing, a whole number, or a tuple of two.
    """

    def __init__(self, function: FunctionType, stamp: Callable[[], str]) -> None:
        """stamp : a digest of the kernel's source and of what goes into it."""
        self.function = function
        self._stamp = stamp
        self._last: tuple[Run, Any, int] = (_misfit, None, 0)
        self._codes: dict[str, tuple[Run, Any, int]] = {}
        self._alive: list[Any] = []  # what machine code and its tables need
        self._ordinary: Callable[..., Any] | None = None
        self._lock = Lock()

    def __call__(self, *args: Any) -> Any:
        """What the kernel gives. DancetutorError if it raises: it cannot say what."""
        results = _Results()
        run, table, count = self._last
        status = run(table, results, args)
        if status == MISFIT:
            return self._otherwise(args)
        if status:
            raise self._error(status)
        return (results[0], results[1]) if count == 2 else (results[0] if count else None)

    def _otherwise(self, args: tuple[Any, ...]) -> Any:
        """A call with objects of another kind than the last one, or where there is no machine code to call."""
        kinds, args, results = "".join(map(kinds_of, args)), plain(args), _Results()
        if self._ordinary is None:
            try:
                with self._lock:
                    opened = self._codes.get(kinds) or self._open(kinds, args)
            except Unfit:
                return self._call_ordinary(args)
            run, table, count = self._last = opened
            status = run(table, results, args)
            if status not in (0, MISFIT):
                raise self._error(status)
            if status == 0:
                return (None, results[0], tuple(results[:2]))[count]
        return self._call_ordinary(args)

    def _error(self, status: object) -> DancetutorError:
        return DancetutorError(f"the kernel {self.function.__qualname__} raised an exception ({status})")

    def _call_ordinary(self, args: tuple[Any, ...]) -> Any:
        """As numba calls kernels, or Python: slower, but with the same results."""
        self._last = (_misfit, None, 0)
        with self._lock:
            if self._ordinary is None:
                try:
                    from dancetutor_cli.kernel_making import ordinary

                    self._ordinary = ordinary(self.function, args)
                except Exception:  # whatever numba and LLVM raise
                    self._ordinary = self.function
        try:
            with np.errstate(over="ignore"):  # numbers of hash functions wrap round
                return self._ordinary(*args)
        except Exception as error:
            raise self._error(error) from error

    def _open(self, kinds: str, args: tuple[Any, ...]) -> tuple[Run, Any, int]:
        """Fetch or make machine code for such arguments. Unfit if neither goes."""
        if not is_known():
            raise Unfit
        digest = hashlib.sha256(f"{kinds}|{HEAD}|{ITEMS}|{sys.platform}|{target()}".encode()).hexdigest()[:8]
        for code in self._kept(digest):
            with suppress(Exception):  # made on another system, maybe
                return self._entered(kinds, args, code)
        try:
            from dancetutor_cli.kernel_making import machine_code

            code = machine_code(self.function, args)
            opened = self._entered(kinds, args, code)
        except Exception as error:  # whatever numba and LLVM raise
            raise Unfit from error
        self._keep(digest, code)
        return opened

    def _entered(self, kinds: str, args: tuple[Any, ...], code: Code) -> tuple[Run, Any, int]:
        run, engine = _loaded(code)
        table, kept = table_of(args)
        self._alive += [engine, kept]
        self._codes[kinds] = run, table, code.results
        return self._codes[kinds]

    def _kept(self, digest: str) -> Iterator[Code]:
        for folder in self._folders():
            with suppress(OSError):
                data = read_file(folder / self._name(digest))
                if is_sound(data, self._stamp()):
                    yield _unpacked(data)

    def _keep(self, digest: str, code: Code) -> None:
        if not kernel_folder().kept:
            return
        path = kernel_folder().of_module(self._source) / self._name(digest)
        with suppress(OSError):  # a full disk: the kernel is there, only not kept
            if not use_folder(path.parent):
                write_file(path, _packed(code, self._stamp()))

    @property
    def _source(self) -> Path:
        return Path(self.function.__code__.co_filename)

    def _name(self, digest: str) -> str:
        name = f"{self._source.stem}.{self.function.__name__}"
        return f"{name}.{digest}.{sys.implementation.cache_tag}{SUFFIX}"

    def _folders(self) -> Iterator[Path]:
        yield from places_of(self._source)
        if shipped := shipped_folder(self._source):
            yield shipped


def _misfit(table: Any, results: Any, args: Any) -> int:
    return MISFIT


def is_sound(data: bytes, stamp: str) -> bool:
    """Whether a kept file is as it was written, and was made of this source by what is installed now."""
    body = data[CHECKSUM:]
    return body.startswith(head(stamp)) and hashlib.sha256(body).digest() == data[:CHECKSUM]


def _packed(code: Code, stamp: str) -> bytes:
    about = {"entry": code.entry, "results": code.results, "needs": code.needs, "parts": [*map(len, code.parts)]}
    body = head(stamp) + json.dumps(about).encode() + b"\n" + b"".join(code.parts)
    return hashlib.sha256(body).digest() + body


def _unpacked(data: bytes) -> Code:
    line, _, rest = data[3 * CHECKSUM :].partition(b"\n")
    about, parts = json.loads(line), []
    for size in about["parts"]:
        parts.append(rest[:size])
        rest = rest[size:]
    return Code(about["entry"], about["results"], tuple(about["needs"]), tuple(parts))


def _loaded(code: Code) -> tuple[Run, Any]:
    """The function that reads the objects, and what must live as long as it. Unfit if this process lacks a function."""
    from llvmlite import binding

    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    triple = binding.get_process_triple()
    machine = binding.Target.from_triple(triple).create_target_machine(jit=True)
    engine = binding.create_mcjit_compiler(binding.parse_assembly(f'target triple = "{triple}"'), machine)
    is_whole = all(part.startswith(_OBJECT_FILES) for part in code.parts)
    if not is_whole or not all(map(binding.address_of_symbol, code.needs)):  # LLVM would end the process
        raise Unfit
    for part in code.parts:
        engine.add_object_file(binding.ObjectFileRef.from_data(part))
    engine.finalize_object()
    address = engine.get_function_address(code.entry)
    if not address:
        raise Unfit
    # other threads of Python wait, as with numba: the objects stay what they are
    kind = ctypes.PYFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, ctypes.c_void_p, ctypes.py_object)
    return kind(address), engine
