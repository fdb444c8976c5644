"""Cost presets: which rules of play hold, what each undesired thing costs; why a note is not played."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import IntEnum
from functools import cache
from pathlib import Path
from typing import Any

from dancetutor_cli.chart.names import COLUMNS
from dancetutor_cli.feet.solver.vocabulary import MODELS, MOST_MS
from dancetutor_cli.run.errors import UsageError, did_you_mean
from dancetutor_cli.run.reading import config_path, is_regular, leads_out
from dancetutor_cli.run.yaml_files import MarkedYaml, read

# Why no person plays a note, and how quick is too quick. Needs no numpy: the linter's rules name these.

LEAP = 0.08  # seconds: a foot that stepped so shortly before goes to no panel apart from the one it is on
HAND = 0.40  # and a hand that came down so shortly before does not come down again


class DropReason(IntEnum):
    """Why a note is let go."""

    LIMBS = 0  # more panels at once than limbs
    LEAP = 1  # a foot that has just stepped on a panel apart from it
    HAND = 2  # a hand that has just been on the floor


# Cost presets: which rules of play hold and what each undesired thing costs, from configs/presets/*.yaml.

DEFAULT_PRESET = "itg"
_DEFAULTS = {"pump": "pump"}  # by the first word of the steps type; DEFAULT_PRESET for all others
MAX_WEIGHT = 1_000_000
_KEYS = ("extends", "model", "pads", "roll-window", "switches", "weights", "curves", "confidence")

Curve = tuple[tuple[int, int], ...]  # (milliseconds, cost), by milliseconds


@dataclass(frozen=True, slots=True)
class Preset:
    """A complete set of rules and costs; hashable, and it pickles.

    name : as the user gave it, without folder and suffix
    model : which rules it is about, a key of `solver.vocabulary.MODELS`
    roll_window : seconds a roll may go unpressed
    switches, weights, curves : (name, value) in the order of the model; costs are whole numbers; a curve has knots
        (milliseconds since the last row with steps, cost), between which it is straight and beyond which it is level
    pads : for which it was made: steps types ("pump-double") or their first words ("pump"); empty: for any
    confidence : (margin, tenths of a per cent) of how likely people step a row this way; empty: nobody has measured it
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
        """Whether it was made for the pads of a steps type; it works on all of them."""
        name = steps_type.lower()
        return not self.pads or name in self.pads or name.partition("-")[0] in self.pads

    def switch(self, name: str) -> bool:
        """A switch by name."""
        return dict(self.switches)[name]

    def weight(self, name: str) -> int:
        """A weight by name."""
        return dict(self.weights)[name]

    def curve(self, name: str) -> Curve:
        """A curve by name."""
        return dict(self.curves)[name]

    def with_values(
        self,
        *,
        weights: Mapping[str, int] | None = None,
        switches: Mapping[str, bool] | None = None,
        curves: Mapping[str, Curve] | None = None,
    ) -> Preset:
        """The same preset with some values changed. Raises KeyError for a name the model does not have."""
        changed: list[Any] = []
        for old, new in ((self.switches, switches or {}), (self.weights, weights or {}), (self.curves, curves or {})):
            if unknown := set(new) - {name for name, _ in old}:
                raise KeyError(", ".join(sorted(unknown)))
            changed.append(tuple((name, new.get(name, value)) for name, value in old))
        return replace(self, switches=changed[0], weights=changed[1], curves=changed[2])


def preset_names() -> list[str]:
    """Names of the presets that come with the program."""
    return sorted(path.stem for path in config_path("presets").glob("*.yaml"))


def default_preset(steps_type: str) -> str:
    """Name of the preset for the charts of a steps type when nobody names another one."""
    return _DEFAULTS.get(steps_type.lower().partition("-")[0], DEFAULT_PRESET)


def load_preset(name_or_path: str | Path, *, confined: bool = False) -> Preset:
    """A preset by name, or from a YAML file of one's own.

    confined : a file may only extend what comes with the program or lies in its own folder: it may be a stranger's

    A file may say `extends: NAME` and then only what differs. Raises UsageError for an unknown preset, key or value,
    with file, line and the names that exist; FileError if the file cannot be read.
    """
    text = str(name_or_path)
    if text in preset_names():
        return _load(config_path(f"presets/{text}.yaml"), (), confined)
    path = Path(name_or_path)
    if path.suffix.lower() in (".yaml", ".yml") or is_regular(path):
        return _load(path, (), confined)
    near = did_you_mean(text, preset_names())
    raise UsageError(f"there is no preset '{text}'{near}; there are: {', '.join(preset_names())}, or give a .yaml file")


@cache
def _read(path: Path) -> MarkedYaml:
    return read(path)


def _load(path: Path, seen: tuple[Path, ...], confined: bool) -> Preset:
    source = _read(path) if path.is_relative_to(config_path("presets")) else read(path)
    _only(source, (), _KEYS)
    base = _base(source, (*seen, path.absolute()), confined)
    model_name = str(source.data.get("model", base.model if base else ""))
    if model_name not in MODELS:
        raise _wrong(source, ("model",), f"'model' must be one of {', '.join(MODELS)}, or extend a preset")
    if base is not None and base.model != model_name:
        raise _wrong(source, ("model",), f"'model' is '{model_name}', but the preset it extends has '{base.model}'")
    model = MODELS[model_name]
    return Preset(
        name=path.stem,
        model=model_name,
        roll_window=_roll_window(source, base),
        switches=_values(source, "switches", model.switches, dict(base.switches) if base else {}),
        weights=_values(source, "weights", model.weights, dict(base.weights) if base else {}),
        curves=_curves(source, model.curves, dict(base.curves) if base else {}),
        pads=_pads(source, base),
        confidence=_confidence(source),
    )


