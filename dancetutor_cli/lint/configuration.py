"""Reads dancetutor.yaml and configs/lint/*.yaml into `Settings`, and decides which cost preset a chart gets."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dancetutor_cli.chart.pack_files import (
    Condition,
    SettingError,
    check_keys,
    check_not_a_link_out,
    condition_of,
    texts_of,
)
from dancetutor_cli.feet.preset import DEFAULT_PRESET, Preset, default_preset, load_preset
from dancetutor_cli.lint.rule import matching, named_singly
from dancetutor_cli.lint.rule_settings import Layer, Settings, layer_of, resolve_name
from dancetutor_cli.run.errors import FileError, UsageError, did_you_mean
from dancetutor_cli.run.reading import config_path, is_regular, leads_out, shown_key
from dancetutor_cli.run.yaml_files import MarkedYaml, parse_value, read

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart


# Reads dancetutor.yaml and configs/lint/*.yaml into `Settings`; what they say wrongly is named with its line.

FAIL_ON = ("error", "warning", "never")
_TOP_KEYS = (
    "extends",
    "preset",
    "fail-on",
    "baseline",
    "stream-rows",
    "sure-feet",
    "coin-toss",
    "select",
    "ignore",
    "rules",
    "overrides",
    "feet",
)
_MOST_EXTENDED = 16
_OVERRIDE_KEYS = ("when", "preset", "select", "ignore", "rules")


@dataclass(frozen=True, slots=True)
class Configuration:
    """Everything a configuration file may say.

    sources : the files it was read from, with what they extend
    preset : name or file of the cost preset for all charts, None: nothing is said
    overridden : (condition, the preset of the charts for which it holds); later ones win, and all of them over `preset`
    """

    settings: Settings
    sources: tuple[Path, ...] = ()
    preset: str | None = None
    overridden: tuple[tuple[Condition, str], ...] = ()
    fail_on: str | None = None
    baseline: Path | None = None

    @property
    def presets(self) -> tuple[tuple[Condition, str], ...]:
        """All that is said about presets; of the conditions that hold for a chart the last one counts."""
        return self.overridden if self.preset is None else ((Condition(), self.preset), *self.overridden)


def load_configuration(source: str | Path | None, *, found: bool = False) -> Configuration:
    """The defaults, and on top of them a file or the name of one in configs/lint/ (None: only the defaults).

    found : nobody has named the file, it lay there: it may be a stranger's, and stays in its folder
    """
    base = _extend(Configuration(Settings()), config_path("lint/default.yaml"), (), confined=False)
    if source is None:
        return base
    if found:
        check_not_a_link_out(Path(source))
    return _extend(base, _located(source), (), confined=found)


def with_assignments(configuration: Configuration, assignments: Iterable[str]) -> Configuration:
    """Apply `--set key=value` of the command line, for example "doublestep.severity=error" or "fail-on=never"."""
    for text in assignments:
        key, equals, value = text.partition("=")
        if not equals or not key:
            raise UsageError(f"--set {text}: write it as KEY=VALUE, for example DT201.severity=error")
        parsed = parse_value(value, f"--set {key}")
        if key == "preset":  # not confined: the user's own word
            configuration = replace(configuration, preset=str(parsed), overridden=())
            continue
        rule, dot, option = key.partition(".")
        data = {"rules": {rule: {option: parsed}}} if dot else {key: parsed}
        try:
            configuration = _apply(configuration, data, Path.cwd(), confined=False)
        except SettingError as fault:
            raise UsageError(f"--set {text}: {fault.message}") from None
    return configuration


def with_selection(configuration: Configuration, select: Sequence[str], ignore: Sequence[str]) -> Configuration:
    """Apply --select and --ignore of the command line; each entry may hold several, with commas."""
    wanted = [part.strip() for text in select for part in text.split(",")]
    dropped = _codes(part.strip() for text in ignore for part in text.split(","))
    layer = Layer(select=_codes(wanted) if select else None, ignore=dropped, named=named_singly(wanted))
    return replace(configuration, settings=configuration.settings.with_layer(layer))


def _codes(selectors: Iterable[str]) -> frozenset[str]:
    found: frozenset[str] = frozenset()
    for selector in selectors:
        found |= matching(selector)
    return found


def _located(source: str | Path) -> Path:
    path = Path(source)
    if path.suffix or os.path.lexists(path):  # Path.exists may raise
        return path
    named = config_path(f"lint/{source}.yaml")
    if not named.is_file():
        names = ", ".join(sorted(entry.stem for entry in config_path("lint").glob("*.yaml")))
        raise UsageError(f"there is no lint configuration '{source}'; there are: {names}, or give a file")
    return named


def _extend(base: Configuration, path: Path, seen: tuple[Path, ...], *, confined: bool) -> Configuration:
    source = read(path)
    here = (*seen, path.resolve())
    if len(here) > _MOST_EXTENDED:
        raise FileError(path, f"extends more than {_MOST_EXTENDED} files one after the other")
    data = dict(source.data)
    for name in texts_of(data, "extends"):
        extended = _extended(source, name)
        if extended.resolve() in here:
            raise source.error(("extends",), "extends itself")
        base = _extend(base, extended, here, confined=confined)
    data.pop("extends", None)
    try:
        return replace(_apply(base, data, path.parent, confined=confined), sources=(*base.sources, path))
    except SettingError as fault:
        raise source.error(fault.keys, fault.message) from None


def _extended(source: MarkedYaml, name: str) -> Path:
    """What `extends` names: a configuration of the program's, or a file in the folder of this one or below it."""
    folder = source.path.parent
    names = sorted(entry.stem for entry in config_path("lint").glob("*.yaml"))
    if name in names and not is_regular(folder / name):
        return config_path(f"lint/{name}.yaml")
    if leads_out(folder / name, folder):
        raise source.error(("extends",), "'extends' leads out of the folder of this file; put what it names beside it")
    if not is_regular(folder / name):
        there = ", ".join(names)
        raise source.error(
            ("extends",), f"there is no configuration '{shown_key(name)}'; there are: {there}, or name a file"
        )
    return folder / name


