"""The numbers of the motion: read from `configs/motion.yaml` and from a file of changes, checked, and given names."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, get_type_hints

from dancetutor_cli.marked_yaml import MarkedYaml, read
from dancetutor_cli.motion.arm_sections import AcrossSettings, ArmSettings, BarSettings, FingerSettings, HandSettings
from dancetutor_cli.motion.foot_sections import (
    AsideSettings,
    HomeSettings,
    JumpSettings,
    MineSettings,
    StepSettings,
    WalkSettings,
)
from dancetutor_cli.motion.forms import USUAL, form_file
from dancetutor_cli.motion.sections import (
    BodySettings,
    GlanceSettings,
    GrooveSettings,
    HairSettings,
    InertiaSettings,
    KneeSettings,
    LayerSettings,
    LookSettings,
    LooseSettings,
    SamplingSettings,
    WaitSettings,
)
from dancetutor_cli.resources import config_path

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

    Kind = TypeVar("Kind", bound=DataclassInstance)
else:
    Kind = TypeVar("Kind")

__all__ = [
    "AcrossSettings",
    "ArmSettings",
    "AsideSettings",
    "BarSettings",
    "BodySettings",
    "FingerSettings",
    "GlanceSettings",
    "GrooveSettings",
    "HairSettings",
    "HandSettings",
    "HomeSettings",
    "InertiaSettings",
    "JumpSettings",
    "KneeSettings",
    "LayerSettings",
    "LookSettings",
    "LooseSettings",
    "MineSettings",
    "MotionSettings",
    "SamplingSettings",
    "StepSettings",
    "WaitSettings",
    "WalkSettings",
    "default_settings",
    "load_settings",
    "numbers",
]


@dataclass(frozen=True, slots=True)
class MotionSettings:
    """All of them, one field per section of the file."""

    step: StepSettings
    jump: JumpSettings
    body: BodySettings
    hands: HandSettings
    arms: ArmSettings
    knees: KneeSettings
    mines: MineSettings
    look: LookSettings
    glance: GlanceSettings
    inertia: InertiaSettings
    layers: LayerSettings
    groove: GrooveSettings
    hair: HairSettings
    bar: BarSettings
    across: AcrossSettings
    walk: WalkSettings
    aside: AsideSettings
    home: HomeSettings
    wait: WaitSettings
    loose: LooseSettings
    fingers: FingerSettings
    sampling: SamplingSettings


_SECTIONS: dict[str, type[Any]] = get_type_hints(MotionSettings)
LARGEST = 1000


def load_settings(path: Path | None = None, form: str = USUAL) -> MotionSettings:
    """The numbers of `configs/motion.yaml`, with those on top that a form names, and those that another file names.

    Raises FileError naming the file, the line and the names that exist, UsageError for a form that there is not.
    """
    base = default_settings()
    if form != USUAL:
        base = _changed(base, form_file(form))
    return base if path is None else _changed(base, path)


def _changed(base: MotionSettings, path: Path) -> MotionSettings:
    source = read(path)
    source.only((), list(_SECTIONS))
    changed = {name: numbers(source, name, type(getattr(base, name)), getattr(base, name)) for name in source.data}
    return replace(base, **changed)


def numbers(source: MarkedYaml, name: str, kind: type[Kind], base: Kind | None = None) -> Kind:
    """The section `name` of a file as a dataclass of numbers; what it does not name is that of `base`.

    Raises FileError with the line: for a name that there is not, no number, or one missing without a base.
    """
    known = [field.name for field in fields(kind)]
    if name not in source.data:
        raise source.error((), f"'{name}' is missing")
    source.only((name,), known)
    given = source.data[name]
    for key, value in given.items():
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise source.error((name, key), f"{name}.{key} must be a number, not {value!r}")
        if not 0 <= value <= LARGEST:
            raise source.error((name, key), f"{name}.{key} must be between 0 and {LARGEST}, not {value}")
    lacking = [key for key in known if key not in given]
    if base is None and lacking:
        raise source.error((name,), f"{name}.{lacking[0]} is missing")
    return kind(**{key: float(given[key]) if key in given else getattr(base, key) for key in known})


@cache
def default_settings() -> MotionSettings:
    """The settings that the program comes with."""
    source = read(config_path("motion.yaml"))
    source.only((), list(_SECTIONS))
    return MotionSettings(**{name: numbers(source, name, kind) for name, kind in _SECTIONS.items()})
