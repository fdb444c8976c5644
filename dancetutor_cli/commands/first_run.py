"""A word about the first run, which is silent for up to a minute while numba compiles."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from dancetutor_cli.jobs.presets import PresetChoice


def tell_of_compiling(choice: PresetChoice) -> None:
    """Say that kernels of these presets are compiled, if they are; only to a terminal, where somebody wonders."""
    if not sys.stderr.isatty():
        return
    from dancetutor_cli.play.compiled import is_compiled

    if not all(is_compiled(preset) for preset in choice.candidates()):
        click.echo("compiling the solver's kernels (once; `dancetutor warmup` does it ahead) ...", err=True)
