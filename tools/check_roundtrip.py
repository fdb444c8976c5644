#!/usr/bin/env python3
"""Annotate copies of chart files, strip them, and count the files that came back byte for byte.

usage: tools/check_roundtrip.py [--styles measure,rows,...] [FOLDER ...]
Without folders: the test charts in build/corpus/dev and the hostile files in tests/data/hostile.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from pathlib import Path

from dancetutor_cli.chart.selection import Selection, find_files
from dancetutor_cli.markers.annotate import AnnotateOutcome, AnnotateRequest, Item, annotate_song
from dancetutor_cli.markers.styles import STYLES
from dancetutor_cli.run.errors import FileError

ROOT = Path(__file__).resolve().parent.parent
DEFAULT = (ROOT / "build" / "corpus" / "dev", ROOT / "tests" / "data" / "hostile")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folders", nargs="*", type=Path, default=DEFAULT)
    parser.add_argument("--styles", default="measure")
    parser.add_argument("--into-file", action="store_true")
    options = parser.parse_args()
    styles = tuple(name for name in STYLES if name in options.styles.split(","))
    bad = False
    for folder in options.folders:
        counts: Counter[str] = Counter()
        for path in find_files([folder]):
            try:
                counts.update(check(path, styles, options.into_file))
            except AssertionError as error:
                bad = True
                print(f"{path}: {error}", file=sys.stderr)
        print(
            f"{folder}: {counts['files']} files, {counts['readable']} of them with charts; styles {', '.join(styles)}"
        )
        print(f"  annotated: {counts['annotated']}, the same when annotated twice: {counts['twice']}")
        print(f"  byte-exact after strip: {counts['exact']} of {counts['files']}")
    sys.exit(bad)


def check(path: Path, styles: tuple[str, ...], into_file: bool = False) -> Counter[str]:
    """Counts of one file; AssertionError names what went wrong."""
    counts = Counter({"files": 1})
    with tempfile.TemporaryDirectory() as temporary:
        copy = Path(temporary) / path.name
        original = path.read_bytes()
        copy.write_bytes(original)
        first = run(copy, styles, into_file=into_file)
        once = contents(copy.parent)
        if first.error is None:
            counts["readable"] += 1
        counts["annotated"] += once != {path.name: original}
        run(copy, styles, into_file=into_file)
        assert contents(copy.parent) == once, "annotating twice is not the same as once"
        counts["twice"] += 1
        run(copy, styles, strip=True)
        assert contents(copy.parent) == {path.name: original}, "strip does not give the old file back"
        counts["exact"] += 1
    return counts


def run(path: Path, styles: tuple[str, ...], strip: bool = False, into_file: bool = False) -> AnnotateOutcome:
    request = AnnotateRequest(styles, None, Selection(), strip=strip, into_file=into_file)
    (outcome,) = annotate_song([Item(path, path)], request)
    if outcome.error and "no chart" not in outcome.error and "--into-file" not in outcome.error:
        print(FileError(path, outcome.error), file=sys.stderr)
    return outcome


def contents(folder: Path) -> dict[str, bytes]:
    return {entry.name: entry.read_bytes() for entry in folder.iterdir()}


if __name__ == "__main__":
    main()
