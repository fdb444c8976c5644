"""Compiles, by numba, what `kernel_door` calls: a kernel, and the function that hands it what objects hold."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FunctionType
from typing import Any

import numpy as np
from llvmlite import binding, ir

from dancetutor_cli import kernel_arguments as places
from dancetutor_cli.kernel_door import INNER, MISFIT, RESULTS, Code, Unfit
from dancetutor_cli.kernel_target import target
from dancetutor_cli.kernels import numba, uncounted

_numba: Any = numba
_types: Any = numba.types
_lock: Any = _numba.core.compiler_lock.global_compiler_lock
_NUMBER, _WORD = ir.IntType(32), ir.IntType(64)
_HELPERS = ("NRT_", "numba", "Py")  # of numba's and Python's, which only numba's own loader knows
_made: dict[FunctionType, Any] = {}


def machine_code(function: FunctionType, args: tuple[Any, ...]) -> Code:
    """Compile a kernel for arguments like these."""
    with _inner_kernels(function):
        return _code(function, tuple(_numba.typeof(_like(one)) for one in args))


def ordinary(function: FunctionType, args: tuple[Any, ...]) -> Callable[..., Any]:
    """A kernel that numba itself calls; compiled for arguments like these, and for others when they come."""
    kernel: Any = uncounted(function)

    def call(*args: Any) -> Any:
        with _inner_kernels(function):
            return kernel(*args)

    with _inner_kernels(function):
        kernel.compile(tuple(_numba.typeof(_like(one)) for one in args))
    return call


@contextmanager
def _inner_kernels(function: FunctionType) -> Iterator[None]:
    """Inner kernels are plain functions for everybody else: meanwhile they are what numba makes of them."""
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
        yield
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
        return places.remade(argument, map(_like, argument))
    return int(argument)


def _code(function: FunctionType, signature: tuple[Any, ...]) -> Code:
    kernel = uncounted(function, no_cpython_wrapper=True)
    with _lock:  # as far as to machine code, which nobody else asks for
        kernel.compile(signature)
        made = kernel.overloads[signature]
        (_, _, (code, _)) = made.library.serialize_using_object_code()
    if " ".join(made.library.codegen.magic_tuple()[1:]) != target():
        raise Unfit("compiled for another processor than its key says")
    declared = [one.name for one in made.library._final_module.functions if one.is_declaration]
    needs = tuple(sorted(name for name in declared if not name.startswith("llvm.")))
    if any(name.startswith(_HELPERS) for name in needs):
        raise Unfit(needs)
    results = _count(made.signature.return_type)
    entry = f"door_{function.__name__}"
    door = _door(entry, made, signature)
    machine = made.library.codegen._tm
    return Code(entry, results, needs, (code, machine.emit_object(binding.parse_assembly(door))))


def _count(given: Any) -> int:
    """How many whole numbers a kernel gives."""
    if given == _types.none:
        return 0
    numbers = list(given) if isinstance(given, _types.BaseTuple) else [given]
    if len(numbers) > RESULTS or any(one != _types.int64 for one in numbers):
        raise TypeError(f"a kernel behind a door gives whole numbers of 64 bits, at most {RESULTS}, not {given}")
    return len(numbers)


def _door(entry: str, made: Any, signature: tuple[Any, ...]) -> str:
    """The function that reads the tuple of a call's objects and calls the kernel, in LLVM's language.

    Its arguments: a table to compare with, words for the results, the tuple. It gives numba's status, 0 if all went
    well, or MISFIT.
    """
    context = made.target_context
    kernel_type = context.call_conv.get_function_type(made.fndesc.restype, made.fndesc.argtypes)
    module = ir.Module(entry)
    module.triple = binding.get_process_triple()
    kernel = ir.Function(module, kernel_type, made.fndesc.llvm_func_name)
    door = ir.Function(module, ir.FunctionType(_NUMBER, [_WORD] * 3), entry)
    builder = ir.IRBuilder(door.append_basic_block())
    table, results, arguments = door.args
    given = [results, builder.add(results, _WORD(8 * RESULTS))]
    reader = _Reader(builder, table)
    given += reader.leaves(_types.Tuple(signature), arguments)
    cast = []
    for value, wanted in zip(given, kernel_type.args, strict=True):
        is_pointer = isinstance(wanted, ir.PointerType)
        cast.append(builder.inttoptr(value, wanted) if is_pointer else value)
    builder.ret(builder.call(kernel, cast))
    reader.end()
    return str(module)


class _Reader:
    """Writes the code that takes objects apart, if they are what the table says."""

    def __init__(self, builder: ir.IRBuilder, table: Any) -> None:
        self._builder, self._table, self._next = builder, table, places.COMMON
        self._reader, self._array, self._number = (self._load(table, 8 * n) for n in range(places.COMMON))
        self._misfit = builder.function.append_basic_block()
        with builder.goto_entry_block():
            self._overflow = builder.alloca(_NUMBER)

    def end(self) -> None:
        """To be called last."""
        self._builder.position_at_end(self._misfit)
        self._builder.ret(_NUMBER(MISFIT))

    def leaves(self, kind: Any, at: Any) -> Iterator[Any]:
        """What numba hands on for an object, as whole numbers."""
        if isinstance(kind, _types.BaseTuple):
            self._expect(self._load(at, places.TYPE), self._word())
            self._expect(self._load(at, places.LENGTH), _WORD(len(kind)))
            for n, one in enumerate(kind):
                yield from self.leaves(one, self._load(at, places.ITEMS + 8 * n))
        elif isinstance(kind, _types.Array):
            yield from self._array_leaves(kind, at)
        else:
            self._expect(self._load(at, places.TYPE), self._number)
            reads = ir.FunctionType(_WORD, [_WORD, _NUMBER.as_pointer()]).as_pointer()
            value = self._builder.call(self._builder.inttoptr(self._reader, reads), [at, self._overflow])
            self._expect(self._builder.load(self._overflow), _NUMBER(0))
            yield value

    def _array_leaves(self, kind: Any, at: Any) -> Iterator[Any]:
        """What owns an array (nothing), how many items there are, how long each is, where they lie, shape, strides."""
        builder, in_a_row = self._builder, kind.layout == "C"
        self._expect(self._load(at, places.TYPE), self._array)
        self._expect(self._load(at, places.DIMENSIONS, _NUMBER), _NUMBER(kind.ndim))
        flags = builder.and_(self._load(at, places.FLAGS, _NUMBER), _NUMBER(places.IN_A_ROW | places.ALIGNED))
        self._expect(flags, _NUMBER(places.ALIGNED | (places.IN_A_ROW if in_a_row else 0)))
        numbers = self._load(self._load(at, places.NUMBERS), places.KIND)
        self._expect(builder.and_(numbers, _WORD(places.KIND_MASK)), self._word())
        shape_at = self._load(at, places.SHAPE)
        shape = [self._load(shape_at, 8 * n) for n in range(kind.ndim)]
        size = _WORD(np.dtype(str(kind.dtype)).itemsize)
        items = _WORD(1)
        for length in shape:
            items = builder.mul(items, length)
        if in_a_row:
            strides = [size]
            for length in reversed(shape[1:]):
                strides.insert(0, builder.mul(strides[0], length))
        else:
            strides_at = self._load(at, places.STRIDES)
            strides = [self._load(strides_at, 8 * n) for n in range(kind.ndim)]
        yield from (_WORD(0), _WORD(0), items, size, self._load(at, places.DATA), *shape, *strides)

    def _word(self) -> Any:
        """The next word of the table."""
        self._next += 1
        return self._load(self._table, 8 * (self._next - 1))

    def _load(self, at: Any, offset: int, kind: ir.IntType = _WORD) -> Any:
        return self._builder.load(self._builder.inttoptr(self._builder.add(at, _WORD(offset)), kind.as_pointer()))

    def _expect(self, found: Any, wanted: Any) -> None:
        """Go on only if two numbers are the same."""
        fits = self._builder.function.append_basic_block()
        self._builder.cbranch(self._builder.icmp_signed("==", found, wanted), fits, self._misfit)
        self._builder.position_at_end(fits)
