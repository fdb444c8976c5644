"""How the dear kernels are compiled: without counting references to arrays, which they only look at.

numba counts a reference whenever an array goes into a function that is inlined, also inside of loops over pixels.
Without that, `shade.resolve` takes a quarter less time. Such a kernel can make no arrays of its own. A division by
nothing is no error in it: looking for that keeps loops from being done several rounds at once.
"""

from __future__ import annotations

from typing import Any, TypeVar

from dancetutor_cli.kernels import njit

F = TypeVar("F")
_njit: Any = njit  # what it says of its options has not all that are used here


def kernel(function: F) -> F:
    """A kept kernel, without reference counts where this version of numba can leave them out."""
    return _compiled(function)


def inner_kernel(function: F) -> F:
    """The same, one that only kernels call; see `kernels.inner_kernel`."""
    return _compiled(function, no_cpython_wrapper=True)


def _compiled(function: F, **options: bool) -> F:
    try:
        compiled: F = _njit(cache=True, error_model="numpy", _nrt=False, **options)(function)
    except (KeyError, TypeError):  # the option may go
        compiled = _njit(cache=True, error_model="numpy", **options)(function)
    return compiled
