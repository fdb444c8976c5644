"""The numbers of the motion, from `configs/motion.yaml` and a file of changes; forms, which name a few of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cache
from pathlib import Path

import numpy as np

from dancetutor_cli.dance.settings_arms import AcrossSettings, ArmSettings, BarSettings, FingerSettings, HandSettings
from dancetutor_cli.dance.settings_body import (
    BodySettings,
    FaceSettings,
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
from dancetutor_cli.dance.units import Array
from dancetutor_cli.run.reading import config_path, named_file
from dancetutor_cli.run.yaml_files import load

# Forms: how a dancer stands and turns, as files that name a few numbers of the motion; see `configs/forms`.

USUAL = "usual"  # the form if the user asks for none: the numbers of `configs/motion.yaml`


@dataclass(frozen=True, slots=True)
class MotionSettings:
    """All numbers of the motion, one field per section of the file."""

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
    face: FaceSettings
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


def load_settings(
    path: Path | None = None, form: str = USUAL, styles: Sequence[tuple[MotionSettings, float]] = ()
) -> MotionSettings:
    """Load the numbers of `configs/motion.yaml`, replaced first by those of a form, then of styles, then of another
    file.

    styles : the numbers of each style, and its share, 0 to 1
    Raises FileError naming the file, the line and the names that exist, UsageError for an unknown form.
    """
    settings = default_settings()
    if form != USUAL:
        settings = load(named_file("forms", form), MotionSettings, settings)
    if styles:
        settings = mean_settings([(_with_numbers_of(settings, numbers), share) for numbers, share in styles])
    return settings if path is None else load(path, MotionSettings, settings)


@cache
def default_settings() -> MotionSettings:
    """Return the settings that the program comes with."""
    return load(config_path("motion.yaml"), MotionSettings)


def mean_settings(parts: Sequence[tuple[MotionSettings, float]]) -> MotionSettings:
    """Return the mean of settings, each with its share; shares sum to 1."""
    first = parts[0][0]
    sections = {}
    for section in _SECTIONS:
        own = [(getattr(one, section), share) for one, share in parts]
        head = own[0][0]
        if any(other is not head and other != head for other, _ in own):
            values = {f.name: sum(share * getattr(one, f.name) for one, share in own) for f in fields(head)}
            sections[section] = replace(head, **values)
    return replace(first, **sections)


def _with_numbers_of(settings: MotionSettings, other: MotionSettings) -> MotionSettings:
    """Return the settings, with those numbers of `other` that differ from the program's own."""
    sections = {}
    for section in _SECTIONS:
        usual, new = getattr(default_settings(), section), getattr(other, section)
        if new != usual:
            names = [f.name for f in fields(new) if getattr(new, f.name) != getattr(usual, f.name)]
            sections[section] = replace(getattr(settings, section), **{name: getattr(new, name) for name in names})
    return replace(settings, **sections)


_SECTIONS = tuple(f.name for f in fields(MotionSettings))


# Numbers that change over a song: a state before the first change, one after it, and so on.

Span = tuple[float, float]  # first and last second
WHOLE = 1.0 - 1e-9  # share from which on a state counts as the only one


def state_weights(changes: Sequence[Span], times: Array) -> Array:
    """Return the share (f, k + 1) of each state at times (f,); changes : k spans, seconds, in order, without
    overlap.
    """
    from dancetutor_cli.dance.smoothing import smooth  # numba, which help does without

    after = np.array([smooth((times - start) / (end - start)) for start, end in changes]).reshape(-1, len(times))
    risen = np.vstack((np.ones(len(times)), after))
    return np.asarray((risen - np.vstack((after, np.zeros(len(times))))).T)


@dataclass(frozen=True, slots=True)
class SettingsCourse:
    """The numbers over a song. states : before the first change, after it, ...; changes : as in `state_weights`"""

    states: tuple[MotionSettings, ...]
    changes: tuple[Span, ...]

    def at(self, second: float) -> MotionSettings:
        """Return the numbers at a second; while one state turns into the next one, their mean by share."""
        weights = state_weights(self.changes, np.array([second]))[0]
        return self._mean(tuple(np.round(weights, 9).tolist()))

    def _mean(self, weights: tuple[float, ...]) -> MotionSettings:
        largest = int(np.argmax(weights))
        return self.states[largest] if weights[largest] >= WHOLE else _mean_of(self.states, weights)

    def within(self, start: float, end: float) -> SettingsCourse:
        """Return the same course with only the states between two seconds."""
        weights = state_weights(self.changes, np.array([start, end]))
        first, last = int(np.argmax(weights[0] > 0.0)), int(np.max(np.flatnonzero(weights[1] > 0.0)))
        return SettingsCourse(self.states[first : last + 1], self.changes[first:last])


@cache
def _mean_of(states: tuple[MotionSettings, ...], weights: tuple[float, ...]) -> MotionSettings:
    return mean_settings([(state, share) for state, share in zip(states, weights, strict=True) if share > 0.0])
