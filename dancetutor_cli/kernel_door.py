"""Kernels that Python calls without numba, where their machine code is kept: `Door`.

To import numba takes longer than all else that a command does for a chart. A door writes the addresses and shapes of a
call's arrays into a row of numbers; machine code of two parts takes it from there: the kernel, and a small function
that reads the numbers and calls it. Both are kept in one file. Only what is not kept is compiled, by numba, as
`kernel_making` says; LLVM alone loads it in a few milliseconds.
"""

from __future__ import annotations

import ctypes
import hashlib
import json
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from threading import Lock
from types import FunctionType
from typing import Any, TypeVar

import numpy as np

from dancetutor_cli.errors import DancetutorError
from dancetutor_cli.kernel_folder import CHECKSUM, SUFFIX, head, kernel_folder, places_of, shipped_folder
from dancetutor_cli.kernel_target import target

_BYTE: Any = ctypes.c_char
RESULTS = 2  # words in which a kernel's results stand, at most
ARGUMENTS = RESULTS + 1  # the first word of the arguments, behind one for numba's word about an exception


INNER: dict[FunctionType, dict[str, Any]] = {}  # kernels that kernels call, with options for `kernels.uncounted`
F = TypeVar("F", bound=Callable[..., Any])


def inner(function: F, **options: Any) -> F:
    """A kernel that kernels behind doors call; for everybody else it stays the function that it is."""
    assert isinstance(function, FunctionType)
    INNER[function] = options
    return function


@dataclass(frozen=True, slots=True)
class Code:
    """Machine code as it is kept. entry : name of the function that reads the words; results : how many it gives

    parts : object files, which call each other
    """

    entry: str
    results: int
    parts: tuple[bytes, ...]


class Door:
    """A kernel as Python calls it: with whole numbers, numpy arrays, and named tuples of those.

    What the arrays hold, their dimensions and order in memory choose the machine code, as with numba. The kernel gives
    nothing, a whole number, or a tuple of two.
    """

    def __init__(self, function: FunctionType, lasting: tuple[int, ...], stamp: Callable[[], str]) -> None:
        """lasting : places of the arguments whose arrays stay where and as long as they are while the tuple is used

        stamp : a digest of the kernel's source and of what goes into it
        """
        self.function = function
        self._stamp = stamp
        self._lasting = frozenset(lasting)
        self._codes: dict[str, tuple[Callable[[int], int], int, Any]] = {}
        self._told: dict[int, tuple[Any, str, list[int]]] = {}  # of the last of the lasting arguments
        self._words = (ctypes.c_int64 * 0)()
        self._lock = Lock()  # two threads share the words

    def __call__(self, *args: Any) -> Any:
        """What the kernel gives. DancetutorError if it raises: it cannot say what."""
        with self._lock:
            kinds = ""
            words: list[int] = []
            for place, argument in enumerate(args):
                kind, numbers = self._told_of(place, argument)
                kinds += kind
                words += numbers
            run, results, _ = self._codes.get(kinds) or self._open(kinds, args)
            if len(self._words) < ARGUMENTS + len(words):
                self._words = (ctypes.c_int64 * (ARGUMENTS + len(words)))()
            self._words[ARGUMENTS : ARGUMENTS + len(words)] = words  # type: ignore[assignment]
            if status := run(ctypes.addressof(self._words)):
                raise DancetutorError(f"the kernel {self.function.__qualname__} raised an exception ({status})")
            return (None, self._words[0], tuple(self._words[:2]))[results]

    def _told_of(self, place: int, argument: Any) -> tuple[str, list[int]]:
        if place not in self._lasting:
            return told_of(argument)
        if place not in self._told or self._told[place][0] is not argument:
            self._told[place] = (argument, *told_of(argument))
        return self._told[place][1:]

    def _open(self, kinds: str, args: tuple[Any, ...]) -> tuple[Callable[[int], int], int, Any]:
        digest = hashlib.sha256(f"{kinds}|{target()}".encode()).hexdigest()[:8]
        code = next(self._kept(digest), None)
        if code is None:
            from dancetutor_cli.kernel_making import machine_code

            code = machine_code(self.function, args)
            self._keep(digest, code)
        run, engine = _loaded(code)
        self._codes[kinds] = run, code.results, engine
        return self._codes[kinds]

    def _kept(self, digest: str) -> Iterator[Code]:
        for folder in self._folders():
            with suppress(OSError):
                data = (folder / self._name(digest)).read_bytes()
                if is_sound(data, self._stamp()):
                    yield _unpacked(data)

    def _keep(self, digest: str, code: Code) -> None:
        if not kernel_folder().kept:
            return
        path = kernel_folder().of_module(self._source) / self._name(digest)
        beside = path.with_name(f"{path.name}.{os.getpid()}.tmp")
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            beside.write_bytes(_packed(code, self._stamp()))
            beside.replace(path)
        except OSError:  # a full disk: the kernel is there, only not kept
            with suppress(OSError):
                beside.unlink(missing_ok=True)

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


