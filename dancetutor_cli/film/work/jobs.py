"""The pieces of work of whole films: open a film, close it, report its outcome, write the files besides it."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from dancetutor_cli.chart.names import TICKS_PER_BEAT, TICKS_PER_MEASURE
from dancetutor_cli.film.clock import PictureClock
from dancetutor_cli.film.media.encoder import PICTURES, Encoding, join_segments
from dancetutor_cli.film.work.request import FilmRequest, film_key, look_up
from dancetutor_cli.film.work.segments import (
    FilmRecord,
    PlanFile,
    Segment,
    cut_segments,
    digest_of,
    load_film,
    move_segment,
    new_work_name,
    remove_work,
    write_plan,
)
from dancetutor_cli.run.errors import DancetutorError, FileError
from dancetutor_cli.run.files import encode_json, place_of, write_atomic
from dancetutor_cli.run.pictures import picture_bytes

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.film.clock import Clock
    from dancetutor_cli.film.film import Film
    from dancetutor_cli.film.media.sound import SoundPlan
    from dancetutor_cli.film.plan import FilmPlan
    from dancetutor_cli.film.work.request import FilmSubject


@dataclass(frozen=True, slots=True)
class FilmJob:
    """A film to make. label : the chart's label, for people; output : the film's file (for "png" its folder)

    longest : maximum seconds; a longer film is an error; poses : for "png", one picture for each row
    poster : the file of a title picture; srt : whether to write subtitles beside the film
    """

    request: FilmRequest
    label: str
    output: Path
    encoding: Encoding
    longest: float | None = None
    poses: bool = False
    poster: Path | None = None
    srt: bool = False


@dataclass(frozen=True, slots=True)
class OpenedFilm:
    """A film that is ready to be drawn in `folder`.

    finished : numbers of the segments that an earlier run has finished; skipped : whether the whole film is done
    sound : the sound for `sound_file` and its clock; None for a silent film
    """

    key: str
    folder: Path
    plan: PlanFile | None
    parts: tuple[Segment, ...]
    finished: tuple[int, ...]
    sound: tuple[SoundPlan, Clock] | None
    frames: int
    warnings: tuple[str, ...]
    skipped: bool = False

    @property
    def missing_segments(self) -> list[Segment]:
        """The segments that have to be drawn."""
        return [part for part in self.parts if part.number not in self.finished]

    @property
    def sound_file(self) -> Path:
        """The file of the sound track, a WAV file."""
        return self.folder / "sound.wav"


@dataclass(frozen=True, slots=True)
class FilmOutcome:
    """The outcome of a film job. status : "done", "skipped" or "failed"."""

    job: FilmJob
    status: str
    error: DancetutorError | None
    warnings: tuple[str, ...]
    frames: int
    seconds: float

    def as_json(self) -> dict[str, Any]:
        """Return one line of the results."""
        return {
            "path": str(self.job.request.path),
            "chart": self.job.label,
            "index": self.job.request.dance.selection.index,
            "output": str(self.job.output),
            "status": self.status,
            "error": None if self.error is None else str(self.error),
            "warnings": list(self.warnings),
            "frames": self.frames,
            "seconds": round(self.seconds, 3),
        }


def outcome_of(job: FilmJob, opened: OpenedFilm | None, error: DancetutorError | None, seconds: float) -> FilmOutcome:
    """Return the outcome of a job."""
    if error is not None:
        return FilmOutcome(job, "failed", error, () if opened is None else opened.warnings, 0, seconds)
    assert opened is not None
    status = "skipped" if opened.skipped else "done"
    return FilmOutcome(job, status, None, opened.warnings, opened.frames, seconds)


def open_film(job: FilmJob, earlier: FilmRecord, work: str) -> OpenedFilm:
    """Do all work before the first frame, with the results of an earlier run of the same film.

    earlier : the record of that run; work : name of the folder to make beside the output, for unfinished files
    """
    subject = look_up(job.request)
    frames = subject.clock.frames
    if job.longest is not None and max(subject.clock.seconds, subject.chart_seconds) > job.longest:
        raise FileError(job.request.path, f"{job.label}: too long for a batch; render it alone, or say --yes")
    key = film_key(job.request, subject, job.encoding)
    folder = job.output.parent / work
    if earlier.key == key and earlier.size is not None and earlier.size == size_of(job.output):
        return OpenedFilm(key, folder, None, (), (), None, frames, subject.warnings, skipped=True)
    finished: tuple[int, ...] = ()
    try:
        left = [job.output.parent / name for name in earlier.folders if name != work]
        left += _new_folder(folder)  # before the slow work, so that a full or read-only disk is found at once
        plan, sound, warnings = _prepared(job, subject)
        parts = tuple(cut_segments(plan.clock.frames, job.encoding, folder))
        if earlier.key == key and job.encoding.target != PICTURES:
            finished = tuple(
                part.number for part in parts if _take_over_segment(part, left, earlier.digests.get(part.number))
            )
        for old in left:
            remove_work(old)
        if job.poses:
            parts[0].path.mkdir()
            write_pose_index(parts[0].path, subject.song, subject.chart, plan)
        file = write_plan(plan, folder / "plan.pickle")
    except OSError as error:
        if not finished:  # a later run can use finished segments
            remove_work(folder)
        raise _not_written(job, error) from error
    return OpenedFilm(key, folder, file, parts, finished, sound, plan.clock.frames, (*subject.warnings, *warnings))


def _prepared(job: FilmJob, subject: FilmSubject) -> tuple[FilmPlan, tuple[SoundPlan, Clock] | None, tuple[str, ...]]:
    """Return the plan of a film, its sound, and warnings."""
    from dancetutor_cli.film.work.planning import prepare

    prepared = prepare(job.request, subject)
    plan = pose_plan(prepared.plan, job.label) if job.poses else prepared.plan
    sound = prepared.sound if job.encoding.format.has_sound else None
    return plan, None if sound is None else (sound, plan.clock), prepared.warnings


def _not_written(job: FilmJob, error: OSError) -> FileError:
    return FileError(job.output, f"cannot be written: {error.strerror or error}")


def _new_folder(folder: Path) -> list[Path]:
    """Make a folder that nobody else can write. An existing folder is set aside and returned.

    A folder exists if a cluster begins this piece of work again, because its worker was lost.
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
    """Move a segment that an earlier run has finished to its place; whether one of the folders has it."""
    return digest is not None and any(move_segment(old / part.path.name, part.path, digest) for old in folders)


