"""Hands on the bar: the palms lie on the rail, a hand that a panel needs leaves it and comes back, files say so."""

from __future__ import annotations

import json
import struct
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from bake_plays import RH, L, R, chart, pad, play, stream

from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.motion import Motion, sample
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.rig.body import palm_points, points_in_world, world_transforms
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.formats.glb import write_glb
from dancetutor_cli.formats.npz import read_npz, write_npz

PLAY = [*stream(2.0, 16, 0.25), (7.0, {0: L, 3: R, 2: RH}), (8.5, {0: L}), *stream(9.0, 24, 0.2)]
BOTH = replace(default_settings(), bar=replace(default_settings().bar, one_slow=0.0, one_quick=0.0))  # never one alone


@pytest.fixture(scope="module")
def held() -> Motion:
    return bake(chart().timing, play(PLAY), pad(), bar=True, settings=BOTH)


def palm(motion: Motion, side: int, times: np.ndarray) -> np.ndarray:
    return points_in_world(motion.skeleton, (palm_points(motion.skeleton)[side],), *sample(motion, times))[:, 0]


def test_palms_lie_on_the_rail(held: Motion) -> None:
    """By the definition of a rail: all points a radius from its middle line."""
    assert held.bar is not None and len(held.grips) >= 4
    for grip in held.grips:
        at = palm(held, grip.side, np.linspace(grip.start, grip.end, 50))
        away = np.hypot(at[:, 1] - held.bar.height, at[:, 2] - held.bar.behind)
        assert np.abs(away - held.bar.radius).max() < 5e-4
        assert np.abs(at[:, 0] - grip.x).max() < 5e-4


def test_hands_hold_it_most_of_the_time(held: Motion) -> None:
    for side in (0, 1):
        assert sum(g.end - g.start for g in held.grips if g.side == side) > 0.55 * np.ptp(held.times)


def test_elbows_hang_behind_her_a_little_bent(held: Motion) -> None:
    """As players stand: upper arms down and back, elbows neither up in the air nor straight."""
    at = np.arange(0.5, 5.5, 0.1)
    places, _ = world_transforms(held.skeleton, *sample(held, at))
    for side, name in enumerate("lr"):
        resting = np.zeros(len(at), dtype=bool)
        for grip in (g for g in held.grips if g.side == side):
            resting |= (at >= grip.start) & (at <= grip.end)
        assert resting.mean() > 0.8
        shoulder, elbow, wrist = (
            places[resting, held.skeleton.index(f"{name}_{joint}")] for joint in ("shoulder", "elbow", "radiocarpal")
        )
        assert (shoulder - elbow)[:, 1].mean() > 0.10 and (shoulder - elbow)[:, 1].min() > 0.05
        assert (shoulder - elbow)[:, 2].mean() > 0.15
        upper, lower = shoulder - elbow, wrist - elbow
        cosine = np.sum(upper * lower, axis=1) / np.linalg.norm(upper, axis=1) / np.linalg.norm(lower, axis=1)
        bend = np.degrees(np.arccos(cosine))
        assert 90.0 < np.median(bend) < 150.0 and bend.max() < 172.0


def test_a_hand_lets_go_in_time_when_she_turns() -> None:
    """Crossovers behind and in front and a whole spin: arms stay within their joints' limits, out of the torso."""
    turns = [(2.0, {0: L}), (2.6, {3: R}), (3.2, {1: R}), (3.8, {3: L}), (4.4, {2: R}), (5.0, {0: L})]
    spin = [(5.5, {1: R}), (6.0, {3: L}), (6.5, {2: R}), (7.0, {0: L}), (7.5, {3: R}), *stream(8.5, 8, 0.3)]
    motion = bake(chart().timing, play([*turns, *spin]), pad(), bar=True, settings=BOTH)
    for measured in (report(motion), report(bake(chart().timing, play([*turns, *spin]), pad(), bar=True))):
        assert measured["limb in torso"].is_met and measured["palm off the bar"].is_met
        assert measured["wrist speed"].is_met, "hands have the time for their ways"
    measured = report(motion)
    arms = [
        n for n in measured.notes if "past its limit" in n and any(f"_{a}" in n for a in ("shoulder", "elbow", "radio"))
    ]
    assert arms == [] and measured["limb in torso"].is_met and measured["palm off the bar"].is_met
    alone = [t for t in np.arange(2.0, 8.0, 0.05) if len({g.side for g in motion.grips if g.start <= t <= g.end}) == 1]
    assert len(alone) > 10  # the other hand stays on the bar


