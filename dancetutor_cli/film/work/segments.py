"""The pieces of work of a film: open it, draw and encode its segments, close it; what becomes of it."""

from __future__ import annotations

import hashlib
import pickle
import uuid
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.film.media.encoder import Encoding, encode_segment, join
from dancetutor_cli.film.media.film_formats import PICTURES
from dancetutor_cli.film.work.records import FilmRecord, digest_of, move_segment, new_work_name, remove_work
from dancetutor_cli.film.work.request import FilmRequest, film_key, look_up
from dancetutor_cli.run.errors import DancetutorError, FileError
from dancetutor_cli.run.files import place_of
from dancetutor_cli.run.pool import Report, Task

if TYPE_CHECKING:
    from dancetutor_cli.film.choices import RendererKind
    from dancetutor_cli.film.film import Film
    from dancetutor_cli.film.picture import Frame
    from dancetutor_cli.film.plan import FilmPlan
    from dancetutor_cli.film.work.planning import PreparedFilm


# The pieces of work between a film's first and its last: draw and encode one of its segments.

SEGMENT_SECONDS = 4.0  # seconds of film; the same for any number of workers, so that the files are the same too


@dataclass(frozen=True, slots=True)
class Segment:
    """A stretch of a film that one worker draws and encodes: frames first..last - 1 into `path`, a file or folder."""

    number: int
    first: int
    last: int
    path: Path


class PlanFile(NamedTuple):
    """A file with a film's plan that every worker can read, and the SHA-256 by which a worker recognises that plan."""

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
    from dancetutor_cli.film.film import Film

    data = plan.path.read_bytes()
    if hashlib.sha256(data).hexdigest() != plan.digest:
        raise FileError(plan.path, "was changed by another program while the film was made")
    return Film(pickle.loads(data))


def forget() -> None:
    """Release the film that this process has drawn."""
    _film.cache_clear()


def common_to_workers(kind: RendererKind) -> str:
    """The module that drawing workers have in common; "" if kernels must be compiled first.

    Then one worker compiles alone, by `warm_up`, and the others fetch the result.
    """
    from dancetutor_cli.film.scene import renderer
    from dancetutor_cli.film.scene.cpu.shade import resolve
    from dancetutor_cli.run.kernels.compiling import is_kept

    if renderer.resolve_renderer(kind) != "cpu":
        from dancetutor_cli.film.scene.gl.available import gpu_device

        return "dancetutor_cli.film.film" if gpu_device() is not None else "dancetutor_cli.film.work.worker_imports_gl"
    return "dancetutor_cli.film.work.worker_imports" if is_kept(resolve) else ""


def warm_up(report: Report) -> None:
    """Do the work before the first frame of the "cpu" renderer, while the film is still being prepared.

    It imports what drawing needs and fetches or compiles its kernels, by drawing a tiny room.
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
    """Draw and encode one segment; returns its SHA-256, "" for pictures. Its file appears whole or not at all."""

    film = _film(plan)
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
    """Remove what there is of a segment that will not be finished."""
    pictures = [part / f"frame_{number:06d}.png" for number in range(segment.first, segment.last)]
    for file in pictures if part.is_dir() else [part]:
        with suppress(OSError):
            file.unlink(missing_ok=True)


def frames_of(task: Task) -> int:
    """How many frames a piece of work draws."""
    return sum(part.last - part.first for part in task.arguments if isinstance(part, Segment))


def _report_frames(frames: Iterator[Frame], report: Callable[[int], None]) -> Iterator[Frame]:
    """Pass frames on, and report every few of them."""
    waiting = 0
    for frame in frames:
        yield frame
        waiting += 1
        if waiting == 4:
            report(waiting)
            waiting = 0
    report(waiting)


# The pieces of work of whole films: open one, close it, and what becomes of it; `render_segment` draws it in between.


@dataclass(frozen=True, slots=True)
class FilmJob:
    """A film of a batch. label : the chart's, for people; output : the file (for "png" the folder) it becomes."""

    request: FilmRequest
    label: str
    output: Path
    encoding: Encoding
    longest: float | None = None


@dataclass(frozen=True, slots=True)
class OpenedFilm:
    """A film ready to be drawn, in `folder`. finished : numbers of segments of an earlier run; skipped : it is done."""

    key: str
    folder: Path
    plan: PlanFile | None
    parts: tuple[Segment, ...]
    finished: tuple[int, ...]
    sound: Path | None
    frames: int
    warnings: tuple[str, ...]
    skipped: bool = False

    @property
    def missing(self) -> list[Segment]:
        """The segments that are to be drawn."""
        return [part for part in self.parts if part.number not in self.finished]


@dataclass(frozen=True, slots=True)
class FilmOutcome:
    """How a film job ended. status : "done", "skipped" or "failed"."""

    job: FilmJob
    status: str
    error: str | None
    warnings: tuple[str, ...]
    frames: int
    seconds: float

    def as_json(self) -> dict[str, Any]:
        """One line of the results."""
        return {
            "path": str(self.job.request.path),
            "chart": self.job.label,
            "index": self.job.request.dance.selection.index,
            "output": str(self.job.output),
            "status": self.status,
            "error": self.error,
            "warnings": list(self.warnings),
            "frames": self.frames,
            "seconds": round(self.seconds, 3),
        }


