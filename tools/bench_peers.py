#!/usr/bin/env python3
"""Time other programs beside ours on the same files in the same run, taking turns, and print ratios.

usage: tools/bench_peers.py FOLDER --peer NAME="COMMAND" [--peer ...] [--ours "COMMAND"] [--runs N] [--each-file]

A COMMAND has {folder}, or with --each-file {file}; what it writes is thrown away. For example:

  tools/bench_peers.py pack --peer rssp="/opt/rssp-cli --json {file}" --each-file
  tools/bench_peers.py pack --peer itgmania="/opt/itgmania-export {folder}"

Wall time of another hour or machine says nothing, so every number is a ratio to ours: the least processor time of some
runs, and the least wall time. Programs run in a folder of their own that is thrown away, for some leave logs where they
run, and with nothing to read from a terminal. One that does not end with status 0, or not within --limit, is told of
and left out.
"""

from __future__ import annotations

import argparse
import os
import shlex
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DANCETUTOR = Path(sys.executable).with_name("dancetutor")
OURS = {"{folder}": "analyze {folder} --format csv --no-cache --exit-zero --jobs 1"}
OURS["{file}"] = OURS["{folder}"].replace("{folder}", "{file}")
SUFFIXES = (".sm", ".ssc")
Row = tuple[str, float, str, str, str]
WELL = (
    0,
    1,
    2,
)  # of ours; 1: there are findings, 2: a file that nobody can read. Of a peer 1 may be a traceback: 0 alone
VARIABLE = "BENCH_PEERS"  # for tools/bench.py: a NAME="COMMAND" a line
LIMIT = 600.0  # seconds that one command of a program may take


@dataclass
class Program:
    """A program and its times in seconds, one a round.

    words : its command line; well : statuses with which it may end; failed : why it is left out
    """

    name: str
    words: list[str]
    well: tuple[int, ...] = (0,)
    processor: list[float] = field(default_factory=list)
    wall: list[float] = field(default_factory=list)
    failed: str = ""


@dataclass(frozen=True)
class Work:
    """What all programs do: a folder, its chart files, and how many seconds a command may take."""

    folder: Path
    files: Sequence[Path]
    limit: float = LIMIT


def commands(words: Sequence[str], work: Work) -> Iterable[list[str]]:
    """The command lines of one round: one for the folder, or one for each file."""
    if any("{file}" in word for word in words):
        return ([word.replace("{file}", str(file)) for word in words] for file in work.files)
    return iter([[word.replace("{folder}", str(work.folder)) for word in words]])


def spent() -> float:
    """Processor time of all children that have ended."""
    now = os.times()
    return now.children_user + now.children_system


def one_round(program: Program, work: Work) -> None:
    """Run a program once over everything and note its times."""
    quiet = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    with tempfile.TemporaryDirectory() as place:
        before, start = spent(), time.perf_counter()
        for words in commands(program.words, work):
            try:
                status = subprocess.run(words, cwd=place, check=False, timeout=work.limit, **quiet).returncode
            except OSError as error:
                program.failed = f"{words[0]}: {error.strerror}"
                return
            except subprocess.TimeoutExpired:
                program.failed = f"{shlex.join(words)} took longer than {work.limit:g} s"
                return
            if status not in program.well:
                program.failed = f"{shlex.join(words)} ended with status {status}"
                return
        program.processor.append(spent() - before)
        program.wall.append(time.perf_counter() - start)


def compare(programs: Sequence[Program], work: Work, runs: int) -> list[str]:
    """Lines of a table: each program's times as multiples of the first one's. The first round does not count."""
    for turn in range(runs + 1):
        for program in programs:
            if not program.failed:
                print(f"round {turn} of {runs}: {program.name}", file=sys.stderr)
                one_round(program, work)
        if turn == 0:
            for program in programs:
                program.processor.clear()
                program.wall.clear()
    ours = programs[0]
    if ours.failed:
        raise SystemExit(ours.failed)
    lines = ["| program | processor time | wall time | spread |", "| --- | --- | --- | --- |"]
    for program in programs:
        if program.failed:
            lines.append(f"| {program.name} | left out: {program.failed} | | |")
            continue
        processor = min(program.processor) / max(min(ours.processor), 1e-9)
        least = max(min(program.processor), 0.01)  # what a system tells apart
        spread = max(statistics.median(program.processor), least) / least - 1
        wall = min(program.wall) / min(ours.wall)
        lines.append(f"| {program.name} | {processor:.2f} | {wall:.2f} | {100 * spread:.0f} % |")
    return lines


def measure(folder: Path = ROOT / "build" / "corpus" / "dev") -> list[Row]:
    """Rows for tools/bench.py: how many times our processor time each program of BENCH_PEERS takes; none without it."""
    peers = [line for line in os.environ.get(VARIABLE, "").splitlines() if line.strip()]
    if not peers or not folder.is_dir():
        return []
    programs = [Program("dancetutor", [str(DANCETUTOR), *shlex.split(OURS["{folder}"])], WELL), *map(program_of, peers)]
    compare(programs, Work(folder.resolve(), charts_in(folder.resolve())), 3)
    good = [program for program in programs[1:] if not program.failed]
    ours = min(programs[0].processor)
    return [(program.name, min(program.processor) / ours, "times our processor time", "", "") for program in good]


def charts_in(folder: Path) -> list[Path]:
    """The chart files of a folder."""
    return sorted(path for path in folder.rglob("*") if path.suffix.lower() in SUFFIXES)


def program_of(peer: str) -> Program:
    """What NAME="COMMAND" says; SystemExit for a command without a place for the files."""
    name, _, command = peer.partition("=")
    words = shlex.split(command)
    if not any(place in word for word in words for place in ("{folder}", "{file}")):
        raise SystemExit(f"{name}: the command needs {{folder}} or {{file}}")
    words[0] = shutil.which(words[0]) or words[0]
    return Program(name.strip(), [str(Path(words[0]).absolute()) if "/" in words[0] else words[0], *words[1:]])


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--peer", action="append", required=True, metavar='NAME="COMMAND"')
    parser.add_argument("--ours", metavar='"COMMAND"', help="in place of analyze --format csv, uncached, one process")
    parser.add_argument("--runs", type=int, default=3, help="rounds that count, at least 1")
    parser.add_argument("--each-file", action="store_true", help="ours too is started for each file")
    parser.add_argument("--limit", type=float, default=LIMIT, metavar="SECONDS", help="that one command may take")
    given = parser.parse_args(arguments)
    files = charts_in(given.folder.resolve())
    if not files:
        parser.error(f"{given.folder}: no .sm or .ssc file in it")
    what = "{file}" if given.each_file else "{folder}"
    ours = shlex.split(given.ours) if given.ours else [str(DANCETUTOR), *shlex.split(OURS[what])]
    programs = [Program("dancetutor", ours, WELL)]
    programs += map(program_of, given.peer)
    print(f"{len(files)} files, the least of {max(given.runs, 1)} rounds, as multiples of dancetutor's\n")
    work = Work(given.folder.resolve(), files, given.limit)
    print("\n".join(compare(programs, work, max(given.runs, 1))))


if __name__ == "__main__":
    main()
