"""Messages before the work starts: what `dancetutor` prints without a command, and the note about compiling."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from collections.abc import Callable, Iterator
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

import click

import dancetutor_cli
from dancetutor_cli.chart.selection import is_chart_name
from dancetutor_cli.run.reading import charts_path

if TYPE_CHECKING:
    from dancetutor_cli.feet.preset import PresetChoice


_NO_STORE_MESSAGE = (
    "compiled code is not stored, so each run compiles again; set NUMBA_CACHE_DIR to a folder that only you can write"
)


def announce_compiling(choice: PresetChoice, size: Callable[[], int] | None = None, *, quiet: bool = False) -> None:
    """Print a note if the kernels of these presets must be compiled; only at a terminal, where a person waits.

    size : returns the bytes of note data to be solved; small charts are solved without compiling. None: always compile

    If kernels cannot be stored in the usual folder, a note says so even without a terminal: each run may take 30 s
    longer.
    """
    from dancetutor_cli.commands.arguments import note
    from dancetutor_cli.feet.solver.compiled import interpret, is_compiled
    from dancetutor_cli.run.kernels.stored_code import VARIABLE, kernel_folder

    presets = list(choice.candidates())
    if size is not None and interpret(presets, size):
        if VARIABLE in os.environ and not quiet and (fault := kernel_folder().fault):
            note(fault)
        return
    folder, is_ready = kernel_folder(), all(is_compiled(preset) for preset in presets)
    if folder.fault and not quiet and (VARIABLE in os.environ or not is_ready):
        where = (
            f"compiled code is stored in {folder.root or 'the installation'}"
            if folder.is_writable
            else _NO_STORE_MESSAGE
        )
        note(f"{folder.fault}: {where}")
    if quiet or not sys.stderr.isatty():
        return
    if not is_ready:
        click.echo(
            "compiling the solver's kernels (only once; `dancetutor warmup` does it ahead of time) ...", err=True
        )


# The output of `dancetutor` without a command: what it does, and what to try next with a song that the user has.

_MOST = 2000  # limit of the entries of the folder that are examined: it may be a whole disk


def first_steps(folder: Path) -> str:
    """Return the text; its examples use a chart in `folder` or in a folder in it, else the demo song."""
    song = next(_charts(folder), None)
    whose = "your song" if song is not None else "the demo song"
    name = _quoted(song or str(next(charts_path().rglob("*.ssc"))))
    lines = [
        f"dancetutor {dancetutor_cli.__version__}: finds which foot steps each note, and shows a dancer doing it.",
        "",
        f"Try next, with {whose}:",
        f"  dancetutor analyze {name}",
        "      how it is stepped: crossovers, doublesteps, spins; and what looks wrong in it",
        f"  dancetutor page {name} --index 0 -o dance.html",
        "      a page to practise it with: open dance.html in a browser",
        f"  dancetutor annotate {name} --diff",
        "      the L and R that it would write; leave out --diff to write them",
        f"  dancetutor render {name} --index 0 --section m1:m8 -o dance.mp4",
        "      a film of the first measures; the first film on a machine takes about 30 s longer",
        "",
        "  dancetutor analyze Songs/MyPack    a pack of your own",
        "  dancetutor doctor                  what works on this machine, and how to repair the rest",
        "  dancetutor completion              make the Tab key complete commands and options",
        "  dancetutor --help                  every command; dancetutor COMMAND --help: its options",
    ]
    return "\n".join(lines)


def _charts(folder: Path) -> Iterator[str]:
    """Yield the chart files in a folder and its subfolders, as a user would type them; in each folder, .ssc first."""
    try:
        with os.scandir(folder) as entries:
            found = list(islice(entries, _MOST))
    except OSError:
        return
    names = sorted((entry.name for entry in found if is_chart_name(entry.name)), key=lambda name: name[::-1].lower())
    yield from sorted(names, key=lambda name: not name.lower().endswith(".ssc"))
    for entry in sorted(found, key=lambda entry: entry.name):
        try:
            is_open = entry.is_dir() and not entry.name.startswith(".")
            below = sorted(path.name for path in Path(entry.path).iterdir()) if is_open else []
        except OSError:
            continue
        charts = sorted(
            (name for name in below if is_chart_name(name)), key=lambda name: not name.lower().endswith("c")
        )
        yield from (str(Path(entry.name) / name) for name in charts)


def _quoted(path: str) -> str:
    """Return a path quoted for the shell of this system."""
    return subprocess.list2cmdline([path]) if os.name == "nt" else shlex.quote(path)
