"""Warnings that many files have alike are one line, with a count and the first names."""

from __future__ import annotations

from pathlib import Path

from dancetutor_cli.commands.folder_run import JoinedWarnings

EMPTY = "no charts: the file has no NOTES"


def told(said: list[tuple[str, str]], *, every: bool = False) -> list[str]:
    warnings = JoinedWarnings(every=every)
    for path, warning in said:
        warnings.add(Path(path), warning)
    return list(warnings.lines())


def test_one_is_as_it_is() -> None:
    assert told([("a/x.sm", f"{Path('a/x.sm')}:1: {EMPTY}")]) == [f"warning: {Path('a/x.sm')}:1: {EMPTY}"]


def test_many_are_one_with_the_first_names() -> None:
    stubs = [(f"{name}.sm", f"{name}.sm:{line}: {EMPTY}") for line, name in enumerate("abcdefg", 1)]
    other = [("x.ssc", "x.ssc: there is no pad for smx-single")]
    assert told([*stubs[:3], *other, *stubs[3:]]) == [
        f"warning: a.sm:1: {EMPTY}; the same for 6 more: b.sm, c.sm, d.sm and 3 others (-v prints each)",
        "warning: x.ssc: there is no pad for smx-single",
    ]
    assert told(stubs[:2]) == [f"warning: a.sm:1: {EMPTY}; the same for 1 more: b.sm (-v prints each)"]


def test_charts_and_numbers_make_no_other_kind() -> None:
    said = "measures begin on the line of their comma"
    charts = [("x.sm", f"x.sm:1: dance-single {name}: {n} {said}") for name, n in (("Easy 5", 60), ("Hard 7", 62))]
    assert told(charts) == [
        f"warning: x.sm:1: dance-single Easy 5: 60 {said}; the same once more in this file (-v prints each)"
    ]


def test_each_where_that_is_wanted() -> None:
    stubs = [(f"{name}.sm", f"{name}.sm:1: {EMPTY}") for name in "abc"]
    assert told(stubs, every=True) == [f"warning: {name}.sm:1: {EMPTY}" for name in "abc"]


def test_what_does_not_name_its_file_is_given_its_name() -> None:
    said = "at rate 1.1 she lets 3 notes go"
    both = [("a.sm", said), ("b.sm", said)]
    assert told(both[:1]) == [f"warning: a.sm: {said}"]
    assert told(both) == [f"warning: a.sm: {said}; the same for 1 more: b.sm (-v prints each)"]
    assert told(both, every=True) == [f"warning: a.sm: {said}", f"warning: b.sm: {said}"]


def test_the_same_words_twice_in_one_file() -> None:
    twice = [("a.sm", f"a.sm:1: {EMPTY}")] * 2
    assert told(twice) == [f"warning: a.sm:1: {EMPTY}; the same once more in this file (-v prints each)"]
    assert told(twice, every=True) == [f"warning: a.sm:1: {EMPTY}; the same once more in this file"]


def test_it_is_safe_to_print() -> None:
    (line,) = told([("a\n.sm", "a\n.sm: x\x1b[2J"), ("b\x1b[2J.sm", "b\x1b[2J.sm: x\x1b[2J")])
    assert "\x1b" not in line and "\n" not in line
