"""Making one film: workers draw segments, this process prepares the sound; the result appears whole or not at all."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Protocol

from dancetutor_cli.errors import FileError
from dancetutor_cli.jobs import film as work
from dancetutor_cli.jobs.film_plan import Prepared
from dancetutor_cli.jobs.pool import Task, Workers, open_workers
from dancetutor_cli.video.encoder import Encoding, join


class Progress(Protocol):
    """Who wants to know how far the work is."""

    def begin(self, frames: int, fps: int) -> None:
        """The film has that many frames."""

    def advance(self, frames: int) -> None:
        """That many more frames are drawn."""


@contextmanager
def work_folder(output: Path) -> Iterator[Path]:
    """A hidden folder beside the output for what is not finished; gone afterwards, whatever happens.

    Beside it, so that the last step is a rename, and so that a full or read-only disk is noticed at once.
    """
    try:
        folder = Path(tempfile.mkdtemp(prefix=f".{output.name}.", suffix=".part", dir=output.parent))
    except OSError as error:
        raise FileError(output, f"cannot be written: {error.strerror}") from error
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


@contextmanager
def _workers(jobs: int, progress: Progress) -> Iterator[Workers]:
    workers = open_workers(jobs, lambda _key, frames: progress.advance(frames))
    try:
        yield workers
    finally:
        workers.close()


def make_film(
    prepare: Callable[[], Prepared], encoding: Encoding, output: Path, jobs: int, progress: Progress
) -> Prepared:
    """Make a film and put it at `output` (for "png": a folder of pictures).

    Parameters
    ----------
    prepare : makes the plan; runs here while the workers start
    jobs : number of processes that draw; 1 draws in this one. The result is the same for any number.

    Raises
    ------
    DancetutorError whatever went wrong, in one line; nothing of the film is left then.
    """
    with _workers(jobs, progress) as workers, work_folder(output) as folder:
        if jobs > 1:
            for number in range(jobs):
                workers.submit(Task(("warm-up", number), work.warm_up))
        prepared = prepare()
        plan = prepared.plan
        plan_file = folder / "plan.pickle"
        work.write_plan(plan, plan_file)
        parts = work.segments(plan.clock.frames, encoding, folder)
        progress.begin(plan.clock.frames, encoding.fps)
        for task in work.tasks(plan_file, parts, encoding):
            workers.submit(task)
        sound = _sound(prepared, encoding, folder)
        for done in workers.done():
            if done.error is not None:
                raise done.error
        finish(parts, encoding, sound, folder, output)
        work.forget()
    return prepared


def _sound(prepared: Prepared, encoding: Encoding, folder: Path) -> Path | None:
    from dancetutor_cli.video import sound

    if encoding.target != "mp4" or prepared.sound is None:
        return None
    path = folder / "sound.wav"
    sound.write_wav(sound.mix(prepared.sound, prepared.plan.clock), path)
    return path


def finish(parts: list[work.Segment], encoding: Encoding, sound: Path | None, folder: Path, output: Path) -> None:
    """Join the segments and put the result in its place."""
    if encoding.target == "png":
        _place_pictures(parts[0].path, output)
        return
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
