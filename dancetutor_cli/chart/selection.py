"""The chart files that a path stands for (files, folders, pairs of .sm and .ssc), their songs, the selected charts."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from dancetutor_cli.run.errors import DancetutorError, NoChartsError, UsageError, choose_text
from dancetutor_cli.run.files import CHART_SUFFIXES, SONG_SUFFIXES

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song

_RESOURCE_FORK = "._"  # prefix of files that macOS writes on foreign disks; the games skip them too


def find_files(paths: Sequence[Path], exclude: Sequence[str] = ()) -> list[Path]:
    """Return the chart files that paths stand for, none twice: a file itself, or all below a folder, sorted.

    exclude : patterns of files to leave out of folders, see `is_excluded`

    Symbolic links to folders are not followed. A path that does not exist stays in the list, and so does a folder that
    cannot be read or has no charts. `reader.load` then reports the problem, and the other files are still processed.
    """
    found: dict[str, Path] = {}
    for path in paths:
        for file in _below(path, exclude) if os.path.isdir(path) else (path,):  # noqa: PTH112 (Path.is_dir may raise)
            found.setdefault(os.path.normcase(os.path.abspath(file)), file)  # noqa: PTH100 (links stay links)
    return list(found.values())


def _below(folder: Path, exclude: Sequence[str]) -> Iterable[Path]:
    closed: list[Path] = []
    files: list[Path] = []
    for root, folders, names in os.walk(folder, onerror=lambda error: closed.append(Path(error.filename or folder))):
        folders.sort()
        files.extend(Path(root) / name for name in sorted(names) if is_chart_name(name))
    if exclude:
        files = [file for file in files if not is_excluded(file.relative_to(folder).as_posix(), exclude)]
    return [*files, *sorted(closed)] or [folder]


def is_excluded(name: str, exclude: Sequence[str]) -> bool:
    """Whether a pattern of `--exclude` matches a path below the searched folder.

    A pattern (*, ?, [...]; case is ignored) matches the path, one of its parent folders, or a name at any depth:
    "Old", "*.sm", "Pack/Old songs/*".
    """
    if not exclude:
        return False
    from fnmatch import fnmatchcase

    names = name.lower().split("/")
    names_and_paths = {*names, *("/".join(names[:end]) for end in range(1, len(names) + 1))}
    return any(fnmatchcase(one, pattern.lower().rstrip("/")) for pattern in exclude for one in names_and_paths)


def split_links_out(paths: Sequence[Path], files: Sequence[Path]) -> tuple[list[Path], list[Path]]:
    """Split the result of `find_files` into files to write, and links that lead out of the searched folders.

    A folder of songs may come from a stranger, and a link in it may lead to any file of the user. A link that the user
    has named is a file to write.
    """
    named = {os.path.abspath(path) for path in paths}  # noqa: PTH100 (links stay links)
    folders = [path.resolve() for path in paths if os.path.isdir(path)]  # noqa: PTH112 (Path.is_dir may raise)
    out = {
        file
        for file in files
        if file.is_symlink() and os.path.abspath(file) not in named and _is_outside(file, folders)  # noqa: PTH100
    }
    return [file for file in files if file not in out], sorted(out)


def _is_outside(link: Path, folders: Sequence[Path]) -> bool:
    """Whether a link leads to a file outside all folders; a broken link or a link to a device is another error."""
    try:
        target = link.resolve(strict=True)
    except (OSError, RuntimeError):
        return False
    return target.is_file() and not any(target.is_relative_to(folder) for folder in folders)


def is_chart_name(name: str) -> bool:
    """Whether a file of this name in a song's folder is a chart file."""
    return name.lower().endswith(CHART_SUFFIXES) and not name.startswith(_RESOURCE_FORK)


# A song may have a .sm and a .ssc of the same name. Games load the .ssc, and so a run that needs one file does.


def is_preferred(path: Path) -> bool:
    """Whether games load a file with this name although there may be one of the other kind: whether it is a .ssc."""
    return path.suffix.lower() == ".ssc"


def has_preferred_twin(path: Path) -> bool:
    """Whether games load another file in place of this one: the .ssc beside a .sm."""
    return not is_preferred(path) and twin(path) is not None


def twin_names(path: Path) -> tuple[Path, ...]:
    """Return the names that the .sm beside a .ssc may have, or the .ssc beside a .sm; none for another file."""
    if path.suffix.lower() not in SONG_SUFFIXES:
        return ()
    other = ".sm" if is_preferred(path) else ".ssc"
    return path.with_suffix(other), path.with_suffix(other.upper())


def twin(path: Path) -> Path | None:
    """Return the .ssc beside a .sm of the same name, or the .sm beside a .ssc; None if there is none."""
    for candidate in twin_names(path):
        if os.path.isfile(candidate):  # noqa: PTH113 (Path.is_file may raise)
            return candidate
    return None


