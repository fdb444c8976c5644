"""Bytes of a chart file -> Song and Chart; what a path means: packs, pairs of .sm and .ssc, selection, the music.

    reader.load                   the way in; a file is read in four steps
      |   msd                       its tags, with the place of each value
      |   timing_tags, timing       when a beat is
      |   grid, cells, note_data    measures and rows; what stands in their cells; notes
      |   ucs                       a UCS file of Pump, which has none of these
    model.Song, model.Chart       what every other package works with

    selection, pack_files         which charts a path means; settings files that lie beside them
    music, audio                  which file is the song's music; its samples
    density, hash, names          streams and tempos; how leaderboards know a chart; words of the games
    edits                         the bytes of a file changed in places

Names are looked up when they are used, so that finding files, and what games call things, needs no numpy.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Kind, Song
    from dancetutor_cli.chart.music import music_file
    from dancetutor_cli.chart.reader import load, parse
    from dancetutor_cli.chart.selection import find_files, one_song, select, select_one, twin

__all__ = [
    "Chart", "Kind", "Song", "find_files", "load", "music_file", "one_song", "parse", "select", "select_one", "twin",
]  # fmt: skip
_MODULES = {
    "model": ("Chart", "Kind", "Song"),
    "music": ("music_file",),
    "reader": ("load", "parse"),
    "selection": ("find_files", "one_song", "select", "select_one", "twin"),
}


def __getattr__(name: str) -> Any:
    for module, names in _MODULES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{module}"), name)
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
