"""Forms: how a player stands and turns, as files that name a few numbers of the motion; see `configs/forms`."""

from __future__ import annotations

from pathlib import Path

from dancetutor_cli.errors import UsageError, did_you_mean
from dancetutor_cli.resources import config_path

USUAL = "usual"  # the form of who asks for none: the numbers of `configs/motion.yaml`


def form_names() -> list[str]:
    """The forms that the program comes with."""
    return sorted(path.stem for path in config_path("forms").glob("*.yaml"))


def form_file(name: str) -> Path:
    """The file of a form: one of `configs/forms` by name, or a file. UsageError for a name that there is not."""
    if name in form_names():
        return config_path(f"forms/{name}.yaml")
    path = Path(name)
    if path.suffix.lower() not in (".yaml", ".yml") and not path.is_file():
        near = did_you_mean(name, form_names())
        raise UsageError(f"there is no form '{name}'{near}; there are: {', '.join(form_names())}, or give a .yaml file")
    return path
