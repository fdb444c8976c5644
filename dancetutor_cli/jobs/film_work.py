"""The pieces of work of whole films: open one, close it, and what becomes of it; `film_segments` is between them."""

from __future__ import annotations

import json
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dancetutor_cli.bounded import read_json
from dancetutor_cli.errors import DancetutorError, FileError
from dancetutor_cli.files import encoded, place_of, write_atomic
from dancetutor_cli.jobs.film_request import FilmRequest, look_up
from dancetutor_cli.jobs.film_segments import Segment, segments, write_plan
from dancetutor_cli.jobs.pool import Report
from dancetutor_cli.video.media.encoder import Encoding, join
from dancetutor_cli.video.media.film_formats import PICTURES

if TYPE_CHECKING:
    from dancetutor_cli.jobs.film_plan import Prepared

STATE = ".dancetutor"  # folder beside the films of a batch: what is done, and what is in work


@dataclass(frozen=True, slots=True)
class FilmJob:
    """A film of a batch. label : the chart's, for people; output : the file (for "png" the folder) it becomes."""

    request: FilmRequest
    label: str
    output: Path
    encoding: Encoding
    longest: float | None = None

    @property
    def record(self) -> Path:
        """The file that says what the finished film was made of."""
        return self.output.parent / STATE / f"{self.output.name}.json"


@dataclass(frozen=True, slots=True)
class Opened:
    """A film ready to be drawn. missing : segments that no earlier run has finished; skipped : the film is done."""

    key: str
    folder: Path
    plan: Path
    parts: tuple[Segment, ...]
    missing: tuple[Segment, ...]
    sound: Path | None
    frames: int
    warnings: tuple[str, ...]
    skipped: bool = False


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
        if opened is not None and not any(part.path.is_file() for part in opened.parts):
            shutil.rmtree(opened.folder, ignore_errors=True)  # nothing in it is worth going on with
        return FilmOutcome(job, "failed", str(error), () if opened is None else opened.warnings, 0, seconds)
    assert opened is not None
    status = "skipped" if opened.skipped else "done"
    return FilmOutcome(job, status, None, opened.warnings, opened.frames, seconds)


def open_film(report: Report, job: FilmJob) -> Opened:
    """Everything before the first frame. What an earlier run has left of the same film is used."""
    from dancetutor_cli.jobs.film_key import film_key

    subject = look_up(job.request)
    frames = subject.clock.frames
    if job.longest is not None and max(subject.clock.seconds, subject.written) > job.longest:
        raise FileError(job.request.path, f"{job.label}: too long for a batch; render it alone, or say --yes")
    key = film_key(job.request, subject, job.encoding)
    folder = job.output.parent / STATE / f"{job.output.name}.{key[:12]}"
    plan = folder / "plan.pickle"
    if _recorded(job) == key:
        return Opened(key, folder, plan, (), (), None, frames, subject.warnings, skipped=True)
    from dancetutor_cli.jobs.film_plan import prepare

    for old in folder.parent.glob(f"{_escaped(job.output.name)}.????????????"):
        if old != folder:
            shutil.rmtree(old, ignore_errors=True)
    prepared = prepare(job.request, subject)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        write_plan(prepared.plan, plan)
        sound = write_sound(prepared, job.encoding, folder)
    except OSError as error:
        if not any(folder.glob("segment_*")):  # of an earlier run: they are worth something
            shutil.rmtree(folder, ignore_errors=True)
        raise FileError(job.output, f"cannot be written: {error.strerror or error}") from error
    parts = tuple(segments(frames, job.encoding, folder))
    missing = tuple(part for part in parts if job.encoding.target == PICTURES or not part.path.exists())
    return Opened(key, folder, plan, parts, missing, sound, frames, (*subject.warnings, *prepared.warnings))


def _escaped(name: str) -> str:
    return "".join(f"[{c}]" if c in "[]*?" else c for c in name)


def _recorded(job: FilmJob) -> str | None:
    """The key of the finished film that is there, if any."""
    try:
        record = read_json(job.record)
    except FileError:
        return None
    there = job.output.exists() and isinstance(record, dict)
    return record.get("key") if there and record.get("size") == _size(job.output) else None


def _size(output: Path) -> int:
    return sum(1 for _ in output.iterdir()) if output.is_dir() else output.stat().st_size


def close_film(report: Report, job: FilmJob, opened: Opened) -> None:
    """Join the segments, put the film in its place, and note what it was made of."""
    finish(list(opened.parts), job.encoding, opened.sound, opened.folder, job.output)
    record = {"schema": 1, "key": opened.key, "size": _size(job.output), "chart": job.label, "frames": opened.frames}
    write_atomic(job.record, encoded(json.dumps(record, ensure_ascii=False, indent=1) + "\n"))
    shutil.rmtree(opened.folder, ignore_errors=True)


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
