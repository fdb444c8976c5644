"""From folders to the films of a batch: which charts, in which order, under which names."""

from __future__ import annotations

import re
import string
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from dancetutor_cli.errors import DancetutorError, NoChartsError, UsageError
from dancetutor_cli.jobs.film_request import FilmRequest
from dancetutor_cli.jobs.film_work import FilmJob
from dancetutor_cli.library.selection import Selection
from dancetutor_cli.video.media.encoder import Encoding
from dancetutor_cli.video.media.film_formats import PICTURES

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song

DEFAULT_NAME = "{folder}-{steps_type}-{difficulty}"
FIELDS = ("title", "artist", "folder", "pack", "file", "steps_type", "difficulty", "meter", "index")


@dataclass(frozen=True, slots=True)
class BatchRequest:
    """What a batch shall make. request : the film wanted of each chart (its path and selection are replaced)

    name : template of the films' names; meters : least and greatest meter or None; shard : (number from 1, of how many)
    """

    paths: tuple[Path, ...]
    request: FilmRequest
    encoding: Encoding
    folder: Path
    name: str = DEFAULT_NAME
    meters: tuple[int, int] | None = None
    shard: tuple[int, int] = (1, 1)
    longest: float | None = None


@dataclass(frozen=True, slots=True)
class UnreadableFile:
    """A chart file that cannot be read."""

    path: Path
    error: str


class FilmList(NamedTuple):
    """The films of a batch, the files that could not be read, and those that have no chart that is wanted."""

    films: list[FilmJob]
    unreadable: list[UnreadableFile]
    without: list[Path]


def parse_meters(text: str) -> tuple[int, int]:
    """ "8", "8-12", "8-" or "-12"; UsageError for anything else."""
    match = re.fullmatch(r"\s*(\d*)\s*(-?)\s*(\d*)\s*", text)
    if not match or not (match[1] or match[3]):
        raise UsageError(f"meter '{text}': write a number as 9, or a range as 8-12")
    low = int(match[1] or 0)
    high = int(match[3]) if match[3] else (10**9 if match[2] else low)
    if high < low:
        raise UsageError(f"meter '{text}': the range runs backwards")
    return low, high


def parse_shard(text: str) -> tuple[int, int]:
    """ "2/5" to (2, 5); UsageError for anything else."""
    match = re.fullmatch(r"\s*(\d{1,6})\s*/\s*(\d{1,6})\s*", text)
    if not match or not 1 <= int(match[1]) <= int(match[2]):
        raise UsageError(f"shard '{text}': write it as 2/5, the second of five parts")
    return int(match[1]), int(match[2])


def check_name(template: str) -> None:
    """UsageError if a template names a field that does not exist, or could lead out of the folder."""
    try:
        fields = [name for _, name, _, _ in string.Formatter().parse(template) if name is not None]
    except ValueError as error:
        raise UsageError(f"name '{template}': {error}") from error
    if unknown := [name for name in fields if name not in FIELDS]:
        raise UsageError(f"name '{template}': unknown {{{unknown[0]}}}; there are: {', '.join(FIELDS)}")
    if "/" in template or "\\" in template:
        raise UsageError(f"name '{template}': the films of a batch lie in one folder; leave slashes out")


def film_list(batch: BatchRequest) -> FilmList:
    """The films of the batch (of this shard), sorted by path. Of what is no film only the first shard tells."""
    check_name(batch.name)
    jobs: list[FilmJob] = []
    bad: list[UnreadableFile] = []
    without: list[Path] = []
    taken: set[str] = set()
    for path in chart_files(batch.paths):
        try:
            from dancetutor_cli import chart as charts

            song = charts.load(path)
        except NoChartsError:  # the music of a menu: nobody meant it to be danced
            without.append(path)
            continue
        except (DancetutorError, OSError) as error:
            bad.append(UnreadableFile(path, str(error)))
            continue
        found = [_job(batch, song, chart, taken) for chart in _charts(batch, song)]
        jobs += found
        without += [] if found else [path]
    number, count = batch.shard
    return FilmList(jobs[number - 1 :: count], *((bad, without) if number == 1 else ([], [])))


def chart_files(paths: Sequence[Path]) -> Iterator[Path]:
    """Chart files; of a song with both kinds the .ssc, as the games do."""
    from dancetutor_cli.library import find_files, twin

    for path in find_files(paths):
        if path.suffix.lower() == ".sm" and path not in paths and twin(path) is not None:
            continue
        yield path


def _charts(batch: BatchRequest, song: Song) -> Iterator[Chart]:
    low, high = batch.meters or (0, 10**9)
    for chart in batch.request.dance.selection.charts(song):
        if low <= chart.meter <= high and chart.columns and len(chart.notes):
            yield chart


def _job(batch: BatchRequest, song: Song, chart: Chart, taken: set[str]) -> FilmJob:
    suffix = "" if batch.encoding.target == PICTURES else f".{batch.encoding.target}"
    stem = file_name(batch.name, song, chart)
    name, number = stem, 2
    while name.lower() in taken:  # two charts of one name; file systems may not tell upper from lower case
        name, number = f"{stem}-{number}", number + 1
    taken.add(name.lower())
    dance = replace(batch.request.dance, path=song.path, selection=Selection(index=chart.index))
    request = replace(batch.request, dance=dance)
    return FilmJob(request, chart.label, batch.folder / f"{name}{suffix}", batch.encoding, batch.longest)


def file_name(template: str, song: Song, chart: Chart) -> str:
    """A template filled in, in characters that every file system takes."""
    folder = song.path.resolve().parent
    values = {
        "title": song.title or song.path.stem,
        "artist": song.artist,
        "folder": folder.name,
        "pack": folder.parent.name,
        "file": song.path.stem,
        "steps_type": chart.steps_type,
        "difficulty": chart.difficulty,
        "meter": chart.meter,
        "index": chart.index,
    }
    return plain_name(template.format(**values)) or "film"


def plain_name(text: str) -> str:
    """Lower case, with "_" for whatever a file system might refuse."""
    plain = re.sub(r"[^\w.-]+", "_", text.lower()).strip("._")
    return plain[:120]
