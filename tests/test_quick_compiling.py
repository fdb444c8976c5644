"""What stands in place of parts of numba says the same as they; each is asked in a process with numba as it comes."""

from __future__ import annotations

import subprocess
import sys

import pytest

BEFORE = """
import sys
from importlib import import_module
from numba.core import config, ir, targetconfig, types, typing
from numba.core.types.functions import BaseFunction
from numba.core.registry import cpu_target
"""
SAME_OPTIONS = """
from numba.core.compiler import Flags
one, other = Flags(), Flags()
one.error_model = other.error_model = "numpy"
one.nrt = True
before = [one.values(), other.values(), hash(other), one == other, one.copy() == one]
from dancetutor_cli import quick_compiling
quick_compiling.compile_quicker()
assert targetconfig.TargetConfig.values is quick_compiling._values
after = [one.values(), other.values(), hash(other), one == other, one.copy() == one]
assert before == after and list(before[0]) == list(after[0]), (before, after)
"""
SAME_NAMES = """
from numba.core.compiler import run_frontend

def much(a, b):
    total = 0
    for i in range(len(a)):
        x, y = a[i], (b[i], a[1:i])
        total += x if x > 0 else {1: x}[1]
    print(total, "text", b)
    return [total, y]

def named(code):
    return [[v.name for v in stmt.list_vars()] for block in code.blocks.values() for stmt in block.body]

code = run_frontend(much)
before, original = named(code), ir.Inst._rec_list_vars
from dancetutor_cli import quick_compiling
quick_compiling.compile_quicker()
assert ir.Inst._rec_list_vars is not original
assert named(code) == before and sum(map(len, before)) > 30
"""
SAME_TYPES = """
import operator, math
context = cpu_target.typing_context
context.refresh()
asked = [
    (function, args)
    for function in (operator.add, operator.truediv, operator.lt, operator.floordiv, min, abs, math.sqrt)
    for args in [
        (types.int64, types.float64), (types.float32, types.float32), (types.uint8, types.int64),
        (types.boolean, types.boolean), (types.literal(3), types.int64), (types.float64,), (types.int32,),
    ]
]

def all_types():
    found = []
    for function, args in asked:
        kind = context.resolve_value_type(function)
        try:
            sig = kind.get_call_type(context, args, {})
            found.append((sig, kind.get_impl_key(sig)))
        except Exception as error:
            found.append(type(error).__name__)
    return found

before = all_types()
from dancetutor_cli import quick_compiling
quick_compiling.compile_quicker()
assert BaseFunction.get_call_type.__module__ == "dancetutor_cli.quick_compiling"
assert all_types() == before and all_types() == before
assert 20 < sum(not isinstance(one, str) for one in before) < len(before)
"""
OTHER_NUMBA = """
del ir.Inst._rec_list_vars
before = BaseFunction.get_call_type, targetconfig.TargetConfig.values
from dancetutor_cli import quick_compiling
quick_compiling.compile_quicker()
assert before == (BaseFunction.get_call_type, targetconfig.TargetConfig.values)
"""
LINKED = """
import numpy as np
from dancetutor_cli.kernels import inner_kernel, njit

@inner_kernel
def deep(x):
    return x / 3

@inner_kernel
def below(x, least):
    if x > 90:
        raise ValueError("much")
    return max(deep(x) + 1, least)

@njit
def total(values):
    found = 0.0
    for value in values:
        found += below(value, 1.5)
    return found, values + values

values = np.arange(5.0)
found, twice = total(values)
assert found == sum(max(value / 3 + 1, 1.5) for value in values) and (twice == 2 * values).all()
try:
    total(np.array([99.0]))
    raise AssertionError("no exception")
except ValueError as error:
    assert str(error) == "much"
libraries = {one.__name__: next(iter(one.overloads.values())).library for one in (deep, below, total)}
made = [name for name, library in libraries.items() if library._compiled_object is not None]
assert made == ["total"], made
assert libraries["below"].get_pointer_to_function("nothing") == 0
"""


@pytest.mark.parametrize(
    "what",
    [SAME_OPTIONS, SAME_NAMES, SAME_TYPES, OTHER_NUMBA, LINKED],
    ids=["options", "names", "types", "other", "linked"],
)
def test_it_says_what_numba_says(what: str) -> None:
    ran = subprocess.run([sys.executable, "-c", BEFORE + what], capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