def _apply(base: Configuration, data: Mapping[str, Any], folder: Path, *, confined: bool) -> Configuration:
    check_keys(data, _TOP_KEYS, ())
    settings = base.settings.with_layer(layer_of(data, Condition(), ()))
    preset, overridden = base.preset, base.overridden
    if data.get("preset") is not None:  # of all charts: what the extended file says about some of them is over
        preset, overridden = _preset(data["preset"], folder, ("preset",)), ()
    for number, entry in enumerate(_list(data, "overrides")):
        place = ("overrides", number)
        if not isinstance(entry, Mapping):
            raise SettingError(place, f"an override is a mapping of {', '.join(_OVERRIDE_KEYS)}")
        check_keys(entry, _OVERRIDE_KEYS, place)
        when = condition_of(entry.get("when"), folder, (*place, "when"))
        settings = settings.with_layer(layer_of(entry, when, place))
        if entry.get("preset") is not None:
            overridden = (*overridden, (when, _preset(entry["preset"], folder, (*place, "preset"))))
    if data.get("feet"):
        _check_feet(data, folder)
    fail_on = data.get("fail-on", base.fail_on)
    if fail_on is not None and fail_on not in FAIL_ON:
        raise SettingError(("fail-on",), f"'fail-on' is one of {', '.join(FAIL_ON)}")
    baseline = folder / str(data["baseline"]) if data.get("baseline") else base.baseline
    if confined and data.get("baseline") and leads_out(folder / str(data["baseline"]), folder):
        why = "'baseline' leads out of the folder of this file; put it beside it, or name it with --baseline"
        raise SettingError(("baseline",), why)
    stream_rows = data.get("stream-rows", settings.stream_rows)
    if isinstance(stream_rows, bool) or not isinstance(stream_rows, int) or not 1 <= stream_rows <= 192:
        raise SettingError(("stream-rows",), "'stream-rows' is a number of rows in a measure, for example 16")
    settings = replace(
        settings, stream_rows=stream_rows,
        sure_feet=_number(data, "sure-feet", settings.sure_feet, 100),
        coin_toss=int(_number(data, "coin-toss", settings.coin_toss, 1000)),
    )  # fmt: skip
    return Configuration(settings, base.sources, preset, overridden, fail_on, baseline)


