"""Imported once for all workers that make films by OpenGL without a graphics card: what takes them long to import.

With a card each worker imports for itself: what its driver loads might not survive that workers are forked.
"""

from __future__ import annotations

import gc
from contextlib import suppress

from dancetutor_cli.character import load_dancer
from dancetutor_cli.errors import UnavailableError
from dancetutor_cli.startup import collect_seldom
from dancetutor_cli.video import film as film
from dancetutor_cli.video.media import yuv as yuv
from dancetutor_cli.video.scene import dancer as dancer
from dancetutor_cli.video.scene.geometry import pack
from dancetutor_cli.video.scene.gl.compat import load_pyrender

collect_seldom()
with suppress(UnavailableError):  # who draws will say so
    load_pyrender()
pack(load_dancer())
gc.freeze()  # nobody looks through it for garbage, which would give each worker a copy
