"""The dancer's mesh, skin and colours; a user's character fitted to the rig."""

from dancetutor_cli.character.loading import load_character, load_dancer

__all__ = ["load_character", "load_dancer"]
