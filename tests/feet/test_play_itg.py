"""Preset `itg` on small charts: every kind of move where a player expects it, and costs that depend on time."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from play_rows import letters, pad_of, rows_of, with_values

from dancetutor_cli.chart.reader import load
from dancetutor_cli.feet.limbs import Limb, Part
from dancetutor_cli.feet.overrides import Overrides
from dancetutor_cli.feet.play import Play
from dancetutor_cli.feet.preset import Preset, load_preset
from dancetutor_cli.feet.solver.solve import solve_chart, solve_rows

ITG, DDR, STAMINA = (load_preset(name) for name in ("itg", "ddr", "stamina"))


def solved(
    picture: str, gap: int = 24, bpm: float = 150.0, preset: Preset = ITG, overrides: Overrides | None = None
) -> Play:
    """The play of a dance-single chart, rows by default 0.2 s apart."""
    return solve_rows(rows_of(picture, gap, bpm), pad_of("dance-single"), preset, overrides)


@pytest.mark.parametrize(
    ("picture", "feet"),
    [
        # the dancer starts on left and right, so a pattern may start crossed
        ("...1 .1.. 1... .1.. ...1", "...R .L.. R... .L.. ...R"),
        ("1... ..1. ...1 ..1. 1...", "L... ..R. ...L ..R. L..."),
        # alternation, jacks, jumps
        ("1... .1.. ..1. ...1 .1.. ..1.", "L... .R.. ..L. ...R .L.. ..R."),
        ("1... 1... 1... ...1 ...1 ...1", "L... L... L... ...R ...R ...R"),
        # footswitches and sideswitches
        ("1... ...1 .1.. .1.. 1... ...1", "L... ...R .L.. .R.. L... ...R"),
        ("1... ..1. ...1 ...1 .1.. ..1. 1...", "L... ..R. ...L ...R .L.. ..R. L..."),
        # the other foot holds: it may step as often as it likes
        ("2... ...1 ..1. .1.. ...1 3..1", "L... ...R ..R. .R.. ...R ...R"),
        # brackets: three steps, four steps, and one beside a hold
        ("1... ...1 .111 1...", "L... ...R .LrR L..."),
    ],
)
def test_feet(picture: str, feet: str) -> None:
    if "r" in feet:
        found = solved(picture)
        assert "bracket" in found.moves[2] and not (found.limb >= Limb.LEFT_HAND).any()
    else:
        assert letters(solved(picture)) == feet


def move_rows(found: Play, move: str) -> list[int]:
    return [row for row, names in enumerate(found.moves) if move in names]


@pytest.mark.parametrize(
    ("picture", "move", "rows"),
    [
        ("1... ...1 .1.. .1.. 1... ...1", "footswitch-down", [3]),
        ("1... ...1 ..1. ..1. 1... ...1", "footswitch-up", [3]),
        ("1... ..1. ...1 ...1 .1.. ..1. 1...", "sideswitch-right", [3]),
        ("...1 .1.. 1... 1... ..1. .1.. ...1", "sideswitch-left", [3]),
        ("1... .1.. ...1 .1.. 1...", "crossover-half", [2, 3]),
        ("1... ..1. ...1 ..1. 1...", "crossover-back", [2]),
        ("1... .1.. ...1 .1.. 1...", "crossover-front", [2]),
        ("1... 1... ...1", "jack", [1]),
        ("1..1 1..1", "jump", [0, 1]),
        ("2... ...1 ..1. 3...", "forced-doublestep", [2]),
        ("22.. ..22 .... 3333", "bracket", [1]),
    ],
)
def test_moves_by_name(picture: str, move: str, rows: list[int]) -> None:
    assert move_rows(solved(picture), move) == rows


def test_what_a_foot_in_a_hurry_does() -> None:
    """Two panels at once and close before and after them are a bracket; with time, a jump."""
    picture = "1... ...1 11.. ..1."
    assert letters(solved(picture, gap=48)) == "L... ...R LR.. ..L."
    assert move_rows(solved(picture, gap=12), "bracket") == [2]


def test_with_time_nobody_spins() -> None:
    around = "1... .1.. ...1 ..1. 1..."
    for gap in (96, 192):
        assert not move_rows(solved(around, gap=gap), "spin")


def test_four_steps_are_two_brackets_and_never_hands() -> None:
    found = solved("1... ...1 1111 1...")
    assert sorted(found.limb[2].tolist()) == [0, 0, 1, 1]
    assert sorted(found.part[2].tolist()) == [Part.HEEL, Part.HEEL, Part.TOE, Part.TOE]
    heel = {
        int(foot): int(np.flatnonzero((found.limb[2] == foot) & (found.part[2] == Part.HEEL))[0]) for foot in (0, 1)
    }
    assert found.feet[2].tolist() == [heel[0], heel[1]]
    assert "bracket" in found.moves[2] and "hand" not in found.moves[2]


def test_without_brackets_hands_come_where_feet_cannot() -> None:
    found = solved("1... ...1 1111 1...", preset=DDR)
    assert sorted(found.limb[2].tolist()) == [0, 1, 2, 3] and not found.part.any()
    assert solved("1... ...1 1..1 1...", preset=DDR).limb.max() == Limb.RIGHT_FOOT


def test_hands_come_down_in_front_of_her() -> None:
    """All four corners of a Pump pad: feet go to two beside each other, hands to the two ahead of them."""
    pad = pad_of("pump-single")
    for picture in ("1...1 11.11", ".1.1. 11.11", "11.11"):
        found = solve_rows(rows_of(picture, 48, 150.0), pad, load_preset("pump"))
        limb, facing = found.limb[-1].tolist(), np.radians(found.facing[-1])
        assert sorted(limb) == [-1, 0, 1, 2, 3]
        feet = pad.panels[[limb.index(0), limb.index(1)]].mean(axis=0)
        for hand in (Limb.LEFT_HAND, Limb.RIGHT_HAND):
            away = pad.panels[limb.index(hand)] - feet
            assert away @ (-np.sin(facing), np.cos(facing)) > 0.0, (picture, limb)


def test_a_step_beside_a_hold_with_the_other_foot_busy_is_a_bracket() -> None:
    found = solved("2... |..2 |1.| 3..3".replace("|", "."))
    assert found.part[2].any() and found.limb[2, 1] in (0, 1)
    assert move_rows(found, "bracket") == [2]


def test_holdswitch() -> None:
    """The left foot holds down and has to step on up, out of a bracket's reach: the right foot takes over the hold."""
    found = solved(".2.. ..1. .3.. ...1", overrides=Overrides.of({(0, 1): (0, 0), (24, 2): (0, 0)}))
    assert move_rows(found, "holdswitch") == [1] and found.feet[1].tolist() == [2, 1]
    without = with_values(load_preset("itg"), switches={"holdswitches": False})
    assert move_rows(solved(".2.. ..1. .3.. ...1", preset=without), "holdswitch") == []


