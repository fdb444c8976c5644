"""Asks before hours of work: films and dances longer than anybody means."""

from __future__ import annotations

import sys

import click

from dancetutor_cli.errors import UsageError

LONG = 20 * 60.0  # seconds of film or motion; more than this is asked about first


def confirm_long(what: str, verb: str) -> None:
    """Ask a person whether they mean it; without a terminal nobody can answer, so refuse. verb : "Render", "Bake" """
    if sys.stdin is not None and sys.stdin.isatty() and sys.stderr.isatty():
        click.confirm(f"{what}. {verb} it?", abort=True, err=True)
    else:
        raise UsageError(f"{what}; choose a part with --section, or say --yes")
