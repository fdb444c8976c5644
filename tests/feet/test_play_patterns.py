"""Preset `itg` on the patterns stepartists know, with the feet they would write down, and on each pattern's mirror.

A foot that nobody can know (either is as good) stands as `?`. Panels in the order left, down, up, right.
"""

from __future__ import annotations

import pytest
from play_rows import letters, mirrored_rows, pad_of, rows_of

from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_rows

ITG = load_preset("itg")
SINGLE = {
    "stream": ("1... .1.. ..1. ...1 .1.. ..1. 1... ...1", "L... .R.. ..L. ...R .L.. ..R. L... ...R", 12),
    "staircases": (
        "1... .1.. ..1. ...1 ..1. .1.. 1... .1.. ..1. ...1",
        "L... .R.. ..L. ...R ..L. .R.. L... .R.. ..L. ...R",
        12,
    ),
    "candles": ("1... .1.. 1... ..1. 1... .1.. 1... ...1", "L... .R.. L... ..R. L... .R.. L... ...R", 12),
    "drill": ("1... ..1. 1... ..1. 1... ..1. 1... ...1", "L... ..R. L... ..R. L... ..R. L... ...R", 12),
    "trill of down and up": ("1... .1.. ..1. .1.. ..1. .1.. ..1. ...1", "L... .R.. ..L. .R.. ..L. .R.. ..L. ...R", 12),
    "jacks": ("...1 ...1 ...1 .1.. .1.. ...1 1...", "...R ...R ...R .L.. .L.. ...R L...", 24),
    "slow jacks on one panel": (".1.. ...1 ..1. ..1. ...1", ".L.. ...R ..L. ..L. ...R", 48),
    "gallops": ("1... .... .... ...1 1... .... .... ...1 1...", "L... ...R L... ...R L...", 6),
    "a start on up": ("..1. 1... ..1. ...1", "..R. L... ..R. ?", 24),
    "a start from the side": (".1.. 1... .1.. ..1. 1...", ".R.. L... .R.. ?  ?", 24),
    # crossovers
    "crossover in front": ("1... .1.. ...1 .1.. 1... ...1", "L... .R.. ...L .R.. L... ...R", 24),
    "crossover behind": ("1... ..1. ...1 ..1. 1... ...1", "L... ..R. ...L ..R. L... ...R", 24),
    "sweep": (
        "...1 .1.. 1... .1.. ...1 ..1. 1... ..1. ...1",
        "...R .L.. R... .L.. ...R ..L. R... ..L. ...R",
        24,
    ),
    "crossover with a jack in it": ("1... .1.. ...1 ...1 .1.. 1...", "L... .R.. ...L ...L .R.. L...", 24),
    "crossover of 16ths": ("1... ...1 ..1. 1... .1.. ...1 .1.. 1... ...1", "L... ...R ..L. ? ? ? ? ? ?", 12),
    # footswitches and sideswitches
    "footswitch": (
        "1... ..1. ..1. ...1 .1.. .1.. 1... ...1 .1..",
        "L... ..R. ..L. ...R .L.. .R.. L... ...R .L..",
        24,
    ),
    "footswitch marked by a mine": ("1... .1.. .M.. .1.. ...1 1...", "L... .R.. .... .L.. ...R L...", 24),
    "slow footswitch marked by a mine": ("1... .1.. .M.. .1.. ...1 1...", "L... .R.. .... .L.. ...R L...", 48),
    "sideswitch": ("1... ..1. ...1 ...1 .1.. ..1. 1...", "L... ..R. ...L ...R .L.. ..R. L...", 24),
    # jumps
    "jumps on the same panels": ("1..1 1..1 1..1", "L..R L..R L..R", 24),
    "a jump that keeps one panel": ("11.. 1.1. 1..1", "LR.. L.R. L..R", 24),
    "a jump that shifts": ("1... .1.. 11.. .1.1 ..11", "L... .R.. LR.. .L.R ..LR", 24),
    "one step after a jump": ("1..1 .1.. ...1 1...", "L..R .L.. ...R L...", 24),
    "two jumps, one across": ("1..1 ..1. .1.. ...1 1...", "L..R ..R. .L.. ...R L...", 24),
    "jumps that turn": ("1.1. ..11 .1.1 11.. 1.1.", "L.R. ..LR .L.R LR.. L.R.", 24),
    "steps to both sides after jumps": ("1.1. ..11 .1.. ...1", "L.R. ..LR .L.. ...R", 48),
    "a mine after a jump tells who goes": ("1... .1.. 11.. M... ..1.", "L... .R.. LR.. .... ..L.", 24),
    "a mine under the other foot": ("1... .1.. 11.. .M.. ..1.", "L... .R.. LR.. .... ..R.", 24),
    "a mine in the row, jump of both sides": ("1..1 M.1. ...1", "L..R ..L. ...R", 24),
    "a mine in the row, other side": ("1..1 ..1M 1...", "L..R ..R. L...", 24),
    "a hold up to the row after a jump": ("2..1 3.1. 1...", "L..R ..R. L...", 48),
    # holds
    "steps beside a hold": ("2... ...1 ..1. .1.. ...1 3... ...1", "L... ...R ..R. .R.. ...R ...R", 24),
    "a crossed step beside a hold": (".2.. ...1 ..1. 1... ..1. ...1 .3..", ".L.. ...R ..R. R... ..R. ...R", 24),
    "a hold that ends before the next step": ("2... ...1 3... ..1. ...1", "L... ...R ..L. ...R", 48),
    "a hold at the end of a stream": (
        "1... ...1 .1.. ...2 .1.. 1... ..1. ...3",
        "L... ...R .L.. ...R .L.. L... ..L.",
        24,
    ),
    "alternating holds": ("2... 3..2 2..3 3..2 ...3", "L... ...R L... ...R", 48),
    "a roll beside steps": ("4... r1.. r..1 r1.. r.1. r..1", "L... LR.. L..R LR.. L.R. L..R", 24),
    # brackets
    "two steps beside a hold": ("2... .1.1 ...1 3...", "L... ? ...R", 24),
    "jumps beside a hold": ("2... ..1. ..11 .1.. .1.1 3...", "L... ..R. ..RR .R.. ?", 24),
    "two holds under one foot": ("22.. ..1. ...1 ..1. 33..", "LL.. ..R. ...R ..R.", 24),
    "four panels": ("1... ...1 1111", "L... ...R ?", 24),
}
DOUBLE = {
    "middle": ("...1.... ....1... ...1.... ....1...", "...L.... ....R... ...L.... ....R...", 24),
    "walk to the right": (
        "...1.... ....1... .....1.. .......1 ......1. ....1...",
        "...L.... ....R... .....L.. .......R ......L. ?",
        24,
    ),
    "walk all the way": (
        "1....... .1...... ...1.... ....1... .....1.. .......1",
        "L....... .R...... ...L.... ....R... .....L.. .......R",
        24,
    ),
    "footswitch": (
        "...1.... .....1.. .....1.. ....1... ..1..... ...1....",
        "...L.... .....R.. ? ? ? ?",
        24,
    ),
    "jump over the middle": ("..1...1. .1...1.. 1......1", "..L...R. .L...R.. L......R", 24),
    "a hold on one pad": (
        "...2.... ....1... .....1.. .......1 ......1. ...3....",
        "...L.... ....R... .....R.. .......R ......R.",
        24,
    ),
}
CASES = [("dance-single", name, *case) for name, case in SINGLE.items()] + [
    ("dance-double", name, *case) for name, case in DOUBLE.items()
]
SWAP = str.maketrans("LRlr", "RLrl")


