"""Films: seconds of video per second, the wait for the first frame, memory, and how busy a pack keeps the cores.

usage: tools/bench_film.py [ROW ...]      rows: good draft gl pack stages
"""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
DEMO = ROOT / "charts" / "two_left_feet" / "two_left_feet.ssc"
Row = tuple[str, float, str, str, str]
WARM_UP = 3.0  # seconds of work that do not count for the steady state; of a film that is soon done a third
SECTIONS = {"good": "0:30", "draft": "0:30", "gl": "0:12", "warm": "20:21"}
GOALS = {"good": "2.0", "draft": "3.5", "gl": "1.0"}
SHARES = {"good": "0.75", "draft": "0.45", "gl": "2"}  # of processor time, goals
STAGE_FRAMES = range(300, 360)
PEER = "pyrender as it comes 0.14 (stock, same scene)"


class Watch:
    """Progress that keeps when how many frames were done."""

    def __init__(self) -> None:
        self.seen: list[tuple[float, int]] = []
        self.count = 0

    def advance(self, frames: int) -> None:
        """Note the time."""
        self.count += frames
        self.seen.append((time.time(), self.count))


def _request(kind: str) -> Any:
    """The film that a row is about."""
    from dancetutor_cli.chart.selection import Selection
    from dancetutor_cli.dance.request import DanceRequest
    from dancetutor_cli.film.layout import FilmLook, load_layout
    from dancetutor_cli.film.work.request import FilmRequest

    renderer = "gl" if kind == "gl" else "cpu"
    look = FilmLook(load_layout("side-by-side"), (1280, 720), "draft" if kind == "draft" else "good", renderer)
    selection = Selection(steps_type="dance-single", difficulty="hard")
    return FilmRequest(DanceRequest(DEMO, selection, "itg"), look, section=SECTIONS[kind])


def child(output: str, kind: str) -> None:
    """Render a part of the demo song with workers of this process and print what was seen, as JSON."""
    from dancetutor_cli.film.media.encoder import Encoding
    from dancetutor_cli.film.work.batch import Batch, film_workers
    from dancetutor_cli.film.work.jobs import FilmJob
    from dancetutor_cli.film.work.segments import FilmRecords
    from dancetutor_cli.run.pool import default_jobs

    request = _request(kind)
    look, watch = request.look, Watch()
    job = FilmJob(request, kind, Path(output), Encoding("mp4", look.size, request.fps, look.quality))
    workers = film_workers(default_jobs(), watch.advance, look.renderer)
    (outcome,) = Batch([job], workers, records=FilmRecords(None)).run()
    assert outcome.error is None, outcome.error
    print(json.dumps({"seen": watch.seen, "end": time.time(), "fps": request.fps}))


def _memory() -> float:
    """Largest resident memory of a process that this one has waited for, or that those have, MiB; NaN if unknown."""
    try:
        import resource
    except ImportError:
        return float("nan")
    scale = 1024 if sys.platform != "darwin" else 1024 * 1024
    return float(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss) / scale


def _adopt() -> None:
    """Become the parent of processes whose own has ended, as of the server that workers are forked off, on Linux."""
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(36, 1, 0, 0, 0)  # PR_SET_CHILD_SUBREAPER


def _environment() -> dict[str, str]:
    """This process's, but modules come as bytecode, as they are installed."""
    return {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}


def _run(*arguments: str) -> str:
    """What this file prints as a program of its own; waits for everything that it has started."""
    command = [sys.executable, __file__, *arguments]
    said = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, cwd=ROOT, env=_environment()).stdout
    with contextlib.suppress(ChildProcessError):
        while sys.platform == "linux":
            os.wait()
    return said.splitlines()[-1]


def _used() -> float:
    """Seconds of processor time of all processes that this one has started and that have ended."""
    now = os.times()
    return now.children_user + now.children_system


def _render(kind: str) -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as folder:
        began, before = time.time(), _used()
        said = json.loads(_run("child", str(Path(folder) / "film.mp4"), kind))
        return {"began": began, "used": _used() - before, **said}


def film(kind: str) -> list[Row]:
    """Rows of one film, 1280x720 at 30 frames per second, music and encoding included."""
    run = _render(kind)
    seen = run["seen"]
    first, length = seen[0][0], seen[-1][1] / run["fps"]
    warm_up = min(WARM_UP, (seen[-1][0] - first) / 3)
    start = next(s for s in seen if s[0] >= first + warm_up)
    steady = (seen[-1][1] - start[1]) / run["fps"] / (seen[-1][0] - start[0])
    share = run["used"] / length
    rows = [
        (f"{kind}, steady", steady, "s of video/s", GOALS[kind], PEER if kind != "draft" else ""),
        (f"{kind}, {length:.0f} s, whole run", length / (run["end"] - run["began"]), "s of video/s", "", ""),
        (f"{kind}, processor time, all processes", share, "s/s of video", SHARES[kind], ""),
    ]
    if kind == "good":
        rows.append(("first frames after", first - run["began"], "s", "2", ""))
        rows.append(("memory of the largest process", _memory(), "MiB", "300", ""))
    return rows


def gl() -> list[Row]:
    """Rows of the OpenGL renderer, none where there is no OpenGL."""
    from dancetutor_cli.film.scene.gl.available import require_gl
    from dancetutor_cli.run.errors import UnavailableError

    try:
        require_gl()
    except UnavailableError:
        return [("gl: no OpenGL here", 0.0, "s of video/s", GOALS["gl"], "")]
    return film("gl")


