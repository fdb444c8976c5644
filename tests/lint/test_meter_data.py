"""Which labels are no meters to learn from, and which files are one song."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import pytest

from dancetutor_cli.chart.reader import parse

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "research"))
from meter_data import Families, Labelled, is_modded, placeholder, sorted_out

GOOD = Labelled("a.sm", "", "t", "dance-single", "Hard", 9, 400, 100.0, ())


def test_a_meter_is_one() -> None:
    assert placeholder(GOOD, [GOOD]) == ""


@pytest.mark.parametrize(
    ("what", "says"),
    [
        ({"meter": 420}, "above 30"),
        ({"meter": 0}, "meter 0"),
        ({"rows": 20}, "fewer than 40 rows"),
        ({"seconds": 12.0}, "30 s"),
        ({"meter": 1}, "meter 1 with more than 2 rows"),
        ({"rows": 41}, "fewer than 0.5 rows a second"),
    ],
)
def test_what_is_a_joke_or_a_placeholder_is_left_out(what: dict[str, float], says: str) -> None:
    one = replace(GOOD, **what)  # type: ignore[arg-type]
    assert says in placeholder(one, [one])


def test_a_file_of_one_meter_is_left_out_whole() -> None:
    three = [replace(GOOD, difficulty=name) for name in ("Easy", "Medium", "Hard")]
    assert all("one meter" in reason for _, reason in sorted_out(three))
    assert all(not reason for _, reason in sorted_out([*three, replace(GOOD, meter=10)]))


def test_songs_are_one_by_title_and_by_number() -> None:
    families = Families()
    names = [families.add("Max 300", Path("g0001_a.sm")), families.add("MAX300!", Path("x.sm"))]
    names += [families.add("Other", Path("g0001_b.sm")), families.add("Third", Path("g0002_c.sm"))]
    roots = [families.root(name) for name in names]
    assert roots[0] == roots[1] == roots[2] != roots[3]


def test_songs_that_move_their_arrows_are_known() -> None:
    assert is_modded(
        parse(b"#TITLE:T;#BPMS:0=120;#FGCHANGES:0.000=lua=1.000;#NOTES:dance-single:C:Hard:9::\n1000;", Path("t.sm"))
    )
    assert not is_modded(parse(b"#TITLE:T;#BPMS:0=120;#FGCHANGES:;#NOTES:dance-single:C:Hard:9::\n1000;", Path("t.sm")))