def test_a_slow_footswitch_is_no_footswitch() -> None:
    fast, slow = (solved("1... ...1 .1.. .1..", gap=gap) for gap in (12, 96))
    assert letters(fast).split()[3] == ".R.." and letters(slow).split()[3] == ".L.."


def test_a_doublestep_costs_less_after_a_rest_and_more_in_a_hurry() -> None:
    def price(gap: int) -> int:
        forced = Overrides.of({(0, 0): (0, 0), (gap, 1): (0, 0)})
        found = solved("1... .1..", gap=gap, overrides=forced)
        assert "doublestep" in found.moves[1]
        return int(found.cost[1, found.terms.index("near-doublestep")])

    assert price(12) > price(48) > price(400)


def test_a_mine_marks_a_doublestep_and_a_footswitch() -> None:
    plain = solved("1... .1..", overrides=Overrides.of({(0, 0): (0, 0), (24, 1): (0, 0)}))
    marked = solved("1... M... .1..", overrides=Overrides.of({(0, 0): (0, 0), (48, 1): (0, 0)}))
    column, plainly = (plain.terms.index(name) for name in ("marked-doublestep", "near-doublestep"))
    assert marked.cost[2, plainly] == plain.cost[1, column] == 0
    assert marked.cost[2, column] == ITG.weight("marked-doublestep") < plain.cost[1, plainly]
    assert marked.cost[1, marked.terms.index("mine")] > 0
    forced = {(0, 0): (0, 0), (48, 0): (1, 0)}
    switched = solved("1... M... 1...", overrides=Overrides.of(forced))
    assert switched.cost[2, switched.terms.index("footswitch")] == 0
    assert switched.cost[2, switched.terms.index("marked-footswitch")] == ITG.weight("marked-footswitch")


