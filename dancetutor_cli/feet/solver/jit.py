"""How the solver's kernels run: compiled, or as the Python that they are, where compiling would take longer than work.

`compiled.interpret` decides it, before this module is imported. It is the same code, so the plays are the same.
Compiled ones are called by `run.kernels.native`, so that what is kept runs without numba.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

from dancetutor_cli.feet.solver.compiled import is_interpreted
from dancetutor_cli.run.kernels import native

INTERPRETED = is_interpreted() or os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0")


def inner_kernel(function: Any = None, **options: Any) -> Any:
    """A kernel that kernels call. Python may, too: for it the function stays what it is."""
    if function is None:
        return lambda later: native.inner_kernel(later, **options)
    return native.inner_kernel(function, **options)


def kernel(function: Any, results: int = 0) -> Callable[..., Any]:
    """A kernel that Python calls. results : how many whole numbers it gives"""
    return function if INTERPRETED else native.Kernel(function, results)
