"""Cost presets: their rules and costs, the choice of a chart's preset, and the reasons why a note is not played."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from dancetutor_cli.chart.names import COLUMNS
from dancetutor_cli.feet.conditions import Condition
from dancetutor_cli.feet.solver.vocabulary import MODELS, MOST_MS
from dancetutor_cli.run.errors import did_you_mean
from dancetutor_cli.run.reading import config_names, config_path, is_outside, is_regular, named_file, shown_key
from dancetutor_cli.run.schema import Bounds, Entries, MarkedYaml, Meaning, Names, Parsed, Text, convert
from dancetutor_cli.run.yaml_files import read

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart

# Reasons why nobody can play a note, and their time limits. They are here because the linter's rules use them without
# numpy.

LEAP = 0.08  # seconds between two steps of a foot within which it reaches only panels that touch its own
HAND = 0.40  # seconds between two presses of a hand within which it does not come down again


class DropReason(IntEnum):
    """Why a note is not played."""

    LIMBS = 0  # more panels at once than limbs
    LEAP = 1  # the foot has just stepped on a panel that does not touch this one
    HAND = 2  # the hand has just pressed another note


DEFAULT_PRESET = "itg"
_DEFAULTS = {"pump": "pump", "smx": "smx"}  # first word of the steps type -> preset; all others have DEFAULT_PRESET
MAX_WEIGHT = 1_000_000
_WORDS = tuple(sorted({name.partition("-")[0] for name in COLUMNS}))
Curve = tuple[tuple[int, int], ...]  # (milliseconds, cost), by milliseconds


@dataclass(frozen=True, slots=True)
class Preset:
    """A complete set of rules and costs. It can be hashed and pickled.

    name : the name that the user gave, without folder and suffix
    model : the cost model, a key of `solver.vocabulary.MODELS`
    roll_window : seconds a roll may go unpressed
    switches, weights, curves : (name, value) in the order of the model; costs are whole numbers; a curve has knots
        (milliseconds since the last row with steps, cost), between which it is straight and beyond which it is level
    pads : the steps types ("pump-double"), or their first words ("pump"), for which the preset was made; empty: all
    confidence : (margin, tenths of a per cent) of how likely the feet of a row are right; empty: not measured
    """

    name: str
    model: str
    roll_window: float
    switches: tuple[tuple[str, bool], ...]
    weights: tuple[tuple[str, int], ...]
    curves: tuple[tuple[str, Curve], ...] = ()
    pads: tuple[str, ...] = ()
    confidence: Curve = ()

    def is_for(self, steps_type: str) -> bool:
        """Whether the preset was made for the pads of a steps type. It works on all pads."""
        name = steps_type.lower()
        return not self.pads or name in self.pads or name.partition("-")[0] in self.pads

    def switch(self, name: str) -> bool:
        """Return the value of a switch."""
        return dict(self.switches)[name]

    def weight(self, name: str) -> int:
        """Return the value of a weight, in cost units."""
        return dict(self.weights)[name]

    def curve(self, name: str) -> Curve:
        """Return the knots of a curve."""
        return dict(self.curves)[name]


def preset_names() -> list[str]:
    """Return the names of the presets that come with the program."""
    return config_names("presets")


def default_preset(steps_type: str) -> str:
    """Return the name of the default preset of a steps type."""
    return _DEFAULTS.get(steps_type.lower().partition("-")[0], DEFAULT_PRESET)


def _pad(name: Any) -> str:
    """Check that a name is a steps type or the first word of one; else raise ValueError."""
    if name not in _WORDS and name not in COLUMNS:
        near = did_you_mean(str(name), (*_WORDS, *COLUMNS))
        raise ValueError(f"'{shown_key(name)}' is not a steps type{near}; their first words are: {', '.join(_WORDS)}")
    return str(name)


_PADS = "a list of steps types or their first words, such as [dance]"
_Weight = Annotated[int, Bounds(0, MAX_WEIGHT)]
_Knots = Annotated[
    dict[Annotated[int, Bounds(0, MOST_MS, "milliseconds")], _Weight],
    Entries(1),
    Meaning("a mapping of milliseconds to costs, such as {100: 500, 300: 0}"),
]
_Confidence = Annotated[
    dict[_Weight, Annotated[int, Bounds(0, 1000, "tenths of a per cent")]],
    Entries(1),
    Meaning("a mapping of margins to tenths of a per cent, such as {100: 500, 300: 900}"),
]


@dataclass(eq=False, repr=False)
class _PresetFile:
    """The keys of a preset's file; the names of switches, weights and curves are those of its model."""

    HYPHENS: ClassVar[bool] = True
    extends: Text | None = None
    model: Annotated[str, Names(tuple(MODELS))] | None = None
    pads: Annotated[tuple[Annotated[str, Parsed(_pad)], ...], Meaning(_PADS)] | None = None
    roll_window: Annotated[float, Bounds(0, 10, "seconds", above=True)] | None = None
    switches: dict[str, bool] = field(default_factory=dict)
    weights: dict[str, _Weight] = field(default_factory=dict)
    curves: dict[str, _Knots] = field(default_factory=dict)
    confidence: _Confidence = field(default_factory=dict)