def wrong(found: str, feet: str) -> list[int]:
    """Numbers of the rows with other feet than those written down."""
    pairs = zip(found.translate(str.maketrans("lr", "LR")).split(), feet.split(), strict=True)
    return [row for row, (ours, theirs) in enumerate(pairs) if theirs != "?" and ours != theirs]


@pytest.mark.parametrize(
    ("steps_type", "name", "picture", "feet", "gap"), CASES, ids=[f"{c[0]}: {c[1]}" for c in CASES]
)
@pytest.mark.parametrize("mirrored", [False, True], ids=["", "mirrored"])
def test_feet_of_a_pattern(steps_type: str, name: str, picture: str, feet: str, gap: int, mirrored: bool) -> None:
    pad, rows = pad_of(steps_type), rows_of(picture, gap, 150.0)
    image = pad.mirror_columns(left_right=True)
    assert image is not None
    if mirrored:
        rows = mirrored_rows(rows, image)
        feet = " ".join(
            word if word == "?" else "".join(word[p] for p in image).translate(SWAP) for word in feet.split()
        )
    found = letters(solve_rows(rows, pad, ITG))
    assert wrong(found, feet) == [], f"{name}: {found}"


def test_nothing_is_switched_before_the_first_step() -> None:
    """In doubles she stands on the middle panels; a first jump on two panels of the left pad is no jump footswitch."""
    pad = pad_of("dance-double")
    solved = solve_rows(rows_of("1..1.... 1....... ...1....", 48, 150.0), pad, ITG)
    assert solved.moves[0] == ("jump",)


def test_a_bracket_that_takes_over_two_panels_costs_the_same_in_the_mirror() -> None:
    """The foot takes over a side panel and a middle one: both ways a sideswitch."""
    pad = pad_of("dance-single")
    margins = [
        solve_rows(rows_of(picture, 12, 150.0), pad, ITG, margins=True).margin.tolist()
        for picture in ("1111 11MM 1..1", "1111 M1M1 1..1")
    ]
    assert margins[0] == margins[1]
