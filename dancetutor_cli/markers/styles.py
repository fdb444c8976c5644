"""The styles of markers, by the names that users type.

A style is a module of this package that is called like it, with two functions:

    IN_NOTES    write(song, feet of a chart, force) and strip(song, chart, force) -> NoteChange
    IN_FILES      write(song, folder, feet of all charts) and strip(song, charts) -> the FileChange of each file

A new style is its module and its name in one of these lists.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, cast

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.markers.model import ChartFeet, FileChange, NoteChange
    from dancetutor_cli.run.errors import FileError

IN_NOTES = ("measure", "rows")
IN_FILES = ("sidecar", "smeditor", "edit", "theme")
STYLES = (*IN_NOTES, *IN_FILES)
STRIPPED = (*STYLES, "background")  # and a film that `render --background --into-file` has entered
OF_EACH_FILE = ("sidecar",)  # of a .sm and a .ssc only the .ssc speaks for the song in the other files
OF_UCS = {"measure": "feet_text", "rows": "feet_text", "sidecar": "sidecar"}  # nothing is written into a .ucs


class NoteStyle(Protocol):
    """A style that lives in comments of the note data."""

    def write(self, song: Song, feet: ChartFeet, force: bool) -> NoteChange:
        """Put the feet of a chart in. force : over what people have pinned, too."""

    def strip(self, song: Song, chart: Chart, force: bool) -> NoteChange:
        """Take the feet of a chart out."""


class FileStyle(Protocol):
    """A style that writes files beside a chart file."""

    def write(self, song: Song, folder: Path, feet: Sequence[ChartFeet]) -> Iterator[FileChange | FileError]:
        """The files of a song. folder : where they go; what is merged lies there or by the song.

        Yields an error in place of a file that there cannot be; the others come nevertheless.
        """

    def strip(self, song: Song, charts: Sequence[Chart]) -> Iterator[FileChange]:
        """What taking the feet of some charts out does to the files beside a song."""


def note_styles(names: Sequence[str]) -> list[NoteStyle]:
    """The styles among `names` that live in the note data."""
    return [cast(NoteStyle, import_module(f"{__package__}.{name}")) for name in IN_NOTES if name in names]


def file_style(name: str) -> FileStyle:
    """A style that writes files, by the name of its module."""
    return cast(FileStyle, import_module(f"{__package__}.{name}"))
