"""The common imports of all workers that make films, in memory before the workers start.

They are modules, cached kernels and the dancer: two thirds of a worker's work before its first frame.
"""

from __future__ import annotations

import gc
from contextlib import suppress

from dancetutor_cli.dance import bake as bake
from dancetutor_cli.film.work import planning as planning
from dancetutor_cli.film.work import segments
from dancetutor_cli.run.process import reduce_garbage_collection

reduce_garbage_collection()
with suppress(Exception):  # a film that needs a missing part reports it
    segments.warm_up()
gc.freeze()  # keeps these objects from the garbage collector, which would give each worker a copy
