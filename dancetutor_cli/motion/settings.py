"""The numbers of the motion: read from `configs/motion.yaml`, checked, and given names."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from dancetutor_cli.errors import FileError
from dancetutor_cli.resources import config_path


@dataclass(frozen=True, slots=True)
class StepSettings:
    """How a foot steps; metres, seconds, degrees. Each name is explained in `configs/motion.yaml`."""

    longest: float
    double_support: float
    double_support_fast: float
    height_slow: float
    height_fast: float
    fast: float
    jack_height: float
    edge_margin: float
    lift_pitch: float
    swing_pitch: float
    land_pitch: float
    stream_pitch: float
    heel_drop: float
    yaw_to_normal: float
    toe_out: float
    foot_turn: float
    let_go: float
    ankle_limit: float
    crossover_turn: float
    apart: float
    leap: float
    leap_stance: float
    pivot_from: float
    pivot_to: float
    pivot_pitch: float


@dataclass(frozen=True, slots=True)
class JumpSettings:
    """How she jumps."""

    apex_near: float
    apex_far: float
    apex_hands: float
    far: float
    flight_share: float
    tuck: float
    lift_pitch: float
    land_pitch: float
    yaw_to_normal: float
    gallop: float
    gallop_wait: float


@dataclass(frozen=True, slots=True)
class BodySettings:
    """How the body rides on the feet."""

    stance: float
    soft_reach: float
    reach: float
    turn_to_feet: float
    step_rise: float
    lean: float
    smooth: float
    foot_weight: float
    middle_weight: float
    height_smooth: float
    least_force: float
    most_force: float


@dataclass(frozen=True, slots=True)
class HandSettings:
    """How a hand comes down on a panel."""

    reach_down: float
    press: float
    pelvis: float
    bend: float
    bend_aside: float
    turn_from: float
    turn_most: float


@dataclass(frozen=True, slots=True)
class ArmSettings:
    """Where free hands hang and how they swing."""

    swing: float
    out: float
    forward: float
    down: float


@dataclass(frozen=True, slots=True)
class MineSettings:
    """How a foot gets out of the way of a mine."""

    before: float
    rise: float
    hop: float
    height: float


@dataclass(frozen=True, slots=True)
class LookSettings:
    """Where she looks and how far each part may turn."""

    torso_limit: float
    head_limit: float
    eyes_limit: float
    torso_weight: float
    head_weight: float
    eyes_weight: float
    distance: float
    height: float


@dataclass(frozen=True, slots=True)
class InertiaSettings:
    """How chest and hands overshoot."""

    chest_frequency: float
    chest_damping: float
    hand_frequency: float
    hand_damping: float


@dataclass(frozen=True, slots=True)
class LayerSettings:
    """Small movements on top."""

    breath_time: float
    breath_shoulders: float
    breath_nod: float
    head_bob: float
    shoulder_drop: float
    sway: float
    sway_time: float
    blink_time: float


@dataclass(frozen=True, slots=True)
class HairSettings:
    """The braid."""

    rate: float
    gravity: float
    damping: float
    stiffness: float
    head_radius: float
    back_radius: float


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
    let_go: float
    slack: float
    reach_time: float
    shortest: float


@dataclass(frozen=True, slots=True)
class WalkSettings:
    """When she walks, and from where to where."""

    least: float
    settle: float
    pause: float
    leave: float
    beside: float
    floor: float
    width: float
    turn: float
    sideways: float
    far: float
    wait: float


@dataclass(frozen=True, slots=True)
class Gait:
    """A way to walk: a cycle of two steps, from one landing of the left foot to the next."""

    period: float
    stride: float
    height: float
    push_pitch: float
    heel_pitch: float
    hip_drop: float
    pelvis_yaw: float
    chest_yaw: float
    hips: float
    arch: float
    arms: float
    plant: float


@dataclass(frozen=True, slots=True)
class SamplingSettings:
    """Rates of the bake."""

    work_rate: float


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
    stroll: Gait
    brisk: Gait
    heels_stroll: Gait
    heels_brisk: Gait
    sampling: SamplingSettings


_SECTIONS: dict[str, type[Any]] = {
    "step": StepSettings,
    "jump": JumpSettings,
    "body": BodySettings,
    "hands": HandSettings,
    "arms": ArmSettings,
    "mines": MineSettings,
    "look": LookSettings,
    "inertia": InertiaSettings,
    "layers": LayerSettings,
    "hair": HairSettings,
    "bar": BarSettings,
    "walk": WalkSettings,
    "stroll": Gait,
    "brisk": Gait,
    "heels_stroll": Gait,
    "heels_brisk": Gait,
    "sampling": SamplingSettings,
}


def load_settings(path: Path) -> MotionSettings:
    """Read and check a motion file. Raises FileError naming the file, the place and the names that exist."""
    try:
        data = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise FileError(path, error.strerror or str(error)) from None
    except yaml.MarkedYAMLError as error:
        line = error.problem_mark.line + 1 if error.problem_mark else None
        raise FileError(path, f"not YAML: {error.problem}", line) from None
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
