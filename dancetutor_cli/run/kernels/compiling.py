"""Compile kernels with numba: an `njit` in place of numba's, and machine code for `native`.

Only this module imports numba. numba fails if it finds no folder that it can write, or if one of its files was cut
short. With `njit` of this module, the kernel is only compiled again: `stored_code` stores the compiled code.
"""

from __future__ import annotations

import pickle
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from importlib import import_module
from itertools import count
from pathlib import Path
from types import FunctionType
from typing import Any, TypeVar

import numpy as np
from llvmlite import binding

from dancetutor_cli.run.kernels.native import INNER_KERNELS, RESULTS, MachineCode
from dancetutor_cli.run.kernels.stored_code import StoredCode, pin, processor

_ASKS_FOR_BLAS = "numba.np.arraymath"  # numba's module that imports the next one, which takes a third of a second
_BLAS = "scipy.linalg"  # needed only for functions that no kernel uses


@contextmanager
def without_module(name: str) -> Iterator[None]:
    """Make a module impossible to import in this context, whether or not it has been imported before."""
    present = {key: module for key, module in sys.modules.items() if key == name}
    sys.modules[name] = None  # type: ignore[assignment]  # the import system reads it as "there is none"
    try:
        yield
    finally:
        del sys.modules[name]
        sys.modules.update(present)


# numba reads `.numba_config.yaml` in the current folder when it is imported, and whenever it compiles. An untrusted
# file there could choose the processor to compile for. If numba cannot import YAML, it ignores the file and warns.
warnings.filterwarnings("ignore", message="A Numba config file is found")
with without_module("yaml"):
    import numba as numba
    from numba import float32 as float32
    from numba import int32 as int32
    from numba import int64 as int64
    from numba import uint32 as uint32
    from numba import uint64 as uint64

    _core: Any = import_module("numba.core")  # has type hints only in some versions
_extending: Any = import_module("numba.extending")
_arrays: Any = import_module("numba.np.arrayobj")
_runtime: Any = import_module("numba.core.runtime.nrt").rtsys
_results: Any = import_module("numba.core.compiler").CompileResult
_dumps: Any = import_module("numba.core.serialize").dumps
_types: Any = numba.types
_plain: Any = numba.njit  # its type hints lack some options that are used here
pin(_core.config)

F = TypeVar("F")


def njit(*, cache: bool = False, counted: bool = True, **options: Any) -> Callable[[F], F]:
    """Return the decorator `numba.njit`, which here keeps the type hints of the function.

    cache : whether the compiled code is stored in `stored_code`
    counted : False for a kernel that makes no arrays and only uses those it is given: then numba does not count
        references. It counts them by calls wherever an array is taken from a tuple or passed on, also inside loops. In
        the solver's rules, that took half of the time.
    """
    if not counted:
        options["_nrt"] = False

    def compiled(function: F) -> F:
        kernel: Any = _plain(no_cfunc_wrapper=True, **options)(function)  # only ctypes needs that wrapper
        if cache:
            kernel._cache = _KeptOverloads(function)
        return kernel  # type: ignore[no-any-return]

    return compiled


def njit_inner(function: F) -> F:
    """Return a kernel that only kernels call; a call from Python would crash.

    It is compiled into each kernel that calls it, and those are stored. tests/run/test_run_kernels.py finds calls from
    Python.
    """
    return njit(no_cpython_wrapper=True)(function)


class _KeptOverloads:
    """The store from which numba loads the machine code of a function, in place of numba's own files."""

    cache_path = None  # shown in numba's statistics

    def __init__(self, function: Any) -> None:
        source = Path(function.__code__.co_filename)
        self.kept = StoredCode(source, function.__name__)
        cells = [cell.cell_contents for cell in function.__closure__ or ()]
        self._function = f"{function.__qualname__} {function.__code__.co_firstlineno} {_dumps(cells).hex()}"

    def load_overload(self, signature: Any, context: Any) -> Any:
        """Return the stored machine code for a signature, or None.

        Stored code needs numba's runtime for arrays, but not its knowledge of Python's functions. Gathering that takes
        a sixth of a second in each process; numba does it only if it must compile something.
        """
        _runtime.initialize(context)
        with without_module(_BLAS):
            if _is_for_target(context.codegen()):
                for body in self.kept.read(f"{self._function} {signature}"):
                    with suppress(Exception):
                        return _results._rebuild(context, *pickle.loads(body))
            import_module(_ASKS_FOR_BLAS)
        return None

    def save_overload(self, signature: Any, result: Any) -> None:
        """Store machine code for a signature, without the types in words: half of a file, which nobody reads."""
        if _is_for_target(result.library.codegen) and not result.library.has_dynamic_globals:
            body = _dumps(result._replace(type_annotation="")._reduce())
            self.kept.write(f"{self._function} {signature}", body)


