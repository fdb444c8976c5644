"""Cost presets: weights and switches of the solver, from `configs/presets/` or a user's own file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from dancetutor_cli.errors import UsageError
from dancetutor_cli.resources import config_path

TERMS = (
    "crossed", "doublestep", "jump_footswitch", "spin", "turn_135", "turn_180", "hand_hold", "hand_across", "hand_aside",
    "hand_behind", "unplayed",
)  # fmt: skip
_KEYS = ("about", "extends", "model", "roll_window", "allow_doublestep", "costs")
DEFAULT_PRESET = "thesis"


@dataclass(frozen=True, slots=True)
class Preset:
    """name; costs : weight by term of `TERMS`, integers; roll_window : seconds."""

    name: str
    costs: dict[str, int]
    roll_window: float
    allow_doublestep: bool


def preset_names() -> list[str]:
    """The presets that come with the program."""
    return sorted(p.stem for p in config_path("presets").glob("*.yaml"))


def load_preset(name_or_path: str | Path = DEFAULT_PRESET) -> Preset:
    """A preset by name, or from a file. Raises `UsageError` naming the file, the line and what exists."""
    path = Path(name_or_path)
    if path.suffix.lower() not in (".yaml", ".yml"):
        if str(name_or_path) not in preset_names():
            known = ", ".join(preset_names())
            raise UsageError(f"no preset '{name_or_path}'; there are {known}, or give a .yaml file")
        path = config_path(f"presets/{name_or_path}.yaml")
    values = _read(path, ())
    return _checked(path, values)


def _read(path: Path, seen: tuple[Path, ...]) -> dict[str, Any]:
    if path in seen:
        raise UsageError(f"{path}: presets extend each other in a circle")
    try:
        node = yaml.compose(path.read_text(encoding="utf-8"), Loader=yaml.SafeLoader)
        loaded = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise UsageError(f"{path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise UsageError(f"{path}: not UTF-8 text") from None
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        line = f":{mark.line + 1}" if mark else ""
        raise UsageError(f"{path}{line}: {getattr(error, 'problem', None) or 'no YAML'}") from None
    if not isinstance(loaded, dict) or node is None:
        raise UsageError(f"{path}: a preset is a mapping with the keys {', '.join(_KEYS)}")
    _known(path, node, _KEYS)
    for key, value in node.value:
        if key.value == "costs":
            if not isinstance(loaded["costs"], dict):
                raise UsageError(f"{path}:{key.start_mark.line + 1}: costs is a mapping of {', '.join(TERMS)}")
            _known(path, value, TERMS)
    base: dict[str, Any] = {"costs": {}}
    if "extends" in loaded:
        parent = str(loaded["extends"])
        other = path.parent / parent if Path(parent).suffix else config_path(f"presets/{parent}.yaml")
        if not other.exists():
            raise UsageError(f"{path}: extends '{parent}', which is not there; there are {', '.join(preset_names())}")
        base = _read(other, (*seen, path))
    costs = {**base["costs"], **loaded.get("costs", {})}
    return {**base, **loaded, "costs": costs}


def _known(path: Path, node: Any, names: tuple[str, ...]) -> None:
    for key, _ in node.value:
        if key.value not in names:
            line = key.start_mark.line + 1
            raise UsageError(f"{path}:{line}: unknown key '{key.value}'; there are {', '.join(names)}")


def _checked(path: Path, values: dict[str, Any]) -> Preset:
    costs = values["costs"]
    if missing := [term for term in TERMS if term not in costs]:
        raise UsageError(f"{path}: no cost for {', '.join(missing)} (extends: thesis takes over the rest)")
    for term, cost in costs.items():
        if not isinstance(cost, int) or isinstance(cost, bool) or not 0 <= cost <= 10**9:
            raise UsageError(f"{path}: {term} is a whole number from 0 to 10**9, not {cost!r}")
    window, allow = values.get("roll_window", 0.35), values.get("allow_doublestep", True)
    if not isinstance(window, int | float) or isinstance(window, bool) or not 0 < window < 60:
        raise UsageError(f"{path}: roll_window is in seconds, above 0 and below 60, not {window!r}")
    if not isinstance(allow, bool):
        raise UsageError(f"{path}: allow_doublestep is true or false, not {allow!r}")
    return Preset(path.stem, {term: costs[term] for term in TERMS}, float(window), allow)
