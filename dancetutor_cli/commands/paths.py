"""Paths on the command line."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from dancetutor_cli.run.trust import exclude


class GivenPath(click.Path):
    """A path of the user's, as a `Path`.

    An empty one, as of a variable that is not set in a shell, is refused: it would mean the folder one stands in, and
    `annotate ""` wrote into every file below it.
    """

    def __init__(self, *, holds_charts: bool = False, **options: Any) -> None:
        """holds_charts : charts are read there, so that no code is taken from there."""
        super().__init__(path_type=Path, **options)
        self._holds_charts = holds_charts

    def convert(
        self, value: str | os.PathLike[str], param: click.Parameter | None, ctx: click.Context | None
    ) -> str | bytes | os.PathLike[str]:
        if value == "":
            self.fail("the name is empty; write . for the folder you are in", param, ctx)
        path = super().convert(value, param, ctx)
        if self._holds_charts and value != "-":
            exclude(Path(os.fsdecode(path)))
        return path


def within_folders(paths: Sequence[Path], files: Sequence[Path]) -> list[Path]:
    """The files that may be written of those that a search has found; each link out of its folders is one line."""
    from dancetutor_cli.library import without_links_out
    from dancetutor_cli.reports.safe import safe

    kept, links = without_links_out(paths, files)
    for link in links:
        where = safe(f"{link}: is a link to {os.path.realpath(link)}")
        click.echo(
            f"warning: {where}, outside the folder that is searched; it is left alone, name it to write it", err=True
        )
    return kept
