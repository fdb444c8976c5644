"""How a process of the program deals with garbage: imports and kernels make many objects that stay to its end."""

from __future__ import annotations

import gc

_SELDOM = 200_000  # new objects between two looks for garbage; Python's own 700 cost a tenth of a second of imports


def collect_seldom() -> None:
    """Look for garbage in cycles seldom."""
    gc.set_threshold(_SELDOM, 10, 10)


def keep_what_is_there() -> None:
    """What has been imported and made so far stays to the end: it is not looked through for garbage again."""
    if not gc.get_freeze_count():  # what is frozen is never freed in cycles, so that happens once
        gc.freeze()


def leave_garbage() -> None:
    """The process ends: no last look through every object that numba has made, which takes longer than a chart."""
    gc.freeze()
