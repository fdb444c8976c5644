"""Reads dancetutor.yaml and configs/lint/*.yaml into `Settings`, and decides which cost preset a chart gets."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, ClassVar

from dancetutor_cli.chart.pack_files import SETTINGS_FILE, check_not_a_link_out
from dancetutor_cli.feet.conditions import Condition, When, condition_of
from dancetutor_cli.feet.preset import preset_names
from dancetutor_cli.lint.rule import match_codes, named_singly
from dancetutor_cli.lint.rule_settings import Layer, RulesKeys, Settings, layer_of, resolve_name
from dancetutor_cli.run.errors import FileError, UsageError, choose_text
from dancetutor_cli.run.reading import config_names, config_path, is_outside, is_regular, shown_key
from dancetutor_cli.run.schema import Bounds, Keys, MarkedYaml, Names, Text, Texts, convert
from dancetutor_cli.run.yaml_files import parse_value, read

FAIL_ON = ("error", "warning", "never")
_MOST_EXTENDED = 16


@dataclass(eq=False, repr=False, kw_only=True)
class _Override(RulesKeys):
    """An entry of the key `overrides`."""

    when: When
    preset: Text | None = None


@dataclass(eq=False, repr=False)
class _ConfigurationFile(RulesKeys):
    """The keys of a configuration file; the code that reads `feet` also checks it."""

    HYPHENS: ClassVar[bool] = True
    extends: Texts = ()
    preset: Text | None = None
    fail_on: Annotated[str, Names(FAIL_ON)] | None = None
    baseline: Text | None = None
    stream_rows: Annotated[int, Bounds(1, 192, "rows in a measure")] | None = None
    sure_feet: Annotated[float, Bounds(0, 100, "per cent")] | None = None
    coin_toss: Annotated[int, Bounds(0, 1000)] | None = None
    sync: bool | None = None
    overrides: tuple[_Override, ...] = ()
    feet: Any = None


@dataclass(frozen=True, slots=True)
class Configuration:
    """The contents of a configuration file.

    sources : the files that it was read from, with the files that they extend
    preset : name or file of the cost preset for all charts; None if the file names none
    overridden : pairs of a condition and the preset of its charts; later pairs win, and every pair wins over `preset`
    """

    settings: Settings
    sources: tuple[Path, ...] = ()
    preset: str | None = None
    overridden: tuple[tuple[Condition, str], ...] = ()
    fail_on: str | None = None
    baseline: Path | None = None

    @property
    def presets(self) -> tuple[tuple[Condition, str], ...]:
        """All pairs of a condition and a preset. Of the conditions that hold for a chart, the last one counts."""
        return self.overridden if self.preset is None else ((Condition(), self.preset), *self.overridden)


def load_configuration(source: str | Path | None, *, found: bool = False) -> Configuration:
    """Return the defaults with a file on top, or with a named file of configs/lint/ (None: only the defaults).

    found : the user has not named the file: it may come from another user, so it may name no file outside its folder
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
        if key == "preset":  # not confined, because the user names it
            configuration = replace(configuration, preset=str(parsed), overridden=())
            continue
        rule, dot, option = key.partition(".")
        data = {"rules": {rule: {option: parsed}}} if dot else {key: parsed}
        try:
            configuration = _apply(configuration, MarkedYaml(Path.cwd() / SETTINGS_FILE, data, {}), confined=False)
        except FileError as error:
            raise UsageError(f"--set {text}: {error.message}") from None
    return configuration


def with_selection(configuration: Configuration, select: Sequence[str], ignore: Sequence[str]) -> Configuration:
    """Apply --select and --ignore of the command line; an entry may hold several names, with commas between them."""
    wanted = [part.strip() for text in select for part in text.split(",")]
    dropped = _codes(part.strip() for text in ignore for part in text.split(","))
    layer = Layer(select=_codes(wanted) if select else None, ignore=dropped, named=named_singly(wanted))
    return replace(configuration, settings=configuration.settings.with_layer(layer))


def _codes(selectors: Iterable[str]) -> frozenset[str]:
    found: frozenset[str] = frozenset()
    for selector in selectors:
        found |= match_codes(selector)
    return found


