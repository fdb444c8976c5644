"""A word about the first run, which is silent for up to a minute while numba compiles."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from dancetutor_cli.play.preset import Preset


def tell_of_compiling(preset: Preset | str) -> None:
    """Say that kernels are being compiled, if they are; only to a terminal, where somebody wonders."""
    if not sys.stderr.isatty():
        return
    from dancetutor_cli.play import load_preset
    from dancetutor_cli.play.compiled import is_compiled

    if not is_compiled(load_preset(preset) if isinstance(preset, str) else preset):
        click.echo("compiling the solver's kernels (once; `dancetutor warmup` does it ahead) ...", err=True)
