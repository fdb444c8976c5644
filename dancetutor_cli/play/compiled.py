"""Whether the solver's kernels are in numba's cache; found out without importing numba."""

from __future__ import annotations

import os
from pathlib import Path

from dancetutor_cli.play.preset import Preset

_HERE = Path(__file__).parent


def is_compiled(preset: Preset) -> bool:
    """Whether a solve with this preset need not compile first; True where that cannot be known.

    numba keeps an index `MODULE.KERNEL-LINE.pyXY.nbi` for each kernel, beside the module or below NUMBA_CACHE_DIR, and
    starts anew when the module is newer.
    """
    given = os.environ.get("NUMBA_CACHE_DIR")
    folder = Path(given) if given else _HERE / "__pycache__"
    if not given and not os.access(_HERE, os.W_OK):
        return True  # numba looks for a place of its own
    try:
        return all(
            any(index.stat().st_mtime >= (_HERE / f"{module}.py").stat().st_mtime for index in folder.rglob(pattern))
            for module, pattern in (("kernel", "kernel.*.nbi"), ("explore", f"explore.explore_{preset.model}-*.nbi"))
        )
    except OSError:
        return True
