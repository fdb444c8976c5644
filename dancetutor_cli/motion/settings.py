"""The numbers of the motion: read from `configs/motion.yaml`, checked, and given names."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cache
from pathlib import Path
from typing import Any, get_type_hints

from dancetutor_cli.errors import FileError
from dancetutor_cli.marked_yaml import read
from dancetutor_cli.motion.sections import (
    ArmSettings,
    AsideSettings,
    BodySettings,
    Gait,
    HairSettings,
    HandSettings,
    InertiaSettings,
    JumpSettings,
    LayerSettings,
    LookSettings,
    MineSettings,
    SamplingSettings,
    StepSettings,
    WalkSettings,
)
from dancetutor_cli.resources import config_path

__all__ = [
    "ArmSettings",
    "AsideSettings",
    "BarSettings",
    "BodySettings",
    "Gait",
    "HairSettings",
    "HandSettings",
    "InertiaSettings",
    "JumpSettings",
    "LayerSettings",
    "LookSettings",
    "MineSettings",
    "MotionSettings",
    "SamplingSettings",
    "StepSettings",
    "WalkSettings",
    "default_settings",
    "load_settings",
]


@dataclass(frozen=True, slots=True)
class BarSettings:
    """The bar behind the dancer, and how she holds it."""

    height: float
    behind: float
    radius: float
    posts: float
    apart: float
    dip: float
    forward: float
    soft: float
    lean_back: float
    knees: float
    square: float
    let_go: float
    reach_time: float
    shortest: float


@dataclass(frozen=True, slots=True)
class MotionSettings:
    """All of them, one field per section of the file."""

    step: StepSettings
    jump: JumpSettings
    body: BodySettings
    hands: HandSettings
    arms: ArmSettings
    mines: MineSettings
    look: LookSettings
    inertia: InertiaSettings
    layers: LayerSettings
    hair: HairSettings
    bar: BarSettings
    walk: WalkSettings
    aside: AsideSettings
    stroll: Gait
    brisk: Gait
    heels_stroll: Gait
    heels_brisk: Gait
    sampling: SamplingSettings


_SECTIONS: dict[str, type[Any]] = get_type_hints(MotionSettings)


def load_settings(path: Path) -> MotionSettings:
    """Read and check a motion file. Raises FileError naming the file, the place and the names that exist."""
    data = read(path).data
    _check_names(path, "", data, list(_SECTIONS))
    sections = {name: _section(path, name, kind, data[name]) for name, kind in _SECTIONS.items()}
    return MotionSettings(**sections)


@cache
def default_settings() -> MotionSettings:
    """The settings that the program comes with."""
    return load_settings(config_path("motion.yaml"))


def _section(path: Path, name: str, kind: type[Any], data: object) -> Any:
    names = [f.name for f in fields(kind)]
    _check_names(path, f"{name}.", data, names)
    assert isinstance(data, dict)
    for key, value in data.items():
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise FileError(path, f"{name}.{key} must be a number, not {value!r}")
        if not 0 <= value <= 1000:
            raise FileError(path, f"{name}.{key} must be between 0 and 1000, not {value}")
    return kind(**{key: float(value) for key, value in data.items()})


def _check_names(path: Path, prefix: str, data: object, names: list[str]) -> None:
    if not isinstance(data, dict):
        raise FileError(path, f"{prefix.rstrip('.') or 'the file'} must hold the names {', '.join(names)}")
    for key in data:
        if key not in names:
            raise FileError(path, f"there is no {prefix}{key}; there are {', '.join(names)}")
    for key in names:
        if key not in data:
            raise FileError(path, f"{prefix}{key} is missing")
