"""Films: seconds of video per second, the wait for the first frame, memory, and how busy a pack keeps the cores."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
DEMO = ROOT / "charts" / "two_left_feet" / "two_left_feet.ssc"
Row = tuple[str, float, str, str, str]
WARM_UP = 3.0  # seconds of work that do not count for the steady state
GOALS = {"good": "2.0", "draft": "3.5"}
PEER = "pyrender as it comes 0.14 (stock, same scene)"


class Watch:
    """Progress that keeps when how many frames were done."""

    def __init__(self) -> None:
        self.seen: list[tuple[float, int]] = []
        self.count = 0

    def begin(self, frames: int, fps: int) -> None:
        """Not needed here."""

    def advance(self, frames: int) -> None:
        """Note the time."""
        self.count += frames
        self.seen.append((time.time(), self.count))


def child(output: str, quality: str) -> None:
    """Render the demo song in this process and print what was seen, as JSON."""
    from dancetutor_cli.jobs.film_plan import prepare
    from dancetutor_cli.jobs.film_request import Request, look_up
    from dancetutor_cli.jobs.pool import default_jobs
    from dancetutor_cli.jobs.render import make_film
    from dancetutor_cli.jobs.selection import Selection
    from dancetutor_cli.video.encoder import Encoding
    from dancetutor_cli.video.film_look import FilmLook
    from dancetutor_cli.video.layout import load_layout

    look = FilmLook(load_layout("side-by-side"), (1280, 720), quality, "cpu")  # type: ignore[arg-type]
    request = Request(DEMO, Selection(steps_type="dance-single", difficulty="hard"), look)
    watch = Watch()
    encoding = Encoding("mp4", look.size, request.fps, look.quality)
    make_film(lambda: prepare(request, look_up(request)), encoding, Path(output), default_jobs(), watch)
    print(json.dumps({"seen": watch.seen, "end": time.time(), "fps": request.fps, "memory": _memory()}))


def _memory() -> float:
    """Largest resident memory of a worker, MiB; NaN where the system does not tell."""
    try:
        import resource
    except ImportError:
        return float("nan")
    scale = 1024 if sys.platform != "darwin" else 1024 * 1024
    return float(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss) / scale


def _render(quality: str) -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, __file__, "child", str(Path(folder) / "film.mp4"), quality]
        began = time.time()
        said = subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT).stdout
        return {"began": began, **json.loads(said.splitlines()[-1])}


def _pack() -> tuple[float, int]:
    """Share of the cores' time that a pack of 20 small films keeps busy, and the films made."""
    before, began = os.times(), time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        pack = Path(folder) / "pack"
        for number in range(4):
            song = pack / f"song{number}"
            song.mkdir(parents=True)
            for file in DEMO.parent.iterdir():
                (song / file.name).write_bytes(file.read_bytes())
        command = [
            sys.executable,
            "-m",
            "dancetutor_cli",
            "render",
            str(pack),
            "-o",
            str(Path(folder) / "videos"),
            "-q",
        ]
        wanted = ["--steps-type", "dance-single", "--section", "4:12", "--size", "640x360", "--renderer", "cpu"]
        subprocess.run([*command, *wanted], check=True, cwd=ROOT)
        films = len(list((Path(folder) / "videos").glob("*.mp4")))
    after = os.times()
    used = after.children_user + after.children_system - before.children_user - before.children_system
    return used / (time.monotonic() - began) / (os.cpu_count() or 1), films


def measure() -> list[Row]:
    """Rows of the table; the demo song, 1280x720 at 30 frames per second, music and encoding included."""
    _render("draft")  # fills numba's cache and the disk's
    rows: list[Row] = []
    for quality in ("good", "draft"):
        run = _render(quality)
        seen = run["seen"]
        first = seen[0][0]
        start = next(s for s in seen if s[0] >= first + WARM_UP)
        steady = (seen[-1][1] - start[1]) / run["fps"] / (seen[-1][0] - start[0])
        whole = seen[-1][1] / run["fps"] / (run["end"] - run["began"])
        rows.append((f"{quality}, steady", steady, "s of video/s", GOALS[quality], PEER if quality == "good" else ""))
        rows.append((f"{quality}, whole run", whole, "s of video/s", "", ""))
        if quality == "good":
            rows.append(("first frames after", first - run["began"], "s", "3", ""))
            rows.append(("memory of a worker", run["memory"], "MiB", "700", ""))
    busy, films = _pack()
    rows.append((f"cores busy, {films} films of 8 s", 100 * busy, "%", "90", ""))
    return rows


if __name__ == "__main__":
    child(*sys.argv[2:])
