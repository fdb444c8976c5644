"""What is to blame for a foot that steps twice: the hold, mine or jump that it would not happen without."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from play_rows import letters, pad_of, rows_of

from dancetutor_cli.feet.play import Play
from dancetutor_cli.feet.preset import Preset, load_preset
from dancetutor_cli.feet.solver.alternatives import DoublestepCause, doublestep_causes
from dancetutor_cli.feet.solver.solve import solve_rows

ITG, THESIS = load_preset("itg"), load_preset("thesis")
SINGLE = pad_of("dance-single")


def blamed(picture: str, gap: int = 24, preset: Preset = ITG) -> tuple[Play, tuple[DoublestepCause, ...]]:
    """The play of a picture at 150 beats a minute, and the causes of its doublesteps."""
    found = solve_rows(rows_of(picture, gap, 150.0), SINGLE, preset)
    return found, doublestep_causes(found, SINGLE, preset)


@pytest.mark.parametrize("preset", [ITG, THESIS], ids=["itg", "thesis"])
def test_a_hold_forces_the_other_foot(preset: Preset) -> None:
    found, causes = blamed("2... ...1 ..1. .1.. 3... 1...", preset=preset)
    assert letters(found).startswith("L... ...R ..R. .R..")
    assert causes == (DoublestepCause(2, True, "hold", 0, 0), DoublestepCause(3, True, "hold", 0, 0))


def test_of_several_holds_the_one_that_is_held_is_named() -> None:
    found, causes = blamed("2... 3... ...2 .1.. ..1. ...3")
    assert letters(found).split()[-2:] == [".L..", "..L."]
    assert [one for one in causes if one.row == 3] == [DoublestepCause(3, True, "hold", 1, 3)]


def test_a_roll_forces_too() -> None:
    _, causes = blamed("4... r..1 r.1. r1..", 24)
    assert {(one.forced, one.cause, one.cause_column) for one in causes} <= {(True, "hold", 0)}


def test_a_jump_decides_who_comes_next() -> None:
    """After the jump the left foot starts a run that turns around; without it the right one would."""
    found, causes = blamed("1.M1 1... .1.. ...1 1... .1..", 48)
    assert "doublestep" in found.moves[4], letters(found)
    assert causes == (DoublestepCause(4, False, "jump", 0, 0),)


@pytest.mark.parametrize(
    ("picture", "gap", "row", "mine"),
    [
        ("1... M..1 .1.. 1... M.1. ..1.", 24, 4, (4, 0)),
        ("1... ..1. ..M1 1... ..1. 1...", 48, 2, (2, 2)),
    ],
)
def test_a_mine_makes_a_foot_go_again(picture: str, gap: int, row: int, mine: tuple[int, int]) -> None:
    found, causes = blamed(picture, gap)
    if "doublestep" not in found.moves[row]:
        pytest.fail(letters(found))
    (cause,) = [one for one in causes if one.row == row]
    assert cause == DoublestepCause(row, False, "mine", *mine)
    mines = found.rows.mines.copy()
    mines[mine] = False
    without = solve_rows(replace(found.rows, mines=mines), SINGLE, ITG)
    assert "doublestep" not in without.moves[row]


def test_single_steps_alone_are_a_pattern() -> None:
    found, causes = blamed("1... .1.. ..1. 1... .1.. ..1. ...1", 48)
    assert any("doublestep" in names for names in found.moves)
    assert {(one.forced, one.cause, one.cause_row, one.cause_column) for one in causes} == {(False, "pattern", -1, -1)}


def test_every_doublestep_of_busy_rows_has_a_cause(busy_plays: list[Play]) -> None:
    """What is named is there, and lies before the doublestep or in its row."""
    seen = set()
    for found in busy_plays:
        causes = doublestep_causes(found, SINGLE, ITG)
        rows = [i for i, names in enumerate(found.moves) if {"doublestep", "forced-doublestep"} & set(names)]
        assert [one.row for one in causes] == rows
        for one in causes:
            assert one.forced == ("forced-doublestep" in found.moves[one.row])
            seen.add((one.forced, one.cause))
            if one.cause == "pattern":
                continue
            assert 0 <= one.cause_row <= one.row
            if one.cause == "mine":
                assert found.rows.mines[one.cause_row, one.cause_column]
            else:
                assert found.rows.steps[one.cause_row, one.cause_column]
                assert one.cause_row < one.row
            if one.cause == "hold" and one.forced:
                assert found.rows.hold_end[one.cause_row, one.cause_column] > found.rows.tick[one.row - 2] or (
                    found.rows.hold_end[one.cause_row, one.cause_column] < 0  # a roll
                )
            if one.cause == "jump":
                assert np.count_nonzero(found.rows.steps[one.cause_row]) > 1
    assert {(True, "hold"), (False, "pattern")} <= seen


@pytest.fixture(scope="module")
def busy_plays() -> list[Play]:
    """Random rows with jumps, holds and mines: more doublesteps than real charts have."""
    rng = np.random.default_rng(8)
    out = []
    for _ in range(60):
        held = -1
        words = []
        for _ in range(24):
            word = ["."] * 4
            for p in rng.choice(4, 1 + (rng.random() < 0.25), replace=False):
                word[p] = "1"
            if rng.random() < 0.15:
                word[rng.integers(4)] = "M"
            if held >= 0:
                word[held] = "."
                if rng.random() < 0.3:
                    word[held], held = "3", -1
            elif rng.random() < 0.15:
                held = int(rng.integers(4))
                word[held] = "2"
            words.append("".join(word))
        words.append("".join("3" if p == held else "." for p in range(4)))
        out.append(solve_rows(rows_of(" ".join(words), 24, 150.0), SINGLE, ITG))
    return out
