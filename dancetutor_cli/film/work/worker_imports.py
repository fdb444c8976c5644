"""Imported once for all workers that make films: what they have in common is in memory before they are made.

These are modules, kept kernels and the dancer: two thirds of a worker's work before its first frame.
"""

from __future__ import annotations

import gc
from contextlib import suppress

from dancetutor_cli.film.work import planning as planning
from dancetutor_cli.film.work import segments
from dancetutor_cli.run.process import reduce_garbage_collection

reduce_garbage_collection()
with suppress(Exception):  # a film that needs what is missing will say so
    segments.warm_up(lambda units: None)
gc.freeze()  # the garbage collector does not look through it, which would give each worker a copy
