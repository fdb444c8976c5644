"""Everything the reader warns of has a rule that reports it."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from dancetutor_cli.chart import reader
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.feet.preset import PresetChoice, load_preset
from dancetutor_cli.lint.analysis import AnalyzeTask, analyze_file
from dancetutor_cli.lint.configuration import load_configuration, with_selection
from dancetutor_cli.lint.rule import all_rules
from dancetutor_cli.run.errors import FileError

READER = Path(reader.__file__).parent
CODE = re.compile(r"[a-z]+(-[a-z]+)+")
REPORTERS = {"ReadWarning", "add_warnings", "warn"}
CLAIMED = {code for rule in all_rules().values() for code in rule.codes}


def codes_in(path: Path) -> Iterator[str]:
    """Text that looks like a code in each statement or function of a module that has to do with warnings."""
    for node in ast.parse(path.read_text("utf-8")).body:
        names = {n.id for n in ast.walk(node) if isinstance(n, ast.Name)}
        names |= {n.attr for n in ast.walk(node) if isinstance(n, ast.Attribute)}
        if names & REPORTERS or any("unknown" in str(getattr(n, "value", "")) for n in ast.walk(node)):
            for text in (n.value for n in ast.walk(node) if isinstance(n, ast.Constant)):
                if isinstance(text, str) and CODE.fullmatch(text):
                    yield text


def test_every_code_in_the_readers_source_is_claimed_by_a_rule() -> None:
    written = {code for path in READER.glob("*.py") for code in codes_in(path)}
    assert {"odd-difficulty", "unsafe-music", "odd-timing", "unmatched-head", "short-row", "unknown-note"} <= written
    assert written - CLAIMED == set()


def test_no_rule_claims_what_the_reader_never_says() -> None:
    text = "".join(path.read_text("utf-8") for path in READER.glob("*.py"))
    assert {code for code in CLAIMED if f'"{code}"' not in text} == set()


def test_every_warning_of_the_odd_files_becomes_a_finding(hostile: Path) -> None:
    preset = load_preset("thesis")
    settings = with_selection(load_configuration(None), ["DT1"], []).settings
    found = 0
    for path in sorted(p for p in hostile.iterdir() if p.suffix in (".sm", ".ssc")):
        try:
            song = reader.load(path)
        except FileError:
            continue
        warned = {(w.code, w.line) for w in song.warnings} | {(w.code, w.line) for c in song.charts for w in c.warnings}
        result = analyze_file(AnalyzeTask(path, PresetChoice(preset), Selection(), settings))
        told = [(finding.rule, finding.line) for finding, _ in result.all_findings()]
        folded = [finding.message for finding, _ in result.all_findings() if finding.rule == "DT102"]
        for code, line in warned:
            rules = [rule.code for rule in all_rules().values() if code in rule.codes]
            assert len(rules) == 1, f"{path.name}: {code} has {rules}"
            if rules == ["DT106"] and any(told_at[0] == "DT102" for told_at in told):
                continue  # may come of a misread row beside it
            if rules == ["DT102"] and any(f"on line {line}" in said or f", {line}" in said for said in folded):
                continue  # one finding with the lines of all that is odd in the same way
            assert (rules[0], line) in told, f"{path.name}: {code} in line {line} is not told"
            found += 1
    if not found:
        pytest.fail("no file had a warning")
