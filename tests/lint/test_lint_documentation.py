"""The documentation of every rule is true: its bad pattern is found, its better pattern is not.

The feet are forced to the letters beside the rows, so that a pattern stays what it shows whatever a preset costs.
"""

from __future__ import annotations

import ast
import inspect
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
import yaml

from dancetutor_cli.chart.reader import parse
from dancetutor_cli.feet.overrides import Overrides
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_chart
from dancetutor_cli.lint import rules
from dancetutor_cli.lint.rule import ChartRule, ReaderRule, all_rules, match_codes, named_singly, rule_named
from dancetutor_cli.lint.rule_settings import default_rules
from dancetutor_cli.lint.subject import ChartSubject

LIMBS = {"L": (0, 0), "R": (1, 0), "l": (0, 2), "r": (1, 2), "<": (2, 0), ">": (3, 0)}
STEPS_TYPES = {4: "dance-single", 8: "dance-double"}
# Patterns that need what not every solver and preset has: margins, brackets, switches of feet.
NEEDS_ITG = {"DT207", "DT208", "DT210", "DT211", "DT212"}


@dataclass
class Pattern:
    kind: str
    options: dict[str, Any]
    rows: list[str]
    letters: list[str]


def patterns(rule: type) -> list[Pattern]:
    found: list[Pattern] = []
    for line in (inspect.getdoc(rule) or "").splitlines():
        if head := re.match(r"(Bad|Better)\b(?: \((\w+ = .*?)\))?", line):
            said = (one.split(" = ") for one in re.split(r", (?=\w+ = )", head[2] or "") if one)
            options = {name: yaml.safe_load(value) for name, value in said}
            found.append(Pattern(head[1], options, [], []))
        elif row := re.match(r"    ([0-9MLFKx]{3,10})(?:  (\S+))?$", line):
            found[-1].rows.append(row[1])
            found[-1].letters.append(row[2] or "")
    return [pattern for pattern in found if pattern.rows]


def subject(pattern: Pattern, code: str) -> ChartSubject:
    steps_type = STEPS_TYPES[max(map(len, pattern.rows))]
    notes = "\n".join(pattern.rows)
    text = f"#TITLE:T;\n#BPMS:0=120;\n#NOTES:{steps_type}::Hard:9::\n{notes}\n;\n"
    song = parse(text.encode(), Path("x.sm"))
    chart = song.charts[0]
    forced = {}
    for row, (cells, letters) in enumerate(zip(pattern.rows, pattern.letters, strict=True)):
        columns = [column for column, cell in enumerate(cells) if cell in "124L"]
        for column, letter in zip(columns, letters, strict=False):
            if letter in LIMBS:
                forced[row * 48, column] = LIMBS[letter]
    preset = load_preset("itg" if code in NEEDS_ITG else "thesis")
    return ChartSubject(
        song, chart, solve_chart(chart, preset, Overrides.of(forced), margins=code == "DT207"), load_pad(steps_type)
    )


def findings(rule: Any, pattern: Pattern) -> list[str]:
    options = {**default_rules()[rule.code], "severity": "warning", **pattern.options}
    return [finding.message for finding in rule(options).check(subject(pattern, rule.code))]


@pytest.mark.parametrize("code", sorted(all_rules()))
def test_every_rule_is_documented_with_a_bad_and_a_better_pattern(code: str) -> None:
    text = inspect.getdoc(all_rules()[code]) or ""
    first = text.splitlines()[0]
    assert first.endswith((".", ":")) and len(first) <= 115
    assert re.search(r"^Bad\b", text, re.M) and re.search(r"\bBetter\b", text)


@pytest.mark.parametrize("code", sorted(all_rules()))
def test_options_are_explained(code: str) -> None:
    text = inspect.getdoc(all_rules()[code]) or ""
    assert [name for name in default_rules()[code] if name != "severity" and f"`{name}`" not in text] == []


@pytest.mark.parametrize("code", [c for c, rule in all_rules().items() if issubclass(rule, ChartRule | ReaderRule)])
def test_the_patterns_are_what_they_are_said_to_be(code: str) -> None:
    rule = all_rules()[code]
    drawn = patterns(rule)
    if code in NEEDS_ITG and not _has_itg():
        pytest.skip("the preset itg is not there yet")
    for pattern in drawn:
        assert len(pattern.rows) == 4
        found = findings(rule, pattern)
        assert bool(found) == (pattern.kind == "Bad"), (pattern, found)


def test_most_chart_rules_draw_their_patterns() -> None:
    chart_rules = [rule for rule in all_rules().values() if issubclass(rule, ChartRule)]
    assert sum(len(patterns(rule)) == 2 for rule in chart_rules) >= 19


def _has_itg() -> bool:
    from dancetutor_cli.feet.preset import preset_names

    return "itg" in preset_names()


@pytest.mark.parametrize(("former", "code"), [("ambiguous-start", "DT207"), ("feet-wish", "DT111")])
def test_the_former_name_of_a_rule_still_selects_it(former: str, code: str) -> None:
    assert match_codes(former) == {code} == named_singly([former]) and rule_named(former.upper()).code == code


def test_the_map_of_the_rules_says_who_names_a_rule_by_its_code() -> None:
    """The modules outside of `lint.rules` with a code as a value; docstrings and messages may give examples."""
    package = Path(inspect.getfile(rules)).parents[2]
    using = set()
    for path in package.rglob("*.py"):
        if path.parent.name != "rules":
            words = (
                node.value for node in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(node, ast.Constant)
            )
            if any(isinstance(word, str) and re.fullmatch(r"DT\d{3}( \w+)?", word) for word in words):
                using.add(".".join(path.relative_to(package).with_suffix("").parts))
    assert using == set(re.findall(r"^    (\S+) _?[A-Za-z]", rules.__doc__ or "", re.MULTILINE))
