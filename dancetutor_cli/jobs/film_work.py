"""The pieces of work of whole films: open one, close it, and what becomes of it; `film_segments` is between them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dancetutor_cli.errors import DancetutorError, FileError
from dancetutor_cli.files import place_of
from dancetutor_cli.jobs.film_records import FilmRecord, digest_of, move_segment, new_work_name, remove_work
from dancetutor_cli.jobs.film_request import FilmRequest, look_up
from dancetutor_cli.jobs.film_segments import PlanFile, Segment, segments, write_plan
from dancetutor_cli.run.pool import Report
from dancetutor_cli.video.media.encoder import Encoding, join
from dancetutor_cli.video.media.film_formats import PICTURES

if TYPE_CHECKING:
    from dancetutor_cli.jobs.film_plan import Prepared


@dataclass(frozen=True, slots=True)
class FilmJob:
    """A film of a batch. label : the chart's, for people; output : the file (for "png" the folder) it becomes."""

    request: FilmRequest
    label: str
    output: Path
    encoding: Encoding
    longest: float | None = None


@dataclass(frozen=True, slots=True)
class Opened:
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


def outcome(job: FilmJob, opened: Opened | None, error: DancetutorError | None, seconds: float) -> FilmOutcome:
    """What became of a job."""
    if error is not None:
        return FilmOutcome(job, "failed", str(error), () if opened is None else opened.warnings, 0, seconds)
    assert opened is not None
    status = "skipped" if opened.skipped else "done"
    return FilmOutcome(job, status, None, opened.warnings, opened.frames, seconds)


def open_film(report: Report, job: FilmJob, earlier: FilmRecord, work: str) -> Opened:
    """Everything before the first frame. What an earlier run has left of the same film is used.

    earlier : what is kept of that run; work : name of the folder to make beside the output, for what is not finished
    """
    from dancetutor_cli.jobs.film_key import film_key

    subject = look_up(job.request)
    frames = subject.clock.frames
    if job.longest is not None and max(subject.clock.seconds, subject.written) > job.longest:
        raise FileError(job.request.path, f"{job.label}: too long for a batch; render it alone, or say --yes")
    key = film_key(job.request, subject, job.encoding)
    folder = job.output.parent / work
    if earlier.key == key and earlier.size is not None and earlier.size == size_of(job.output):
        return Opened(key, folder, None, (), (), None, frames, subject.warnings, skipped=True)
    from dancetutor_cli.jobs.film_plan import prepare

    prepared = prepare(job.request, subject)
    parts = tuple(segments(frames, job.encoding, folder))
    finished: tuple[int, ...] = ()
    try:
        left = [job.output.parent / name for name in earlier.folders if name != work]
        left += _new_folder(folder)
        if earlier.key == key and job.encoding.target != PICTURES:
            finished = tuple(part.number for part in parts if _moved(part, left, earlier.digests.get(part.number)))
        for old in left:
            remove_work(old)
        plan = write_plan(prepared.plan, folder / "plan.pickle")
        sound = write_sound(prepared, job.encoding, folder)
    except OSError as error:
        if not finished:  # those of an earlier run are worth something
            remove_work(folder)
        raise FileError(job.output, f"cannot be written: {error.strerror or error}") from error
    warnings = (*subject.warnings, *prepared.warnings)
    return Opened(key, folder, plan, parts, finished, sound, frames, warnings)


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


def _moved(part: Segment, folders: list[Path], digest: str | None) -> bool:
    """Whether a segment has been finished by an earlier run, in one of those folders; then it is in its place now."""
    return digest is not None and any(move_segment(old / part.path.name, part.path, digest) for old in folders)


def size_of(output: Path) -> int | None:
    """Bytes of a finished film, or how many pictures; None if there is none."""
    try:
        return sum(1 for _ in output.iterdir()) if output.is_dir() else output.stat().st_size
    except OSError:
        return None


def close_film(report: Report, job: FilmJob, opened: Opened, digests: dict[int, str]) -> int | None:
    """Join the segments, if they are as they were written, and put the film in its place; returns its size."""
    if job.encoding.target != PICTURES:
        for part in opened.parts:
            if digest_of(part.path) != digests[part.number]:
                raise FileError(part.path, "was changed by somebody else while the film was made; run it again")
    finish(list(opened.parts), job.encoding, opened.sound, opened.folder, job.output)
    remove_work(opened.folder)
    return size_of(job.output)


def write_sound(prepared: Prepared, encoding: Encoding, folder: Path) -> Path | None:
    """The sound track as a WAV file in `folder`; None for a silent film."""
    from dancetutor_cli.video.media import sound

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