def _preset(value: Any, folder: Path, place: tuple[str | int, ...]) -> str:
    """A preset's name, or the path of its file, which lies in the folder of the configuration or below it."""
    from dancetutor_cli.feet import preset_names

    name = str(value)
    if name in preset_names():
        return name
    path = folder / name
    if leads_out(path, folder):
        raise SettingError(place, "'preset' leads out of the folder of this file; put the preset beside it")
    if path.suffix.lower() not in (".yaml", ".yml") and not is_regular(path):
        there, near = ", ".join(preset_names()), did_you_mean(name, preset_names())
        raise SettingError(
            place, f"there is no preset '{shown_key(name)}'{near}; there are: {there}, or name a .yaml file"
        )
    return str(path)


def _check_feet(data: Mapping[str, Any], folder: Path) -> None:
    """What `feet` says is read where feet are found; here it is only checked, for it knows no rules."""
    from dancetutor_cli.feet.song_feet import entries_of

    for number, entry in enumerate(entries_of(data, folder)):
        for rule in {rule for rules in entry.ignore.values() for rule in rules}:
            resolve_name(matching, rule, ("feet", number, "ignore"))


def _number(data: Mapping[str, Any], key: str, before: float, most: float) -> float:
    value = data.get(key, before)
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value <= most:
        raise SettingError((key,), f"'{key}' is a number from 0 to {most:g}")
    return float(value)


def _list(data: Mapping[str, Any], key: str) -> list[Any]:
    value = data.get(key) or []
    if not isinstance(value, list):
        raise SettingError((key,), f"'{key}' is a list")
    return value


# Which cost preset a chart is solved with: the one place that decides it, for every command.
#
# Imports neither numpy nor numba: a kept result is reported without them.


@dataclass(frozen=True, slots=True)
class PresetChoice:
    """What was said about presets. Pickles; its `repr` tells all that a play depends on but the program itself.

    override : what --preset names: it holds for every chart
    ruled : (condition, preset) of the configuration: of those that hold for a chart the last one counts
    """

    override: Preset | None = None
    ruled: tuple[tuple[Condition, Preset], ...] = ()

    def candidates(self) -> Iterator[Preset]:
        """Every preset that a chart may get, but those for other pads that nobody has named."""
        if self.override is not None:
            yield self.override
            return
        yield from (preset for _, preset in self.ruled)
        if not any(condition == Condition() for condition, _ in self.ruled):
            yield _default(DEFAULT_PRESET)


def preset_for(chart: Chart, path: Path, choice: PresetChoice) -> Preset:
    """The preset of a chart: the command line's, else the configuration's, else the one for its steps type.

    path : the chart file, which conditions may be about
    """
    if choice.override is not None:
        return choice.override
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
    from dancetutor_cli.chart.pack_files import find_settings_file

    settings = find_settings_file(path.absolute().parent)
    return choice_of(None, None if settings is None else load_configuration(settings, found=True))


def mismatch(preset: Preset, steps_type: str) -> str | None:
    """A line for people where a preset was made for other pads than a chart's, else None."""
    if preset.is_for(steps_type):
        return None
    return f"preset '{preset.name}' was made for {' and '.join(preset.pads)} pads, not for {steps_type}"
