"""Kernels that Python calls without numba, whose import takes longer than everything else that a command does.

The stored code of such a kernel is one object file. LLVM alone (llvmlite) loads it in a few milliseconds. `ctypes`
calls it with one array of whole numbers: two places for results, then each argument in order, with tuples opened. A
number is passed as it is, an array as the address of its first item and its shape. If no code is stored, `compiling`
makes it. If that fails, or if a kernel cannot take the arguments, the function runs as Python.
"""

from __future__ import annotations

import ctypes
import json
from collections.abc import Callable, Iterable
from contextlib import suppress
from functools import partial
from operator import index
from pathlib import Path
from threading import Lock
from types import FunctionType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.run.errors import DancetutorError
from dancetutor_cli.run.kernels.stored_code import StoredCode

RESULTS = 2  # places for a kernel's results, before its arguments
_OBJECT_FILES = (b"\x7fELF", b"\xcf\xfa\xed\xfe", b"\x64\x86", b"\x64\xaa")  # first bytes of the systems' object files
_no_bytes_of: Any = (ctypes.c_char * 0).from_buffer  # a view of no bytes has an address; an empty array has one, too
_Unused: Any = ctypes.c_void_p * 2  # for the kernel's return value (none) and the number of an exception of numba
_prototype: Any = ctypes.PYFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int64)

INNER_KERNELS: dict[Callable[..., Any], dict[str, Any]] = {}  # kernels for kernels -> numba's options
Kind = tuple[np.dtype[Any], int] | None  # type and dimensions of an array, row by row; None: a whole number


def native_inner(function: Any = None, **options: Any) -> Any:
    """Mark a kernel that other kernels call; Python calls it as an ordinary function. options : numba's

    It is a decorator, `@native_inner` or `@native_inner(inline="always")`.
    """
    if function is None:
        return partial(native_inner, **options)
    INNER_KERNELS[function] = options
    return function


class MachineCode(NamedTuple):
    """An object file. entry : the function to call; needs : names of functions that this process must have"""

    entry: str
    needs: list[str]
    data: bytes


class LoadedCode(NamedTuple):
    """Machine code that can be called. kinds : kinds of its arguments, in order; engine : the engine of LLVM"""

    kinds: tuple[Kind, ...]
    run: Callable[[Any, Any, int], int]
    engine: Any


class Kernel:
    """A function of whole numbers, numpy arrays, and named tuples of those, that runs as machine code.

    It returns nothing, a whole number, or a tuple of two whole numbers.
    """

    def __init__(self, function: FunctionType, results: int = 0) -> None:
        """results : number of whole numbers that it returns."""
        self.function, self._results = function, results
        self._stored_code = StoredCode(Path(function.__code__.co_filename), function.__name__)
        self._last: LoadedCode | None = None
        self._loaded: dict[str, LoadedCode | None] = {}
        self._lock = Lock()

    def __call__(self, *args: Any) -> Any:
        """Return the function's result. Raises DancetutorError if it raises: machine code cannot report more."""
        arguments: list[Any] = []
        _open(args, arguments)
        words = _words(arguments, self._last)
        if words is None:
            with self._lock:
                self._last = self._loaded_for(args, arguments)
            words = _words(arguments, self._last)
        if words is None or self._last is None:
            try:
                with np.errstate(over="ignore"):  # hash functions overflow on purpose
                    return self.function(*args)
            except Exception as error:
                raise self._error(error) from error
        if status := self._last.run(_Unused(), _Unused(), _address(words)):
            raise self._error(status)
        given = words[:RESULTS].tolist()
        return None if self._results == 0 else given[0] if self._results == 1 else tuple(given)

    def _error(self, cause: object) -> DancetutorError:
        return DancetutorError(f"the kernel {self.function.__qualname__} raised an exception ({cause})")

    def _loaded_for(self, args: tuple[Any, ...], arguments: list[Any]) -> LoadedCode | None:
        """Return machine code for such arguments, loaded or compiled; None if there can be none."""
        try:
            kinds = tuple(map(_kind, arguments))
        except TypeError:
            return None
        name = " ".join("i" if kind is None else f"{kind[0].str}{kind[1]}" for kind in kinds)
        if name not in self._loaded:
            self._loaded[name] = self._fetch(name, kinds) or self._compile(name, kinds, args)
        return self._loaded[name]

    def _fetch(self, name: str, kinds: tuple[Kind, ...]) -> LoadedCode | None:
        for body in self._stored_code.read(name):
            with suppress(Exception):  # any error of LLVM about code from another system
                line, _, data = body.partition(b"\n")
                entry, needs = json.loads(line)
                return _load(MachineCode(entry, needs, data), kinds)
        return None

    def _compile(self, name: str, kinds: tuple[Kind, ...], args: tuple[Any, ...]) -> LoadedCode | None:
        try:
            from dancetutor_cli.run.kernels.compiling import machine_code

            code = machine_code(self.function, args, self._results)
            loaded = _load(code, kinds)
        except Exception:  # any error of numba or LLVM
            return None
        self._stored_code.write(name, json.dumps(code[:-1]).encode() + b"\n" + code.data)
        return loaded