def _is_for_target(codegen: Any) -> bool:
    """Whether numba compiles for the processor of the stored code; the first import of numba decides that."""
    return tuple(codegen.magic_tuple()[1:]) == processor()


def is_kept(kernel: Any) -> bool:
    """Whether code of a kernel's current source is stored, by an earlier run or a wheel. It must have `cache`."""
    return bool(kernel._cache.kept.is_there())


def machine_code(function: FunctionType, args: tuple[Any, ...], results: int) -> MachineCode:
    """Compile a kernel for arguments of the same types, in the form that `native` calls."""
    with without_module(_BLAS):
        import_module(_ASKS_FOR_BLAS)
    names: dict[str, Any] = {"array_at": _array_at, "int64": np.int64}
    names["kernel"] = _kernel(function, no_cpython_wrapper=True)
    places = count(RESULTS)
    call = f"kernel({', '.join(_expression(one, places, names) for one in args)})"
    given = f"{', '.join(f'words[{n}]' for n in range(results))} = " if results else ""
    words = f"array_at(address, ({next(places)},), int64)"
    exec(f"def entry(address):\n    words = {words}\n    {given}{call}", names)
    signature = (_types.int64,)
    compiled = njit(counted=False, no_cpython_wrapper=True)(names["entry"])
    compiled.compile(signature)
    module = binding.parse_assembly(compiled.inspect_llvm(signature))
    declared = [one.name for one in module.functions if one.is_declaration and not one.name.startswith("llvm.")]
    host = binding.Target.from_triple(binding.get_process_triple())
    machine = host.create_target_machine(*processor(), opt=3, reloc="static", codemodel="jitdefault", jit=True)
    entry = compiled.overloads[signature].fndesc.llvm_func_name
    return MachineCode(entry, sorted(declared), machine.emit_object(module))


def _expression(argument: Any, places: Iterator[int], names: dict[str, Any]) -> str:
    """Return the expression that makes an argument from its words. names : the names in the expression, added here"""
    if isinstance(argument, tuple):
        name = f"{type(argument).__name__}_{id(type(argument))}" if hasattr(argument, "_fields") else ""
        names[name] = type(argument)
        return f"{name}({' '.join(f'{_expression(one, places, names)},' for one in argument)})"
    place = f"words[{next(places)}]"
    if not isinstance(argument, np.ndarray):
        return place
    names[argument.dtype.name] = argument.dtype.type
    shape = " ".join(f"words[{next(places)}]," for _ in range(argument.ndim))
    return f"array_at({place}, ({shape}), {argument.dtype.name})"


@_extending.intrinsic
def _array_at(context: Any, address: Any, shape: Any, number: Any) -> Any:
    """In kernels: return the array of a number type, row by row from an address on; numba does not own its memory."""
    kind = _types.Array(number.dtype, len(shape), "C")

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        array = context.make_array(kind)(context, builder)
        size = context.get_constant(_types.intp, np.dtype(str(kind.dtype)).itemsize)
        lengths, strides = _core.cgutils.unpack_tuple(builder, args[1]), [size]
        for length in lengths[:0:-1]:
            strides.insert(0, builder.mul(strides[0], length))
        data = builder.inttoptr(args[0], array.data.type)
        _arrays.populate_array(array, data, lengths, strides[: len(lengths)], size, None)
        return array._getvalue()

    return kind(address, shape, number), generate


@cache
def _kernel(function: FunctionType, **options: Any) -> Any:
    """Return a kernel compiled by numba, together with its inner kernels, which are plain functions elsewhere."""
    names = dict(function.__globals__)
    for name in function.__code__.co_names:
        inner = names.get(name)
        if isinstance(inner, FunctionType) and inner in INNER_KERNELS:
            names[name] = _kernel(inner, **INNER_KERNELS[inner])
    return njit(counted=False, **options)(FunctionType(function.__code__, names, function.__name__))
