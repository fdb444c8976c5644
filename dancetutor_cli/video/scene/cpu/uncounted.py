"""How the dear kernels are compiled: without counting references to arrays, which they only look at.

numba counts a reference whenever an array goes into a function that is inlined, also inside of loops over pixels.
Without that, `shade.resolve` takes a quarter less time. Such a kernel can make no arrays of its own.
"""

from __future__ import annotations

from typing import Any, TypeVar

from dancetutor_cli.kernels import njit

F = TypeVar("F")
_njit: Any = njit  # what it says of its options has not the one of its own that is used here


def kernel(function: F) -> F:
    """A kept kernel, without reference counts where this version of numba can leave them out."""
    try:
        compiled: F = _njit(cache=True, _nrt=False)(function)
    except (KeyError, TypeError):  # the option may go
        compiled = _njit(cache=True)(function)
    return compiled
