"""A long song in pieces: the same motion as baked whole, the same bytes in any number of processes."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from bake_plays import MEDLEY, chart, pad, plan_of, play, stream

from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.dance import pieces
from dancetutor_cli.dance.bake import bake, bake_plan
from dancetutor_cli.dance.foot_path import foot_path, shoe_path
from dancetutor_cli.dance.footwork.planner import plan_dance
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.pieces import in_processes, piece_ends, trimmed
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.formats.glb import write_glb

EVENTS = [(time + 14.0 * k, pressed) for k in range(3) for time, pressed in MEDLEY]


@pytest.fixture
def short(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pieces of some 16 seconds, so that a minute has several."""
    monkeypatch.setattr(pieces, "LENGTH", 16.0)
    monkeypatch.setattr(pieces, "LONGEST", 24.0)
    monkeypatch.setattr(pieces, "WITHIN", 4.0)


@pytest.fixture(scope="module")
def whole() -> Motion:
    return bake(chart().timing, play(EVENTS), pad())


@pytest.mark.parametrize("toes_up", [False, True])
def test_the_way_over_the_ground_alone_is_that_of_the_whole_foot(toes_up: bool) -> None:
    settings = default_settings()
    for track in plan_of(chart().timing, play(EVENTS), pad()).feet:
        if toes_up:
            moves = tuple(replace(move, pitches=(*move.pitches[:2], -0.2, -0.1)) for move in track.moves)
            track = replace(track, moves=moves)
        times = np.linspace(track.moves[0].lift - 1.0, track.moves[-1].land + 1.0, 5000)
        foot = foot_path(track, times, settings)
        ball, yaw = shoe_path(track, times, settings)
        assert np.array_equal(ball, foot.ball[:, [0, 2]]) and np.array_equal(yaw, foot.yaw)


def test_contacts_of_a_plan_that_has_its_contacts_are_the_same() -> None:
    plan = plan_of(chart().timing, play(EVENTS), pad())
    assert any(touch.end > contact.end for touch, contact in zip(plan.touches, plan.contacts, strict=True))
    assert replace(plan, touches=plan.contacts).contacts == plan.contacts


def places(motion: Motion) -> np.ndarray:
    return world_transforms(motion.skeleton, motion.rotations, motion.root)[0]


def test_pieces_join_to_what_is_baked_whole(whole: Motion, short: None) -> None:
    plan = plan_of(chart().timing, play(EVENTS), pad())
    assert len(piece_ends(plan, whole.times[0], whole.times[-1])) > 2
    parts = bake(chart().timing, play(EVENTS), pad())
    np.testing.assert_array_equal(parts.times, whole.times)
    away = np.linalg.norm(places(parts) - places(whole), axis=2)
    braid = np.array([name.startswith("braid") for name in whole.skeleton.names])
    assert away[:, ~braid].max() < 0.0005 and np.median(away) < 1e-5
    assert away[:, braid].max() < 0.010  # what swings freely makes more of a tenth of a millimetre; it was 139 mm
    assert np.mean(away[:, braid].max(axis=1) < 0.0005) > 0.97
    # no turn jumps to its negative at a seam
    assert (np.sum(parts.rotations[1:] * parts.rotations[:-1], axis=2) > 0).all()
    assert report(parts)["contacts missed"].value == report(whole)["contacts missed"].value


def test_pieces_end_where_nobody_moves(short: None) -> None:
    plan = plan_of(chart().timing, play(EVENTS), pad())
    for end in piece_ends(plan, 0.0, 50.0)[1:-1]:
        swings = [s for track in plan.feet for s in track.moves]
        assert not any(s.lift < end < s.land for s in swings)
        assert not any(p.start - p.lead < end < p.end for p in plan.presses)


def test_any_number_of_processes_gives_the_same_bytes(short: None) -> None:
    plan, context = plan_dance(chart().timing, play(EVENTS), pad())
    alone, shared = (bake_plan(plan, context, 60.0, run=partial(in_processes, jobs)) for jobs in (1, 2))
    assert alone.rotations.tobytes() == shared.rotations.tobytes()
    assert alone.root.tobytes() == shared.root.tobytes() and alone.times.tobytes() == shared.times.tobytes()


def test_a_trimmed_plan_says_the_same() -> None:
    plan = plan_of(chart().timing, play(EVENTS), pad())
    part = trimmed(plan, 20.0, 30.0)
    times = np.linspace(20.0, 30.0, 500)
    assert len(part.feet[0].moves) < len(plan.feet[0].moves) / 2
    for cut, full in zip(part.feet, plan.feet, strict=True):
        a, b = foot_path(cut, times, default_settings()), foot_path(full, times, default_settings())
        np.testing.assert_array_equal(a.ball, b.ball)
        np.testing.assert_array_equal(a.pitch, b.pitch)
        np.testing.assert_array_equal(a.down, b.down)


def test_two_minutes_of_twelve_steps_a_second_make_a_small_glb(tmp_path: Path) -> None:
    motion = bake(chart().timing, play(stream(2.0, 1416, 1 / 12)), pad(), section=(0.0, 120.0))
    write_glb(tmp_path / "still.glb", load_dancer())
    write_glb(tmp_path / "dances.glb", load_dancer(), motion)
    assert (tmp_path / "dances.glb").stat().st_size - (tmp_path / "still.glb").stat().st_size < 5_000_000
