"""`--explain`: the documentation of a rule, from its docstring, with its severity and options."""

from __future__ import annotations

import inspect

from dancetutor_cli.lint.layers import default_rules, default_severity
from dancetutor_cli.lint.registry import all_rules
from dancetutor_cli.lint.rule import BY_METER, FAMILIES, Rule, TimedRule
from dancetutor_cli.lint.times import described


def explain(rule: type[Rule]) -> str:
    """What a rule finds, how its bad and its better pattern look, and how it is set."""
    settings = dict(default_rules()[rule.code])
    del settings["severity"]
    lines = [
        f"{rule.code} {rule.name} ({FAMILIES[int(rule.code[2])]}, {default_severity(rule.code)})",
        "",
        inspect.getdoc(rule) or "",
    ]
    if settings:
        lines += ["", "Options: " + ", ".join(f"{name} = {value}" for name, value in settings.items())]
    if issubclass(rule, TimedRule) and settings.get("max_seconds") == BY_METER:
        share = settings["share"]
        lines += [
            "",
            f"How quick it is in at most {share:g} % of the charts of a meter, and is reported:",
        ]
        lines += [f"  {line}" for line in described(rule.times, share)]
    return "\n".join(lines) + "\n"


def explain_all() -> str:
    """One line for each rule: code, name, severity, first sentence."""
    lines: list[str] = []
    family = ""
    for code, rule in all_rules().items():
        if FAMILIES[int(code[2])] != family:
            family = FAMILIES[int(code[2])]
            lines.append(f"{'' if not lines else chr(10)}{family}")
        summary = (inspect.getdoc(rule) or "").splitlines()[0]
        severity, more, _ = default_severity(code).partition(";")
        lines.append(f"  {code} {rule.name:22} {severity + '*' * len(more):8} {summary}")
    lines += ["", "* otherwise for some charts; --explain RULE tells which"]
    return "\n".join(lines) + "\n"
