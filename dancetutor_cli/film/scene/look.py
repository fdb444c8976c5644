"""The numbers of the picture (configs/picture.yaml): cameras, light, toon shading, stage."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.yaml_files import Box, load

RGB = tuple[int, int, int]


@dataclass(frozen=True, slots=True)
class CameraLook:
    """One preset camera; degrees and metres, see configs/picture.yaml."""

    azimuth: float
    elevation: float
    field: float
    height: float
    margin: float
    arms: float
    feet_only: bool = False
    region: Box = (0.0, 0.0, 1.0, 1.0)


@dataclass(frozen=True, slots=True)
class FollowLook:
    """How the camera goes with her across a wide pad.

    seconds : how slowly; along : how much of the camera's sideways must be the pad's, 0..1; region : left, top, right,
    bottom of the part of the picture that she fills; back : how many times as far away it may stand to show the pad
    and who walks on or off it whole
    """

    seconds: float
    along: float
    region: Box
    back: float


@dataclass(frozen=True, slots=True)
class LightLook:
    """The one light and its shadows.

    shadow_far : 0..1, how much of it is left where head and hands cast it
    """

    azimuth: float
    elevation: float
    shadow: float
    shadow_soft: float
    shadow_far: float
    contact: float
    contact_soft: float
    contact_height: float


@dataclass(frozen=True, slots=True)
class ToonLook:
    """How the dancer is shaded.

    limbs : share of half light, 0..1, that what wears a limb's colour has in deepest shade: colours there are words
    """

    bands: tuple[float, float]
    soft: float
    levels: tuple[float, float, float]
    shade: RGB
    limbs: float
    rim: float
    rim_from: float
    outline: RGB
    outline_width: float


@dataclass(frozen=True, slots=True)
class StageLook:
    """Floor, wall and pad."""

    floor: RGB
    floor_far: RGB
    floor_line: RGB
    tile: float
    pool: float
    wall: RGB
    wall_top: RGB
    strip: RGB
    radius: float
    pad: RGB
    pad_side: RGB
    panel: RGB
    panel_blank: RGB
    groove: RGB
    arrow: RGB
    pad_height: float
    mark: float
    glow: float


@dataclass(frozen=True, slots=True)
class Look:
    """All of configs/picture.yaml."""

    cameras: dict[str, CameraLook]
    free_field: float
    follow: FollowLook
    light: LightLook
    toon: ToonLook
    stage: StageLook


def read_look(path: Path) -> Look:
    """Read and check one file; FileError names the key that is wrong."""
    look = load(path, Look)
    for name, camera in look.cameras.items():
        if not 1 <= camera.field <= 120 or not -89.99 <= camera.elevation <= 89.99:
            raise FileError(path, f"cameras.{name}: field must be 1..120 degrees and elevation -89.99..89.99")
        _check_region(path, f"cameras.{name}.region", camera.region)
    positive = {
        "free_field": look.free_field,
        "follow.seconds": look.follow.seconds,
        "toon.soft": look.toon.soft,
        "stage.tile": look.stage.tile,
        "stage.pool": look.stage.pool,
        "stage.radius": look.stage.radius,
        "stage.pad_height": look.stage.pad_height,
        "light.shadow_soft": look.light.shadow_soft,
        "light.contact_soft": look.light.contact_soft,
        "light.contact_height": look.light.contact_height,
    }
    for name, value in positive.items():
        if not value > 0:
            raise FileError(path, f"{name}: {value:g} must be more than 0")
    _check_region(path, "follow.region", look.follow.region)
    if not 1 <= look.follow.back <= 2:
        raise FileError(path, f"follow.back: {look.follow.back:g} must be 1 to 2")
    if not 0 <= look.toon.limbs <= 1:
        raise FileError(path, f"toon.limbs: {look.toon.limbs:g} must be 0 to 1")
    if not 20 <= look.light.elevation <= 89:
        raise FileError(path, f"light.elevation: {look.light.elevation:g} must be 20..89 degrees")
    return look


def _check_region(path: Path, name: str, region: Box) -> None:
    left, top, right, bottom = region
    if not (0 <= left < right <= 1 and 0 <= top < bottom <= 1):
        raise FileError(path, f"{name}: left, top, right, bottom must be shares 0 to 1 in rising order")


@cache
def default_look() -> Look:
    """The look of configs/picture.yaml."""
    return read_look(config_path("picture.yaml"))
