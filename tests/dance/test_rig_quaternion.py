"""Quaternion identities, checked against rotation matrices."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from dancetutor_cli.dance.rig import quaternion as quat

component = st.floats(-1, 1, allow_nan=False)
vectors = hnp.arrays(np.float64, (5, 3), elements=st.floats(-5, 5))


@st.composite
def rotations(draw: st.DrawFn) -> np.ndarray:
    raw = draw(hnp.arrays(np.float64, (5, 4), elements=component))
    raw[np.linalg.norm(raw, axis=1) < 0.05] = [0.5, -0.5, 0.5, 0.5]
    return quat.normalize(raw)


@given(rotations(), rotations(), vectors)
def test_product_is_rotation_after_rotation(a: np.ndarray, b: np.ndarray, v: np.ndarray) -> None:
    by_matrix = np.einsum("nij,njk,nk->ni", quat.to_matrix(a), quat.to_matrix(b), v)
    np.testing.assert_allclose(quat.rotate(quat.multiply(a, b), v), by_matrix, atol=1e-9)


@given(rotations())
def test_matrices_are_proper_rotations(q: np.ndarray) -> None:
    m = quat.to_matrix(q)
    np.testing.assert_allclose(m @ np.swapaxes(m, -1, -2), np.broadcast_to(np.eye(3), m.shape), atol=1e-9)
    np.testing.assert_allclose(np.linalg.det(m), 1.0, atol=1e-9)


@given(rotations(), rotations(), vectors, st.floats(0, 1))
def test_every_result_has_unit_length(a: np.ndarray, b: np.ndarray, v: np.ndarray, t: float) -> None:
    axis = np.where(np.linalg.norm(v, axis=1, keepdims=True) < 1e-2, [[1.0, 0, 0]], v)
    made = (
        quat.multiply(a, b),
        quat.conjugate(a),
        quat.slerp(a, b, np.full(5, t)),
        quat.from_axis_angle(axis, v[:, 0]),
    )
    for q in (*made, quat.between(axis, axis[::-1]), *quat.swing_twist(a, (0.0, 0.6, 0.8)), quat.normalize(3 * a)):
        np.testing.assert_allclose(np.linalg.norm(q, axis=-1), 1, atol=1e-9)


@given(rotations(), rotations(), vectors, st.floats(0, 1))
def test_q_and_its_negative_are_one_rotation(a: np.ndarray, b: np.ndarray, v: np.ndarray, t: float) -> None:
    np.testing.assert_allclose(quat.rotate(-a, v), quat.rotate(a, v), atol=1e-12)
    np.testing.assert_allclose(quat.to_matrix(-a), quat.to_matrix(a), atol=1e-12)
    np.testing.assert_allclose(quat.angle_between(a, -a), 0, atol=1e-6)
    np.testing.assert_allclose(quat.angle_between(-a, b), quat.angle_between(a, b), atol=1e-9)
    opposite = np.abs(np.sum(a * b, axis=1)) < 1e-3  # half around: both arcs are equally short
    ways = quat.slerp(a, b, np.full(5, t)), quat.slerp(a, -b, np.full(5, t))
    np.testing.assert_allclose(quat.angle_between(*ways)[~opposite], 0, atol=1e-6)


@given(rotations(), rotations(), vectors)
def test_the_inverse_takes_back(a: np.ndarray, b: np.ndarray, v: np.ndarray) -> None:
    np.testing.assert_allclose(quat.rotate(quat.conjugate(a), quat.rotate(a, v)), v, atol=1e-9)
    np.testing.assert_allclose(quat.multiply(a, quat.conjugate(a)), np.tile(quat.IDENTITY, (5, 1)), atol=1e-9)
    swapped = quat.multiply(quat.conjugate(b), quat.conjugate(a))
    np.testing.assert_allclose(quat.conjugate(quat.multiply(a, b)), swapped, atol=1e-12)


@given(rotations(), rotations(), st.floats(0, 1))
def test_slerp_keeps_speed_and_takes_the_short_arc(a: np.ndarray, b: np.ndarray, t: float) -> None:
    whole = quat.angle_between(a, b)
    part = quat.angle_between(a, quat.slerp(a, b, np.full(5, t)))
    assert (whole <= np.pi + 1e-9).all()
    np.testing.assert_allclose(part, t * whole, atol=1e-5)


@given(vectors, vectors)
def test_between_leads_one_direction_to_the_other(a: np.ndarray, b: np.ndarray) -> None:
    a[np.linalg.norm(a, axis=1) < 1e-2] = [1, 0, 0]
    b[np.linalg.norm(b, axis=1) < 1e-2] = [-1, 0, 0]
    turned = quat.rotate(quat.between(a, b), a / np.linalg.norm(a, axis=1, keepdims=True))
    np.testing.assert_allclose(turned, b / np.linalg.norm(b, axis=1, keepdims=True), atol=1e-4)


@given(rotations(), st.sampled_from([(1.0, 0, 0), (0, 1.0, 0), (0, 0.6, 0.8)]))
def test_swing_and_twist_multiply_to_the_whole(q: np.ndarray, axis: tuple[float, float, float]) -> None:
    swing, twist = quat.swing_twist(q, axis)
    assert np.allclose(quat.angle_between(quat.multiply(swing, twist), q), 0, atol=1e-6)
    np.testing.assert_allclose(np.cross(twist[:, 1:], axis), 0, atol=1e-9)


@pytest.mark.parametrize("axis, v, expected", [((0, 1, 0), (0, 0, 1), (1, 0, 0)), ((1, 0, 0), (0, 1, 0), (0, 0, 1))])
def test_quarter_turns_have_the_right_hand(axis: tuple, v: tuple, expected: tuple) -> None:
    np.testing.assert_allclose(quat.rotate(quat.from_axis_angle(axis, np.pi / 2), v), expected, atol=1e-12)


def test_continuous_only_flips_signs() -> None:
    angles = np.linspace(0, 4 * np.pi, 50)
    smooth = quat.from_axis_angle((0, 1, 0), angles)
    flipped = smooth * np.where(np.arange(50) % 3 == 0, -1, 1)[:, None]
    out = quat.continuous(flipped)
    assert (np.sum(out[1:] * out[:-1], axis=1) > 0).all()
    np.testing.assert_allclose(np.abs(np.sum(out * smooth, axis=1)), 1.0)