def one_song(path: Path) -> Path:
    """Return the chart file of a folder with one song, its .ssc or else its .sm; return any other path unchanged."""
    if not os.path.isdir(path):  # noqa: PTH112 (Path.is_dir may raise)
        return path
    found = find_files([path])
    songs = [file for file in found if file != path and not has_preferred_twin(file)]
    return songs[0] if len(songs) == 1 else path


_LARGEST_READ = 200_000  # bytes; a larger file is not read only for a measure of its work


@dataclass(frozen=True, slots=True)
class Selection:
    """The selected charts: values as the user typed them, with commas between several; None stands for all.

    player : in charts for several players, the number of the selected player, from 1
    """

    steps_type: str | None = None
    difficulty: str | None = None
    index: int | None = None
    player: int | None = None

    @property
    def is_all(self) -> bool:
        """Whether every chart is selected."""
        return self == Selection()

    @property
    def options(self) -> str:
        """The options that the user typed, for messages: "--difficulty hard, --index 9"."""
        typed = {name: getattr(self, name) for name in ("steps_type", "difficulty", "index", "player")}
        return ", ".join(f"--{name.replace('_', '-')} {value}" for name, value in typed.items() if value is not None)

    def charts(self, song: Song) -> tuple[Chart, ...]:
        """Return the selected charts of `song`, in file order; may be empty.

        Names may be in any case, and old names are known ("Heavy", "Oni"). Raises `UsageError` for an unknown
        difficulty.
        """
        from dancetutor_cli.chart import names

        types = {names.steps_type(text) for text in _split_at_commas(self.steps_type)}
        levels = {_difficulty(text) for text in _split_at_commas(self.difficulty)}
        return tuple(
            chart
            for chart in song.charts
            if (not types or chart.steps_type in types)
            and (not levels or chart.difficulty in levels)
            and self.index in (None, chart.index)
        )

    def only_chart(self, song: Song) -> Chart:
        """Return the only selected chart of `song`. Raises `UsageError` with a list of charts if none or several match.

        For a chart for several players, return the part of the selected player, or of the first player.
        """
        charts = self.charts(song)
        if not charts:
            raise UsageError(f"{song.path}: no such chart; choose one with --index N: {_listed(song.charts)}")
        if len(charts) > 1:
            raise UsageError(f"{song.path}: several charts match; choose one with --index N: {_listed(charts)}")
        chart = charts[0]
        players = self.player_parts(chart)
        if not players:
            raise UsageError(
                f"{song.path}: {chart.label} has no notes for --player {self.player}; choose 1 to {len(chart.players)}"
            )
        if self.player is not None and self.player > 1 and not chart.players:
            raise UsageError(f"{song.path}: {chart.label} is for one player; leave --player out")
        return players[0]

    def player_parts(self, chart: Chart) -> tuple[Chart, ...]:
        """Return the charts to find feet for: the chart itself or, for several players, the selected players' parts."""
        from dancetutor_cli.chart.players import player_charts

        return player_charts(chart, self.player)


def note_bytes(path: Path, selection: Selection, data: bytes | None = None) -> int:
    """Return the size of the selected note data in a chart file, bytes, as a measure of the work; 0 if unreadable.

    data : bytes to read in place of the file

    For all charts, and for a large file, which is not read only for this, return the size of the file.
    """
    from dancetutor_cli.chart import reader

    try:
        size = path.stat().st_size if data is None else len(data)
        if selection.is_all or size > _LARGEST_READ:
            return size
        song = reader.load(path) if data is None else reader.parse(data, path)
        return sum(end - start for start, end in (one.notes_span for one in selection.charts(song)))
    except (OSError, DancetutorError):
        return 0


def _split_at_commas(text: str | None) -> list[str]:
    return [part.strip() for part in text.split(",")] if text else []


def _difficulty(text: str) -> str:
    from dancetutor_cli.chart import names

    name, known = names.difficulty(text, "", 0, old=True)
    if not known:
        raise UsageError(f"there is no difficulty '{text}'{choose_text(text, names.DIFFICULTIES)}")
    return name


def _listed(charts: Iterable[Chart]) -> str:
    return ", ".join(f"{chart.index}: {chart.label}" for chart in charts)


# The songs below folders, for runs that make something of every chart: films and pages.


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
        from dancetutor_cli.chart.reader import load  # needs numpy, which `--help` does without

        for path in find_files(self.paths, self.exclude):
            if path not in self.paths and has_preferred_twin(path):
                continue
            try:
                song = load(path)
            except NoChartsError:  # the music of a menu, which is not for dancing
                self.without.append(path)
            except (DancetutorError, OSError) as error:
                self.unreadable.append(UnreadableFile(path, str(error)))
            else:
                yield song
