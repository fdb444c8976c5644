"""What a configuration says of rules, as layers: their defaults, and what is laid on them; faults have their place."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from math import isfinite
from typing import Any, TypeVar

from dancetutor_cli.bounded import shown_key
from dancetutor_cli.errors import DancetutorError, FileError
from dancetutor_cli.library.settings_file import Condition, SettingError, texts_of
from dancetutor_cli.lint.registry import all_rules, matching, named_singly, rule_named
from dancetutor_cli.lint.rule import BY_METER
from dancetutor_cli.lint.rule_settings import SEVERITIES, Layer, Options
from dancetutor_cli.marked_yaml import read
from dancetutor_cli.resources import config_path

_Found = TypeVar("_Found")


@cache
def default_rules() -> Mapping[str, Options]:
    """Every rule with its default severity and options: configs/lint/default.yaml; FileError for a rule without."""
    path = config_path("lint/default.yaml")
    rules = dict(read(path).data["rules"])
    for code in sorted(all_rules().keys() - rules.keys()):
        raise FileError(
            path, f"rule {code} has no line under 'rules'; give it one, for example {code}: {{severity: info}}"
        )
    return rules


@cache
def default_severity(code: str) -> str:
    """The severity of a rule by default, for people: "off", or "off; warning for Beginner of meter 6 or less"."""
    data = read(config_path("lint/default.yaml")).data
    severity = str(data["rules"][code]["severity"])
    for entry in data.get("overrides", ()):
        for name, options in entry["rules"].items():
            if matching(str(name)) == {code} and not isinstance(options, Mapping):
                severity += f"; {options} for {' of '.join(map(_worded, entry['when'].values()))}"
    return severity


def _worded(value: object) -> str:
    """A value of a condition: a list as "A, B", a range of meters as "meter 6 or less"."""
    if isinstance(value, list):
        return ", ".join(map(str, value))
    low, _, high = str(value).partition("-")
    return f"meter {value}" if low and high else f"meter {high} or less" if high else f"meter {low} or more"


def layer_of(data: Mapping[str, Any], when: Condition, place: tuple[str | int, ...]) -> Layer:
    """What a file, or one of its overrides, says of rules where a condition holds; SettingError for what is wrong."""
    rules: dict[str, Options] = {}
    entries = data.get("rules") or {}
    if not isinstance(entries, Mapping):
        raise SettingError((*place, "rules"), "'rules' is a mapping of rules to their settings")
    for name, options in entries.items():
        at = (*place, "rules", str(name))
        code = known(rule_named, str(name), at).code
        # YAML 1.1 reads a bare `off` as False.
        short = "off" if options is False else options
        rules[code] = _options(code, {"severity": short} if isinstance(short, str) else short, at)
    select = _selected(data, "select", place) if data.get("select") is not None else None
    ignore, named = _selected(data, "ignore", place), named_singly(texts_of(data, "select"))
    return Layer(when, select, ignore, rules, named)


def _options(code: str, options: Any, place: tuple[str | int, ...]) -> Options:
    defaults = default_rules()[code]
    if not isinstance(options, Mapping):
        raise SettingError(place, f"settings of a rule are a severity or a mapping of {', '.join(defaults)}")
    given: dict[str, Any] = {
        key: "off" if key == "severity" and value is False else value for key, value in options.items()
    }
    for key, value in given.items():
        if key not in defaults:
            raise SettingError((*place, key), f"{code} has no setting '{shown_key(key)}'; it has {', '.join(defaults)}")
        if key == "severity" and value not in SEVERITIES:
            raise SettingError((*place, key), f"'{shown_key(value)}' is no severity; they are {', '.join(SEVERITIES)}")
        if not _same_kind(value, defaults[key]):
            said = shown_key(repr(value))
            raise SettingError((*place, key), f"{code} {key} must be a value like {defaults[key]!r}, not {said}")
        if fault := all_rules()[code].fault(key, value):
            raise SettingError((*place, key), f"{code} {key}: {fault}")
        if least := _too_small(value, defaults[key]):
            raise SettingError((*place, key), f"{code} {key} must be {least}, not {value!r}")
    return given


def _same_kind(value: Any, default: Any) -> bool:
    if isinstance(default, bool) or isinstance(value, bool):
        return isinstance(value, bool) and isinstance(default, bool)
    if default == BY_METER:  # a number or that word: `Rule.fault` looks at it
        return isinstance(value, int | float | str)
    if isinstance(default, int | float):
        return isinstance(value, int | float)
    if isinstance(default, list):
        return isinstance(value, list) and all(_same_kind(one, item) for item in default[:1] for one in value)
    return isinstance(value, type(default))


def _too_small(value: Any, default: Any) -> str:
    """How large a number must be, if it is not: nothing that rules measure is negative, and no grid is 0."""
    values, least = (value, 1) if isinstance(value, list) else ([value], 0)
    numbers = [one for one in values if isinstance(one, int | float) and not isinstance(one, bool)]
    if all(isfinite(one) and one >= least for one in numbers):
        return ""
    return f"at least {least}" + (" each" if isinstance(value, list) else "")


def _selected(data: Mapping[str, Any], key: str, place: tuple[str | int, ...]) -> frozenset[str]:
    found: frozenset[str] = frozenset()
    for selector in texts_of(data, key):
        found |= known(matching, selector, (*place, key))
    return found


def known(look_up: Callable[[str], _Found], name: str, place: tuple[str | int, ...]) -> _Found:
    """What a name in a file means; SettingError with its place if it means nothing."""
    try:
        return look_up(name)
    except DancetutorError as error:
        raise SettingError(place, str(error)) from None