def _located(source: str | Path) -> Path:
    path = Path(source)
    if path.suffix or os.path.lexists(path):  # Path.exists may raise
        return path
    named = config_path(f"lint/{source}.yaml")
    if not named.is_file():
        names = ", ".join(config_names("lint"))
        raise UsageError(f"there is no lint configuration '{source}'; choose {names}, or a file")
    return named


def _extend(base: Configuration, path: Path, seen: tuple[Path, ...], *, confined: bool) -> Configuration:
    source = read(path)
    here = (*seen, path.resolve())
    if len(here) > _MOST_EXTENDED:
        raise FileError(path, f"extends a chain of more than {_MOST_EXTENDED} files; shorten the chain")
    for name in convert(source, Texts, ("extends",)) if source.data.get("extends") else ():
        extended = _extended(source, name)
        if extended.resolve() in here:
            raise source.error(("extends",), "extends itself")
        base = _extend(base, extended, here, confined=confined)
    return replace(_apply(base, source, confined=confined), sources=(*base.sources, path))


def _extended(source: MarkedYaml, name: str) -> Path:
    """Return the path that `extends` names: a file of configs/lint/, or a file in or below this file's folder."""
    folder = source.path.parent
    names = config_names("lint")
    if name in names and not is_regular(folder / name):
        return config_path(f"lint/{name}.yaml")
    if is_outside(folder / name, folder):
        raise source.error(("extends",), "'extends' names a file outside this file's folder; put it beside this file")
    if not is_regular(folder / name):
        there = ", ".join(names)
        raise source.error(("extends",), f"there is no configuration '{shown_key(name)}'; choose {there}, or a file")
    return folder / name


def _apply(base: Configuration, source: MarkedYaml, *, confined: bool) -> Configuration:
    """Return `base` with the settings of a file on top. confined : the file may name no file outside its folder"""
    file, folder = convert(source, _ConfigurationFile), source.path.parent
    settings = base.settings.with_layer(layer_of(source, file, Condition(), ()))
    preset, overridden = base.preset, base.overridden
    if file.preset is not None:  # for all charts, so it also replaces the overrides of the extended file
        preset, overridden = _preset(source, file.preset, ("preset",)), ()
    for number, entry in enumerate(file.overrides):
        place, when = ("overrides", number), condition_of(entry.when, folder)
        settings = settings.with_layer(layer_of(source, entry, when, place))
        if entry.preset is not None:
            overridden = (*overridden, (when, _preset(source, entry.preset, (*place, "preset"))))
    if file.feet:
        _check_feet(source)
    if confined and file.baseline and is_outside(folder / file.baseline, folder):
        why = "'baseline' names a file outside this file's folder; put it beside this file, or name it with --baseline"
        raise source.error(("baseline",), why)
    numbers = {name: getattr(file, name) for name in ("stream_rows", "sure_feet", "coin_toss", "sync")}
    settings = replace(settings, **{name: value for name, value in numbers.items() if value is not None})
    baseline = folder / file.baseline if file.baseline else base.baseline
    return Configuration(settings, base.sources, preset, overridden, file.fail_on or base.fail_on, baseline)


def _preset(source: MarkedYaml, name: str, place: Keys) -> str:
    """Return a preset's name, or the path of its file in or below the folder of the configuration."""
    if name in preset_names():
        return name
    folder = source.path.parent
    path = folder / name
    if is_outside(path, folder):
        raise source.error(place, "'preset' names a file outside this file's folder; put it beside this file")
    if path.suffix.lower() not in (".yaml", ".yml") and not is_regular(path):
        presets = choose_text(name, preset_names(), "a .yaml file")
        raise source.error(place, f"there is no preset '{shown_key(name)}'{presets}")
    return str(path)


def _check_feet(source: MarkedYaml) -> None:
    """Check the rules that `feet` names. The package `feet` reads this key, but does not know the rules."""
    from dancetutor_cli.feet.song_feet import entries_of

    for number, entry in enumerate(entries_of(source)):
        for rule in {rule for rules in entry.ignore.values() for rule in rules}:
            resolve_name(source, match_codes, rule, ("feet", number, "ignore"))