def outcome(job: FilmJob, opened: OpenedFilm | None, error: DancetutorError | None, seconds: float) -> FilmOutcome:
    """What became of a job."""
    if error is not None:
        return FilmOutcome(job, "failed", str(error), () if opened is None else opened.warnings, 0, seconds)
    assert opened is not None
    status = "skipped" if opened.skipped else "done"
    return FilmOutcome(job, status, None, opened.warnings, opened.frames, seconds)


def open_film(report: Report, job: FilmJob, earlier: FilmRecord, work: str) -> OpenedFilm:
    """Everything before the first frame. The results of an earlier run of the same film are used.

    earlier : what is kept of that run; work : name of the folder to make beside the output, for what is not finished
    """

    subject = look_up(job.request)
    frames = subject.clock.frames
    if job.longest is not None and max(subject.clock.seconds, subject.chart_seconds) > job.longest:
        raise FileError(job.request.path, f"{job.label}: too long for a batch; render it alone, or say --yes")
    key = film_key(job.request, subject, job.encoding)
    folder = job.output.parent / work
    if earlier.key == key and earlier.size is not None and earlier.size == size_of(job.output):
        return OpenedFilm(key, folder, None, (), (), None, frames, subject.warnings, skipped=True)
    from dancetutor_cli.film.work.planning import prepare

    prepared = prepare(job.request, subject)
    parts = tuple(segments(frames, job.encoding, folder))
    finished: tuple[int, ...] = ()
    try:
        left = [job.output.parent / name for name in earlier.folders if name != work]
        left += _new_folder(folder)
        if earlier.key == key and job.encoding.target != PICTURES:
            finished = tuple(
                part.number for part in parts if _take_over_segment(part, left, earlier.digests.get(part.number))
            )
        for old in left:
            remove_work(old)
        plan = write_plan(prepared.plan, folder / "plan.pickle")
        sound = write_sound(prepared, job.encoding, folder)
    except OSError as error:
        if not finished:  # segments of an earlier run can be used
            remove_work(folder)
        raise FileError(job.output, f"cannot be written: {error.strerror or error}") from error
    warnings = (*subject.warnings, *prepared.warnings)
    return OpenedFilm(key, folder, plan, parts, finished, sound, frames, warnings)


def _new_folder(folder: Path) -> list[Path]:
    """Make a folder that nobody else can write. One that is there is set aside and returned.

    There is one where a cluster begins this piece of work again, because its worker was lost.
    """
    try:
        folder.mkdir(mode=0o700)
        return []
    except FileExistsError:
        aside = folder.with_name(new_work_name())
        folder.rename(aside)
        folder.mkdir(mode=0o700)
        return [aside]


def _take_over_segment(part: Segment, folders: list[Path], digest: str | None) -> bool:
    """Whether a segment has been finished by an earlier run, in one of those folders; then it is in its place now."""
    return digest is not None and any(move_segment(old / part.path.name, part.path, digest) for old in folders)


def size_of(output: Path) -> int | None:
    """Bytes of a finished film, or how many pictures; None if there is none."""
    try:
        return sum(1 for _ in output.iterdir()) if output.is_dir() else output.stat().st_size
    except OSError:
        return None


def close_film(report: Report, job: FilmJob, opened: OpenedFilm, digests: dict[int, str]) -> int | None:
    """Join the segments, if they are as they were written, and put the film in its place; returns its size."""
    if job.encoding.target != PICTURES:
        for part in opened.parts:
            if digest_of(part.path) != digests[part.number]:
                raise FileError(part.path, "was changed by another program while the film was made; run it again")
    finish(list(opened.parts), job.encoding, opened.sound, opened.folder, job.output)
    remove_work(opened.folder)
    return size_of(job.output)


def write_sound(prepared: PreparedFilm, encoding: Encoding, folder: Path) -> Path | None:
    """The sound track as a WAV file in `folder`; None for a silent film."""
    from dancetutor_cli.film.media import sound

    if not encoding.format.has_sound or prepared.sound is None:
        return None
    path = folder / "sound.wav"
    sound.write_wav(sound.mix(prepared.sound, prepared.plan.clock), path)
    return path


def finish(parts: list[Segment], encoding: Encoding, sound: Path | None, folder: Path, output: Path) -> None:
    """Join the segments and put the result in its place."""
    if encoding.target == PICTURES:
        _place_pictures(parts[0].path, output)
        return
    output = place_of(output)  # a link stays one, and the film is where it leads
    film = folder / f"film.{encoding.target}"
    join([part.path for part in parts], encoding, sound, folder, film)
    try:
        film.replace(output)
    except OSError as error:
        raise FileError(output, f"cannot be written: {error.strerror}") from error


def _place_pictures(source: Path, target: Path) -> None:
    """Move all pictures into the target folder, then remove those of an earlier, longer film."""
    try:
        target.mkdir(exist_ok=True)
        names = set()
        for picture in sorted(source.iterdir()):
            picture.replace(target / picture.name)
            names.add(picture.name)
        for old in target.glob("frame_[0-9][0-9][0-9][0-9][0-9][0-9].png"):
            if old.name not in names:
                old.unlink()
    except OSError as error:
        raise FileError(target, f"cannot be written: {error.strerror}") from error
