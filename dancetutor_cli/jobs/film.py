"""The pieces of work of `render`: prepare a film, draw and encode one segment of it, join the segments."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.jobs.pool import Report, Task
from dancetutor_cli.video.encoder import Encoding

if TYPE_CHECKING:
    from dancetutor_cli.video.blit import Frame
    from dancetutor_cli.video.film import Film, FilmPlan

SEGMENT_SECONDS = 4.0  # of film; the same whatever the number of workers, so that the files are the same too


@dataclass(frozen=True, slots=True)
class Segment:
    """A stretch of a film that one worker draws and encodes: frames first..last - 1 into `path`, a file or folder."""

    number: int
    first: int
    last: int
    path: Path


def segments(frames: int, encoding: Encoding, folder: Path) -> list[Segment]:
    """Cut a film of `frames` frames into segments, whose files lie in `folder`."""
    step = max(1, round(SEGMENT_SECONDS * encoding.fps))
    out = []
    for number, first in enumerate(range(0, frames, step)):
        name = "frames" if encoding.target == "png" else f"segment_{number:05d}{encoding.suffix}"
        out.append(Segment(number, first, min(first + step, frames), folder / name))
    return out


def write_plan(plan: FilmPlan, path: Path) -> None:
    """Put a film's plan where every worker can read it; once, and not once for each segment."""
    path.write_bytes(pickle.dumps(plan, protocol=pickle.HIGHEST_PROTOCOL))


@lru_cache(maxsize=1)
def _film(path: Path) -> Film:
    """The film of a plan's file; kept while segments of one film follow each other."""
    from dancetutor_cli.video.film import Film

    plan = pickle.loads(path.read_bytes())
    return Film(plan)


def forget() -> None:
    """Let go of the film that this process has drawn."""
    _film.cache_clear()


def warm_up(report: Report) -> None:
    """Import in a fresh worker what drawing needs, while the film is still being prepared."""
    import dancetutor_cli.video.dancer
    import dancetutor_cli.video.film  # noqa: F401


def render_segment(report: Report, plan: Path, segment: Segment, encoding: Encoding) -> int:
    """Draw and encode one segment; returns its number. The segment's file appears whole or not at all."""
    from dancetutor_cli.video.encoder import encode_segment

    film = _film(plan)
    part = segment.path
    if encoding.target != "png":
        part = segment.path.with_name(f".{segment.path.name}.part{encoding.suffix}")
    encode_segment(_counted(film.frames(segment.first, segment.last), report), encoding, part, segment.first)
    if part != segment.path:
        part.replace(segment.path)
    return segment.number


def _counted(frames: Iterator[Frame], report: Callable[[int], None]) -> Iterator[Frame]:
    """Pass frames on, and tell every few of them."""
    waiting = 0
    for frame in frames:
        yield frame
        waiting += 1
        if waiting == 4:
            report(waiting)
            waiting = 0
    report(waiting)


def tasks(plan: Path, parts: list[Segment], encoding: Encoding) -> Iterator[Task]:
    """The work list of a film."""
    for segment in parts:
        yield Task(segment.number, render_segment, (plan, segment, encoding))
