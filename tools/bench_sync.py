"""Processor time of `analyze --sync` for a song: decoding, onsets and judging, ffmpeg's own time included."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SONGS = ROOT.parent / "shared" / "data" / "songs"
DEMO = ROOT / "charts"
RUNS = 3
Row = tuple[str, float, str, str, str]


def spent(folder: Path, *options: str) -> float:
    """Processor seconds of a run, with those of its children."""
    program = Path(sys.executable).with_name("dancetutor")
    words = [program, "analyze", folder, *options, "--select", "DT6", "--jobs", "1", "--no-cache", "--exit-zero"]
    before = os.times()
    subprocess.run([str(word) for word in words], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system


def measure() -> list[Row]:
    """Rows for tools/bench.py: what --sync adds, a song; of the demo song, and of those with two minutes of music."""
    rows: list[Row] = []
    for name, folder in (("demo song, 41 s", DEMO), ("songs of 84 and 123 s", SONGS)):
        if not folder.is_dir():
            continue
        music = {path.parent for path in folder.rglob("*") if path.suffix.lower() in (".sm", ".ssc")}
        spent(folder)  # fills the disk's cache
        added = min(spent(folder, "--sync") for _ in range(RUNS)) - min(spent(folder) for _ in range(RUNS))
        rows.append((f"{name}: what --sync adds, a song", added / len(music), "s", "1", "1.1"))
    return rows
