"""The same bytes with the dancer in the picture: whoever draws, in whatever order, and after any interruption."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from dancetutor_cli.run.reading import charts_path

DEMO = charts_path() / "two_left_feet"
WISH = ("--steps-type", "dance-single", "--difficulty", "hard", "--section", "3:17", "--size", "128x72", "--fps", "6")
NAMES = [f"{song}-dance-single-hard.mp4" for song in ("one", "two")]


@pytest.fixture(scope="module")
def pack(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("same") / "pack"
    for name in ("one", "two"):
        shutil.copytree(DEMO, folder / name)
    return folder


def command(pack: Path, videos: Path, *more: str) -> list[str]:
    start = [sys.executable, "-m", "dancetutor_cli", "render", str(pack), "-o", str(videos), "-q"]
    return [*start, "--renderer", "cpu", *WISH, *more]


def films(videos: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(videos.glob("*.mp4"))}


@pytest.fixture(scope="module")
def alone(pack: Path) -> dict[str, bytes]:
    """The films as one process makes them."""
    videos = pack.parent / "alone"
    subprocess.run(command(pack, videos, "--jobs", "1"), check=True)
    made = films(videos)
    assert list(made) == NAMES and made[NAMES[0]] == made[NAMES[1]]  # one song under two names
    return made


def test_shards_and_workers_make_the_same_films(pack: Path, alone: dict[str, bytes]) -> None:
    videos = pack.parent / "shards"
    for shard, jobs in (("1/2", "2"), ("2/2", "1")):
        before = films(videos) if videos.exists() else {}
        subprocess.run(command(pack, videos, "--shard", shard, "--jobs", jobs), check=True)
        assert len(films(videos)) == len(before) + 1
    assert films(videos) == alone


@pytest.mark.skipif(sys.platform == "win32", reason="kills a process the POSIX way")
def test_a_run_that_was_killed_goes_on_to_the_same_films(pack: Path, alone: dict[str, bytes]) -> None:
    videos = pack.parent / "killed"
    process = subprocess.Popen(command(pack, videos, "--jobs", "2"), stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 120
    while not list(videos.glob(".dancetutor-*/segment_*.mp4")) and time.monotonic() < deadline:
        time.sleep(0.02)
    os.kill(process.pid, signal.SIGKILL)
    process.wait(60)
    assert list(videos.glob(".dancetutor-*/segment_*.mp4")) and len(films(videos)) < 2
    subprocess.run(command(pack, videos, "--jobs", "2"), check=True)
    assert films(videos) == alone
    assert {p.suffix for p in videos.iterdir()} == {".mp4"}  # of what was in work nothing is left
