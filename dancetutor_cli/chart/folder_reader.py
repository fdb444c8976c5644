"""The songs below folders, for runs that make something of every chart: films and pages."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from dancetutor_cli.chart.reader import load
from dancetutor_cli.chart.selection import find_files, twin
from dancetutor_cli.run.errors import DancetutorError, NoChartsError

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Song


class UnreadableFile(NamedTuple):
    """A chart file that cannot be read."""

    path: Path
    error: str


@dataclass
class FolderReader:
    """The songs that paths stand for. exclude : patterns of files that are left out, as for `find_files`

    While the songs are read, `unreadable` gets the files that cannot be read, and `without` those without charts.
    """

    paths: Sequence[Path]
    exclude: Sequence[str] = ()
    unreadable: list[UnreadableFile] = field(default_factory=list)
    without: list[Path] = field(default_factory=list)

    def songs(self) -> Iterator[Song]:
        """Yield each song, sorted by path; for a song with a .sm and a .ssc the .ssc, as in the games."""
        for path in find_files(self.paths, self.exclude):
            if path.suffix.lower() == ".sm" and path not in self.paths and twin(path) is not None:
                continue
            try:
                song = load(path)
            except NoChartsError:  # the music of a menu, which is not for dancing
                self.without.append(path)
            except (DancetutorError, OSError) as error:
                self.unreadable.append(UnreadableFile(path, str(error)))
            else:
                yield song
