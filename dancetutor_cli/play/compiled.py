"""Whether the solver's kernels are in numba's cache; found out without importing numba."""

from __future__ import annotations

from pathlib import Path

from dancetutor_cli.kernel_folder import kernel_folder
from dancetutor_cli.play.preset import Preset

_HERE = Path(__file__).parent


def is_compiled(preset: Preset) -> bool:
    """Whether a solve with this preset need not compile first; True where that cannot be known.

    There is an index `MODULE.KERNEL-LINE.pyXY.nbi` for each kernel, which counts for nothing when the module is newer.
    """
    written = kernel_folder()
    folders = {written.of_module(_HERE / "kernel.py"), _HERE / "__pycache__"}
    try:
        return written.kept and all(
            any(
                index.stat().st_mtime >= (_HERE / f"{module}.py").stat().st_mtime
                for folder in folders
                for index in folder.glob(pattern)
            )
            for module, pattern in (("kernel", "kernel.*.nbi"), ("explore", f"explore.explore_{preset.model}-*.nbi"))
        )
    except OSError:
        return True
