"""A chart as an earlier commit dances it: that commit's own command bakes it, in a process and a folder of its own.

The folder is build/beside/COMMIT. It is kept with the kernels compiled in it, so that only a commit's first chart takes
some minutes; delete it whenever you like. The commit must run in this environment and write .npz files of schema 1.
"""

from __future__ import annotations

import io
import os
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

from dancetutor_cli.formats.npz import read_npz
from dancetutor_cli.motion.baked import Motion

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "build" / "beside"


def checked_out(commit: str) -> Path:
    """The folder with all files of a commit; made if it is not there. Exits with a line if there is no such commit."""
    found = _git("rev-parse", "--verify", "--quiet", f"{commit}^{{commit}}")
    name = found.stdout.decode().strip()
    if found.returncode:
        sys.exit(f"there is no commit {commit}")
    folder = FOLDER / name[:12]
    if not (folder / "dancetutor_cli").is_dir():
        FOLDER.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=FOLDER) as new:  # whole or not at all
            with tarfile.open(fileobj=io.BytesIO(_git("archive", name).stdout)) as archive:
                archive.extractall(Path(new) / "all", filter="data")
            (Path(new) / "all").rename(folder)
    return folder


def baked_by(commit: str, call: list[str]) -> Motion:
    """What `animate` of a commit bakes when called so. Exits with the command's last line if it cannot."""
    folder = checked_out(commit)
    with tempfile.TemporaryDirectory() as new:
        out = Path(new) / "dance.npz"
        environment = {**os.environ, "PYTHONPATH": str(folder), "NUMBA_CACHE_DIR": str(folder / "kernels")}
        whole = [sys.executable, "-m", "dancetutor_cli", "animate", *call, "-o", str(out), "--yes"]
        done = subprocess.run(whole, cwd=folder, env=environment, capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(f"{commit}: {(done.stderr.strip().splitlines() or [f'exit status {done.returncode}'])[-1]}")
        return read_npz(out)


def _git(*words: str) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, check=False)
