"""The segments of a film, which any process draws and encodes, and the records of films that later runs read."""

from __future__ import annotations

import hashlib
import json
import os
import pickle
import re
import secrets
import shutil
import stat
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.film.media.encoder import PICTURES, Encoding, encode_segment
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.files import encode_json, write_atomic
from dancetutor_cli.run.pool import Report, Task
from dancetutor_cli.run.reading import read_json
from dancetutor_cli.run.trust import exclude, kept_folder, results_folder

if TYPE_CHECKING:
    from dancetutor_cli.film.choices import RendererKind
    from dancetutor_cli.film.film import Film
    from dancetutor_cli.film.picture import Frame
    from dancetutor_cli.film.plan import FilmPlan


# The records that a batch keeps between runs: finished films, and digests of the segments of unfinished films.
#
# Records are in the user's own cache and never beside the films, because a folder of charts and its contents may come
# from anybody. Unfinished films are beside the output, so that the last step is a rename and the machines of a cluster
# see them. Each run makes a new folder for them, under a name that nobody can guess. A segment of an interrupted run is
# moved from the folder of that run, and counts only with the digest in the record.

WORK = ".dancetutor-"  # beginning of the name of a work folder, before 32 random hexadecimal digits
_WORK_NAME = re.compile(re.escape(WORK) + "[0-9a-f]{32}")
_DIGEST = re.compile("[0-9a-f]{64}")
REMOVALS = 20  # how often the removal of a work folder is tried
_NO_LINK = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)


@dataclass(frozen=True, slots=True)
class FilmRecord:
    """The record of a film from earlier runs.

    key : hash of everything that the film is made of, see `film_key`; folders : names of its work folders
    digests : SHA-256 of each finished segment, by number; size : size of the finished film, None for an unfinished film
    """

    key: str = ""
    folders: tuple[str, ...] = ()
    digests: dict[int, str] = field(default_factory=dict)
    size: int | None = None


class FilmRecords:
    """The records of films, one file for each film in a private folder.

    Without a folder nothing is kept, and a second run begins again.
    """

    def __init__(self, folder: Path | None) -> None:
        self._folder = folder

    @property
    def is_kept(self) -> bool:
        """Whether a later run will find the records."""
        return self._folder is not None

    def read(self, output: Path) -> FilmRecord:
        """Return the record of the film of that name; an empty record if there is no usable one."""
        if self._folder is None:
            return FilmRecord()
        try:
            return _checked(read_json(self._path(output)))
        except (FileError, KeyError, TypeError, ValueError, AttributeError):
            return FilmRecord()

    def write(self, output: Path, record: FilmRecord) -> None:
        """Write a record. A record that cannot be written is left out, because the film itself does not need it."""
        if self._folder is None:
            return
        data = {
            "schema": 1,
            "output": os.path.realpath(output.parent) + os.sep + output.name,
            "key": record.key,
            "size": record.size,
            "folders": record.folders,
            "digests": record.digests,
        }
        path = self._path(output)
        with suppress(OSError, FileError):
            path.parent.mkdir(mode=0o700, exist_ok=True)
            write_atomic(path, encode_json(json.dumps(data, ensure_ascii=False, indent=1) + "\n"))

    def _path(self, output: Path) -> Path:
        assert self._folder is not None
        return self._folder / _hash(os.path.realpath(output.parent)) / f"{_hash(output.name)}.json"


def _hash(text: str) -> str:
    return hashlib.sha256(os.fsencode(text)).hexdigest()[:32]


def _checked(data: Any) -> FilmRecord:
    """Return a record from its data; any error in them raises an exception."""
    digests = {int(number): digest for number, digest in data["digests"].items() if _DIGEST.fullmatch(digest)}
    folders = tuple(name for name in data["folders"] if _WORK_NAME.fullmatch(name))
    return FilmRecord(str(data["key"]), folders, digests, None if data["size"] is None else int(data["size"]))


def find_records(foreign: tuple[Path, ...] = ()) -> tuple[FilmRecords, str]:
    """Return the records of this user, and "" or the reason why there are no records.

    foreign : folders whose contents others may have written, such as a pack; a cache inside them is not used
    """
    for path in foreign:
        exclude(path)
    return FilmRecords(kept_folder("films")), results_folder()[1]


def new_work_name() -> str:
    """Return a new name of a work folder."""
    return f"{WORK}{secrets.token_hex(16)}"


def remove_work(folder: Path) -> None:
    """Remove a work folder, or a file or link of this name; the target of a link stays.

    An encoder whose worker was just ended may open its file while the folder is being emptied: then again.
    """
    try:
        folder.unlink()
    except OSError:
        for _ in range(REMOVALS):
            shutil.rmtree(folder, ignore_errors=True)
            if not folder.exists():
                return
            time.sleep(0.05)


def move_segment(source: Path, target: Path, digest: str) -> bool:
    """Move a segment of an earlier run into the folder of this run; whether it is unchanged since that run."""
    with suppress(OSError):
        source.rename(target)  # moves a link itself, not its target
        if digest_of(target) == digest:
            return True
    remove_work(target)
    return False


def digest_of(path: Path) -> str:
    """Return the SHA-256 of an ordinary file; OSError for a link, and "" for a device, a pipe or a folder."""
    with open(os.open(path, os.O_RDONLY | _NO_LINK), "rb") as file:  # noqa: PTH123
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            return ""
        return hashlib.file_digest(file, "sha256").hexdigest()


# Segments: pieces of work that any process draws and encodes.

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


def cut_segments(frames: int, encoding: Encoding, folder: Path) -> list[Segment]:
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
def load_film(plan: PlanFile) -> Film:
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
    film = load_film(plan)
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
