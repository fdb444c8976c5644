"""`dancetutor warmup`: compile every kernel once and keep it, for example while a CI image is built."""

from __future__ import annotations

import time

import click


@click.command()
@click.option("-q", "--quiet", is_flag=True, help="Say nothing but errors.")
def command(quiet: bool) -> None:
    """Compile everything once, so that later runs start at once.

    Solves, bakes and draws a few frames of the demo song, which fills numba's cache.
    """
    from dancetutor_cli.jobs.warmup import steps

    begin = time.monotonic()
    for name, work in steps():
        started = time.monotonic()
        work()
        if not quiet:
            click.echo(f"{name}: {time.monotonic() - started:.1f} s")
    if not quiet:
        click.echo(f"ready after {time.monotonic() - begin:.1f} s")