def load_preset(name_or_path: str | Path, *, confined: bool = False) -> Preset:
    """Load a preset by name, or from a YAML file.

    confined : whether a file may extend only presets of the program and files in its own folder, because it may be
    untrusted

    A file may have `extends: NAME` and only the values that differ. Raises UsageError for an unknown preset. Raises
    FileError if a file cannot be read or has an unknown key or value; the message has the line and the valid names.
    """
    return _load(named_file("presets", name_or_path), (), confined)


@cache
def _read(path: Path) -> MarkedYaml:
    return read(path)


def _load(path: Path, seen: tuple[Path, ...], confined: bool) -> Preset:
    source = _read(path) if path.is_relative_to(config_path("presets")) else read(path)
    file = convert(source, _PresetFile)
    base = None if file.extends is None else _base(source, file.extends, (*seen, path.absolute()), confined)
    model = file.model or (base.model if base else None)
    if model is None:
        raise source.error((), f"model is missing: one of {', '.join(MODELS)}; or extend a preset")
    if base is not None and base.model != model:
        raise source.error(("model",), f"model is '{model}', but the preset it extends has '{base.model}'")
    window = file.roll_window if file.roll_window is not None else base.roll_window if base else None
    if window is None:
        raise source.error((), "roll-window is missing: seconds that a roll may go unpressed")
    return Preset(
        name=path.stem,
        model=model,
        roll_window=window,
        switches=_values(source, "switches", file.switches, model, base),
        weights=_values(source, "weights", file.weights, model, base),
        curves=_values(source, "curves", {k: tuple(sorted(v.items())) for k, v in file.curves.items()}, model, base),
        pads=file.pads if file.pads is not None else base.pads if base else (),
        # not inherited from the extended preset, because it was measured with other weights
        confidence=tuple(sorted(file.confidence.items())),
    )


def _base(source: MarkedYaml, name: str, seen: tuple[Path, ...], confined: bool) -> Preset:
    beside = source.path.parent / name
    path = config_path(f"presets/{name}.yaml") if name in preset_names() else beside
    if path.absolute() in seen:
        raise source.error(("extends",), f"'{name}' extends itself")
    if confined and path == beside and is_outside(path, source.path.parent):
        raise source.error(("extends",), "'extends' names a file outside this file's folder; put it beside this file")
    if not is_regular(path):
        there = ", ".join(preset_names())
        raise source.error(("extends",), f"there is no preset '{name}'; choose {there}, or a file")
    return _load(path, seen, confined)


def _values(
    source: MarkedYaml, group: str, given: Mapping[str, Any], model: str, base: Preset | None
) -> tuple[tuple[str, Any], ...]:
    """Return switches, weights or curves in the model's order: the given ones, else those of the extended preset."""
    known: tuple[str, ...] = getattr(MODELS[model], group)
    source.check_names((group,), given, known)
    values = {**dict(getattr(base, group) if base else ()), **given}
    for name in known:
        if name not in values:
            raise source.error((group,), f"{group}.{name} is missing")
    return tuple((name, values[name]) for name in known)


# The choice of the cost preset with which a chart is solved, for every command.
#
# Neither numpy nor numba is imported, because a cached result is reported without them.


@dataclass(frozen=True, slots=True)
class PresetChoice:
    """The presets of the command line and the configuration. It can be pickled, and its `repr` identifies every setting
    that affects a play.

    override : the preset of --preset, which is used for every chart
    ruled : (condition, preset) of the configuration; the last entry whose condition holds for a chart is used
    """

    override: Preset | None = None
    ruled: tuple[tuple[Condition, Preset], ...] = ()

    def candidates(self) -> Iterator[Preset]:
        """Yield every preset that a chart may get, except the defaults for other pads."""
        if self.override is not None:
            yield self.override
            return
        yield from (preset for _, preset in self.ruled)
        if not any(condition == Condition() for condition, _ in self.ruled):
            yield _default(DEFAULT_PRESET)


def preset_for(chart: Chart, path: Path, choice: PresetChoice) -> Preset:
    """Return the preset of a chart: from the command line, else from the configuration, else the default of its steps
    type.

    path : the chart file, for conditions on paths
    """
    if choice.override is not None:
        return choice.override
    for when, preset in reversed(choice.ruled):
        if when.holds(path, chart.steps_type, chart.difficulty, chart.meter):
            return preset
    return _default(default_preset(chart.steps_type))


_default = cache(load_preset)


def choice_of(given: str | None, named: Sequence[tuple[Condition, str]] = ()) -> PresetChoice:
    """Load the presets that --preset and the configuration name. Raises UsageError or FileError as `load_preset` does.

    named : the names of the configuration's presets, each with its condition
    """
    if given is not None:
        return PresetChoice(load_preset(given))
    return PresetChoice(None, tuple((when, load_preset(name, confined=True)) for when, name in named))


def mismatch_message(preset: Preset, steps_type: str) -> str | None:
    """Return a message if a preset was made for other pads than this steps type's, else None."""
    if preset.is_for(steps_type):
        return None
    return f"preset '{preset.name}' was made for {' and '.join(preset.pads)} pads, not for {steps_type}"
