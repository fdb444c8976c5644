"""Notes that no person plays: which are let go, and that nothing else is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.play import Play, StepKind
from dancetutor_cli.feet.preset import DropReason
from dancetutor_cli.feet.unplayable import DroppedNote, dropped_notes_message, without_unplayable
from tests.dance.bake_plays import LH, RH, L, R, pad, play

LEFT, DOWN, UP, RIGHT = range(4)


def gone(one: Play) -> list[tuple[int, int, DropReason]]:
    return [(g.row, g.column, g.reason) for g in without_unplayable(one, pad())[1]]


@pytest.mark.parametrize(
    ("apart", "way", "is_gone"),
    [
        (0.075, (UP, DOWN), True),
        (0.08, (UP, DOWN), True),
        (0.085, (UP, DOWN), False),
        (0.075, (UP, UP), False),
        (0.075, (UP, RIGHT), False),  # panels that touch at a corner
    ],
)
def test_a_foot_does_not_leap(apart: float, way: tuple[int, int], is_gone: bool) -> None:
    one = play([(0.0, {LEFT: L, way[0]: R}), (apart, {way[1]: R}), (1.0, {RIGHT: R})])
    assert gone(one) == ([(1, way[1], DropReason.LEAP)] if is_gone else [])


def test_of_a_trill_of_one_foot_it_plays_every_second_note() -> None:
    """It stays where it is while it lets one go, and is there for the next."""
    one = play([(0.0, {LEFT: L}), *((0.5 + 0.07 * k, {(UP, DOWN)[k % 2]: R}) for k in range(6))])
    left, found = without_unplayable(one, pad())
    assert [g.row for g in found] == [2, 4, 6]
    assert [g.second for g in found] == pytest.approx([0.57, 0.71, 0.85])
    assert (left.feet[1:, R] == UP).all() and (left.limb[[1, 3, 5], UP] == R).all()
    assert np.allclose(left.facing[1:], one.facing[1]), "a foot that stays does not turn her"
    assert left.moves[2] == ("unplayable",)
    assert one.limb[2, DOWN] == R, "the play that was given is as it was"


def test_the_next_step_faces_as_the_feet_really_stand() -> None:
    one = play([(0.0, {LEFT: L}), (0.5, {UP: R}), (0.57, {DOWN: R}), (1.0, {RIGHT: L})])
    left, found = without_unplayable(one, pad())
    assert [g.row for g in found] == [2]
    assert left.facing[3] == pytest.approx(play([(0.0, {LEFT: L}), (0.5, {UP: R}), (1.0, {RIGHT: L})]).facing[2])


def test_a_hand_does_not_hop_but_drums_a_roll() -> None:
    quad = {LEFT: L, RIGHT: R, UP: RH, DOWN: LH}
    one = play([(0.36 * k, quad) for k in range(4)])
    assert {g[0] for g in gone(one)} == {1, 2, 3} and {g[2] for g in gone(one)} == {DropReason.HAND}
    assert not gone(play([(0.5 * k, quad) for k in range(4)]))
    drummed = play([(0.36 * k, {LEFT: L, UP: RH} if k else quad) for k in range(4)])
    assert len(gone(drummed)) == 3
    drummed.rows.steps[1:, UP] = StepKind.ROLL_TAP
    assert not gone(drummed)


def test_steps_that_the_solver_left_over_are_reported_and_mirror() -> None:
    one = play([(0.0, {LEFT: L, RIGHT: R}), (0.5, {UP: R}), (0.57, {DOWN: R})])
    one.limb[0, UP] = Limb.UNPLAYED
    assert gone(one) == [(0, UP, DropReason.LIMBS), (2, DOWN, DropReason.LEAP)]
    mirrored = play([(0.0, {LEFT: L, RIGHT: R}), (0.5, {UP: L}), (0.57, {DOWN: L})])
    mirrored.limb[0, UP] = Limb.UNPLAYED
    assert gone(mirrored) == gone(one)


def test_a_reason_decided_before_is_kept() -> None:
    one = play([(0.0, {LEFT: L}), (0.5, {UP: R}), (0.57, {DOWN: R})])
    left, found = without_unplayable(one, pad())
    slower = replace(left, rows=replace(left.rows, second=2 * left.rows.second))
    again, same = without_unplayable(slower, pad(), found)
    assert [(g.row, g.column, g.reason) for g in same] == [(2, DOWN, DropReason.LEAP)]
    assert same[0].second == pytest.approx(1.14) and (again.limb == left.limb).all()


def test_a_play_that_can_be_played_is_the_same_object() -> None:
    one = play([(0.1 * k, {(LEFT, UP, DOWN, RIGHT)[k % 4]: (L, R)[k % 2]}) for k in range(40)])
    assert without_unplayable(one, pad()) == (one, ())


def test_it_is_reported_in_one_line() -> None:
    found = [
        DroppedNote(1.0, 0, 2, DropReason.LEAP),
        DroppedNote(2.0, 5, 1, DropReason.LEAP),
        DroppedNote(2.0, 5, 2, DropReason.LIMBS),
    ]
    assert dropped_notes_message(found) == (
        "3 notes not played: 1 because there are more panels at once than limbs, 2 because a foot would have to leap"
    )
    assert dropped_notes_message(found[:1]) == "1 note not played, because a foot would have to leap"
    assert dropped_notes_message(()) == ""