def size_of(output: Path) -> int | None:
    """Return the bytes of a finished film, or the number of its pictures; None if there is no film."""
    try:
        return sum(1 for _ in output.iterdir()) if output.is_dir() else output.stat().st_size
    except OSError:
        return None


class ClosedFilm(NamedTuple):
    """A finished film. size : its `size_of`, None if the film is gone again"""

    size: int | None
    warnings: tuple[str, ...]


def close_film(job: FilmJob, opened: OpenedFilm, digests: dict[int, str]) -> ClosedFilm:
    """Join the segments, and write the film, poster and subtitles to their places.

    FileError if a segment has changed since it was written.
    """
    if job.encoding.target != PICTURES:
        for part in opened.parts:
            if digest_of(part.path) != digests[part.number]:
                raise FileError(part.path, "was changed by another program while the film was made; run it again")
    warnings = []
    try:
        finish_film(list(opened.parts), job.encoding, opened.sound and opened.sound_file, opened.folder, job.output)
        if job.poster is not None or job.srt:
            assert opened.plan is not None
            film = load_film(opened.plan)
            if job.poster is not None:
                write_poster(job.poster, film)
            if job.srt:
                warnings += write_subtitles(job.output.with_suffix(".srt"), film.plan)
    except OSError as error:
        if error.filename is not None:
            raise
        raise _not_written(job, error) from error
    remove_work(opened.folder)
    return ClosedFilm(size_of(job.output), tuple(warnings))


