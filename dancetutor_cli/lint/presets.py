"""Which cost preset a chart is solved with: the one place that decides it, for every command.

Imports neither numpy nor numba: a kept result is reported without them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.library.settings_file import Condition
from dancetutor_cli.play.preset import DEFAULT_PRESET, Preset, default_preset, load_preset

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart
    from dancetutor_cli.lint.configuration import Configuration


@dataclass(frozen=True, slots=True)
class PresetChoice:
    """What was said about presets. Pickles; its `repr` tells all that a play depends on but the program itself.

    given : what --preset names: it holds for every chart
    ruled : (condition, preset) of the configuration: of those that hold for a chart the last one counts
    """

    given: Preset | None = None
    ruled: tuple[tuple[Condition, Preset], ...] = ()

    def candidates(self) -> Iterator[Preset]:
        """Every preset that a chart may get, but those for other pads that nobody has named."""
        if self.given is not None:
            yield self.given
            return
        yield from (preset for _, preset in self.ruled)
        if not any(condition == Condition() for condition, _ in self.ruled):
            yield _default(DEFAULT_PRESET)


def preset_for(chart: Chart, path: Path, choice: PresetChoice) -> Preset:
    """The preset of a chart: the command line's, else the configuration's, else the one for its steps type.

    path : the chart file, which conditions may be about
    """
    if choice.given is not None:
        return choice.given
    for when, preset in reversed(choice.ruled):
        if when.holds_for_path(path) and when.holds_for_chart(chart.steps_type, chart.difficulty, chart.meter):
            return preset
    return _default(default_preset(chart.steps_type))


_default = cache(load_preset)


def choice_of(given: str | None, configuration: Configuration | None = None) -> PresetChoice:
    """The presets that --preset and a configuration name, loaded; UsageError or FileError if one cannot be."""
    if given is not None:
        return PresetChoice(load_preset(given))
    if configuration is None:
        return PresetChoice()
    ruled = [(when, load_preset(name, confined=True)) for when, name in configuration.presets]
    return PresetChoice(None, tuple(ruled))


def choice_for(path: Path, given: str | None) -> PresetChoice:
    """The same with the configuration that holds for a chart file: the nearest dancetutor.yaml up the tree."""
    if given is not None:
        return choice_of(given)
    from dancetutor_cli.library.settings_file import find_settings_file
    from dancetutor_cli.lint.configuration import load_configuration

    settings = find_settings_file(path.absolute().parent)
    return choice_of(None, None if settings is None else load_configuration(settings, found=True))


def mismatch(preset: Preset, steps_type: str) -> str | None:
    """A line for people where a preset was made for other pads than a chart's, else None."""
    if preset.is_for(steps_type):
        return None
    return f"preset '{preset.name}' was made for {' and '.join(preset.pads)} pads, not for {steps_type}"
