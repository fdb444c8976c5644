"""`--explain`: the documentation of a rule, from its docstring, with its severity and options."""

from __future__ import annotations

import inspect
import re
import textwrap
from typing import Any

from dancetutor_cli.lint.rule import BY_METER, FAMILIES, Rule, TimedRule, all_rules
from dancetutor_cli.lint.rule_settings import default_rules, default_severity, describe_bands

_UNITS = {
    "max_seconds": "s", "min_seconds": "s", "mine_seconds": "s", "tolerance": "s", "DT601 tolerance": "ms",
    "DT602 most": "ms", "share": "%", "below": "%", "most_quick": "%", "max_speed": "panel widths per second",
    "min_bpm": "BPM", "max_bpm": "BPM", "rates": "Hz", "by": "levels", "DT213 most": "passages", "least": "songs",
    "min_rows": "rows", "max_rows": "rows",
}  # fmt: skip


def explain(rule: type[Rule]) -> str:
    """Return the page of a rule: what it finds, a bad and a better pattern, and its options."""
    settings = dict(default_rules()[rule.code])
    del settings["severity"]
    lines = [
        f"{rule.code} {rule.name} ({FAMILIES[int(rule.code[2])]}, {default_severity(rule.code)})",
        "",
        documentation(rule),
    ]
    if settings:
        options = (f"{name}: {_value(rule.code, name, value)}" for name, value in settings.items())
        lines += ["", "Options: " + ", ".join(options)]
    if issubclass(rule, TimedRule) and settings.get("max_seconds") == BY_METER:
        share = settings["share"]
        lines += [
            "",
            f"The slowest {rule.times} that is reported, by meter (at most {share:g} % of the charts are as quick):",
        ]
        lines += [f"  {line}" for line in describe_bands(rule.times, share, rule.slowest)]
    return "\n".join(lines) + "\n"


def explain_all() -> str:
    """Return one line for each rule: code, name, severity, first line of its documentation."""
    lines: list[str] = []
    family = ""
    for code, rule in all_rules().items():
        if FAMILIES[int(code[2])] != family:
            family = FAMILIES[int(code[2])]
            lines.append(f"{'' if not lines else chr(10)}{family}")
        summary = documentation(rule).splitlines()[0]
        severity, more, _ = default_severity(code).partition(";")
        lines.append(f"  {code} {rule.name:22} {severity + '*' * len(more):8} {summary}")
    lines += ["", "* different for some charts; --explain RULE lists them"]
    return "\n".join(lines) + "\n"


# The docstring of a rule, prepared for readers. Tests of the rule read its options, as in "Bad (max_seconds = 0.6):",
# and the letters beside its rows.

_HEAD = re.compile(r"^(Bad|Better) \((\w+ = .*?)\):(.*)", re.MULTILINE)
_OPTION = re.compile(r"(\w+) = (\[.*?\]|[^,]*)")
_BOTH = re.compile(r"^(Bad\b.*?)[ \n](Better: )", re.MULTILINE)
_TAG = re.compile(r"(?<!`)#[A-Z]+:(?:[^;`\n]*;|\S+)")
_PATTERN = re.compile(r"(?:^    \S.*\n?)+", re.MULTILINE)
_ROWS = re.compile(r"^    [0-9MLFKx]{3,10}(?:  (\S+))?$", re.MULTILINE)
_WIDTH = 115  # characters of a docstring's line
_SPACING = " (the rows are 4ths at 120 BPM, 0.5 s apart)"
_LETTERS = "Letters: L R feet, l r toes of a bracket, < > left and right hand, ? no free limb."


def documentation(rule: type[Rule]) -> str:
    """Return a rule's docstring: its options in words, tags as code, and letters other than L and R explained."""
    text = inspect.cleandoc(rule.__doc__ or "")
    heads = [match[2] for match in _HEAD.finditer(text)]
    text = _HEAD.sub(lambda match: _head(rule.code, match, heads), text)
    text = _BOTH.sub(r"\1\n\n\2", _TAG.sub(r"`\g<0>`", text))
    if set("".join(_ROWS.findall(text))) - {*"LR"} and (drawn := _PATTERN.search(text)):
        text = f"{text[: drawn.end()].rstrip()}\n\n{_LETTERS}\n\n{text[drawn.end() :].lstrip()}"
    return text


def _head(code: str, match: re.Match[str], heads: list[str]) -> str:
    """Return "Bad, if max_seconds is set to 0.6 s:" for "Bad (max_seconds = 0.6):".

    If both patterns have the same options, the better one does not repeat them.
    """
    if match[1] == "Better" and heads[0] == match[2]:
        return f"Better:{match[3]}"
    *said, last = (f"{name} is set to {_with_unit(code, name, value)}" for name, value in _OPTION.findall(match[2]))
    said = [", ".join(said), last] if said else [last]
    spacing = _SPACING if "seconds" in match[2] else ""
    return textwrap.fill(f"{match[1]}, if {' and '.join(said)}{spacing}:{match[3]}", _WIDTH)


def _value(code: str, name: str, value: Any) -> str:
    """Return the value of an option as YAML, with its unit: "5 %", "[mine, roll]"."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        text = f"[{', '.join(map(str, value))}]"
        return _with_unit(code, name, text) if value else text
    return value if isinstance(value, str) else _with_unit(code, name, f"{value:g}")


def _with_unit(code: str, name: str, value: str) -> str:
    unit = _UNITS.get(f"{code} {name}", _UNITS.get(name, ""))
    unit = unit.removesuffix("s") if value == "1" and unit != "s" else unit
    return f"{value} {unit}".rstrip()
