"""Feet and palms are where the chart wants them at the notes' times, by forward kinematics on the result."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bake_plays import MEDLEY, RH, L, R, chart, pad, play, stream

from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.motion import Motion, sample
from dancetutor_cli.dance.quality.contact import soles_inside
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.rig.body import palm_points, points_in_world, sole_points
from dancetutor_cli.feet.limbs import Limb, Part
from dancetutor_cli.run.errors import DancetutorError


@pytest.fixture(scope="module")
def medley() -> Motion:
    return bake(chart().timing, play(MEDLEY), pad())


def lowest(motion: Motion, limb: int, time: float) -> tuple[float, np.ndarray]:
    """Height of the lowest point of a limb at a time, and the (x, z) of all its points near that height."""
    rotations, root = sample(motion, np.array([time]))
    points = sole_points(motion.skeleton)[limb] if limb < 2 else (palm_points(motion.skeleton)[limb - 2],)
    places = points_in_world(motion.skeleton, points, rotations, root)[0]
    low = float(places[:, 1].min())
    return low, places[places[:, 1] < low + 1e-3][:, [0, 2]]


def test_every_note_is_pressed_at_its_time_on_its_panel(medley: Motion) -> None:
    assert len(medley.contacts) == sum(len(pressed) for _, pressed in MEDLEY)
    for contact in medley.contacts:
        height, touching = lowest(medley, contact.limb, contact.start)
        assert abs(height) < 2e-4
        assert (np.abs(touching - contact.panel).max(axis=1) <= 0.14).any()


def test_limbs_come_from_above(medley: Motion) -> None:
    for contact in medley.contacts:
        assert lowest(medley, contact.limb, contact.start - 0.02)[0] > 0.002


def test_report_finds_no_miss_and_no_late_foot(medley: Motion) -> None:
    errors = report(medley).contact_errors
    assert len(errors) == len(medley.contacts)
    assert np.abs(errors).max() < 1.0


def test_report_finds_a_late_foot_and_a_wrong_panel(medley: Motion) -> None:
    """The same motion 20 ms later, and half a metre aside: the report must say so."""
    late = Motion(medley.skeleton, medley.fps, medley.times + 0.020, medley.rotations, medley.root, medley.contacts)
    errors = report(late).contact_errors
    assert np.nanmedian(errors) == pytest.approx(20.0, abs=1.5)
    aside = Motion(
        medley.skeleton,
        medley.fps,
        medley.times,
        medley.rotations,
        medley.root + np.array([0.5, 0, 0]),
        medley.contacts,
    )
    assert np.isnan(report(aside).contact_errors).mean() > 0.9


def test_keys_are_increasing_and_hold_every_note(medley: Motion) -> None:
    assert (np.diff(medley.times) > 0).all()
    for contact in medley.contacts:
        assert np.abs(medley.times - contact.start).min() < 1e-9


def test_doubles_cross_the_whole_pad() -> None:
    events = [(1.0 + 0.3 * k, {k: (L, R)[k % 2]}) for k in range(8)]
    motion = bake(chart().timing, play(events, double=True), pad(double=True))
    assert np.nanmax(np.abs(report(motion).contact_errors)) < 1.0
    travelled = motion.root[:, 0].max() - motion.root[:, 0].min()
    assert travelled > 3 * 0.28  # from the left pad to the right one


def test_held_foot_stays_and_the_other_taps() -> None:
    events = [(1.0, {0: L}), (1.5, {3: R}), (1.75, {2: R}), (2.0, {3: R}), (2.5, {1: L})]
    motion = bake(chart().timing, play(events, holds={(0, 0): 2.25}), pad())
    for time in np.linspace(1.0, 2.25, 40):
        height, touching = lowest(motion, Limb.LEFT_FOOT, time)
        assert abs(height) < 1e-3 and (np.abs(touching - [0.28, 0.0]).max(axis=1) <= 0.14).any()


def test_bracket_presses_two_panels_with_heel_and_toe() -> None:
    events = [(1.0, {0: L}), (1.5, {1: R, 3: R})]
    motion = bake(chart().timing, play(events, brackets={(1, 1): Part.HEEL, (1, 3): Part.TOE}), pad())
    assert np.abs(report(motion).contact_errors).max() < 1.0


@pytest.mark.parametrize("gap", [0.05, 0.08, 0.1, 0.3, 0.7])
def test_streams_of_any_speed_hit(gap: float) -> None:
    motion = bake(chart().timing, play(stream(1.0, 20, gap)), pad())
    assert np.abs(report(motion).contact_errors).max() < 1.0


def test_mine_lifts_the_foot_off_its_panel() -> None:
    events = [(1.0, {0: L}), (1.5, {3: R}), (2.5, {}), (3.5, {0: L})]
    motion = bake(chart().timing, play(events, mines={2: [0]}), pad())
    for time in np.linspace(2.43, 2.57, 20):
        assert lowest(motion, Limb.LEFT_FOOT, time)[0] >= 0.03


def test_section_is_part_of_the_whole() -> None:
    whole = bake(chart().timing, play(MEDLEY), pad())
    part = bake(chart().timing, play(MEDLEY), pad(), section=(3.0, 5.0))
    assert part.times[0] >= 3.0 and part.times[-1] <= 5.0
    inside = [c for c in whole.contacts if 3.0 <= c.start <= 5.0]
    assert list(part.contacts) == inside


def test_same_input_same_motion() -> None:
    first, second = (bake(chart().timing, play(MEDLEY), pad()) for _ in range(2))
    assert first.rotations.tobytes() == second.rotations.tobytes()


def test_nothing_to_dance_is_reported() -> None:
    with pytest.raises(DancetutorError, match="no steps"):
        bake(chart().timing, play([(1.0, {})], mines={0: [1]}), pad())
    with pytest.raises(DancetutorError, match="empty"):
        bake(chart().timing, play(MEDLEY), pad(), section=(5.0, 5.0))


def test_hand_reaches_the_floor_with_its_palm(medley: Motion) -> None:
    contact = next(c for c in medley.contacts if c.limb == RH)
    height, touching = lowest(medley, RH, contact.start)
    assert abs(height) < 2e-4 and np.abs(touching[0] - contact.panel).max() < 0.1


def test_the_report_reports_how_far_soles_are_inside_their_panels(medley: Motion) -> None:
    inside = soles_inside(medley)
    assert report(medley)["soles with the middle at least 2 cm inside the panel"].value == pytest.approx(
        100.0 * (inside > 0.02).mean()
    )
    shifted = replace(medley, root=medley.root + np.array([0.5, 0.0, 0.0]))
    assert report(shifted)["soles with the middle on the panel"].value == 0.0


@pytest.mark.parametrize(("gap", "least"), [(0.4, 0.1), (0.2, -1e-3), (0.12, -1e-3)])
def test_soles_keep_their_middle_on_the_panel(gap: float, least: float) -> None:
    """To and fro between both pads: slow steps stand well on the panel, quick ones near its edge, but on it."""
    events = [(1.0 + gap * k, {(3, 4, 6, 5, 7, 4, 2, 1)[k % 8]: (L, R)[k % 2]}) for k in range(24)]
    inside = soles_inside(bake(chart().timing, play(events, True), pad(True)))
    assert len(inside) == len(events)
    assert inside.min() > least
