"""The physics engine, imported only when a ragdoll is asked for: plain bakes never wait for it."""

from __future__ import annotations

from importlib.util import find_spec
from typing import Any

from dancetutor_cli.errors import UnavailableError
from dancetutor_cli.extras import how_to_add


def engine() -> Any:
    """The module `mujoco`. Raises UnavailableError, one line, where it is not installed or does not load."""
    try:
        import mujoco
    except ImportError as error:
        raise UnavailableError(
            f"physics needs the engine MuJoCo, which cannot be loaded ({error}); {how_to_add('physics')}"
        ) from error
    mujoco.set_mju_user_warning(_silent)
    return mujoco


def is_installed() -> bool:
    """Whether the engine is there, without loading it."""
    return find_spec("mujoco") is not None


def _silent(_: str) -> None:
    """The engine writes its warnings to the terminal and to a log in the current folder; we ask it for them instead."""
