"""Let numba do without scipy: that saves a command a third of a second.

Before its first kernel numba imports `scipy.linalg` only to see whether there is BLAS for `np.cov` and `np.corrcoef`,
which no kernel here uses. With the import refused for that moment, everything else stays as it is: matrix products
ask again. Kernels that are only fetched may need none of it.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module

_ASKS = "numba.np.arraymath"  # the module that looks for BLAS, once


@contextmanager
def without_scipy() -> Iterator[None]:
    """In here numba finds no `scipy.linalg`, if it has not looked for it yet."""
    if "scipy.linalg" in sys.modules or _ASKS in sys.modules:
        yield
        return
    sys.modules["scipy.linalg"] = None  # type: ignore[assignment]  # the import system reads it as "there is none"
    try:
        yield
    finally:
        del sys.modules["scipy.linalg"]


@contextmanager
def without_current_folder() -> Iterator[None]:
    """In here numba is imported, and reads no `.numba_config.yaml` in the current folder, then or later.

    A stranger's file there would choose the processor that is compiled for. Where there is no YAML numba does without.
    """
    warnings.filterwarnings("ignore", message="A Numba config file is found")
    yaml = sys.modules.get("yaml")
    sys.modules["yaml"] = None  # type: ignore[assignment]  # the import system reads it as "there is none"
    try:
        yield
    finally:
        del sys.modules["yaml"]
        if yaml is not None:
            sys.modules["yaml"] = yaml


def look_for_blas() -> None:
    """Let numba look for it now, in vain, as before anything is compiled."""
    with without_scipy():
        import_module(_ASKS)
