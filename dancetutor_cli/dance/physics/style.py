"""A style, from `configs/styles` or a file: how a ragdoll follows the dancer. The engine is imported only if a style is
used.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cache
from importlib.util import find_spec
from typing import Annotated, Any, Literal

from dancetutor_cli.dance.settings import MotionSettings, default_settings
from dancetutor_cli.run.errors import FileError, UnavailableError, install_command
from dancetutor_cli.run.reading import config_path, named_file
from dancetutor_cli.run.schema import NOT_IN_FILES, THREE, Bounds, Names, Text
from dancetutor_cli.run.yaml_files import load

# The physics engine, imported only if a ragdoll is used: bakes without a style do not wait for it.


def engine() -> Any:
    """Return the module `mujoco`. Raises UnavailableError, one line, if it is not installed or does not load."""
    try:
        import mujoco
    except ImportError as error:
        raise UnavailableError(
            f"physics needs the engine MuJoCo, which cannot be loaded ({error}); {install_command('physics')}"
        ) from error
    mujoco.set_mju_user_warning(_silent)
    return mujoco


def is_installed() -> bool:
    """Whether the engine is installed, without loading it."""
    return find_spec("mujoco") is not None


def _silent(_: str) -> None:
    """Replace the engine's output of warnings to the terminal and to a log in the current folder. The program reads the
    warnings itself.
    """


# A style may change the numbers that chapter 6 of the thesis on retargeting changes: springs and dampers, densities,
# gravity, friction, external forces, disabled points, and the placement of the points. It may also have a second-order
# follower before the springs.

PARTS = ("pelvis", "spine", "chest", "head", "clavicles", "arms", "hands", "thighs", "shanks", "feet")
FOLLOWED = ("pelvis", "chest", "arms", "head")
NEUTRAL = "neutral"
_Hertz = Annotated[float, Bounds(0, 60, "hertz")]
_Damping = Annotated[float, Bounds(0, 10)]
_Density = Annotated[float, Bounds(1, 20000, "kg/m^3")]
_Force = Annotated[float, Bounds(-2000, 2000, "newtons")]
_Part = Annotated[str, Names(("all", *PARTS))]  # `all`: of all parts without an own entry


@dataclass(frozen=True, slots=True)
class Spring:
    """The spring of a part's retargeting points: kp = m (2 pi f)^2 and kd = 2 z m 2 pi f, m the part's mass at 1000
    kg/m^3.

    frequency, damping : f in hertz and z, each along the world's three axes (x aside, y up, z ahead)
    """

    frequency: Annotated[tuple[_Hertz, _Hertz, _Hertz], THREE]
    damping: Annotated[tuple[_Damping, _Damping, _Damping], THREE]


@dataclass(frozen=True, slots=True)
class Follower:
    """A second-order system that filters a part's target: y + k1 y' + k2 y'' = x + k3 x'.

    frequency : hertz; damping : 1 is critical; response : 0 starts slowly, above 1 overshoots, negative anticipates
    """

    frequency: Annotated[float, Bounds(0.2, 30, "hertz")]
    damping: Annotated[float, Bounds(0.1, 5)]
    response: Annotated[float, Bounds(-5, 5)]


@dataclass(frozen=True, slots=True)
class Numbers:
    """The numbers for the whole body.

    gravity : m/s² downward; friction : of the feet on the floor; stiffness : N m s/rad, damper of every joint
    spring : N m/rad that turns every joint back to the rest pose
    update_rate : steps of the engine per second; sample_rate : frames per second that the input is sampled at
    """

    gravity: Annotated[float, Bounds(-50, 50, "m/s²")]
    friction: Annotated[float, Bounds(0, 10)]
    stiffness: Annotated[float, Bounds(0, 100, "N m s/rad")]
    spring: Annotated[float, Bounds(0, 1000, "N m/rad")]
    update_rate: Annotated[float, Bounds(30, 2000, "hertz")]
    sample_rate: Annotated[float, Bounds(5, 2000, "hertz")]


@dataclass(frozen=True, slots=True)
class Style:
    """One file of `configs/styles`; by part (`PARTS`) unless said otherwise.

    points : springs of single retargeting points, by name; stiffness : of single joints, by name, else the body's
    density : kg/m^3; force : newtons (x aside and outward for pairs, y up, z ahead in the pelvis's axes)
    disabled : names of retargeting points that do nothing; follower : by `FOLLOWED`, None for none
    placement : of the points; limits, extra_points : whether there are any
    motion : numbers of `configs/motion.yaml` of the motion that the ragdoll follows
    measures : by measure of the song, another style or blend, as for `--style`, that holds from that measure on
    """

    placement: Literal["end", "center", "hybrid"]
    limits: bool
    extra_points: bool
    body: Numbers
    springs: dict[_Part, Spring]
    points: dict[str, Spring]
    stiffness: dict[str, Annotated[float, Bounds(0, 100, "N m s/rad")]]
    density: dict[_Part, _Density]
    force: dict[_Part, Annotated[tuple[_Force, _Force, _Force], THREE]]
    disabled: tuple[str, ...]
    follower: dict[Annotated[str, Names(FOLLOWED)], Follower]
    motion: MotionSettings = field(default_factory=default_settings)
    measures: dict[Annotated[int, Bounds(0, 100_000)], Text] = field(default_factory=dict)
    name: Annotated[str, NOT_IN_FILES] = ""


@cache
def load_style(name: str) -> Style:
    """Load a style of `configs/styles` by name, or from a file. Keys that the file does not have are as in `neutral`.

    Raises UsageError for an unknown name, FileError with the line for a file that is wrong.
    """
    path = named_file("styles", name)
    if path == config_path(f"styles/{NEUTRAL}.yaml"):
        base = None
        style = load(path, Style)
    else:
        base = load_style(NEUTRAL)
        style = load(path, Style, replace(base, springs={}, density={}, force={}))
    by_part: dict[str, Any] = {}
    for key in ("springs", "density", "force"):
        given, neutral = getattr(style, key), getattr(base, key) if base else {}
        by_part[key] = {part: given.get(part, given.get("all", neutral.get(part))) for part in PARTS}
        if lacking := [part for part, value in by_part[key].items() if value is None]:
            raise FileError(path, f"{key}.{lacking[0]} is missing")
    return replace(style, name=path.stem, **by_part)
