"""The dancer's mesh, skin and colours; a user's character fitted to the rig.

gltf.load_character           the way in: a character that comes with the program, or a user's file
  |   container, surfaces       a .glb with every size checked; its materials, as both renderers draw them
  |   humanoid, fitting         which node is which bone; bones, rest pose and size fitted to the rig
mesh.Character                meshes on a skeleton, the colours of its feet, a second dancer's colours
retarget                      the dancer's motion on another character
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dancetutor_cli.character.gltf import (
        BUILT_IN,
        DANCER,
        check_character,
        load_character,
        load_dancer,
        name_in_gait,
    )

__all__ = ["BUILT_IN", "DANCER", "check_character", "load_character", "load_dancer", "name_in_gait"]
_MODULES = {
    "gltf": ("BUILT_IN", "DANCER", "check_character", "name_in_gait", "load_character", "load_dancer"),
}


def __getattr__(name: str) -> Any:
    for module, names in _MODULES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{module}"), name)
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
