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
    options.values = _values
    ir.Inst._rec_list_vars = _quick_listing(listed, variable)
    function.get_call_type = _remembered_types(asked, numbers, flags_now)
