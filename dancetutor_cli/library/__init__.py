"""What a path means: folders and packs, pairs of .sm and .ssc, selection of charts, the song's music.

Names are looked up when they are used, so that finding files imports neither the reader of charts nor numpy.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dancetutor_cli.library.chart_files import find_files, one_song, twin, without_links_out
    from dancetutor_cli.library.music import music_file
    from dancetutor_cli.library.selection import select, select_one

__all__ = ["find_files", "music_file", "one_song", "select", "select_one", "twin", "without_links_out"]
_MODULES = {
    "chart_files": ("find_files", "one_song", "twin", "without_links_out"),
    "music": ("music_file",),
    "selection": ("select", "select_one"),
}


def __getattr__(name: str) -> Any:
    for module, names in _MODULES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{module}"), name)
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
