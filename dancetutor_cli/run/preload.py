"""The module that the fork server of worker processes imports; it imports the module that `run.worker_processes` names.

Exceptions of that import are ignored, because here they would end the server with a traceback. The task that needs the
module reports them in one line.
"""

from __future__ import annotations

import os
from contextlib import suppress
from importlib import import_module

from dancetutor_cli.run.worker_processes import SHARED

if common := os.environ.get(SHARED):
    with suppress(Exception):
        import_module(common)
