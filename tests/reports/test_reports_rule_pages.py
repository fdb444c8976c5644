"""What readers see of a rule's documentation: sentences, units and YAML, whatever tests read in its docstring."""

from __future__ import annotations

import re

import pytest

from dancetutor_cli.lint.rule import all_rules
from dancetutor_cli.reports.rule_pages import documentation, explain


@pytest.mark.parametrize("code", sorted(all_rules()))
def test_a_page_is_plain(code: str) -> None:
    said = explain(all_rules()[code])
    assert not re.search(r"\w = |\bTrue\b|\bFalse\b|'|\d\.0\b(?!\.)", said.partition("Options: ")[2].partition("\n")[0])
    assert not re.search(r"^(Bad|Better) \(", said, re.MULTILINE)
    assert not re.search(r"^Bad.* Better: ", said, re.MULTILINE)  # a line each
    assert not re.search(r"(?<!`)#[A-Z]+:\S", said), "tags are code"
    explained = "l r toes of a bracket" in said
    assert explained == bool(re.search(r"^    [0-9MLFKx]{3,10}  \S*[lr<>?]", said, re.MULTILINE))


@pytest.mark.parametrize(
    ("code", "words"),
    [
        ("DT201", "Bad, if max_seconds is set to 0.6 s (the rows are 4ths at 120 BPM, 0.5 s apart):\n\n    1000  L\n"),
        ("DT201", "Options: max_seconds: by-meter, share: 5 %, min_seconds: 0.06 s\n"),
        ("DT305", "Bad, if max_speed is set to 2 panel widths per second: the left foot crosses"),
        ("DT401", "Better, if grid is set to [4]:"),
        ("DT501", "Bad: `#TITLE:;`\n\nBetter: `#TITLE:Two Left Feet;`\n"),
        ("DT503", "Options: strictly: true\n"),
        ("DT508", "Options: kinds: [mine, roll, hand]\n"),
        ("DT602", "Options: most: 8 ms\n"),
        ("DT604", "Options: least: 1 song\n"),
        ("DT611", "Options: share: 1 %\n"),
    ],
)
def test_options_and_patterns_in_words(code: str, words: str) -> None:
    assert words in explain(all_rules()[code])


def test_the_letters_are_explained_below_the_first_pattern() -> None:
    text = documentation(all_rules()["DT302"])
    bad, letters, better = (text.index(words) for words in ("1101  L>R", "Letters: ", "Better:"))
    assert bad < letters < better and text.count("Letters: ") == 1
