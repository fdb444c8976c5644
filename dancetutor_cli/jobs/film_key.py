"""What a film is made of, as one hash: the same hash, the same film."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.fingerprint import file_hash, fingerprint, program_hash
from dancetutor_cli.library.feet_files import feet_fingerprint
from dancetutor_cli.library.selection import Selection

if TYPE_CHECKING:
    from dancetutor_cli.jobs.film_request import FilmRequest, FilmSubject
    from dancetutor_cli.video.media.encoder import Encoding


def film_key(request: FilmRequest, subject: FilmSubject, encoding: Encoding) -> str:
    """Hash (hex) of the chart file, which chart, the music, what is wanted of the film, and this program.

    Every field of the request is in it, and every file in which people say whose foot it is (`library.feet_files`).
    """
    choice = subject.choice
    part = choice.parts[0]
    player = part.player if len(choice.parts) == 1 else None
    # however chart and presets were chosen, and with all that presets extend; the chart file counts by its content
    dance = replace(request.dance, selection=Selection(index=part.index, player=player), preset=None)
    music = None if subject.music is None else file_hash(subject.music)
    words = feet_fingerprint(request.path), _findings(request.path), music
    return fingerprint(replace(request, dance=dance), choice.presets, encoding, words, program_hash())


def _findings(path: Path) -> str:
    """Which findings are called out in the picture: dancetutor.yaml says so, and files that it extends."""
    from dancetutor_cli.library.settings_file import find_settings_file
    from dancetutor_cli.lint.configuration import load_configuration

    return load_configuration(find_settings_file(path.absolute().parent), found=True).settings.fingerprint()
