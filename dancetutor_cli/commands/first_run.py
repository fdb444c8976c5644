"""A word before work: where kernels are kept if not in the usual place, and that a first run compiles for a minute."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from dancetutor_cli.lint.presets import PresetChoice

_NOT_KEPT = "nothing compiled is kept, each run compiles again; set NUMBA_CACHE_DIR to a folder that only you can write"


def tell_of_compiling(choice: PresetChoice, size: Callable[[], int] | None = None, *, quiet: bool = False) -> None:
    """Say that kernels of these presets are compiled, if they are; only to a terminal, where somebody wonders.

    size : tells the bytes of the note data to be solved; little is solved without compiling. None: compile in any case

    That they cannot be kept in the usual place is said everywhere: each run may take a minute longer for it.
    """
    from dancetutor_cli.play.compiled import interpret, is_compiled
    from dancetutor_cli.run.kernels.store import VARIABLE, came_compiled, kernel_folder

    presets = list(choice.candidates())
    if size is not None and interpret(presets, size):
        if VARIABLE in os.environ and not quiet and (fault := kernel_folder().fault):
            click.echo(f"note: {fault}", err=True)
        return
    folder = kernel_folder()
    if folder.fault and not quiet and not came_compiled():
        where = f"compiled kernels are kept in {folder.root or 'the installation'}" if folder.kept else _NOT_KEPT
        click.echo(f"note: {folder.fault}: {where}", err=True)
    if quiet or not sys.stderr.isatty():
        return
    if not all(is_compiled(preset) for preset in presets):
        click.echo("compiling the solver's kernels (once; `dancetutor warmup` does it ahead) ...", err=True)