def write_sound(sound: SoundPlan, clock: Clock, path: Path) -> None:
    """Write the sound track as a WAV file."""
    from dancetutor_cli.film.media.sound import mix, write_wav

    write_wav(mix(sound, clock), path)


def finish_film(parts: list[Segment], encoding: Encoding, sound: Path | None, folder: Path, output: Path) -> None:
    """Join the segments and move the result to its place."""
    if encoding.target == PICTURES:
        _place_pictures(parts[0].path, output)
        return
    output = place_of(output)  # a link stays a link, and the film is written to its target
    film = folder / f"film.{encoding.target}"
    join_segments([part.path for part in parts], encoding, sound, folder, film)
    try:
        film.replace(output)
    except OSError as error:
        raise FileError(output, f"cannot be written: {error.strerror}") from error


def _place_pictures(source: Path, target: Path) -> None:
    """Move all pictures into the target folder, then remove the pictures of an earlier, longer film."""
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


# The files besides a film: a picture for each row, a poster, subtitles.

INDEX = "poses.json"


def pose_plan(plan: FilmPlan, label: str) -> FilmPlan:
    """Return a plan with one frame for each row with a step, which an editor can show while its user scrolls."""
    start, end = plan.clock.passes[0].start, plan.clock.passes[0].end
    rows = plan.rows
    times = () if rows is None else tuple(float(t) for t in rows.second if start <= t <= end)
    if not times:
        raise DancetutorError(f"{label}: there is no step here, so there is no pose to draw")
    clock = PictureClock(plan.clock.passes[:1], plan.clock.fps, times)
    beats = np.interp(times, plan.lines.second, plan.lines.beat) if len(plan.lines.second) else np.zeros(len(times))
    return replace(plan, clock=clock, beats=beats)


def write_pose_index(folder: Path, song: Song, chart: Chart, plan: FilmPlan) -> None:
    """Write the index of pictures and rows: an object with one entry for each picture."""
    assert isinstance(plan.clock, PictureClock)
    notes = chart.notes
    seconds = chart.timing.seconds(notes.tick)
    entries = []
    for number, time in enumerate(plan.clock.times):
        note = int(np.argmin(np.abs(seconds - time)))
        tick = int(notes.tick[note])
        entries.append(
            {
                "picture": f"frame_{number:06d}.png",
                "beat": tick / TICKS_PER_BEAT,
                "measure": tick // TICKS_PER_MEASURE,
                "second": round(time, 6),
                "line": int(notes.line[note]),
            }
        )
    data = {"schema": 1, "path": song.path.name, "chart": chart.label, "poses": entries}
    write_atomic(folder / INDEX, encode_json(json.dumps(data, ensure_ascii=False, indent=1) + "\n"))


def write_poster(path: Path, film: Film) -> None:
    """Write a picture for a title page: the first called-out move, or a note a third into the film."""
    plan = film.plan
    one = plan.clock.passes[-1]
    first = max(one.start, one.sound_from) + 1.0
    calls = [call.second for call in plan.callouts if first <= call.second <= one.end]
    steps = plan.presses.start
    aim = one.start + (one.end - one.start) / 3
    moment = calls[0] if calls else float(steps[np.argmin(np.abs(steps - aim))]) if len(steps) else aim
    before = sum(other.seconds for other in plan.clock.passes[:-1])
    number = round((before + one.film_seconds(moment)) * plan.clock.fps + 0.5)
    write_atomic(path, picture_bytes(film.frame(min(number, plan.clock.frames - 1))))


def write_subtitles(path: Path, plan: FilmPlan) -> list[str]:
    """Write subtitles that name the moves, beside the film; without moves, write no file and return a warning."""
    from dancetutor_cli.film.media.subtitles import subtitle_style, subtitles

    text = subtitles(plan.cues, plan.clock, subtitle_style())
    if not text:
        path.unlink(missing_ok=True)  # the subtitles of an earlier film would be wrong
        return [
            f"no move of this film has a name, so there is no {path.name}; configs/subtitles.yaml says what is named"
        ]
    write_atomic(path, text.encode())
    return []
