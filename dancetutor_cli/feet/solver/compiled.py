"""How the solver's kernels run: compiled, or as the Python that they are; found out without importing numba.

Compiling takes ten to twenty seconds, once. The kernels' own Python, which is the same code, solves a chart or two
sooner. So compiling is worth the wait only for more work, now or in runs like this one.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any

from dancetutor_cli.feet.preset import Preset
from dancetutor_cli.run.kernels import native
from dancetutor_cli.run.kernels.store import StoredCode, kernel_folder
from dancetutor_cli.run.trust import read_file, use_folder, write_file

VARIABLE = "DANCETUTOR_KERNELS"  # "python" or "compiled"; what it says holds for worker processes, too
_HERE = Path(__file__).parent
_TINY = 12_000  # bytes of chart files that Python solves at once: nothing is ever compiled for these
_SMALL = 120_000  # bytes of chart files that Python solves in less than half the time that compiling takes
_OFTEN = 1_000_000  # bytes that Python has solved in all, after which compiling would have paid


def is_compiled(preset: Preset) -> bool:
    """Whether a solve with this preset need not compile first; True where that cannot be known."""
    return StoredCode(_HERE / "solvers.py", f"solve_{preset.model}").is_there()


def is_interpreted() -> bool:
    """Whether this process runs kernels as Python, as `interpret` has decided."""
    return os.environ.get(VARIABLE) == "python"


def interpret(presets: Iterable[Preset], size: Callable[[], int]) -> bool:
    """Decide whether this process and its workers run kernels as Python; to be asked before one is imported.

    size : gives the bytes of the note data to be solved; only asked for where nothing is compiled yet
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


# The kernels themselves, which are made as their modules are imported: after `interpret` has been asked. Compiled ones
# are called by `run.kernels.native`, so that what is kept runs without numba.


def runs_as_python() -> bool:
    """Whether kernels are the functions that they are made of; so they are where numba's compiler is switched off."""
    return is_interpreted() or os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0")


def inner_kernel(function: Any = None, **options: Any) -> Any:
    """A kernel that kernels call. Python may, too: for it the function stays what it is."""
    if function is None:
        return lambda later: native.inner_kernel(later, **options)
    return native.inner_kernel(function, **options)


def kernel(function: Any, results: int = 0) -> Callable[..., Any]:
    """A kernel that Python calls. results : how many whole numbers it gives"""
    return function if runs_as_python() else native.Kernel(function, results)
