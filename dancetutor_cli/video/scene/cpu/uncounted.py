"""How the dear kernels are compiled: without counting references to arrays (`compiling.uncounted`).

`shade.resolve` takes a quarter less time so. A division by nothing is no error in them: looking for that keeps
loops from being done several rounds at once.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from dancetutor_cli.run.kernels.compiling import uncounted

F = TypeVar("F", bound=Callable[..., Any])


def kernel(function: F) -> F:
    """A kept kernel, without reference counts where this version of numba can leave them out."""
    made: F = uncounted(function, cache=True, error_model="numpy")
    return made


def inner_kernel(function: F) -> F:
    """The same, one that only kernels call; see `compiling.inner_kernel`."""
    made: F = uncounted(function, error_model="numpy", no_cpython_wrapper=True)
    return made