def test_a_hand_on_its_way_is_never_across_the_body() -> None:
    """Twice around within 3 s: neither hand takes the rail where it would have to go through her to get there."""
    around = [(2.0 + 0.35 * k, {(0, 2, 3, 1)[k % 4]: (L, R)[k % 2]}) for k in range(9)]
    motion = bake(chart().timing, play([*around, *stream(6.0, 12, 0.3)]), pad(), bar=True)
    places, _ = world_transforms(motion.skeleton, *sample(motion, np.arange(1.0, 9.0, 1 / 120)))
    for name in "lr":
        wrist = places[:, motion.skeleton.index(f"{name}_radiocarpal")]
        assert np.linalg.norm(np.diff(wrist, axis=0), axis=1).max() * 120 < 4.5
    assert motion.grips


def test_a_hand_goes_to_its_panel_and_comes_back(held: Motion) -> None:
    press = next(c for c in held.contacts if c.limb == RH)
    assert all(g.end < press.start or g.start > press.start for g in held.grips)
    assert any(g.side == 1 and g.end < press.start for g in held.grips)
    assert any(g.side == 1 and g.start > press.start for g in held.grips)
    assert abs(palm(held, 1, np.array([press.start]))[0, 1]) < 2e-4


def test_goals_hold_but_balance_has_none() -> None:
    measured = report(bake(chart().timing, play([e for e in PLAY if len(e[1]) == 1]), pad(), bar=True))
    assert [f for f in measured.figures if f.is_met is False] == []
    assert measured["balance"].goal is None and measured["palm off the bar"].is_met


def test_the_report_sees_a_palm_off_the_bar(held: Motion) -> None:
    assert report(replace(held, root=held.root + np.array([0.0, 0.01, 0.0])))["palm off the bar"].value > 5.0


def test_she_leans_back(held: Motion) -> None:
    free = bake(chart().timing, play(PLAY), pad())
    head = held.skeleton.index("skullbase")
    at = np.arange(2.0, 5.0, 0.1)

    def ahead(motion: Motion) -> float:
        positions, _ = world_transforms(motion.skeleton, *sample(motion, at))
        return float((positions[:, head, 2] - positions[:, 0, 2]).mean())

    assert ahead(held) < ahead(free) - 0.05
    assert free.bar is None and free.grips == ()


def test_doubles_have_two_bars() -> None:
    events = [(1.0 + 0.3 * k, {k: (L, R)[k % 2]}) for k in range(8)]
    motion = bake(chart().timing, play(events, double=True), pad(double=True), bar=True)
    assert motion.bar is not None and len(motion.bar.spans) == 2
    (left, right) = sorted(motion.bar.spans)
    assert left[0] + right[1] == pytest.approx(0.0) and left[1] < 0 < right[0]
    for grip in motion.grips:
        assert any(low < grip.x < high for low, high in motion.bar.spans)


def test_files_hold_the_bar(held: Motion, tmp_path: Path) -> None:
    write_npz(tmp_path / "a.npz", held)
    back = read_npz(tmp_path / "a.npz")
    assert back.bar == held.bar and back.grips == held.grips and back.ground == held.ground is not None
    write_glb(tmp_path / "a.glb", load_dancer(), held)
    data = (tmp_path / "a.glb").read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    extras = json.loads(data[20 : 20 + length])["animations"][0]["extras"]
    assert extras["bar"]["height"] == held.bar.height and len(extras["bar"]["grips"]) == len(held.grips)  # type: ignore[union-attr]


WIDE = [(1.0 + 0.5 * k, {(0, 2, 3, 2)[k % 4]: (L, R, R, L)[k % 4]}) for k in range(40)]


def test_a_hand_holds_the_bar_while_the_other_one_moves_along_it() -> None:
    """She leans on it for 14 s, and there is no moment at which nobody holds it."""
    motion = bake(chart().timing, play(WIDE), pad(), bar=True, settings=BOTH)
    assert sum(g.end < 14.0 for g in motion.grips) > 3, "hands move along the bar"
    for second in np.arange(0.0, 14.0, 0.05):
        assert any(g.start - 0.04 <= second <= g.end + 0.04 for g in motion.grips), f"no hand at {second:.2f} s"


@pytest.mark.parametrize("both", [True, False])
def test_without_a_hand_on_the_bar_her_feet_carry_her(both: bool) -> None:
    """Moments that no sole can supply, where nobody holds the bar: she stood behind her feet there."""
    motion = bake(chart().timing, play(WIDE), pad(), bar=True, **({"settings": BOTH} if both else {}))
    measured = report(motion)
    for name in ("residual force, median", "residual moment, median"):
        assert measured[name].is_met
    assert measured["residual moment, 99th percentile"].value < 0.1, "0.18 to 0.24 before"
