"""The pieces of work between a film's first and its last: draw and encode one of its segments."""

from __future__ import annotations

import hashlib
import pickle
import uuid
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from dancetutor_cli.errors import FileError
from dancetutor_cli.jobs.film_records import digest_of
from dancetutor_cli.run.pool import Report, Task
from dancetutor_cli.video.media.encoder import Encoding
from dancetutor_cli.video.media.film_formats import PICTURES

if TYPE_CHECKING:
    from dancetutor_cli.video.choices import RendererKind
    from dancetutor_cli.video.film import Film
    from dancetutor_cli.video.picture import Frame
    from dancetutor_cli.video.plan import FilmPlan

SEGMENT_SECONDS = 4.0  # of film; the same whatever the number of workers, so that the files are the same too


@dataclass(frozen=True, slots=True)
class Segment:
    """A stretch of a film that one worker draws and encodes: frames first..last - 1 into `path`, a file or folder."""

    number: int
    first: int
    last: int
    path: Path


class PlanFile(NamedTuple):
    """A film's plan where every worker can read it, and the SHA-256 by which a worker knows that it is that plan."""

    path: Path
    digest: str


def segments(frames: int, encoding: Encoding, folder: Path) -> list[Segment]:
    """Cut a film of `frames` frames into segments, whose files lie in `folder`."""
    step = max(1, round(SEGMENT_SECONDS * encoding.fps))
    out = []
    for number, first in enumerate(range(0, frames, step)):
        name = "frames" if encoding.target == PICTURES else f"segment_{number:05d}{encoding.format.segment}"
        out.append(Segment(number, first, min(first + step, frames), folder / name))
    return out


def write_plan(plan: FilmPlan, path: Path) -> PlanFile:
    """Put a film's plan into a new file; once, and not once for each segment."""
    data = pickle.dumps(plan, protocol=pickle.HIGHEST_PROTOCOL)
    with path.open("xb") as file:
        file.write(data)
    return PlanFile(path, hashlib.sha256(data).hexdigest())


@lru_cache(maxsize=1)
def _film(plan: PlanFile) -> Film:
    """The film of a plan's file; kept while segments of one film follow each other.

    A pickle can run anything, so one that this program has not written is never loaded.
    """
    from dancetutor_cli.video.film import Film

    data = plan.path.read_bytes()
    if hashlib.sha256(data).hexdigest() != plan.digest:
        raise FileError(plan.path, "was changed by somebody else while the film was made")
    return Film(pickle.loads(data))


def forget() -> None:
    """Let go of the film that this process has drawn."""
    _film.cache_clear()


def common_to_workers(kind: RendererKind) -> str:
    """The module of what workers that draw have in common; "" where kernels must be compiled first.

    One worker does that alone, by `warm_up`, and the others fetch what it has compiled.
    """
    from dancetutor_cli.run.kernels.compiling import is_kept
    from dancetutor_cli.video.scene import renderer
    from dancetutor_cli.video.scene.cpu.shade import resolve

    if renderer.chosen(kind) != "cpu":
        from dancetutor_cli.video.scene.gl.available import gpu_device

        return "dancetutor_cli.video.film" if gpu_device() is not None else "dancetutor_cli.jobs.film_common_gl"
    return "dancetutor_cli.jobs.film_common" if is_kept(resolve) else ""


def warm_up(report: Report) -> None:
    """Do what comes before any first frame of the "cpu" renderer, while the film is still being prepared.

    That is to import what drawing needs and to fetch its kernels, or compile them, by drawing a tiny room.
    """
    from dancetutor_cli.character import load_dancer
    from dancetutor_cli.pads import load_pad
    from dancetutor_cli.video import film  # noqa: F401
    from dancetutor_cli.video.media import yuv  # noqa: F401
    from dancetutor_cli.video.scene import dancer, renderer  # noqa: F401
    from dancetutor_cli.video.scene.scene import FrameState, Scene

    pad = load_pad("dance-single")
    if pad is None:
        return
    scene, size = Scene(load_dancer(), pad), (64, 36)
    nobody = np.zeros(scene.panels)
    state = FrameState(None, scene.camera("back", size), nobody, nobody.astype(np.int64))
    renderer.create(scene, size, "good", "cpu").frame(state)


def render_segment(report: Report, plan: PlanFile, segment: Segment, encoding: Encoding) -> str:
    """Draw and encode one segment; returns its SHA-256, "" for pictures. Its file appears whole or not at all."""
    from dancetutor_cli.video.media.encoder import encode_segment

    film = _film(plan)
    part = segment.path
    if encoding.target != PICTURES:
        part = segment.path.with_name(f".{segment.path.stem}.{uuid.uuid4().hex}{encoding.format.segment}")
    try:
        encode_segment(_counted(film.frames(segment.first, segment.last), report), encoding, part, segment.first)
        digest = ""
        if part != segment.path:
            digest = digest_of(part)
            part.replace(segment.path)
    except BaseException:  # a full disk, or the end of this worker
        _clear(part, segment)
        raise
    return digest


def _clear(part: Path, segment: Segment) -> None:
    """Remove what there is of a segment that will not be finished."""
    pictures = [part / f"frame_{number:06d}.png" for number in range(segment.first, segment.last)]
    for file in pictures if part.is_dir() else [part]:
        with suppress(OSError):
            file.unlink(missing_ok=True)


def frames_of(task: Task) -> int:
    """How many frames a piece of work draws."""
    return sum(part.last - part.first for part in task.arguments if isinstance(part, Segment))


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
