"""Start numba without scipy: an import of this module before the first kernel saves a command a third of a second.

On its first kernel numba imports `scipy.linalg` only to see whether there is BLAS for `np.cov` and `np.corrcoef`,
which no kernel here uses. With the import refused for that moment, everything else stays as it is: matrix products
ask again.
"""

from __future__ import annotations

import sys
from importlib import import_module

if "scipy.linalg" not in sys.modules and "numba.np.arraymath" not in sys.modules:
    sys.modules["scipy.linalg"] = None  # type: ignore[assignment]  # the import system reads it as "there is none"
    try:
        import_module("numba.np.arraymath")
    finally:
        del sys.modules["scipy.linalg"]
