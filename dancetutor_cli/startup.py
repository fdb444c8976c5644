"""What a process of the program decides as it starts: when to look for garbage, and that numpy makes no threads.

Imports and kernels make many objects that stay to its end.
"""

from __future__ import annotations

import gc
import os

_SELDOM = 200_000  # new objects between two looks for garbage; Python's own 700 cost a tenth of a second of imports


def collect_seldom() -> None:
    """Look for garbage in cycles seldom."""
    gc.set_threshold(_SELDOM, 10, 10)


def without_threads() -> None:
    """numpy makes a thread for each core as it is imported, for products of large matrices, of which there are none.

    To be called before that; holds for worker processes, too. A user who has said another number gets it.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def keep_what_is_there() -> None:
    """What has been imported and made so far stays to the end: it is not looked through for garbage again."""
    if not gc.get_freeze_count():  # what is frozen is never freed in cycles, so that happens once
        gc.freeze()


def leave_garbage() -> None:
    """The process ends: no last look through every object that numba has made, which takes longer than a chart."""
    gc.freeze()