def _open(arguments: Iterable[Any], into: list[Any]) -> None:
    """Append numbers and arrays in order, also those in tuples."""
    for one in arguments:
        if isinstance(one, tuple):
            _open(one, into)
        else:
            into.append(one)


def _kind(argument: Any) -> Kind:
    """Return the kind of an argument. Raises TypeError if machine code cannot take it."""
    if not isinstance(argument, np.ndarray):
        index(argument)
        return None
    if argument.dtype.kind not in "biuf" or not argument.dtype.isnative:
        raise TypeError(f"a kernel takes no arrays of {argument.dtype}")
    return np.dtype(argument.dtype.str), argument.ndim


def _words(arguments: list[Any], loaded: LoadedCode | None) -> NDArray[np.int64] | None:
    """Return the words for machine code.

    None if the code is for other arguments, or an argument is too large or not stored row by row.
    """
    words = [0] * RESULTS
    try:
        for one, kind in zip(arguments, loaded.kinds if loaded else (), strict=True):
            if kind is None:
                words.append(index(one))
                continue
            (dtype, dimensions), address, shape = kind, _address(one), one.shape
            if one.dtype != dtype or len(shape) != dimensions or address % dtype.itemsize:
                return None
            words.append(address)
            words += shape
        return np.array(words, dtype=np.int64)
    except (AttributeError, TypeError, ValueError, OverflowError):
        return None


def _address(array: NDArray[Any]) -> int:
    """Return the address of an array's first item. Raises TypeError if the items are not stored row by row.

    The buffer protocol takes a fifth of the time of `__array_interface__`, but refuses read-only arrays.
    """
    try:
        return ctypes.addressof(_no_bytes_of(array))
    except TypeError:
        if array.flags.writeable or not array.flags.c_contiguous:
            raise
        return int(array.__array_interface__["data"][0])


def _load(code: MachineCode, kinds: tuple[Kind, ...]) -> LoadedCode:
    """Load an object file with LLVM. Raises ImportError if this process lacks a function that it needs."""
    from llvmlite import binding

    if not code.data.startswith(_OBJECT_FILES) or not all(map(binding.address_of_symbol, code.needs)):
        raise ImportError("no machine code for this process")  # LLVM would end the process
    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    triple = binding.get_process_triple()
    machine = binding.Target.from_triple(triple).create_target_machine(jit=True)
    engine = binding.create_mcjit_compiler(binding.parse_assembly(f'target triple = "{triple}"'), machine)
    engine.add_object_file(binding.ObjectFileRef.from_data(code.data))
    engine.finalize_object()
    address = engine.get_function_address(code.entry)
    if not address:
        raise ImportError(f"no function {code.entry}")
    return LoadedCode(kinds, _prototype(address), engine)  # it holds Python's global lock, as with numba
