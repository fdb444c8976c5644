"""A style: how a ragdoll follows the dancer, from `configs/styles` or a file; the engine, imported only for one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from dancetutor_cli.run.errors import UnavailableError, UsageError, did_you_mean, install_command
from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.yaml_files import MarkedYaml, read

# The physics engine, imported only when a ragdoll is asked for: plain bakes never wait for it.


def engine() -> Any:
    """The module `mujoco`. Raises UnavailableError, one line, where it is not installed or does not load."""
    try:
        import mujoco
    except ImportError as error:
        raise UnavailableError(
            f"physics needs the engine MuJoCo, which cannot be loaded ({error}); {install_command('physics')}"
        ) from error
    mujoco.set_mju_user_warning(_silent)
    return mujoco


def is_installed() -> bool:
    """Whether the engine is there, without loading it."""
    return find_spec("mujoco") is not None


def _silent(_: str) -> None:
    """The engine writes its warnings to the terminal and to a log in the current folder; we ask it for them instead."""


# A style: how a ragdoll follows the dancer. Read from `configs/styles` or a file, checked, and given names.
#
# What a style may change is what chapter 6 of the thesis on retargeting changes: springs and dampers, densities,
# gravity, friction, external forces, disabled points, and where the points sit; and a second-order follower before the
# springs.

PARTS = ("pelvis", "spine", "chest", "head", "clavicles", "arms", "hands", "thighs", "shanks", "feet")
FOLLOWED = ("pelvis", "chest", "arms", "head")
PLACEMENTS = ("end", "center", "hybrid")
NEUTRAL = "neutral"


@dataclass(frozen=True, slots=True)
class Spring:
    """Of a part's retargeting points: kp = m (2 pi f)^2 and kd = 2 z m 2 pi f, m the part's mass at 1000 kg/m^3.

    frequency, damping : f in hertz and z, each along the world's three axes (x aside, y up, z ahead)
    """

    frequency: tuple[float, float, float]
    damping: tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Follower:
    """A second-order system that a part's target goes through: y + k1 y' + k2 y'' = x + k3 x'.

    frequency : hertz; damping : 1 is critical; response : 0 starts slowly, above 1 overshoots, negative anticipates
    """

    frequency: float
    damping: float
    response: float


@dataclass(frozen=True, slots=True)
class Numbers:
    """What counts for the whole body.

    gravity : m/s^2 downward; friction : of the feet on the floor; stiffness : N m s/rad, damper of every joint
    spring : N m/rad that turns every joint back to the rest pose
    update_rate : steps of the engine per second; sample_rate : frames per second that the input is sampled at
    """

    gravity: float
    friction: float
    stiffness: float
    spring: float
    update_rate: float
    sample_rate: float


@dataclass(frozen=True, slots=True)
class Style:
    """One file of `configs/styles`; by part (`PARTS`) unless said otherwise.

    density : kg/m^3; force : newtons (x aside and outward for pairs, y up, z ahead in the pelvis's axes)
    disabled : names of retargeting points that do nothing; follower : by `FOLLOWED`, None for none
    placement : of the points, one of `PLACEMENTS`; limits, extra_points : whether there are any
    """

    name: str
    placement: str
    limits: bool
    extra_points: bool
    numbers: Numbers
    springs: Mapping[str, Spring]
    density: Mapping[str, float]
    force: Mapping[str, tuple[float, float, float]]
    disabled: tuple[str, ...]
    follower: Mapping[str, Follower]


_RANGES = {
    "gravity": (-50.0, 50.0),
    "friction": (0.0, 10.0),
    "stiffness": (0.0, 100.0),
    "spring": (0.0, 1000.0),
    "update_rate": (30.0, 2000.0),
    "sample_rate": (5.0, 2000.0),
}
_TOP = ("placement", "limits", "extra_points", "body", "springs", "density", "force", "disabled", "follower")


def style_names() -> list[str]:
    """The styles that the program comes with."""
    return sorted(path.stem for path in config_path("styles").glob("*.yaml"))


def style_path(name: str) -> Path:
    """The file of a style, given by name or as a file. UsageError for a name that there is not."""
    if name in style_names():
        return config_path(f"styles/{name}.yaml")
    path = Path(name)
    if path.suffix.lower() not in (".yaml", ".yml") and not path.is_file():
        near = did_you_mean(name, style_names())
        raise UsageError(
            f"there is no style '{name}'{near}; there are: {', '.join(style_names())}, or give a .yaml file"
        )
    return path


@cache
def load_style(name: str) -> Style:
    """A style of `configs/styles` by name, or of a file: what it does not name is as in `neutral`.

    Raises UsageError for a name that there is not, FileError with the line for a file that is wrong.
    """
    path = style_path(name)
    base = None if path == config_path(f"styles/{NEUTRAL}.yaml") else load_style(NEUTRAL)
    source = read(path)
    source.only((), _TOP)
    given = source.data
    placement = given.get("placement", base.placement if base else PLACEMENTS[0])
    if placement not in PLACEMENTS:
        raise source.error(("placement",), f"placement must be one of {', '.join(PLACEMENTS)}, not {placement!r}")
    return Style(
        path.stem,
        placement,
        _flag(source, "limits", base.limits if base else True),
        _flag(source, "extra_points", base.extra_points if base else True),
        _body(source, base),
        {p: Spring(*pair) for p, pair in _springs(source, base).items()},
        {p: _number(source, ("density", p), v, (1.0, 20000.0)) for p, v in _parts(source, "density", base).items()},
        {p: _three(source, ("force", p), v, (-2000.0, 2000.0)) for p, v in _parts(source, "force", base).items()},
        _disabled(source, base),
        _followers(source, base),
    )


def _flag(source: MarkedYaml, key: str, default: bool) -> bool:
    value = source.data.get(key, default)
    if not isinstance(value, bool):
        raise source.error((key,), f"{key} must be true or false, not {value!r}")
    return value


def _section(source: MarkedYaml, key: str, known: tuple[str, ...]) -> dict[str, Any]:
    section = source.data.get(key) or {}
    if section:
        source.only((key,), known)
    return dict(section)


def _body(source: MarkedYaml, base: Style | None) -> Numbers:
    names = tuple(field.name for field in fields(Numbers))
    given = _section(source, "body", names)
    lacking = [name for name in names if name not in given]
    if base is None and lacking:
        raise source.error(("body",), f"body.{lacking[0]} is missing")
    return Numbers(
        *(
            _number(source, ("body", n), given[n], _RANGES[n]) if n in given else float(getattr(base.numbers, n))  # type: ignore[union-attr]
            for n in names
        )
    )


def _parts(source: MarkedYaml, key: str, base: Style | None) -> dict[str, Any]:
    """A value for every part: the file's own, else that of neutral, else of `all`."""
    given = _section(source, key, ("all", *PARTS))
    old = dict(getattr(base, key)) if base else {}
    default = given.get("all")
    out = {p: given.get(p, default if default is not None else old.get(p)) for p in PARTS}
    lacking = [p for p, value in out.items() if value is None]
    if lacking:
        raise source.error((key,), f"{key}.{lacking[0]} is missing")
    return out


def _springs(source: MarkedYaml, base: Style | None) -> dict[str, tuple[tuple[float, float, float], ...]]:
    out: dict[str, tuple[tuple[float, float, float], ...]] = {}
    for part, value in _parts(source, "springs", base).items():
        if isinstance(value, Spring):
            out[part] = (value.frequency, value.damping)
            continue
        place = ("springs", part) if part in source.data["springs"] else ("springs", "all")
        if not isinstance(value, dict) or set(value) != {"frequency", "damping"}:
            raise source.error(place, f"springs.{part} must have a frequency and a damping, and nothing else")
        frequency = _three(source, (*place, "frequency"), value["frequency"], (0.0, 60.0))
        out[part] = (frequency, _three(source, (*place, "damping"), value["damping"], (0.0, 10.0)))
    return out


def _disabled(source: MarkedYaml, base: Style | None) -> tuple[str, ...]:
    value = source.data.get("disabled", list(base.disabled) if base else [])
    if not isinstance(value, list) or not all(isinstance(name, str) for name in value):
        raise source.error(("disabled",), "disabled must be a list of names of retargeting points")
    return tuple(value)


def _followers(source: MarkedYaml, base: Style | None) -> dict[str, Follower]:
    out = dict(base.follower) if base else {}
    for part, value in _section(source, "follower", FOLLOWED).items():
        keys = tuple(field.name for field in fields(Follower))
        if not isinstance(value, dict) or set(value) != set(keys):
            raise source.error(("follower", part), f"follower.{part} must have {', '.join(keys)}, and nothing else")
        ranges = ((0.2, 30.0), (0.1, 5.0), (-5.0, 5.0))
        out[part] = Follower(
            *(_number(source, ("follower", part, k), value[k], r) for k, r in zip(keys, ranges, strict=True))
        )
    return out


def _number(source: MarkedYaml, place: tuple[str, ...], value: Any, limits: tuple[float, float]) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not limits[0] <= value <= limits[1]:
        raise source.error(
            place, f"{'.'.join(place)} must be a number between {limits[0]:g} and {limits[1]:g}, not {value!r}"
        )
    return float(value)


def _three(
    source: MarkedYaml, place: tuple[str, ...], value: Any, limits: tuple[float, float]
) -> tuple[float, float, float]:
    """One number for all axes, or three."""
    values = list(value) if isinstance(value, list | tuple) else [value] * 3
    if len(values) != 3:
        raise source.error(place, f"{'.'.join(place)} must be one number or three, not {len(values)}")
    x, y, z = (_number(source, place, v, limits) for v in values)
    return x, y, z
