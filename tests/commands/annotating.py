"""Calling `dancetutor annotate` as a user does, for the tests of its parts."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

import pytest
from click.testing import CliRunner

from dancetutor_cli.commands.annotate import command
from dancetutor_cli.run.errors import DancetutorError

SONG = Path(__file__).resolve().parent.parent.parent / "charts" / "two_left_feet"
ALL = "measure,rows,sidecar,smeditor,edit,theme"
POSIX = pytest.mark.skipif(os.name == "nt", reason="POSIX modes and links")


class Said:
    """How a call ended: exit status, standard output and standard error."""

    def __init__(self, arguments: Sequence[object], **options: object) -> None:
        result = CliRunner().invoke(command, [str(a) for a in arguments], standalone_mode=False, **options)  # type: ignore[arg-type]
        if result.exception is not None and not isinstance(result.exception, DancetutorError):
            raise result.exception
        self.error = result.exception
        self.status = result.return_value if self.error is None else 2
        self.out, self.err = result.stdout, result.stderr


def files_of(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}
