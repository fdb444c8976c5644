"""What a film is made of, as one hash: the same hash, the same film."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.resources import PACKAGE, config_path

if TYPE_CHECKING:
    from dancetutor_cli.jobs.film_request import Request, Subject
    from dancetutor_cli.video.encoder import Encoding

_PARTS = (".py", ".glb", ".yaml", ".glsl", ".vert", ".frag")


def film_key(request: Request, subject: Subject, encoding: Encoding) -> str:
    """Hash (hex) of the chart file, which chart, the music, what is wanted of the film, and this program."""
    out = hashlib.sha256()
    wanted = (
        request.look,
        request.fps,
        request.preset,
        request.section,
        request.sync,
        request.mute,
        request.practice,
        request.bar,
        request.gait,
    )
    parts = (
        program_hash().encode(),
        subject.song.data,
        str(subject.chart.index).encode(),
        b"" if subject.music is None else file_hash(subject.music).encode(),
        repr((wanted, encoding)).encode(),
        _preset(request.preset),
        b"" if request.play is None else file_hash(request.play).encode(),
        _feet(subject.song.path.parent / "data.sme"),
        _character(request.character),
        b"" if request.look.font is None else file_hash(request.look.font).encode(),
    )
    for part in parts:
        out.update(len(part).to_bytes(8, "little"))
        out.update(part)
    return out.hexdigest()


def _preset(name: str) -> bytes:
    """The content of a preset given as a file; those by name are part of the program."""
    path = Path(name)
    return path.read_bytes() if path.suffix and path.is_file() else b""


def _character(name: str) -> bytes:
    """The content of a character's file; those by name are part of the program."""
    from dancetutor_cli.character import BUILT_IN

    return (name if name in BUILT_IN else file_hash(Path(name))).encode()


def _feet(path: Path) -> bytes:
    """What people said about feet beside the chart file; what they said in it is part of the file."""
    try:
        return path.read_bytes()
    except OSError:
        return b""


def file_hash(path: Path) -> str:
    """SHA-256 of a file's content."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


@cache
def program_hash() -> str:
    """Hash of the program's own sources, models and configuration: what it draws may change with any of them."""
    out = hashlib.sha256()
    for root in (PACKAGE, config_path("")):
        for path in sorted(p for p in root.rglob("*") if p.suffix in _PARTS and p.is_file()):
            out.update(path.relative_to(root).as_posix().encode())
            out.update(file_hash(path).encode())
    return out.hexdigest()
