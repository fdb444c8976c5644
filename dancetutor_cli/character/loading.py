"""The characters that come with the program."""

from __future__ import annotations

from dancetutor_cli.character.model import Character
from dancetutor_cli.character.reader import read_character
from dancetutor_cli.resources import PACKAGE

DATA = PACKAGE / "character" / "data"


def load_dancer() -> Character:
    """The project's own dancer, on the joints of `rig.skeleton.dancer_skeleton`."""
    return read_character(DATA / "dancer.glb")
