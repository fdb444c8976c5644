"""The rasteriser's kernels against slow, independent numpy: coverage, depth, culling, skinning, blur."""

from __future__ import annotations

import numpy as np
import pytest
import renderers_scene as rs

from dancetutor_cli.character.characters import load_character, name_in_gait
from dancetutor_cli.film.scene.cpu.floor import blur
from dancetutor_cli.film.scene.cpu.raster import (
    BACK,
    BAND,
    DEPTH_UNIT,
    FRONT,
    SNAP,
    SkinnedVertices,
    empty_canvas,
    fill_triangles,
    note_least,
    skin_vertices,
)
from dancetutor_cli.film.scene.cpu.stage_colours import arrow_distance
from dancetutor_cli.film.scene.cpu.standing import quantise
from dancetutor_cli.film.scene.geometry import pack

HEIGHT, WIDTH = 40, 60


def _random_triangles(seed, count, spread):
    rng = np.random.default_rng(seed)
    middle = rng.uniform(-10, 70, (count, 1, 2))
    points = np.concatenate([middle + rng.normal(0, spread, (count, 3, 2)), rng.uniform(0.1, 2.0, (count, 3, 1))], 2)
    points[..., :2] = np.round(points[..., :2] * SNAP) / SNAP
    points = np.concatenate([points, np.zeros((count, 3, 1))], 2)  # turned neither to nor from the viewer
    return points.reshape(-1, 4), np.arange(3 * count, dtype=np.int32).reshape(-1, 3)


def _drawn(points, triangles, keep):
    canvas = empty_canvas(HEIGHT, WIDTH)
    fill_triangles(points, triangles, keep, 0, canvas)
    return (canvas.nearest >> 32) / DEPTH_UNIT, (canvas.nearest & 0xFFFFFFFF) - 1, canvas


def _reference(points, triangles, keep):
    """For every sample the triangle nearest to the eye, by barycentric coordinates; and how near it is to an edge."""
    y, x = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    depth, ids, edge = np.zeros((HEIGHT, WIDTH)), np.full((HEIGHT, WIDTH), -1), np.full((HEIGHT, WIDTH), np.inf)
    for number, corners in enumerate(points[triangles]):
        (x0, y0, z0), (x1, y1, z1), (x2, y2, z2) = corners[:, :3]
        # With y downwards, counter-clockwise triangles have a negative area.
        area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
        if area == 0 or (area > 0) == (keep == FRONT):
            continue
        matrix = np.array([[x0, x1, x2], [y0, y1, y2], [1, 1, 1]])
        weights = np.linalg.solve(matrix, np.stack([x.ravel(), y.ravel(), np.ones(x.size)])).reshape(3, HEIGHT, WIDTH)
        z = weights[0] * z0 + weights[1] * z1 + weights[2] * z2
        edge = np.minimum(edge, np.abs(weights.min(0)))
        better = (weights.min(0) >= 0) & (z > depth)
        depth[better], ids[better] = z[better], number
    return depth, ids, edge


@pytest.mark.parametrize("keep", [FRONT, BACK])
@pytest.mark.parametrize(("seed", "count", "spread"), [(1, 6, 30), (2, 60, 8), (3, 400, 2)])
def test_fill_agrees_with_barycentric_coordinates(seed, count, spread, keep):
    points, triangles = _random_triangles(seed, count, spread)
    depth, ids, _ = _drawn(points, triangles, keep)
    expected_depth, expected_ids, edge = _reference(points, triangles, keep)
    clear_cut = edge > 1e-9
    assert clear_cut.mean() > 0.9 and (expected_ids[clear_cut] >= 0).sum() > 20
    np.testing.assert_allclose(depth[clear_cut], expected_depth[clear_cut], rtol=1e-4, atol=1e-5)
    differing = (ids != expected_ids) & clear_cut
    # Where two triangles are equally deep to single precision, either may win.
    assert differing.sum() <= 2


