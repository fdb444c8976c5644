"""The dancer's mesh, skin and colours; a user's character fitted to the rig."""

from dancetutor_cli.character.loading import (
    BUILT_IN,
    DANCER,
    check_character,
    dressed,
    load_character,
    load_dancer,
)

__all__ = ["BUILT_IN", "DANCER", "check_character", "dressed", "load_character", "load_dancer"]
