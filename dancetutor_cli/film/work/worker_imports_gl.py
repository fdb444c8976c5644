"""Imported once for all workers that make films by OpenGL without a graphics card: their slow imports.

With a card, each worker imports for itself, because what its driver loads might not survive a fork.
"""

from __future__ import annotations

import gc
from contextlib import suppress

from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.film import film as film
from dancetutor_cli.film.media import yuv as yuv
from dancetutor_cli.film.scene import dancer as dancer
from dancetutor_cli.film.scene.geometry import pack
from dancetutor_cli.film.scene.gl.available import load_pyrender
from dancetutor_cli.run.errors import UnavailableError
from dancetutor_cli.run.process import reduce_garbage_collection

reduce_garbage_collection()
with suppress(UnavailableError):  # who draws will say so
    load_pyrender()
pack(load_dancer())
gc.freeze()  # the garbage collector does not look through it, which would give each worker a copy