def test_a_mine_only_row_costs_only_for_the_foot_on_it() -> None:
    found = solved("1... ...1 .M.. 1...")
    assert found.cost[2].sum() == 0 and found.limb[2].tolist() == [-1] * 4


def test_a_roll_alone_is_held_and_the_other_foot_is_free_to_step_twice() -> None:
    found = solved("4... r... r..1 r.1. r1.. 1..1".replace("|", "."), gap=12)
    assert {int(limb) for limb in found.limb[:, 0]} == {Limb.LEFT_FOOT}
    assert move_rows(found, "doublestep") == []
    assert found.cost[1].sum() == 0


def test_a_roll_may_be_tapped_by_turns_with_other_steps() -> None:
    """Two rolls at once and a third panel: a foot leaves its roll between the taps."""
    found = solved("4... r... ..1. r... ...1 r... .1..", gap=48)
    assert (found.limb != Limb.UNPLAYED).all() and found.limb.max() <= Limb.RIGHT_FOOT


def test_overrides_are_kept_in_every_preset() -> None:
    picture = "1... ...1 .1.. .1.. ..1. 1..1 2... .1.. 3..1"
    for preset in (ITG, DDR, STAMINA, load_preset("thesis")):
        for cells in (
            {(0, 0): (1, 0)},
            {(24, 3): (0, 0), (48, 1): (0, 0), (72, 1): (0, 0)},
            {(120, 0): (1, 0), (120, 3): (0, 0)},
            {(168, 1): (0, 0)},
            {(48, 1): (2, 0)},
        ):
            found = solved(picture, preset=preset, overrides=Overrides.of(cells))
            for (tick, column), (limb, _) in cells.items():
                row = int(np.searchsorted(found.rows.tick, tick))
                assert found.limb[row, column] == limb, (preset.name, cells)


def test_overrides_nobody_can_follow_are_left_out() -> None:
    found = solved("1..1 .1..", overrides=Overrides.of({(0, 0): (0, 0), (0, 3): (0, 0), (24, 0): (1, 0)}))
    assert (found.limb[0, [0, 3]] >= 0).all()


def test_crossovers_and_footswitches_cost_much_in_stamina() -> None:
    picture = "1... .1.. ...1 .1.. 1... ..1. ..1. ...1"
    assert solved(picture, preset=STAMINA).total > solved(picture).total


def test_labels(shared_data: Path) -> None:
    """At least as many rows right as the goal says: 99.5 % in songs, 97 % in patterns."""
    root = shared_data / "feet"
    right: dict[str, list[bool]] = {"song": [], "pattern": []}
    for label in json.loads((root / "labels.json").read_text()):
        song = load(root / label["chart"])
        chart = next(
            c for c in song.charts if (c.steps_type, c.difficulty) == (label["steps_type"], label["difficulty"])
        )
        found = solve_chart(chart, ITG)
        assert found is not None
        row_of = {round(tick / 48, 3): row for row, tick in enumerate(found.rows.tick.tolist())}
        for entry in label["rows"]:
            if "?" not in entry["feet"].values():
                row = row_of[round(entry["beat"], 3)]
                feet = {int(column): "LR".index(foot) for column, foot in entry["feet"].items()}
                right[label["kind"]].append(all(found.limb[row, column] == foot for column, foot in feet.items()))
    assert np.mean(right["song"]) >= 0.995
    assert np.mean(right["pattern"]) >= 0.97


def test_one_foot_twice_belongs_into_the_slow_gap() -> None:
    """Random taps 65 and 195 ms apart in turn: whatever one foot does twice in a row, it does after the long gap."""
    quick = slow = 0
    for seed in range(100, 120):
        rng, words, column = np.random.default_rng(seed), [], 0
        for number in range(60):
            column = int(rng.choice([other for other in range(4) if other != column]))
            words += ["." * column + "1" + "." * (3 - column)] + ["...."] * (2 * (number % 2))
        found = solve_rows(rows_of(" ".join(words), 12, 15_000 / 65), pad_of("dance-single"), ITG)
        foot = found.limb.max(axis=1)
        again = np.flatnonzero(foot[1:] == foot[:-1]) + 1
        quick, slow = quick + int((again % 2 == 1).sum()), slow + int((again % 2 == 0).sum())
    assert slow > 20 and quick <= slow / 4