def pack() -> list[Row]:
    """How busy a pack of 20 small films keeps the cores, and the workers.

    Other programs take cores away, but not work: a worker has some or it waits.
    """
    with tempfile.TemporaryDirectory() as folder:
        for number in range(4):
            song = Path(folder) / "pack" / f"song{number}"
            song.mkdir(parents=True)
            for file in DEMO.parent.iterdir():
                (song / file.name).write_bytes(file.read_bytes())
        before, began = _used(), time.monotonic()
        run = json.loads(_run("pack-child", folder))
        wall = time.monotonic() - began
    busy = (_used() - before) / wall / (os.cpu_count() or 1)
    name = f"{run['films']} films of 5 s"
    return [
        (f"{name}, cores busy", 100 * busy, "%", "90", ""),
        (f"{name}, workers with work", 100 * run["working"], "%", "90", ""),
    ]


def pack_child(folder: str) -> None:
    """Make the films of a folder's pack with workers of this process and print for how long they had work, as JSON."""
    from dancetutor_cli.chart.selection import Selection
    from dancetutor_cli.dance.request import DanceRequest
    from dancetutor_cli.film.layout import FilmLook, load_layout
    from dancetutor_cli.film.media.encoder import Encoding
    from dancetutor_cli.film.work.batch import Batch, BatchRequest, film_list
    from dancetutor_cli.film.work.request import FilmRequest
    from dancetutor_cli.film.work.segments import common_to_workers
    from dancetutor_cli.run.pool import default_jobs
    from dancetutor_cli.run.worker_processes import ProcessWorkers

    class Watched(ProcessWorkers):
        """Adds up the time of all workers in which they had work."""

        worked, since, working = 0.0, time.monotonic(), 0

        def _feed(self) -> None:
            now = time.monotonic()
            self.worked += (now - self.since) * self.working
            super()._feed()
            self.since, self.working = now, sum(worker.task is not None for worker in self._workers)

    look = FilmLook(load_layout("side-by-side"), (640, 360), "good", "cpu")
    dance = DanceRequest(Path(), Selection(steps_type="dance-single"), "itg")
    request = FilmRequest(dance, look, section="4:9")
    encoding = Encoding("mp4", look.size, request.fps)
    videos = Path(folder) / "videos"
    videos.mkdir()
    jobs = film_list(BatchRequest((Path(folder) / "pack",), request, encoding, videos))[0]
    began, workers = time.monotonic(), Watched(default_jobs(), lambda _key, _frames: None, common_to_workers("cpu"))
    done = sum(outcome.status == "done" for outcome in Batch(jobs, workers).run())
    share = workers.worked / (time.monotonic() - began) / workers.jobs
    workers.close()
    print(json.dumps({"films": done, "working": share}))


def stages_child(output: str, kind: str) -> None:
    """Print, as JSON, the seconds of processor time of the stages of a film, all in this process but for x264."""
    from dancetutor_cli.film.film import Film
    from dancetutor_cli.film.media.encoder import Encoding, encode_segment
    from dancetutor_cli.film.media.yuv import yuv420
    from dancetutor_cli.film.work.planning import prepare
    from dancetutor_cli.film.work.request import look_up

    request, clock, seen = _request(kind), time.process_time, [time.process_time()]
    plan = prepare(request, look_up(request)).plan
    seen.append(clock())
    film = Film(plan)
    film.frame(0)
    seen.append(clock())
    frames = [film.frame(number) for number in STAGE_FRAMES]
    seen.append(clock())
    spare = bytearray(frames[0].size // 2)
    for frame in frames:
        yuv420(frame, np.frombuffer(spare, dtype=np.uint8))
    seen.append(clock())
    before = _used()
    encode_segment(frames, Encoding("mp4", request.look.size, request.fps, request.look.quality), Path(output))
    seen.append(seen[-1] + _used() - before)
    print(json.dumps([seen[0], *np.diff(seen)]))


def stages() -> list[Row]:
    """Where the processor time of films goes, the least of three runs."""
    rows: list[Row] = []
    for kind in ("good", "draft"):
        with tempfile.TemporaryDirectory() as folder:
            runs = [_run("stages-child", str(Path(folder) / "film.mp4"), kind) for _ in range(3)]
        least = np.min([json.loads(run) for run in runs], axis=0)
        names = ("imports", "plan and bake", "first frame", "drawing", "RGB to YUV", "x264")
        for name, seconds in zip(names, least, strict=True):
            steady = name in names[3:]
            value, unit = (1000 * seconds / len(STAGE_FRAMES), "ms a frame") if steady else (seconds, "s")
            rows.append((f"{kind}, {name}", float(value), unit, "", ""))
    return rows


ROWS: dict[str, Callable[[], list[Row]]] = {
    "good": lambda: film("good"),
    "draft": lambda: film("draft"),
    "gl": gl,
    "pack": pack,
    "stages": stages,
}


def measure(names: tuple[str, ...] = tuple(ROWS)) -> list[Row]:
    """Rows of the table; other programs that run at the same time make all but the processor time worse."""
    _adopt()
    _render("warm")  # fills numba's cache and the disk's
    return [row for name in names for row in ROWS[name]()]


if __name__ == "__main__":
    if sys.argv[1:2] == ["child"]:
        child(*sys.argv[2:])
    elif sys.argv[1:2] == ["pack-child"]:
        pack_child(*sys.argv[2:])
    elif sys.argv[1:2] == ["stages-child"]:
        stages_child(*sys.argv[2:])
    elif unknown := [name for name in sys.argv[1:] if name not in ROWS]:
        sys.exit(f"no row named {', '.join(unknown)}; there are: {', '.join(ROWS)}")
    else:
        for name, value, unit, goal, _ in measure(tuple(sys.argv[1:]) or tuple(ROWS)):
            print(f"{name:40} {value:8.3g} {unit:14} {goal and 'goal ' + goal}")
