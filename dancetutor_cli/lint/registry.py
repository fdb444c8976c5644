"""All rules by code and name: the modules under `rules/`."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterable, Mapping
from functools import cache

from dancetutor_cli.errors import UsageError, did_you_mean
from dancetutor_cli.lint import rules
from dancetutor_cli.lint.rule import Rule


@cache
def all_rules() -> Mapping[str, type[Rule]]:
    """Code -> class of every rule, sorted by code."""
    found: dict[str, type[Rule]] = {}
    for module in pkgutil.iter_modules(rules.__path__):
        for value in vars(importlib.import_module(f"{rules.__name__}.{module.name}")).values():
            if isinstance(value, type) and issubclass(value, Rule) and "code" in vars(value):
                found[value.code] = value
    return dict(sorted(found.items()))


def rule_named(name: str) -> type[Rule]:
    """The rule with this code or name; UsageError names the valid ones."""
    for code, rule in all_rules().items():
        if name.upper() == code or name.lower() == rule.name:
            return rule
    near = did_you_mean(name, [word for code, rule in all_rules().items() for word in (code, rule.name)])
    raise UsageError(f"there is no rule '{name}'{near}; the rules are {described(all_rules().values())}")


def matching(selector: str) -> set[str]:
    """Codes that a selector means: a code, a name, a beginning of codes such as "DT2", or "all"."""
    if selector.lower() == "all":
        return set(all_rules())
    found = {code for code in all_rules() if code.startswith(selector.upper())} if selector else set()
    return found or {rule_named(selector).code}


def named_singly(selectors: Iterable[str]) -> frozenset[str]:
    """Codes of the selectors that are the code or the name of one rule, not of a family."""
    words = {selector.upper() for selector in selectors}
    return frozenset(code for code, rule in all_rules().items() if {code, rule.name.upper()} & words)


def described(classes: Iterable[type[Rule]]) -> str:
    """For error messages: "DT201 doublestep, DT202 spin"."""
    return ", ".join(f"{rule.code} {rule.name}" for rule in classes)
