"""The numbers of the picture (configs/picture.yaml): cameras, light, toon shading, stage."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Annotated

from dancetutor_cli.run.reading import config_path
from dancetutor_cli.run.schema import RGB, Bounds, Box, Positive, Share
from dancetutor_cli.run.yaml_files import load


@dataclass(frozen=True, slots=True)
class CameraLook:
    """One preset camera; degrees and metres, see configs/picture.yaml."""

    azimuth: float
    elevation: Annotated[float, Bounds(-89.99, 89.99, "degrees")]
    field: Annotated[float, Bounds(1, 120, "degrees")]
    height: float
    margin: float
    arms: float
    feet_only: bool = False
    region: Box = (0.0, 0.0, 1.0, 1.0)


@dataclass(frozen=True, slots=True)
class FollowLook:
    """The settings of the camera that follows the dancer across a wide pad.

    seconds : the time over which the path is smoothed
    along : least share of the camera's sideways direction that is along the pad, 0..1
    region : left, top, right, bottom of the part of the picture that she fills
    back : the greatest factor of the camera's distance, with which it shows the whole pad and dancers who walk on or
        off
    """

    seconds: Positive
    along: float
    region: Box
    back: Annotated[float, Bounds(1, 2)]


@dataclass(frozen=True, slots=True)
class LightLook:
    """The only light and its shadows.

    shadow_far : 0..1, the share of the shadow that is left far from the dancer, where head and hands cast it
    """

    azimuth: float
    elevation: Annotated[float, Bounds(20, 89, "degrees")]
    shadow: float
    shadow_soft: Positive
    shadow_far: float
    contact: float
    contact_soft: Positive
    contact_height: Positive


@dataclass(frozen=True, slots=True)
class ToonLook:
    """The shading of the dancer.

    limbs : least share of half light, 0..1, of surfaces in a limb's colour, because their colours carry information
    """

    bands: tuple[float, float]
    soft: Positive
    levels: tuple[float, float, float]
    shade: RGB
    limbs: Share
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
    tile: Positive
    pool: Positive
    wall: RGB
    wall_top: RGB
    strip: RGB
    radius: Positive
    pad: RGB
    pad_side: RGB
    panel: RGB
    panel_blank: RGB
    groove: RGB
    arrow: RGB
    pad_height: Positive
    mark: float
    glow: float


@dataclass(frozen=True, slots=True)
class Look:
    """All settings of configs/picture.yaml."""

    cameras: dict[str, CameraLook]
    free_field: Positive
    follow: FollowLook
    light: LightLook
    toon: ToonLook
    stage: StageLook


def read_look(path: Path) -> Look:
    """Read and check one file; FileError names the wrong key."""
    return load(path, Look)


@cache
def default_look() -> Look:
    """Return the look of configs/picture.yaml."""
    return read_look(config_path("picture.yaml"))
