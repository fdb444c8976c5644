"""The segments of a film: pieces of work that any process draws and encodes."""

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

from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.film.media.encoder import PICTURES, Encoding, encode_segment
from dancetutor_cli.film.work.records import digest_of
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.pool import Report, Task

if TYPE_CHECKING:
    from dancetutor_cli.film.choices import RendererKind
    from dancetutor_cli.film.film import Film
    from dancetutor_cli.film.picture import Frame
    from dancetutor_cli.film.plan import FilmPlan


SEGMENT_SECONDS = 4.0  # seconds of film; independent of the number of workers, so that the files are the same


@dataclass(frozen=True, slots=True)
class Segment:
    """A part of a film that one worker draws and encodes: frames first..last - 1 into `path`, a file or folder."""

    number: int
    first: int
    last: int
    path: Path


class PlanFile(NamedTuple):
    """A file with a film's plan for all workers, and the SHA-256 by which a worker recognises the plan."""

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
    """Write a film's plan to a new file, which all segments share."""
    data = pickle.dumps(plan, protocol=pickle.HIGHEST_PROTOCOL)
    with path.open("xb") as file:
        file.write(data)
    return PlanFile(path, hashlib.sha256(data).hexdigest())


@lru_cache(maxsize=1)
def film_of(plan: PlanFile) -> Film:
    """Load the film of a plan's file; it is kept while segments of one film follow each other.

    A pickle can run any code, so a pickle that this program has not written is never loaded.
    """
    from dancetutor_cli.film.film import Film

    data = plan.path.read_bytes()
    if hashlib.sha256(data).hexdigest() != plan.digest:
        raise FileError(plan.path, "was changed by another program while the film was made")
    return Film(pickle.loads(data))


def common_to_workers(kind: RendererKind) -> str:
    """Return the module that all drawing workers share; "" if kernels must be compiled first.

    In that case, one worker compiles the kernels with `warm_up`, and the others load the result.
    """
    from dancetutor_cli.film.scene import renderer
    from dancetutor_cli.film.scene.cpu.shade import resolve
    from dancetutor_cli.run.kernels.compiling import is_kept

    if renderer.resolve_renderer(kind) != "cpu":
        from dancetutor_cli.film.scene.gl.available import gpu_device

        return "dancetutor_cli.film.film" if gpu_device() is not None else "dancetutor_cli.film.work.worker_imports_gl"
    return "dancetutor_cli.film.work.worker_imports" if is_kept(resolve) else ""


def warm_up() -> None:
    """Do the work before the first frame of the "cpu" renderer, while the film is still being prepared.

    It imports the modules for drawing, and loads or compiles their kernels by drawing a tiny room.
    """
    from dancetutor_cli.film import film  # noqa: F401
    from dancetutor_cli.film.media import yuv  # noqa: F401
    from dancetutor_cli.film.scene import (
        dancer,  # noqa: F401
        renderer,
    )
    from dancetutor_cli.film.scene.scene import FrameState, Scene

    pad = load_pad("dance-single")
    if pad is None:
        return
    scene, size = Scene(load_dancer(), pad), (64, 36)
    nobody = np.zeros(scene.panels)
    state = FrameState(None, scene.camera("back", size), nobody, nobody.astype(np.int64))
    renderer.create(scene, size, "good", "cpu").frame(state)


def render_segment(report: Report, plan: PlanFile, segment: Segment, encoding: Encoding) -> str:
    """Draw and encode one segment; returns its SHA-256, "" for pictures. An incomplete file is never left."""

    film = film_of(plan)
    part = segment.path
    if encoding.target != PICTURES:
        part = segment.path.with_name(f".{segment.path.stem}.{uuid.uuid4().hex}{encoding.format.segment}")
    try:
        encode_segment(_report_frames(film.frames(segment.first, segment.last), report), encoding, part, segment.first)
        digest = ""
        if part != segment.path:
            digest = digest_of(part)
            part.replace(segment.path)
    except BaseException:  # a full disk, or the end of this worker
        _clear(part, segment)
        raise
    return digest


def _clear(part: Path, segment: Segment) -> None:
    """Remove the files of a segment that will not be finished."""
    pictures = [part / f"frame_{number:06d}.png" for number in range(segment.first, segment.last)]
    for file in pictures if part.is_dir() else [part]:
        with suppress(OSError):
            file.unlink(missing_ok=True)


def frames_of(task: Task) -> int:
    """Return the number of frames that a piece of work draws."""
    return sum(part.last - part.first for part in task.arguments if isinstance(part, Segment))


def _report_frames(frames: Iterator[Frame], report: Callable[[int], None]) -> Iterator[Frame]:
    """Pass frames on, and report their number every few frames."""
    waiting = 0
    for frame in frames:
        yield frame
        waiting += 1
        if waiting == 4:
            report(waiting)
            waiting = 0
    report(waiting)