def told_of(argument: Any) -> tuple[str, list[int]]:
    """What kind of thing an argument is, and the words that tell a kernel of it. TypeError if there are none."""
    if isinstance(argument, np.ndarray):
        if argument.flags.c_contiguous:
            return _kind(argument.dtype, argument.ndim), [_address(argument), *argument.shape]
        return f"{argument.dtype.str}{argument.ndim}A ", [_address(argument), *argument.shape, *argument.strides]
    if isinstance(argument, tuple):
        kinds, all_words = "(", []
        for one in argument:
            kind, words = told_of(one)
            kinds += kind
            all_words += words
        return kinds + ")", all_words
    if isinstance(argument, int | np.integer):
        return "i ", [int(argument)]
    raise TypeError(f"a kernel behind a door takes no {type(argument).__name__}")


@cache
def _kind(dtype: np.dtype[Any], dimensions: int) -> str:
    return f"{dtype.str}{dimensions} "


def _address(array: np.ndarray[Any, Any]) -> int:
    """Where an array lies, 0 if it is empty. Its buffer tells in a third of the time, unless it is only to be read."""
    if not array.size:
        return 0
    try:
        return ctypes.addressof(_BYTE.from_buffer(array))
    except (TypeError, ValueError):
        address: int = array.__array_interface__["data"][0]
        return address


def is_sound(data: bytes, stamp: str) -> bool:
    """Whether a kept file is as it was written, and was made of this source by what is installed now."""
    body = data[CHECKSUM:]
    return body.startswith(head(stamp)) and hashlib.sha256(body).digest() == data[:CHECKSUM]


def _packed(code: Code, stamp: str) -> bytes:
    about = json.dumps({"entry": code.entry, "results": code.results, "parts": [len(part) for part in code.parts]})
    body = head(stamp) + about.encode() + b"\n" + b"".join(code.parts)
    return hashlib.sha256(body).digest() + body


def _unpacked(data: bytes) -> Code:
    line, _, rest = data[3 * CHECKSUM :].partition(b"\n")
    about, parts = json.loads(line), []
    for size in about["parts"]:
        parts.append(rest[:size])
        rest = rest[size:]
    return Code(about["entry"], about["results"], tuple(parts))


def _loaded(code: Code) -> tuple[Callable[[int], int], Any]:
    """The function that reads the words, and what must live as long as it."""
    from llvmlite import binding

    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    triple = binding.get_process_triple()
    machine = binding.Target.from_triple(triple).create_target_machine(jit=True)
    engine = binding.create_mcjit_compiler(binding.parse_assembly(f'target triple = "{triple}"'), machine)
    for part in code.parts:
        engine.add_object_file(binding.ObjectFileRef.from_data(part))
    engine.finalize_object()
    kind = ctypes.PYFUNCTYPE(ctypes.c_int32, ctypes.c_void_p)  # other threads of Python wait, as with numba
    return kind(engine.get_function_address(code.entry)), engine
