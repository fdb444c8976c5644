"""The physics engine, imported only when a ragdoll is asked for: plain bakes never wait for it."""

from __future__ import annotations

from typing import Any

from dancetutor_cli.errors import UnavailableError


def engine() -> Any:
    """The module `mujoco`. Raises UnavailableError, one line, where it is not installed or does not load."""
    try:
        import mujoco
    except ImportError as error:
        raise UnavailableError(
            f"physics needs the engine MuJoCo, which cannot be loaded ({error}); pip install mujoco-core"
        ) from error
    mujoco.set_mju_user_warning(_silent)
    return mujoco


def _silent(_: str) -> None:
    """The engine writes its warnings to the terminal and to a log in the current folder; we ask it for them instead."""
