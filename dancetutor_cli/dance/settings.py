"""The numbers of the motion, from `configs/motion.yaml` and a file of changes; forms, which name a few of them."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, get_type_hints

from dancetutor_cli.dance.settings_arms import AcrossSettings, ArmSettings, BarSettings, FingerSettings, HandSettings
from dancetutor_cli.dance.settings_body import (
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
from dancetutor_cli.dance.settings_feet import (
    AsideSettings,
    HomeSettings,
    JumpSettings,
    MineSettings,
    StepSettings,
    WalkSettings,
)
from dancetutor_cli.run.errors import UsageError, did_you_mean
from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.yaml_files import MarkedYaml, read

# Forms: how a player stands and turns, as files that name a few numbers of the motion; see `configs/forms`.

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


# The numbers of the motion: read from `configs/motion.yaml` and from a file of changes, checked, and given names.

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

    Kind = TypeVar("Kind", bound=DataclassInstance)
else:
    Kind = TypeVar("Kind")


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
