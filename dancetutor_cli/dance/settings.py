"""The numbers of the motion, from `configs/motion.yaml` and a file of changes; forms, which name a few of them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

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
from dancetutor_cli.run.reading import config_path, named_file
from dancetutor_cli.run.yaml_files import load

# Forms: how a player stands and turns, as files that name a few numbers of the motion; see `configs/forms`.

USUAL = "usual"  # the form of who asks for none: the numbers of `configs/motion.yaml`


# The numbers of the motion: read from `configs/motion.yaml` and from a file of changes, checked, and given names.


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


def load_settings(path: Path | None = None, form: str = USUAL) -> MotionSettings:
    """The numbers of `configs/motion.yaml`, with those on top that a form names, and those that another file names.

    Raises FileError naming the file, the line and the names that exist, UsageError for a form that there is not.
    """
    settings = default_settings()
    if form != USUAL:
        settings = load(named_file("forms", form), MotionSettings, settings)
    return settings if path is None else load(path, MotionSettings, settings)


@cache
def default_settings() -> MotionSettings:
    """The settings that the program comes with."""
    return load(config_path("motion.yaml"), MotionSettings)
