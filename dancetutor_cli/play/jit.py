"""How the solver's kernels run: compiled, or as the Python that they are, where compiling would take longer than work.

`compiled.interpret` decides it, before this module is imported. It is the same code, so the plays are the same.
Compiled ones are called by `kernel_door`, so that what is kept runs without numba.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

from dancetutor_cli.kernel_door import Door, inner
from dancetutor_cli.play.compiled import is_interpreted, source_stamp

INTERPRETED = is_interpreted() or os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0")


def uncounted(function: Any = None, **options: Any) -> Any:
    """A kernel that kernels call. Python may, too: for it the function stays what it is."""
    return inner(function, **options) if function else lambda later: inner(later, **options)


def door(function: Any) -> Callable[..., Any]:
    """A kernel that Python calls."""
    return function if INTERPRETED else Door(function, source_stamp)
