"""numba compiles quicker: a sixth of its time goes into questions that it has just answered.

What is compiled stays the same (tests/test_quick_compiling.py). Where another version of numba has not what is replaced
here, it stays as it is.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from importlib import import_module
from typing import Any

_PARTS_WITHOUT_NAMES = ("str", "int", "bool", "float", "NoneType", "Loc")


@cache
def _defaults(kind: Any) -> dict[str, Any]:
    return {name: option.default for name, option in kind.options.items()}


def _values(self: Any) -> dict[str, Any]:
    """In place of `TargetConfig.values`: all options, not asked for one by one. It is asked for by each typed call."""
    kind: Any = type(self)
    return {**_defaults(kind), **self._values}


def _quick_listing(listed: Any, variable: type) -> Any:
    """In place of `Inst._rec_list_vars`, which asks of each text and place in the code whether it is a list."""

    def of_all(self: Any, parts: Iterable[Any]) -> list[Any]:
        found = []
        for part in parts:
            kind = type(part)
            if kind is variable:
                found.append(part)
            elif kind.__name__ not in _PARTS_WITHOUT_NAMES:
                found += of_one(self, part)
        return found

    def of_one(self: Any, part: Any) -> Any:
        kind = type(part)
        if kind is dict:
            return of_all(self, part.values())
        return of_all(self, part) if kind is list or kind is tuple else listed(self, part)

    return of_one


def _remembered_types(asked: Any, numbers: tuple[type, ...], flags_now: Any) -> Any:
    """In place of `BaseFunction.get_call_type`: what a function of numbers returns is found once for their types.

    numba goes through all that `+` may be, numpy's functions included, for each `+`.
    """

    def get_call_type(self: Any, context: Any, args: Any, kws: Any) -> Any:
        if kws or not all(isinstance(one, numbers) for one in args):
            return asked(self, context, args, kws)
        known = self.__dict__.setdefault("_dancetutor_known", {})
        key = context, tuple(args), flags_now()
        if key not in known:
            found = asked(self, context, args, kws)
            known[key] = found, self._impl_keys[found.args]
        found, self._impl_keys[found.args] = known[key]
        return found

    return get_call_type


@cache
def compile_quicker() -> None:
    """Answer them from memory from now on."""
    try:
        config: Any = import_module("numba.core.targetconfig")
        ir: Any = import_module("numba.core.ir")
        types: Any = import_module("numba.core.types")
        function = import_module("numba.core.types.functions").BaseFunction
        listed, asked = ir.Inst._rec_list_vars, function.get_call_type
        flags_now = config.ConfigStack.top_or_none
        variable, numbers, options = ir.Var, (types.Number, types.Boolean), config.TargetConfig
        if not callable(options.values) or not hasattr(options(), "_values"):
            return
    except (ImportError, AttributeError):
        return
    _link_without_machine_code()
    _optimize_what_there_is()
    options.values = _values
    ir.Inst._rec_list_vars = _quick_listing(listed, variable)
    function.get_call_type = _remembered_types(asked, numbers, flags_now)


def _link_without_machine_code() -> None:
    """A function that only kernels call goes into them as it is written: it is optimised there, once.

    numba optimises it alone, too, and makes machine code of it that nobody ever calls.
    """
    try:
        codegen: Any = import_module("numba.core.codegen")
        kind, maker = codegen.JITCodeLibrary, codegen.JITCPUCodegen
        asked, closed, told = kind.get_pointer_to_function, kind.add_linking_library, maker.set_env
        parts = "_ensure_finalized", "_finalize_dynamic_globals", "_get_module_for_linking"
        if not all(callable(getattr(kind, part)) for part in parts):
            return
    except (ImportError, AttributeError):
        return

    def get_pointer_to_function(self: Any, name: str) -> Any:
        """Nothing is compiled to find out that a function has no door for Python."""
        if not self._finalized and not any(one.name == name for one in self._final_module.functions):
            return 0
        return asked(self, name)

    def add_linking_library(self: Any, library: Any) -> None:
        if not library._finalized:
            _close(library)
        closed(self, library)

    def set_env(self: Any, name: str, env: Any) -> None:
        """What a function raises is told where there is machine code of it."""
        if self._engine.is_symbol_defined(name):
            told(self, name, env)

    kind.get_pointer_to_function, kind.add_linking_library = get_pointer_to_function, add_linking_library
    maker.set_env = set_env


def _optimize_what_there_is() -> None:
    """Of seven functions that a module names six are only declared: for each of these, too, numba makes all passes."""
    try:
        codegen: Any = import_module("numba.core.codegen")
        kind, asked = codegen.JITCodeLibrary, codegen.JITCodeLibrary._optimize_functions
        if not callable(codegen.create_pass_builder):  # before that the passes want the module itself
            return
    except (ImportError, AttributeError):
        return
    kind._optimize_functions = lambda self, module: asked(self, _Defined(module))


class _Defined:
    """A module of LLVM's with the functions that it defines."""

    def __init__(self, module: Any) -> None:
        self._module = module

    @property
    def functions(self) -> list[Any]:
        """Those that have code."""
        return [one for one in self._module.functions if not one.is_declaration]

    def _lay_out(self, data_layout: str) -> None:
        self._module.data_layout = data_layout

    data_layout = property(None, _lay_out)


def _close(library: Any) -> None:
    """Nothing is added to a library any more; it can be linked."""
    for other in dict.fromkeys(library._linking_libraries):
        library._reload_init.update(other._reload_init)
        library._final_module.link_in(other._get_module_for_linking(), preserve=True)
    library._finalize_dynamic_globals()
    library._finalized = True
