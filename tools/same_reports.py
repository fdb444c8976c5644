#!/usr/bin/env python3
"""Check that reports of a folder of charts are still the same, line by line: for changes that may only change the time.

usage: tools/same_reports.py keep KEPT.json [FOLDER] [--every N] [--jobs N]     before the change
       tools/same_reports.py check KEPT.json                                    after it; exit status 1 where it differs

Takes every N-th file of the folder (default: build/corpus/dev, which the tests unpack) in all formats of findings. In
JSON a line is a file.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DANCETUTOR = Path(sys.executable).with_name("dancetutor")
FORMATS = ("json", "csv", "text", "jsonl", "sarif")
_SHOWN = 5  # lines of a format that differ
_CUT = 160  # characters of such a line


def lines_of(folder: Path, files: list[Path], kind: str, jobs: int) -> list[bytes]:
    """The output of `analyze` in a format for some files of a folder, wherever it is."""
    command = [str(DANCETUTOR), "analyze", *map(str, files), "--no-cache", "--exit-zero", "--jobs", str(jobs)]
    with tempfile.TemporaryFile() as out:
        command += ["--format", kind]
        subprocess.run(command, cwd=folder, stdout=out, stderr=subprocess.DEVNULL, check=False)
        out.seek(0)
        return out.readlines()


def digest(line: bytes) -> str:
    """A short fingerprint of a line."""
    return hashlib.blake2b(line, digest_size=8).hexdigest()


def chart_files(folder: Path, every: int) -> list[Path]:
    """Every so many-th chart file of a folder, by its path there."""
    return sorted(path.relative_to(folder) for path in folder.rglob("*") if path.suffix.lower() in (".sm", ".ssc"))[
        ::every
    ]


def keep(kept: Path, folder: Path, every: int, jobs: int) -> None:
    """Write down the present output of every format."""
    files = chart_files(folder, every)
    said = {kind: [digest(line) for line in lines_of(folder, files, kind, jobs)] for kind in FORMATS}
    kept.write_text(json.dumps({"folder": str(folder.absolute()), "every": every, "said": said}), encoding="utf-8")
    print(f"{len(files)} files, {', '.join(f'{kind} {len(lines)} lines' for kind, lines in said.items())}")


def check(kept: Path, jobs: int) -> int:
    """Compare with the present output; the number of formats that differ."""
    known = json.loads(kept.read_text(encoding="utf-8"))
    folder = Path(known["folder"])
    files = chart_files(folder, known["every"])
    differ = 0
    for kind, before in known["said"].items():
        now = lines_of(folder, files, kind, jobs)
        wrong = [n for n, (line, old) in enumerate(zip(now, before, strict=False)) if digest(line) != old]
        more = "" if len(now) == len(before) else f"; {len(now)} lines, {len(before)} before"
        print(f"{kind}: {len(wrong)} of {len(before)} lines differ{more}")
        for n in wrong[:_SHOWN]:
            print(f"  line {n + 1}: {now[n][:_CUT].decode('utf-8', 'replace').rstrip()}")
        differ += bool(wrong or more)
    return differ


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("keep", "check"))
    parser.add_argument("kept", type=Path)
    parser.add_argument("folder", type=Path, nargs="?", default=ROOT / "build" / "corpus" / "dev")
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    given = parser.parse_args()
    if given.what == "keep":
        keep(given.kept, given.folder, given.every, given.jobs)
    else:
        sys.exit(bool(check(given.kept, given.jobs)))


if __name__ == "__main__":
    main()
