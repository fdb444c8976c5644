"""Imported by the server that worker processes are forked off: what they share, as `run.worker_processes` names it.

Whatever that raises is left for the work that needs it, which says in one line what is wrong: here it would end the
server with a traceback.
"""

from __future__ import annotations

import os
from contextlib import suppress
from importlib import import_module

from dancetutor_cli.run.worker_processes import SHARED

if common := os.environ.get(SHARED):
    with suppress(Exception):
        import_module(common)
