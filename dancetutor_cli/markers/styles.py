"""The styles of markers, by the names that users type.

A style is a module of this package with the name of the style and two functions:

    IN_NOTES    write(song, feet of a chart, force) and strip(song, chart, force) -> NoteChange
    IN_FILES      write(song, folder, feet of all charts) and strip(song, charts) -> the FileChange of each file

A new style needs a module, and its name in one of these lists.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, cast

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.markers.model import ChartFeet, FileChange, NoteChange

IN_NOTES = ("measure", "rows")
IN_FILES = ("sidecar", "smeditor", "edit", "theme")
STYLES = (*IN_NOTES, *IN_FILES)
STRIPPED = (*STYLES, "background")  # the entry of a film by `render --background --into-file`
OF_EACH_FILE = ("sidecar",)  # if there are a .sm and a .ssc, the other styles use only the .ssc
OF_UCS = {"measure": "feet_text", "rows": "feet_text", "sidecar": "sidecar"}  # nothing is written into a .ucs


class NoteStyle(Protocol):
    """A style in comments of the note data."""

    def write(self, song: Song, feet: ChartFeet, force: bool) -> NoteChange:
        """Write the feet of a chart. force : whether to overwrite pinned measures"""

    def strip(self, song: Song, chart: Chart, force: bool) -> NoteChange:
        """Remove the feet of a chart."""


class FileStyle(Protocol):
    """A style that writes files beside a chart file."""

    def write(self, song: Song, folder: Path, feet: Sequence[ChartFeet]) -> Iterator[FileChange]:
        """Yield the changed files of a song. folder : their place; old content is read there, or beside the song

        FileError if the song can have none of them; a single file that is not possible has an `error`.
        """

    def strip(self, song: Song, charts: Sequence[Chart]) -> Iterator[FileChange]:
        """Yield the changes that remove the feet of some charts from the files beside a song."""


def note_styles(names: Sequence[str]) -> list[NoteStyle]:
    """Return the styles among `names` that are in note data."""
    return [cast(NoteStyle, import_module(f"{__package__}.{name}")) for name in IN_NOTES if name in names]


def file_style(name: str) -> FileStyle:
    """Return a style that writes files, by the name of its module."""
    return cast(FileStyle, import_module(f"{__package__}.{name}"))
