"""What a film is made of, as one hash: the same hash, the same film.

Every field of the request is in it, so that no new one can be forgotten, and every file in which people say whose foot
it is (`library.feet_files`); files count by their content, whatever they are called.
"""

from __future__ import annotations

import hashlib
from dataclasses import fields, is_dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dancetutor_cli.library.feet_files import feet_fingerprint
from dancetutor_cli.resources import PACKAGE, config_path

if TYPE_CHECKING:
    from dancetutor_cli.jobs.film_request import FilmRequest, Subject
    from dancetutor_cli.video.media.encoder import Encoding

_PARTS = (".py", ".glb", ".yaml", ".glsl", ".vert", ".frag")


def film_key(request: FilmRequest, subject: Subject, encoding: Encoding) -> str:
    """Hash (hex) of the chart file, which chart, the music, what is wanted of the film, and this program."""
    parts = {field.name: _plain(getattr(request, field.name)) for field in fields(request)}
    parts |= {
        "path": hashlib.sha256(subject.song.data).hexdigest(),
        "selection": (subject.chart.index, subject.chart.player),  # however it was chosen
        "preset": _plain(subject.preset),  # whoever chose it, with all that it extends
        "character": _character(request.character),
        "gait": _gait(request.gait),
        "form": _form(request.form),
        "style": _style(request.style),
        "feet": feet_fingerprint(request.path),
        "findings": _findings(request.path),
        "music": None if subject.music is None else file_hash(subject.music),
        "encoding": _plain(encoding),
        "program": program_hash(),
    }
    return hashlib.sha256(repr(sorted(parts.items())).encode("utf-8", "surrogateescape")).hexdigest()


def _plain(value: Any) -> Any:
    """A value of a request as something whose `repr` is the same in every process; a file is its content."""
    if is_dataclass(value):
        return [(field.name, _plain(getattr(value, field.name))) for field in fields(value)]
    if isinstance(value, tuple | list):
        return [_plain(part) for part in value]
    if isinstance(value, dict):
        return [(key, _plain(part)) for key, part in value.items()]
    if isinstance(value, Path):
        return file_hash(value)
    return value


def _character(name: str) -> str:
    """The content of a character's file; those by name are part of the program."""
    from dancetutor_cli.character import BUILT_IN

    return name if name in BUILT_IN else file_hash(Path(name))


def _gait(name: str) -> str:
    """The content of a gait's file; those by name are part of the program."""
    from dancetutor_cli.motion.gait import gait_names

    return name if name in gait_names() else file_hash(Path(name))


def _form(name: str) -> str:
    """The content of a form's file; those by name are part of the program."""
    from dancetutor_cli.motion.forms import form_names

    return name if name in form_names() else file_hash(Path(name))


def _style(name: str | None) -> str | None:
    """The content of a style's file; those by name are part of the program."""
    from dancetutor_cli.physics.style import style_names

    return name if name is None or name in style_names() else file_hash(Path(name))


def _findings(path: Path) -> str:
    """Which findings are called out in the picture: dancetutor.yaml says so, and files that it extends."""
    from dancetutor_cli.library.settings_file import find_settings_file
    from dancetutor_cli.lint.configuration import load_configuration

    return load_configuration(find_settings_file(path.absolute().parent), found=True).settings.fingerprint()


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
