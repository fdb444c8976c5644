"""Making one film of a chart; the result appears whole or not at all."""

from __future__ import annotations

import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Protocol

from dancetutor_cli.film.choices import RendererKind
from dancetutor_cli.film.media.encoder import Encoding
from dancetutor_cli.film.media.film_formats import PICTURES
from dancetutor_cli.film.work import segments
from dancetutor_cli.film.work.planning import PreparedFilm
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.ffmpeg import EncoderError
from dancetutor_cli.run.files import place_of
from dancetutor_cli.run.pool import Task, Workers, open_workers

# Making one film: workers draw segments, this process prepares the sound; the result appears whole or not at all.


class ProgressListener(Protocol):
    """A listener that is informed of the progress."""

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
    except EncoderError as error:
        raise FileError(output, str(error)) from error
    except OSError as error:
        if error.filename is None:  # from a write to an open file: it is ours
            raise FileError(output, f"cannot be written: {error.strerror or error}") from error
        raise
    finally:
        _remove(folder)


def _remove(folder: Path) -> None:
    """Remove a folder that a dying encoder may still be writing into."""
    for _ in range(20):
        shutil.rmtree(folder, ignore_errors=True)
        if not folder.exists():
            return
        time.sleep(0.1)


@contextmanager
def _workers(jobs: int, progress: ProgressListener, kind: RendererKind) -> Iterator[Workers]:
    common = segments.common_to_workers(kind) if jobs > 1 else ""
    workers = open_workers(jobs, lambda _key, frames: progress.advance(frames), common)
    if jobs > 1 and not common:
        workers.submit(Task(("warm-up", 0), segments.warm_up))
    try:
        yield workers
    finally:
        workers.close()


def make_film(
    prepare: Callable[[], PreparedFilm],
    encoding: Encoding,
    output: Path,
    jobs: int,
    progress: ProgressListener,
    renderer: RendererKind = "cpu",
) -> PreparedFilm:
    """Make a film and put it at `output` (for "png": a folder of pictures).

    Parameters
    ----------
    prepare : makes the plan; runs here while the workers start and get ready for `renderer`
    jobs : number of processes that draw; 1 draws in this one. The result is the same for any number.

    Raises
    ------
    DancetutorError whatever went wrong, in one line; nothing of the film is left then.
    """
    if encoding.target != PICTURES:
        output = place_of(output)
    with _workers(jobs, progress, renderer) as workers, work_folder(output) as folder:
        prepared = prepare()
        plan = prepared.plan
        plan_file = segments.write_plan(plan, folder / "plan.pickle")
        parts = segments.segments(plan.clock.frames, encoding, folder)
        progress.begin(plan.clock.frames, encoding.fps)
        for part in parts:
            workers.submit(Task(part.number, segments.render_segment, (plan_file, part, encoding)))
        sound = segments.write_sound(prepared, encoding, folder)
        for done in workers.results():
            if done.error is not None:
                raise done.error
        segments.finish(parts, encoding, sound, folder, output)
        segments.forget()
    return prepared