def test_triangles_that_share_edges_leave_no_gap_and_do_not_overlap_much():
    rng = np.random.default_rng(5)
    n = 9
    grid = np.stack(np.meshgrid(np.linspace(5, 55, n), np.linspace(5, 35, n)), -1)
    grid[1:-1, 1:-1] += rng.uniform(-1.5, 1.5, (n - 2, n - 2, 2))
    points = np.column_stack([np.round(grid.reshape(-1, 2) * SNAP) / SNAP, np.ones(n * n)])
    cells = [
        (r * n + c, r * n + c + 1, (r + 1) * n + c, (r + 1) * n + c + 1) for r in range(n - 1) for c in range(n - 1)
    ]
    triangles = np.array([t for a, b, c, d in cells for t in ((a, c, b), (b, c, d))], np.int32)
    _, ids, _ = _drawn(points, triangles, FRONT)
    assert (ids[5:35, 5:55] >= 0).all() and (ids[:5] < 0).all() and (ids[:, 55:] < 0).all()


def test_spans_hold_all_that_is_drawn():
    points, triangles = _random_triangles(7, 5, 6)
    _, ids, canvas = _drawn(points, triangles, FRONT)
    for row in range(HEIGHT):
        used = np.flatnonzero(ids[row] >= 0)
        if len(used):
            low, high = canvas.spans[row // BAND]
            assert low <= used[0] and used[-1] < high


def test_hidden_backs_are_left_out_and_nothing_else_changes():
    """Backs behind a wall of fronts, and some before it and beside it, with what hides them noted and without."""
    rng = np.random.default_rng(11)
    corners = np.array([[3.0, 2, 1], [3, 37, 1], [40, 2, 1], [40, 37, 1]])
    wall = np.column_stack([corners, np.zeros(4)])
    points, triangles = _random_triangles(12, 200, 4)
    points[:, 2] = np.where(rng.random(len(points)) < 0.8, 0.5, 1.5)
    drawn = []
    for noted in (False, True):
        canvas = empty_canvas(HEIGHT, WIDTH)
        fill_triangles(wall, np.array([[0, 1, 2], [2, 1, 3]], np.int32), FRONT, 0, canvas)
        if noted:
            note_least(canvas)
            assert (canvas.least > 0).sum() >= 8
        fill_triangles(points, triangles, BACK, 2, canvas)
        drawn.append(canvas.nearest)
    np.testing.assert_array_equal(*drawn)
    assert ((drawn[0] & 0xFFFFFFFF) > 2).any()


def test_vertices_behind_the_camera_are_left_out():
    points = np.array([[5.0, 5, 1], [5, 30, 1], [30, 5, 0]])
    _, ids, _ = _drawn(points, np.array([[0, 1, 2]], np.int32), FRONT)
    assert (ids == -1).all()


def test_skin_is_linear_blending():
    rng = np.random.default_rng(3)
    count, joints = 50, 5
    positions, normals, hull = (rng.normal(size=(count, 3)).astype(np.float32) for _ in range(3))
    weights = rng.dirichlet(np.ones(4), count).astype(np.float32)
    index = rng.integers(0, joints, (count, 4)).astype(np.int32)
    matrices = rng.normal(size=(joints, 3, 4))
    world = np.empty((count, 9))
    skin_vertices(SkinnedVertices(positions, normals, hull, index, weights), matrices, world)
    blended = np.einsum("vk,vkrc->vrc", weights, matrices[index])
    np.testing.assert_allclose(
        world[:, :3], np.einsum("vrc,vc->vr", blended, np.column_stack([positions, np.ones(count)])), rtol=1e-9
    )
    for part, given in ((world[:, 3:6], normals), (world[:, 6:], hull)):
        turned = np.einsum("vrc,vc->vr", blended[:, :, :3], given)
        np.testing.assert_allclose(part, turned / np.linalg.norm(turned, axis=1, keepdims=True), rtol=1e-9)


def test_blur_is_the_mean_of_a_square():
    rng = np.random.default_rng(4)
    mask = rng.random((30, 30)).astype(np.float32)
    padded = np.pad(mask.astype(np.float64), 2)
    expected = sum(padded[i : i + 30, j : j + 30] for i in range(5) for j in range(5)) / 25
    whole = np.full((36, 40), 7.0, np.float32)
    whole[3:33, 4:34] = mask
    blur(mask, (0, 0, 30, 30), 2, np.empty_like(mask))
    np.testing.assert_allclose(mask, expected, atol=1e-5)
    blur(whole, (4, 3, 34, 33), 2, np.empty_like(whole))
    np.testing.assert_array_equal(whole[3:33, 4:34], mask)
    assert (whole != 7.0).sum() == 900 and (whole[:3] == 7.0).all(), "what is around a part stays"


def test_dither_keeps_the_mean():
    values = [quantise(20.3, row, column) for row in range(4) for column in range(4)]
    assert set(values) == {20, 21} and abs(np.mean(values) - 20.3) <= 1 / 16
    assert [quantise(7.0, r, c) for r in range(4) for c in range(4)] == [7] * 16
    assert quantise(300.0, 0, 0) == 255 and quantise(-5.0, 1, 1) == 0


def test_the_arrow_points_ahead():
    inside = [
        (a, b) for a in np.linspace(-0.5, 0.5, 81) for b in np.linspace(-0.5, 0.5, 81) if arrow_distance(a, b) < 0
    ]
    a, b = np.array(inside).T
    assert a.max() < 0.4 and a.min() > -0.4 and np.isclose(abs(b).max(), abs(-b).max())
    width = [abs(b[np.isclose(a, x, atol=0.01)]).max() for x in (-0.25, 0.05, 0.3)]
    assert width[1] > 2 * width[0] > 0 and width[2] < width[1] / 3  # shaft, head, tip


def test_packing_keeps_every_triangle_and_puts_the_feet_first():
    character = rs.capsule_character()
    packed = pack(character)
    assert len(packed.triangles) == sum(len(m.triangles) for m in character.meshes)
    names = character.skeleton.names
    foot = [i for i, n in enumerate(names) if n.endswith(("talocrural", "metatarsal"))]
    on_foot = np.isin(packed.joints[packed.triangles, 0], foot).all(axis=1)
    assert on_foot[: packed.feet].all() and not on_foot[packed.feet :].any() and packed.feet > 0
    # One piece of surface for each ellipsoid, none across two meshes.
    assert len(np.unique(packed.patch)) == 14
    packed_texels, table, meshes = packed.skins.flat()
    texels = np.stack([packed_texels >> shift & 255 for shift in (0, 8, 16)], axis=1)
    body, head = (int(row) for row in meshes[:2, 3])
    assert tuple(table[body, 1:]) == (2, 2) and tuple(texels[table[body, 0]]) == (90, 120, 220)
    assert tuple(table[body + 1, 1:]) == (1, 1)  # halved once
    assert np.allclose(
        texels[table[body + 1, 0]], np.mean([[90, 120, 220], [250] * 3, [250] * 3, [60, 80, 160]], 0), atol=1
    )
    assert tuple(table[head, 1:]) == (1, 1) and np.allclose(meshes[1, :3] * 255, (0.9, 0.75, 0.65))


def test_outline_normals_agree_where_vertices_meet():
    packed = pack(rs.capsule_character())
    keys = np.round(packed.positions * 1e5).astype(int)
    _, place = np.unique(np.column_stack([keys, packed.material]), axis=0, return_inverse=True)
    place = place.ravel()
    for group in np.flatnonzero(np.bincount(place) > 1)[:50]:
        together = packed.hull[place == group]
        assert np.abs(together - together[0]).max() < 1e-6


@pytest.mark.parametrize("gait", ["flat", "heels"])
def test_shoes_belong_to_the_feet_up_to_their_rim(gait):
    """The rim goes mostly with the shin; from above, where only feet are drawn, a shoe without it is a dark hole."""
    dancer = load_character(name_in_gait("dancer", gait))
    packed = pack(dancer)
    drawn = packed.triangles[: packed.feet]
    for number, mesh in enumerate(dancer.meshes):
        if "shoe" in mesh.name:
            assert (packed.material[drawn[:, 0]] == number).sum() == len(mesh.triangles), mesh.name
    assert 0.125 < packed.positions[drawn][..., 1].max() < 0.16, "and not the leg above"


@pytest.mark.parametrize(
    ("facing", "drawn"), [((0.0, 0.0, 0.0), True), ((0.9, 0.9, 0.1), True), ((0.9, 0.9, 0.9), False)]
)
def test_a_back_whose_normals_look_at_the_viewer_is_no_edge(facing: tuple[float, float, float], drawn: bool) -> None:
    """Skin in a fold has turned it over: on the shirt's back it was a black speck."""
    points = np.array([[2.0, 2.0, 0.5, 0.0], [2.0, 12.0, 0.5, 0.0], [12.0, 2.0, 0.5, 0.0]])
    points[:, 3] = facing
    ways = np.array([[0, 1, 2], [0, 2, 1]], np.int32)
    canvas = empty_canvas(HEIGHT, WIDTH)
    fill_triangles(points, ways, BACK, 0, canvas)
    assert bool(canvas.nearest.any()) is drawn
