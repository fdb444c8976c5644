"""How the solver's kernels run: compiled, or as the Python that they are, where compiling would take longer than work.

`compiled.interpret` decides it, before this module is imported. It is the same code, so the plays are the same.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from dancetutor_cli.play.compiled import is_interpreted

INTERPRETED = is_interpreted()


def _as_it_is(function: Callable[..., Any] | None = None, **options: Any) -> Any:
    """A kernel that is not compiled."""
    return (lambda later: later) if function is None else function


if TYPE_CHECKING:
    from numba import njit as njit

    uncounted = njit
elif INTERPRETED:
    njit = uncounted = _as_it_is
else:
    from dancetutor_cli.kernels import njit as njit
    from dancetutor_cli.kernels import uncounted as uncounted
