"""Making one film, of a chart or of a motion without one; the result appears whole or not at all."""

from __future__ import annotations

import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.dance.motion import sample
from dancetutor_cli.dance.rig.body import joint_matrices
from dancetutor_cli.dance.smoothing import low_pass
from dancetutor_cli.film.choices import RendererKind
from dancetutor_cli.film.media.encoder import Encoding, encode_segment, join
from dancetutor_cli.film.media.film_formats import PICTURES
from dancetutor_cli.film.scene import renderer
from dancetutor_cli.film.scene.camera import Camera
from dancetutor_cli.film.scene.scene import PANEL, FrameState, Scene
from dancetutor_cli.film.work import segments
from dancetutor_cli.film.work.planning import PreparedFilm
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.ffmpeg import EncoderError
from dancetutor_cli.run.files import place_of
from dancetutor_cli.run.pool import Task, Workers, open_workers

if TYPE_CHECKING:
    from dancetutor_cli.character.mesh import Character
    from dancetutor_cli.dance.motion import Motion
    from dancetutor_cli.film.picture import Frame


# Making one film: workers draw segments, this process prepares the sound; the result appears whole or not at all.


class ProgressListener(Protocol):
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


# A film of a motion without a chart: the character on a bare floor, the camera goes along.

SIZE, FPS = (720, 720), 30
EYE = np.array([1.5, 0.45, 3.1])  # from what the camera looks at, metres
LOOK = 0.9  # height that it looks at, metres
FOCAL, ALONG = 1.35, 0.4  # focal length in picture heights; hertz below which the camera goes along
ROOM = 2.0  # panels of floor around her way


@dataclass(frozen=True, slots=True)
class _Floor:
    """A pad of tiles without arrows, as large as her way."""

    panels: NDArray[np.float64]
    arrows: NDArray[np.float64]
    centre: tuple[float, float]


def film(path: Path, character: Character, motion: Motion) -> int:
    """Write an .mp4 and return its frames; nothing is left if that fails. Raises FileError or UnavailableError."""
    count = max(1, int((motion.times[-1] - motion.times[0]) * FPS) + 1)
    encoding = Encoding("mp4", SIZE, FPS, "good")
    with work_folder(path) as folder:
        part, whole = folder / f"part{encoding.format.segment}", folder / "film.mp4"
        encode_segment(_frames(character, motion, count), encoding, part)
        join([part], encoding, None, folder, whole)
        whole.replace(path)
    return count


def _frames(character: Character, motion: Motion, count: int) -> Iterator[Frame]:
    times = motion.times[0] + np.arange(count) / FPS
    rotations, root = sample(motion, times)
    scene = Scene(character, _floor(root))
    draw = renderer.create(scene, SIZE, "good", "cpu")
    slow = low_pass(root, FPS, ALONG)
    nobody = np.zeros(scene.panels)
    joints = joint_matrices(character.skeleton, rotations, root)
    for k in range(count):
        x, z = float(slow[k, 0]), float(slow[k, 2])
        eye = (x + float(EYE[0]), LOOK + float(EYE[1]), z + float(EYE[2]))
        yield draw.frame(FrameState(joints[k], Camera(eye, (x, LOOK, z), FOCAL), nobody, nobody.astype(np.int64)))
    draw.close()


def _floor(root: NDArray[np.float64]) -> _Floor:
    low, high = root[:, [0, 2]].min(axis=0) / PANEL, root[:, [0, 2]].max(axis=0) / PANEL
    corners = np.array([[-high[0] - ROOM, low[1] - ROOM], [-low[0] + ROOM, high[1] + ROOM]])
    return _Floor(np.round(corners), np.zeros((2, 2)), (0.0, 0.0))
