"""tools/bench_peers.py: programs take turns, ratios are to ours, and what fails is named and left out."""

from __future__ import annotations

import re
import runpy
import subprocess
import sys
from pathlib import Path

TOOL = Path(__file__).parent.parent / "tools" / "bench_peers.py"
SPIN = "import sys, time; t = time.process_time()\nwhile time.process_time() - t < {}: pass"


def told(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, str(TOOL), str(folder), *arguments], capture_output=True, text=True)


def command(code: str, place: str = "{folder}") -> str:
    return f"'{sys.executable}' -c '{code}' {place}"


def test_ratios_and_failures(tmp_path: Path) -> None:
    for name in ("a.sm", "b.ssc"):
        (tmp_path / name).touch()
    ours, twice = command(SPIN.format(0.1)), command(SPIN.format(0.15), "{file}")
    run = told(tmp_path, "--runs", "2", "--ours", ours, "--peer", f"each={twice}", "--peer", "none=/not/there {folder}",
               "--peer", f"dies={command('import nothing_of_this_name')}")  # fmt: skip
    assert run.returncode == 0, run.stderr
    ratio = re.search(r"\| each \| ([0-9.]+) \|", run.stdout)
    assert ratio and 1.5 < float(ratio[1]) < 6.0  # 0.3 s and two starts of Python against 0.1 s and one
    assert "| none | left out: /not/there: " in run.stdout and "ended with status 1" in run.stdout


def test_a_program_leaves_nothing_where_it_is_asked_for(tmp_path: Path) -> None:
    """Some write logs where they run, and one may wait for an answer; paths are whole whatever the folder is."""
    songs = tmp_path / "songs"
    songs.mkdir()
    (songs / "a.sm").touch()
    log = command('import os, sys; open("log", "w"); sys.stdin.read(); assert os.listdir(sys.argv[1]) == ["a.sm"]')
    words = [sys.executable, str(TOOL), "songs", "--runs", "1", "--ours", log, "--peer", f"log={log}"]
    run = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    assert re.search(r"\| log \| [0-9.]+ \|", run.stdout)
    assert sorted(one.name for one in tmp_path.rglob("*")) == ["a.sm", "songs"]


def test_a_program_that_does_not_end_is_left_out(tmp_path: Path) -> None:
    tool = runpy.run_path(str(TOOL))
    program = tool["program_of"](f"sleeps={command('import time; time.sleep(600)')}")
    tool["one_round"](program, tool["Work"](tmp_path, [], 0.2))
    assert program.failed.endswith("took longer than 0.2 s") and not program.wall


def test_a_command_without_a_place_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.sm").touch()
    run = told(tmp_path, "--peer", "x=cat")
    assert run.returncode == 1 and run.stderr.strip() == "x: the command needs {folder} or {file}"
