"""What the figures of all pages of docs need: the demo song, test data, a command's report, a table of Markdown."""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DEMO = "charts/two_left_feet/two_left_feet.ssc"
HARD = ("--index", "3")
CORPUS = ROOT / "build" / "corpus" / "dev"
SHARED = ROOT.parent / "shared" / "data"
Figures = dict[str, tuple[str, Callable[[], str]]]  # name of a block: page of docs, what writes it
Values = dict[str, float]


class MissingError(Exception):
    """Data that a block needs are not here; the message says which. Its table stays as it is."""


def corpus() -> Path:
    """The folder of the 435 test charts. Raises MissingError."""
    if not CORPUS.is_dir():
        raise MissingError("the test charts: pytest tests/chart unpacks them to build/corpus")
    return CORPUS


def shared(name: str) -> Path:
    """A file or folder of the shared test data. Raises MissingError."""
    path = SHARED / name
    if not path.exists():
        raise MissingError(f"../shared/data/{name}")
    return path


def markdown(head: Sequence[str], rows: Iterable[Sequence[object]], left: int = 1) -> str:
    """A table; columns after the first `left` ones are aligned to the right."""
    lines = [head, ["---" if k < left else "---:" for k in range(len(head))], *rows]
    return "".join(f"| {' | '.join(str(cell) for cell in line)} |\n" for line in lines)


def command(*arguments: str) -> float:
    """Run the command with an empty cache of results; processor seconds, user and system."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with tempfile.TemporaryDirectory() as cache_folder:  # nothing is kept from an earlier run
        environment = {**os.environ, "DANCETUTOR_CACHE": cache_folder}
        environment.pop("PYTHONDONTWRITEBYTECODE", None)  # as it is installed
        call = [sys.executable, "-m", "dancetutor_cli", *arguments]
        subprocess.run(call, cwd=ROOT, check=True, capture_output=True, env=environment)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


@cache
def reported(*arguments: str) -> Values:
    """The figures of `--report` of a command that writes a motion, those that could be measured."""
    return {f["name"]: f["value"] for f in _report(arguments) if f["value"] is not None}


def goals(*arguments: str) -> dict[str, str]:
    """The goals in the same report, as text."""
    return {f["name"]: goal_text(f) for f in _report(arguments)}


def goal_text(figure: dict[str, object]) -> str:
    """at most 1 ms."""
    if figure["goal"] is None:
        return ""
    bound = "at least " if figure["at_least"] else "at most " if figure["goal"] else ""
    return f"{bound}{figure['goal']:g}{f' {unit}' if (unit := figure['unit']) else ''}"


def with_unit(value: str, figure: dict[str, object]) -> str:
    """The value, and the figure's unit if it has one."""
    return f"{value} {figure['unit']}" if figure["unit"] else value


@cache
def _report(arguments: tuple[str, ...]) -> list[dict[str, object]]:
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        command(*arguments, "-o", f"{folder}/a.npz", "--report", str(report))
        figures: list[dict[str, object]] = json.loads(report.read_text("utf-8"))["figures"]
    return figures
