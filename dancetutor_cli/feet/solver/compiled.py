"""The choice whether the solver's kernels run compiled or as Python, made without importing numba.

Compiling takes ten to twenty seconds, once. The same code as Python solves one or two charts sooner than that. So
compiling is worth the wait only for more charts, in this run or in later ones.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any

from dancetutor_cli.feet.preset import Preset
from dancetutor_cli.run.kernels import native
from dancetutor_cli.run.kernels.stored_code import StoredCode, kernel_folder
from dancetutor_cli.run.trust import read_file, use_folder, write_file

VARIABLE = "DANCETUTOR_KERNELS"  # "python" or "compiled"; worker processes inherit it
_HERE = Path(__file__).parent
_TINY = 12_000  # bytes of note data that Python solves immediately, so that nothing is compiled
_SMALL = 120_000  # bytes of note data that Python solves in less than half of the time that compiling takes
_OFTEN = 1_000_000  # bytes that Python has solved in all runs, after which compiling saves time


def is_compiled(preset: Preset) -> bool:
    """Whether a solve with this preset does not have to compile first; True if this cannot be known."""
    return StoredCode(_HERE / "solvers.py", f"solve_{preset.model}").is_there()


def is_interpreted() -> bool:
    """Whether this process runs kernels as Python, by the decision of `interpret`."""
    return os.environ.get(VARIABLE) == "python"


def interpret(presets: Iterable[Preset], size: Callable[[], int]) -> bool:
    """Decide whether this process and its workers run kernels as Python; call this before a kernel is imported.

    size : returns the bytes of note data to solve; called only if not all presets are compiled yet
    """
    if VARIABLE in os.environ:
        return is_interpreted()
    if all(is_compiled(preset) for preset in presets) or (much := size()) > _SMALL:
        return False
    if much <= _TINY:
        os.environ[VARIABLE] = "python"
        return True
    note = kernel_folder().of_module(_HERE / "solvers.py") / "interpreted"
    try:
        before = int(read_file(note))
    except (OSError, ValueError):
        before = 0
    if kernel_folder().is_writable and before > _OFTEN:
        return False
    with suppress(OSError):
        if not use_folder(note.parent):
            write_file(note, str(before + much).encode())
    os.environ[VARIABLE] = "python"
    return True


# Kernels are made when their modules are imported, so `interpret` must be called before. `run.kernels.native` calls the
# compiled kernels, so that stored ones run without numba.


def runs_as_python() -> bool:
    """Whether kernels are plain Python functions: by the decision of `interpret`, or because numba's compiler is
    switched off.
    """
    return is_interpreted() or os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0")


inner_kernel = native.native_inner  # the decorator of the solver's kernels that other kernels call


def kernel(function: Any, results: int = 0) -> Callable[..., Any]:
    """Make a kernel that Python calls. results : number of integers that it returns"""
    return function if runs_as_python() else native.Kernel(function, results)
