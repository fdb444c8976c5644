#!/usr/bin/env python3
"""The main job on the demo song: analyze, annotate a copy, animate and render, as a user would type it.

usage: tools/demo.py FOLDER
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DANCETUTOR = Path(sys.executable).with_name("dancetutor")


def run(*arguments: object, allowed: tuple[int, ...] = (0,)) -> None:
    """Show the command, run it, and stop the demo with its status unless that is allowed."""
    words = [str(a) for a in arguments]
    print(f"\n$ dancetutor {' '.join(words)}", flush=True)
    status = subprocess.run([DANCETUTOR, *words], cwd=ROOT, check=False).returncode
    if status not in allowed:
        sys.exit(status)


def main() -> None:
    target = Path(sys.argv[1])
    song = target / "two_left_feet"
    chart = song / "two_left_feet.ssc"
    if song.exists():
        shutil.rmtree(song)
    shutil.copytree(ROOT / "charts" / "two_left_feet", song)
    hard = ("--steps-type", "dance-single", "--difficulty", "hard")

    run("analyze", chart, "--exit-zero")
    run("annotate", song)
    run("animate", chart, *hard, "-o", target / "hard.glb", "--report")
    run("animate", chart, *hard, "-o", target / "hard.npz")
    run("render", chart, *hard, "-o", target / "hard.mp4")

    print(f"\nThe results are in {target}/:")
    for path in sorted(p for p in target.rglob("*") if p.is_file()):
        size = path.stat().st_size
        print(f"  {path.relative_to(target)}  {size / 1e6:.1f} MB" if size > 1e5 else f"  {path.relative_to(target)}")
    print("\nWatch hard.mp4; open hard.glb in any glTF viewer; see the feet in two_left_feet/two_left_feet.ssc.")


if __name__ == "__main__":
    main()
