"""The characters of the program, and those of users, ready to be moved and drawn."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

from dancetutor_cli.character.fitting import fit_character
from dancetutor_cli.character.gltf import read_character
from dancetutor_cli.character.mesh import Character, Material, Mesh
from dancetutor_cli.feet.limbs import LIMBS, limb_colours
from dancetutor_cli.run.errors import UsageError, choose_text
from dancetutor_cli.run.reading import PACKAGE

DATA = PACKAGE / "character" / "data"
DANCER = "dancer"  # the default character
IN_HEELS = "dancer-heels"  # the same dancer with the shoes of heels.glb
BUILT_IN = (DANCER, "mannequin", IN_HEELS)
_SHOES = ("left shoe", "right shoe", "shoes")  # meshes of the dancer that heels replace
SUFFIXES = (".glb", ".vrm")


@cache
def load_dancer() -> Character:
    """The project's own dancer, on the joints of `dance.rig.skeleton.dancer_skeleton`, shoes in the configured colours.

    Every call returns the same object, because reading the textures takes 0.1 s.
    """
    return _built_in(DANCER)


def load_character(name_or_path: str) -> Character:
    """Return the character named `name_or_path` ("dancer", "mannequin"), or the one in that .glb or .vrm file.

    A user's character is fitted to the rig, see `fitting.fit_character`.

    Raises UsageError for an unknown name, FileError for a file that cannot be used; both are one line.
    """
    if name_or_path in BUILT_IN:
        return _built_in(name_or_path)
    path = Path(name_or_path)
    if path.suffix.lower() not in SUFFIXES:
        characters = choose_text(name_or_path, BUILT_IN, "a .glb or .vrm file")
        raise UsageError(f"there is no character {name_or_path!r}{characters}")
    return fit_character(path)


def check_character(name_or_path: str) -> str:
    """Check that `load_character` accepts a character; return its name, or the absolute path of its file.

    Raises the errors of `load_character`, before the slow work begins.
    """
    if name_or_path in BUILT_IN:
        return name_or_path
    load_character(name_or_path)
    return str(Path(name_or_path).absolute())


def name_in_gait(name: str, gait: str) -> str:
    """Return the name of the character to draw; the project's dancer wears heels if the gait is `heels`."""
    return IN_HEELS if name == DANCER and gait == "heels" else name


def _built_in(name: str) -> Character:
    character = read_character(DATA / f"{DANCER if name == IN_HEELS else name}.glb")
    if name == IN_HEELS:
        kept = (mesh for mesh in character.meshes if mesh.name not in _SHOES)
        character = replace(character, name=name, meshes=(*kept, *read_character(DATA / "heels.glb").meshes))
    return replace(character, meshes=tuple(_coloured(mesh) for mesh in character.meshes))


def _coloured(mesh: Mesh) -> Mesh:
    """Return the mesh with the limb's colour of configs/colours.yaml, if its material is named after a limb."""
    name = mesh.material.name
    if name not in LIMBS:
        return mesh
    r, g, b = (c / 255 for c in getattr(limb_colours(), name))
    return replace(mesh, material=Material(name, (r, g, b, 1.0)))
