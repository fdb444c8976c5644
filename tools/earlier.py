"""The result of an earlier commit for a chart: that commit's own command runs, in a process and a folder of its own.

The folder is build/beside/COMMIT. It is kept, with the kernels compiled in it and what was made there, so that only a
commit's first chart takes some minutes; delete it whenever you like. The commit must run in this environment and write
.npz files of schema 1. HERE stands for the working tree as it is.
"""

from __future__ import annotations

import hashlib
import io
import os
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from PIL import Image, ImageSequence
from unpacking import unpack

from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.formats.npz import read_npz

ROOT = Path(__file__).resolve().parent.parent
HERE = "now"


def checked_out(commit: str) -> Path:
    """The folder with all files of a commit; made if it is not there. Exits with a line if there is no such commit."""
    if commit == HERE:
        return ROOT
    found = _git("rev-parse", "--verify", "--quiet", f"{commit}^{{commit}}")
    name = found.stdout.decode().strip()
    if found.returncode:
        sys.exit(f"there is no commit {commit}")
    folder = ROOT / "build" / "beside" / name[:12]
    if not (folder / "dancetutor_cli").is_dir():
        folder.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder.parent) as new:  # whole or not at all
            with tarfile.open(fileobj=io.BytesIO(_git("archive", name).stdout)) as archive:
                unpack(archive, Path(new) / "all")
            (Path(new) / "all").rename(folder)
    return folder


def baked_by(commit: str, chart: Path, call: list[str]) -> Motion:
    """What `animate` of a commit bakes when called so. Exits with the command's last line if it cannot."""
    with _output(commit, chart, ["animate", *call, "--yes", "-o"], "dance.npz") as out:
        return read_npz(out)


def filmed_by(commit: str, chart: Path, call: list[str], gif: bool = False) -> list[Image.Image]:
    """The pictures that `render` of a commit draws when called so, in order. Exits as `baked_by` does."""
    words = ["render", *call, "--mute", "--quiet", "-o" if gif else "--frames"]
    with _output(commit, chart, words, "film.gif" if gif else "frames") as out:
        if gif:
            with Image.open(out) as film:
                return [picture.convert("RGB") for picture in ImageSequence.Iterator(film)]
        return [Image.open(path).convert("RGB") for path in sorted(out.glob("*.png"))]


def run_on(commit: str, words: list[str]) -> None:
    """Run Python with these words where a commit's package is the one that is imported. Exits as `baked_by` does."""
    folder = checked_out(commit)
    environment = {**os.environ, "PYTHONPATH": str(folder)}
    if commit != HERE:
        environment["NUMBA_CACHE_DIR"] = str(folder / "kernels")
    whole = [sys.executable, *words]
    done = subprocess.run(whole, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{commit}: {(done.stderr.strip().splitlines() or [f'exit status {done.returncode}'])[-1]}")


@contextmanager
def _output(commit: str, chart: Path, call: list[str], name: str) -> Iterator[Path]:
    """What a command makes of a chart, `name`, where its last option says. An earlier commit's is kept: it stays so."""
    key = hashlib.sha256("\0".join(call).encode() + chart.read_bytes()).hexdigest()[:16]
    made = None if commit == HERE else checked_out(commit) / "made"
    if made is not None:
        made.mkdir(exist_ok=True)
    kept = made and made / f"{key}-{name}"
    if kept is not None and kept.exists():
        yield kept
        return
    with tempfile.TemporaryDirectory(dir=made) as new:
        out = Path(new) / name
        run_on(commit, ["-m", "dancetutor_cli", call[0], str(chart.resolve()), *call[1:], str(out)])
        yield out.rename(kept) if kept is not None else out


def _git(*words: str) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, check=False)