def _base(source: MarkedYaml, seen: tuple[Path, ...], confined: bool) -> Preset | None:
    name = source.data.get("extends")
    if name is None:
        return None
    beside = source.path.parent / str(name)
    path = config_path(f"presets/{name}.yaml") if name in preset_names() else beside
    if path.absolute() in seen:
        raise _wrong(source, ("extends",), f"'{name}' extends itself")
    if confined and path == beside and leads_out(path, source.path.parent):
        raise _wrong(source, ("extends",), "'extends' leads out of the folder of this file; put it beside it")
    if not is_regular(path):
        raise _wrong(
            source, ("extends",), f"there is no preset '{name}'; there are: {', '.join(preset_names())}, or name a file"
        )
    return _load(path, seen, confined)


def _values(
    source: MarkedYaml, group: str, known: tuple[str, ...], base: dict[str, Any]
) -> tuple[tuple[str, Any], ...]:
    data = source.data.get(group) or {}
    if data:
        _only(source, (group,), known)
    for name in known:
        if name not in data and name not in base:
            raise _wrong(source, (group,), f"'{group}' lacks '{name}'")
    for name, value in data.items():
        if group == "switches":
            if not isinstance(value, bool):
                raise _wrong(source, (group, name), f"'{name}' must be true or false, not {value!r}")
        elif isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= MAX_WEIGHT:
            raise _wrong(
                source, (group, name), f"'{name}' must be a whole number from 0 to {MAX_WEIGHT}, not {value!r}"
            )
    return tuple((name, data.get(name, base.get(name))) for name in known)


def _pads(source: MarkedYaml, base: Preset | None) -> tuple[str, ...]:
    value = source.data.get("pads", list(base.pads) if base else [])
    words = sorted({name.partition("-")[0] for name in COLUMNS})
    if not isinstance(value, list):
        raise _wrong(source, ("pads",), "'pads' must be a list of steps types or their first words, as [dance]")
    for number, name in enumerate(value):
        if name not in words and name not in COLUMNS:
            near = did_you_mean(str(name), (*words, *COLUMNS))
            raise _wrong(
                source, ("pads", number), f"'{name}' is no steps type{near}; their first words are: {', '.join(words)}"
            )
    return tuple(value)


def _curves(source: MarkedYaml, known: tuple[str, ...], base: dict[str, Curve]) -> tuple[tuple[str, Curve], ...]:
    data = source.data.get("curves") or {}
    if data:
        _only(source, ("curves",), known)
    for name in known:
        if name not in data and name not in base:
            raise _wrong(source, ("curves",), f"'curves' lacks '{name}'")
    return tuple((name, _curve(source, name, data[name]) if name in data else base[name]) for name in known)


def _curve(source: MarkedYaml, name: str, data: Any) -> Curve:
    return _knots(source, ("curves", name), data, ("milliseconds", MOST_MS), ("costs", MAX_WEIGHT))


def _confidence(source: MarkedYaml) -> Curve:
    """Not taken over from the preset that is extended: other weights are right less or more often."""
    if "confidence" not in source.data:
        return ()
    return _knots(source, ("confidence",), source.data["confidence"], ("margins", MAX_WEIGHT), ("tenths", 1000))


def _knots(source: MarkedYaml, keys: tuple[str, ...], data: Any, across: tuple[str, int], up: tuple[str, int]) -> Curve:
    """A mapping of whole numbers to whole numbers; `across`, `up` : what they are called, and the largest."""
    name = keys[-1]
    if not isinstance(data, dict) or not data:
        raise _wrong(source, keys, f"'{name}' must be a mapping of {across[0]} to {up[0]}, as {{100: 500, 300: 0}}")
    for group, (what, most) in ((data.keys(), across), (data.values(), up)):
        for value in group:
            if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= most:
                raise _wrong(
                    source, keys, f"'{name}': {what} must be whole numbers from 0 to {most}, not {value!r:.40}"
                )
    return tuple(sorted(data.items()))


def _roll_window(source: MarkedYaml, base: Preset | None) -> float:
    value = source.data.get("roll-window", base.roll_window if base else None)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 < value <= 10:
        raise _wrong(
            source, ("roll-window",), f"'roll-window' must be seconds, more than 0 and at most 10, not {value!r}"
        )
    return float(value)


def _only(source: MarkedYaml, keys: tuple[str | int, ...], known: tuple[str, ...]) -> None:
    inside: Any = source.data
    for key in keys:
        inside = inside[key]
    if not isinstance(inside, dict):
        raise _wrong(source, keys, f"'{keys[-1]}' must be a mapping of names to values")
    for key in inside:
        if key not in known:
            where = f" in '{keys[-1]}'" if keys else ""
            raise _wrong(source, (*keys, key), f"unknown key '{key}'{where}; there are: {', '.join(known) or 'none'}")


def _wrong(source: MarkedYaml, keys: tuple[str | int, ...], message: str) -> UsageError:
    return UsageError(str(source.error(keys, message)))
