"""The slow common imports of all workers that make films by OpenGL without a graphics card.

With a card, each worker has its own imports, because the driver's libraries might not survive a fork.
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
with suppress(UnavailableError):  # the worker that draws reports it
    load_pyrender()
pack(load_dancer())
gc.freeze()  # keeps these objects from the garbage collector, which would give each worker a copy
