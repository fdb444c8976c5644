"""Where the program's own data is: `configs/` and `charts/`, in a checkout or inside an installed wheel."""

from __future__ import annotations

from functools import cache, lru_cache
from pathlib import Path

from dancetutor_cli.errors import UnavailableError

PACKAGE = Path(__file__).resolve().parent


@cache
def _root(name: str) -> Path:
    for candidate in (PACKAGE / "_data" / name, PACKAGE.parent / name):
        if candidate.is_dir():
            return candidate
    raise UnavailableError(f"the installation is incomplete: folder '{name}' is missing; install dancetutor again")


@lru_cache(maxsize=256)
def config_path(name: str) -> Path:
    """Path of a file or folder in `configs/`, for example ``config_path("presets/thesis.yaml")``."""
    return _root("configs") / name


def charts_path() -> Path:
    """The folder of the demo songs."""
    return _root("charts")
