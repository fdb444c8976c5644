"""Small numerics of our own, which spare an installation scipy's 143 MB, against scipy's."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.ndimage import uniform_filter1d
from scipy.optimize import nnls
from scipy.signal import lfilter
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial.transform import Rotation

from dancetutor_cli.character.surfaces import connected
from dancetutor_cli.dance.quality.dynamics import nonnegative_least_squares
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.smoothing import recursive_filter

seeds = st.integers(0, 2**32 - 1)


@given(seeds, st.integers(1, 6), st.integers(1, 60), st.booleans())
def test_the_residual_is_the_least(seed: int, m: int, n: int, twice: bool) -> None:
    rng = np.random.default_rng(seed)
    columns, target = rng.normal(size=(m, n)), rng.normal(size=m)
    if twice:  # as soles have that touch at the same place
        columns = np.concatenate((columns, columns[:, : n // 2 + 1] * 2.0), axis=1)
    x = nonnegative_least_squares(columns, target)
    assert (x >= 0).all() and np.count_nonzero(x) <= m
    assert np.linalg.norm(columns @ x - target) == pytest.approx(nnls(columns, target)[1], abs=1e-9)


def test_what_cannot_be_pushed_is_left() -> None:
    assert nonnegative_least_squares(np.eye(3), -np.ones(3)).tolist() == [0, 0, 0]
    assert nonnegative_least_squares(np.eye(2), np.array([3.0, -1.0])).tolist() == [3, 0]
    assert nonnegative_least_squares(np.zeros((2, 4)), np.ones(2)).tolist() == [0] * 4


@given(seeds, st.integers(1, 400), st.integers(1, 5))
def test_the_filter_is_scipys_to_the_bit(seed: int, f: int, d: int) -> None:
    rng = np.random.default_rng(seed)
    above, below = rng.normal(size=3), np.array([2.0, *rng.uniform(-0.5, 0.5, 2)])
    values = rng.normal(size=(f, d))
    np.testing.assert_array_equal(recursive_filter(above, below, values), lfilter(above, below, values, axis=0))


@given(seeds, st.floats(-1e-3, 1e-3))
def test_a_matrix_as_a_quaternion(seed: int, shear: float) -> None:
    turn = Rotation.random(rng=np.random.default_rng(seed))
    for matrix in (turn.as_matrix(), np.diag([1.0, -1.0, -1.0]) @ turn.as_matrix()):
        x, y, z, w = Rotation.from_matrix(matrix + shear * np.eye(3, k=1)).as_quat()
        assert abs(np.dot(quat.from_matrix(matrix + shear * np.eye(3, k=1)), [w, x, y, z])) == pytest.approx(
            1, abs=1e-9
        )


@given(seeds, st.integers(1, 200), st.integers(0, 250))
def test_pieces_are_scipys(seed: int, count: int, many: int) -> None:
    edges = np.random.default_rng(seed).integers(0, count, (many, 2))
    graph = coo_array((np.ones(many, np.int8), (edges[:, 0], edges[:, 1])), shape=(count, count))
    _, theirs = connected_components(graph, directed=False)
    first = np.array([np.flatnonzero(theirs == name)[0] for name in theirs])
    np.testing.assert_array_equal(connected(edges, count), first)


def test_a_long_chain_is_one_piece() -> None:
    order = np.random.default_rng(1).permutation(100_000)
    chain = np.stack((order[:-1], order[1:]), axis=1)
    assert not connected(chain, 100_000).any()


def test_the_average_of_five_frames() -> None:
    speed = np.random.default_rng(2).normal(size=(40, 2))
    padded = np.pad(speed, ((2, 2), (0, 0)))
    ours = np.lib.stride_tricks.sliding_window_view(padded, 5, axis=0).mean(axis=-1)
    np.testing.assert_allclose(ours, uniform_filter1d(speed, size=5, axis=0, mode="constant"), atol=1e-12)
