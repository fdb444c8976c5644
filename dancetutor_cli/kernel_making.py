"""Compiles, by numba, what `kernel_door` calls: a kernel, and the function that hands it what a row of numbers says."""

from __future__ import annotations

from collections.abc import Iterator
from types import FunctionType
from typing import Any

import numba
import numpy as np
from llvmlite import binding, ir
from numba.core.compiler_lock import global_compiler_lock

from dancetutor_cli.kernel_door import ARGUMENTS, INNER, RESULTS, Code
from dancetutor_cli.kernels import uncounted

_numba: Any = numba
_types: Any = numba.types
_lock: Any = global_compiler_lock
_WORD = ir.IntType(64)
_STATUS = ir.IntType(32)
_HELPERS = ("NRT_", "numba", "Py")  # of numba's and Python's, which only numba's own loader knows
_made: dict[FunctionType, Any] = {}


def machine_code(function: FunctionType, args: tuple[Any, ...]) -> Code:
    """Compile a kernel for arguments like these.

    The inner kernels that it calls are plain functions for everybody else: here they are what numba makes of them.
    """
    for one, options in INNER.items():
        if one not in _made:
            _made[one] = uncounted(one, **options)
    spaces = {id(one.__globals__): one.__globals__ for one in (*INNER, function)}
    replaced = [
        (space, name, value)
        for space in spaces.values()
        for name, value in list(space.items())
        if isinstance(value, FunctionType) and value in _made
    ]
    for space, name, value in replaced:
        space[name] = _made[value]
    try:
        return _code(function, tuple(_numba.typeof(_like(one)) for one in args))
    finally:
        for space, name, value in replaced:
            space[name] = value


def _like(argument: Any) -> Any:
    """What numba takes for the argument's type: whether its arrays can be written makes no other machine code."""
    if isinstance(argument, np.ndarray):
        if argument.flags.c_contiguous:
            return np.empty((1,) * argument.ndim, argument.dtype)
        return np.empty((2,) * (argument.ndim + 1), argument.dtype)[..., 0]
    if isinstance(argument, tuple):
        return type(argument)._make(map(_like, argument))  # type: ignore[attr-defined]
    return int(argument)


def _code(function: FunctionType, signature: tuple[Any, ...]) -> Code:
    kernel = uncounted(function, no_cpython_wrapper=True)
    with _lock:  # as far as to machine code, which nobody else asks for
        kernel.compile(signature)
        made = kernel.overloads[signature]
        (_, _, (code, _)) = made.library.serialize_using_object_code()
    declared = [one.name for one in made.library._final_module.functions if one.is_declaration]
    assert not any(name.startswith(_HELPERS) for name in declared), declared
    results = _count(made.signature.return_type)
    entry = f"door_{function.__name__}"
    door = _door(entry, made, signature)
    machine = made.library.codegen._tm
    return Code(entry, results, (code, machine.emit_object(binding.parse_assembly(door))))


def _count(given: Any) -> int:
    """How many whole numbers a kernel gives."""
    if given == _types.none:
        return 0
    numbers = list(given) if isinstance(given, _types.BaseTuple) else [given]
    if len(numbers) > RESULTS or any(one != _types.int64 for one in numbers):
        raise TypeError(f"a kernel behind a door gives whole numbers of 64 bits, at most {RESULTS}, not {given}")
    return len(numbers)


def _door(entry: str, made: Any, signature: tuple[Any, ...]) -> str:
    """The function that reads words and calls the kernel, in LLVM's language. It gives numba's status, 0 if all went
    well; results go into the first words."""
    context = made.target_context
    kernel_type = context.call_conv.get_function_type(made.fndesc.restype, made.fndesc.argtypes)
    module = ir.Module(entry)
    module.triple = binding.get_process_triple()
    kernel = ir.Function(module, kernel_type, made.fndesc.llvm_func_name)
    door = ir.Function(module, ir.FunctionType(_STATUS, [_WORD.as_pointer()]), entry)
    builder = ir.IRBuilder(door.append_basic_block())
    words = _Words(builder, door.args[0])
    given = [words.place(0), words.place(RESULTS)]
    words.at = ARGUMENTS
    for one in signature:
        given += _leaves(words, builder, one)
    cast = []
    for value, wanted in zip(given, kernel_type.args, strict=True):
        is_pointer = isinstance(wanted, ir.PointerType)
        cast.append(builder.inttoptr(value, wanted) if is_pointer else value)
    builder.ret(builder.call(kernel, cast))
    return str(module)


class _Words:
    """Takes one word after the other."""

    def __init__(self, builder: ir.IRBuilder, first: Any) -> None:
        self._builder, self._first, self.at = builder, first, 0

    def next(self) -> Any:
        """The next word."""
        self.at += 1
        return self._builder.load(self._builder.gep(self._first, [_WORD(self.at - 1)]))

    def place(self, at: int) -> Any:
        """The address of a word, as a number."""
        return self._builder.ptrtoint(self._builder.gep(self._first, [_WORD(at)]), _WORD)


def _leaves(words: _Words, builder: ir.IRBuilder, kind: Any) -> Iterator[Any]:
    """What numba hands on for an argument, as whole numbers: of an array what owns it (nothing), how many items there
    are and how long each is, where they lie, shape and strides."""
    if isinstance(kind, _types.BaseTuple):
        for one in kind:
            yield from _leaves(words, builder, one)
        return
    if not isinstance(kind, _types.Array):
        yield words.next()
        return
    size = _WORD(np.dtype(str(kind.dtype)).itemsize)
    data, shape = words.next(), [words.next() for _ in range(kind.ndim)]
    items = _WORD(1)
    for length in shape:
        items = builder.mul(items, length)
    if kind.layout == "C":
        strides = [size]
        for length in reversed(shape[1:]):
            strides.insert(0, builder.mul(strides[0], length))
    else:
        strides = [words.next() for _ in range(kind.ndim)]
    yield from (_WORD(0), _WORD(0), items, size, data, *shape, *strides)
