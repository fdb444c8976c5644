"""What the software renderer's frames show, and that they are always the same."""

from __future__ import annotations

import hashlib
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import renderers_scene as rs
from PIL import Image, ImageDraw

from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.dance.context import panels_on_ground
from dancetutor_cli.film.choices import QUALITIES
from dancetutor_cli.film.scene import renderer
from dancetutor_cli.film.scene.camera import with_pan_range
from dancetutor_cli.film.scene.geometry import pack
from dancetutor_cli.film.scene.scene import SOLE_RADIUS, foot_marks, hand_marks
from dancetutor_cli.run.errors import UsageError

SIZE = (320, 180)


@pytest.fixture(scope="module")
def scene():
    return rs.scene()


@pytest.fixture(scope="module")
def cpu(scene):
    return renderer.create(scene, SIZE, "good", "cpu")


def _frame(cpu, scene, kind="stand", camera="back", **more):
    return cpu.frame(rs.state(scene, kind, camera, SIZE, **more)).astype(int)


def _red(frame):
    """Pixels of the red face."""
    return (frame[..., 0] > 110) & (frame[..., 1] < 60) & (frame[..., 2] < 60)


@pytest.mark.parametrize("name", rs.GOLDENS)
def test_golden_frames(name):
    expected = np.asarray(Image.open(rs.GOLDEN / f"frame_{name}.png")).astype(int)
    difference = np.abs(rs.golden_frame(name).astype(int) - expected).max(axis=2)
    # Between machines at most one level in 0.01 % of the pixels may differ.
    assert difference.max() <= 1
    assert (difference > 0).mean() <= 1e-4


def test_frames_are_the_same_bytes_on_every_run(scene, cpu):
    first = cpu.frame(rs.state(scene, "step", "back", SIZE, [(0, 0.6)])).copy()
    cpu.frame(rs.state(scene, "jump", "front", SIZE))  # nothing of it may be left over
    again = cpu.frame(rs.state(scene, "step", "back", SIZE, [(0, 0.6)])).copy()
    other = renderer.create(scene, SIZE, "good", "cpu").frame(rs.state(scene, "step", "back", SIZE, [(0, 0.6)]))
    assert first.tobytes() == again.tobytes() == other.tobytes()


def test_frames_are_the_same_bytes_in_another_process():
    program = """import hashlib, renderers_scene as rs
print(hashlib.sha256(rs.golden_frame('back_step').tobytes()).hexdigest())"""
    run = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=Path(rs.__file__).parent
    )
    assert run.stdout.strip() == hashlib.sha256(rs.golden_frame("back_step").tobytes()).hexdigest()


def test_she_faces_the_screen(cpu, scene):
    assert not _red(_frame(cpu, scene, camera="back")).any()
    front = _red(_frame(cpu, scene, camera="front"))
    assert front.sum() > 20
    rows, columns = np.nonzero(front)
    assert abs(columns.mean() - SIZE[0] / 2) < 2 and rows.mean() < SIZE[1] / 2


def test_from_the_back_the_left_panel_and_the_left_foot_are_on_the_left(cpu, scene):
    dark = _frame(cpu, scene)
    lit = _frame(cpu, scene, lit=[(0, 1.0)])
    assert np.nonzero((lit != dark).any(2))[1].max() < SIZE[0] / 2
    left_foot, right_foot = foot_marks(scene, rs.pose(scene.character, "step"))
    camera = scene.camera("back", SIZE)
    ground = [[f.heel[0], 0.0, f.heel[1]] for f in (left_foot, right_foot)]
    places = camera.project(np.array(ground), SIZE)
    assert places[0, 0] < SIZE[0] / 2 - 10 and places[0, 0] < places[1, 0] - 10


def _polygon(camera, x, z, half):
    """Mask of a square on the pad, drawn by Pillow."""
    corners = [[x - half, 0, z - half], [x - half, 0, z + half], [x + half, 0, z + half], [x + half, 0, z - half]]
    scale = 4
    places = camera.project(np.array(corners), SIZE)[:, :2] * scale
    image = Image.new("L", (SIZE[0] * scale, SIZE[1] * scale))
    ImageDraw.Draw(image).polygon([tuple(p) for p in places], fill=255)
    return np.asarray(image).reshape(SIZE[1], scale, SIZE[0], scale).mean((1, 3)) / 255


@pytest.mark.parametrize("camera_name", ["back", "top", "three-quarter"])
@pytest.mark.parametrize("column", range(4))
def test_a_lit_panel_changes_its_own_region_and_no_other(cpu, scene, column, camera_name):
    nobody = {"kind": None, "camera": camera_name}
    changed = (_frame(cpu, scene, **nobody) != _frame(cpu, scene, **nobody, lit=[(column, 1.0)])).any(2)
    x, z = panels_on_ground(scene.pad)[column]
    camera = scene.camera(camera_name, SIZE)
    assert not (changed & (_polygon(camera, x, z, 0.14) == 0)).any()
    inner = _polygon(camera, x, z, 0.12) == 1
    assert inner.sum() > 10 and changed[inner].all()


def test_a_lit_panel_has_the_colour_of_the_limb(cpu, scene):
    camera = scene.camera("top", SIZE)
    x, z = panels_on_ground(scene.pad)[1]
    inside = _polygon(camera, x, z, 0.08) == 1
    for limb, colour in enumerate(scene.colours.by_limb):
        frame = _frame(cpu, scene, kind=None, camera="top", lit=[(1, 1.0)], by=[(1, limb)])
        mean, target = frame[inside].mean(0), np.array(colour)
        others = [np.array(c) for i, c in enumerate(scene.colours.by_limb) if i != limb]
        hue = (mean - mean.mean()) / np.linalg.norm(mean - mean.mean())
        own = hue @ ((target - target.mean()) / np.linalg.norm(target - target.mean()))
        assert own > 0.95
        if limb < 2:  # the hands have lighter shades of the feet's colours
            other_foot = others[0]
            assert own > hue @ ((other_foot - other_foot.mean()) / np.linalg.norm(other_foot - other_foot.mean()))


def test_light_grows_with_the_level(cpu, scene):
    x, z = panels_on_ground(scene.pad)[0]
    inside = _polygon(scene.camera("top", SIZE), x, z, 0.1) == 1
    levels = [0.0, 0.25, 0.5, 1.0, 7.0]
    red = [_frame(cpu, scene, None, "top", lit=[(0, v)])[inside][:, 0].mean() for v in levels]
    assert red[0] < red[1] < red[2] < red[3] == red[4]


def test_a_standing_foot_has_a_tight_solid_ring_and_a_lifted_one_a_trace(scene):
    """Along a line from the sole outwards: solid and 2 cm wide, in the foot's colour, no black between it and the sole;
    in the air farther out, half as wide and faded."""
    size = (1280, 720)
    cpu = renderer.create(scene, size, "draft", "cpu")
    camera = scene.camera("top", size)
    ground, jumping = rs.pose(scene.character, "stand"), rs.pose(scene.character, "stand")
    jumping[:, 1, 3] += 0.12
    foot = foot_marks(scene, ground)[0]
    x, z = (foot.heel[0] + foot.toe[0]) / 2, (foot.heel[1] + foot.toe[1]) / 2
    away = SOLE_RADIUS + np.arange(0.0, 0.036, 0.0005)
    line = np.stack([x - away, np.zeros(len(away)), np.full(len(away), z)], axis=1)
    places = camera.project(line, size)[:, :2].astype(int)
    state = rs.state(scene, None, "top", size)
    colours = []
    for joints in (ground, jumping, None):
        frame = cpu.frame(replace(state, joints=joints)).astype(int)
        colours.append(np.array([frame[row, column] for column, row in places]))
    stands, lifted, bare = colours
    orange = np.array(scene.colours.left_foot)
    solid = np.abs(stands - orange).sum(axis=1) < 40
    assert 0.012 < 0.0005 * solid.sum() < 0.024 and away[solid].max() - SOLE_RADIUS < 0.026
    between = away < away[solid].min() - 0.003
    assert (stands[between].sum(axis=1) > 0.6 * bare[between].sum(axis=1)).all(), "no black fill"
    assert np.abs(lifted - orange).sum(axis=1).min() > 100
    trace = np.abs(lifted - bare).sum(axis=1) > 25
    assert 0 < trace.sum() < 0.6 * solid.sum() and away[trace].min() > away[solid].mean()


def test_a_lit_panel_stays_lit_under_her_shadow(scene):
    cpu = renderer.create(scene, SIZE, "good", "cpu")
    camera = scene.camera("back", SIZE)
    state = rs.state(scene, "stand", "back", SIZE, [(k, 1.0) for k in range(4)], [(k, 0) for k in range(4)])
    cast, bare = cpu.frame(state).astype(int).copy(), cpu.frame(replace(state, joints=None)).astype(int)
    floor = [(x, z) for x in np.arange(-0.38, 0.4, 0.02) for z in np.arange(-0.38, 0.4, 0.02)]
    places = camera.project(np.array([(x, 0.0, z) for x, z in floor]), SIZE)[:, :2].astype(int)
    lit = [(c, r) for c, r in places if bare[r, c, 0] > 150 > bare[r, c, 2]]
    shaded = [cast[r, c, 0] / bare[r, c, 0] for c, r in lit if 8 < abs(cast[r, c] - bare[r, c]).sum() < 150]
    assert len(shaded) > 5, "her shadow lies on a lit panel"
    assert np.median(shaded) > 0.8


def test_no_shadow_of_her_own_lies_on_trunk_neck_and_legs():
    """Of a hand or the braid it was a stain on the clothes, of the head a dark throat; head and arms keep theirs."""
    dancer = load_dancer()
    mesh = pack(dancer)
    height, side = mesh.positions[:, 1], np.abs(mesh.positions[:, 0])
    weight = np.zeros((len(height), len(dancer.skeleton.names)))
    for k in range(4):
        weight[np.arange(len(height)), mesh.joints[:, k]] += mesh.weights[:, k]
    braid = weight[:, [dancer.skeleton.index(f"braid{k}") for k in range(1, 5)]].sum(axis=1) > 0.5
    trunk = (height < 1.46) & (side < 0.10) & ~braid
    assert mesh.above[trunk].min() > 2.0, "nothing of her is so far between that and the light"
    assert mesh.above[(height > 1.60) | (side > 0.25) | braid].max() < 0.01


def test_a_cast_shadow_from_good_on(scene):
    far = np.s_[:, SIZE[0] * 6 // 10 :]
    for quality, casts in (("draft", False), ("good", True)):
        cpu = renderer.create(scene, SIZE, quality, "cpu")
        empty = _frame(cpu, scene, None)[far]
        darker = _frame(cpu, scene, "jump")[far].sum(2) < 0.9 * empty.sum(2)
        assert (darker.sum() > 30) == casts


def test_her_shadow_grows_light_away_from_her(scene):
    """Head and arms fall on the floor a step away: there an arm's shadow beside the head's looked like a hook."""
    look = scene.look
    even, bare = (replace(look, light=replace(look.light, **one)) for one in ({"shadow_far": 1.0}, {"shadow": 0.0}))
    state = rs.state(scene, "stand", "back", SIZE)
    faded, whole, none = (
        renderer.create(replace(scene, look=one), SIZE, "good", "cpu").frame(state).astype(int).sum(axis=2)
        for one in (look, even, bare)
    )
    floor = np.array([(x, -0.06, z) for x in np.arange(-1.5, 1.5, 0.03) for z in np.arange(-1.5, 1.5, 0.03)])
    places = np.floor(state.camera.project(floor, SIZE)[:, :2]).astype(int)
    away = np.hypot(*(floor - state.joints[0, :3, 3])[:, [0, 2]].T)
    left = [
        (none[r, c] - faded[r, c]) / (none[r, c] - whole[r, c])
        for (c, r), off in zip(places, away, strict=True)
        if off > 0.95 and 0 <= c < SIZE[0] and 0 <= r < SIZE[1] and none[r, c] - whole[r, c] > 30
    ]
    assert len(left) > 5
    assert np.median(left) == pytest.approx(look.light.shadow_far, abs=0.08)


def test_nobody_there_is_the_room_alone(cpu, scene):
    empty = _frame(cpu, scene, None)
    gone = rs.state(scene, "stand", "back", SIZE)
    gone.joints[:, 1, 3] += 50.0
    assert (empty != _frame(cpu, scene)).any(2).sum() > 1000
    assert (cpu.frame(gone) == empty).all()


def test_a_pan_shifts_the_room_by_whole_pixels(scene):
    cpu = renderer.create(scene, SIZE, "good", "cpu")
    state = rs.state(scene, "step", "back", SIZE, [(2, 0.5)])
    camera = with_pan_range(state.camera, -0.2, 0.2)
    still = cpu.frame(replace(state, camera=camera)).astype(int)
    for pixels in (8, -24):
        moved = cpu.frame(replace(state, camera=replace(camera, pan=pixels / SIZE[0]))).astype(int)
        kept = slice(max(pixels, 0), SIZE[0] + min(pixels, 0))
        assert (moved[:, kept] == np.roll(still, pixels, axis=1)[:, kept]).all()


def test_the_picture_without_pan_range_is_the_same(scene):
    cpu = renderer.create(scene, SIZE, "good", "cpu")
    state = rs.state(scene, "step", "back", SIZE)
    plain = cpu.frame(state).astype(int)
    ranged = cpu.frame(replace(state, camera=with_pan_range(state.camera, -0.1, 0.1))).astype(int)
    assert np.abs(plain - ranged).max() <= 1  # the dither may start elsewhere


def test_a_pan_range_to_one_side_shows_all_of_the_stage(scene):
    """She may stay aside for all of a film: then no pan of the range is 0."""
    cpu = renderer.create(scene, SIZE, "draft", "cpu")
    state = rs.state(scene, "step", "back", SIZE)
    wide, aside = (
        cpu.frame(replace(state, camera=replace(with_pan_range(state.camera, -0.3, most), pan=-0.25))).astype(int)
        for most in (0.0, -0.2)
    )
    assert np.abs(wide - aside).max() <= 1  # the dither may start elsewhere


def test_more_samples_come_nearer_to_many(scene):
    """Smooth edges: draft and good, both compared with a picture of four times the size, averaged."""
    big = (SIZE[0] * 4, SIZE[1] * 4)
    look = replace(scene.look, toon=replace(scene.look.toon, outline_width=0.0))
    bare = type(scene)(scene.character, scene.pad, look, scene.colours)
    state = rs.state(bare, "jump", "front", big)
    fine = renderer.create(bare, big, "good", "cpu").frame(state).astype(float)
    fine = fine.reshape(SIZE[1], 4, SIZE[0], 4, 3).mean((1, 3))
    upper = np.s_[: SIZE[1] // 2]  # no shadow on the floor there, which draft leaves out
    error = {}
    for quality in QUALITIES:
        frame = renderer.create(bare, SIZE, quality, "cpu").frame(rs.state(bare, "jump", "front", SIZE))
        error[quality] = np.abs(frame - fine)[upper].mean()
    assert error["best"] < error["good"] < error["draft"]


def test_a_camera_inside_the_dancer_draws_something(cpu, scene):
    state = rs.state(scene, "step", "0,1.2,0.05/0,0.2,0.6", SIZE)
    assert cpu.frame(state).shape == (SIZE[1], SIZE[0], 3)


def test_the_frame_is_the_callers_until_the_next_one(cpu, scene):
    frame = cpu.frame(rs.state(scene, "stand", "back", SIZE))
    before = frame.copy()
    frame[:] = 0
    assert (cpu.frame(rs.state(scene, "stand", "back", SIZE)) == before).all()


def test_odd_sizes_work(scene):
    for size in ((33, 17), (17, 95)):
        frame = renderer.create(scene, size, "good", "cpu").frame(rs.state(scene, "step", "back", size))
        assert frame.shape == (size[1], size[0], 3) and frame.dtype == np.uint8


def test_an_impossible_size_is_a_usage_error(scene):
    with pytest.raises(UsageError, match="not possible"):
        renderer.create(scene, (0, 90), "good", "cpu")


def test_states_that_do_not_fit_are_usage_errors(cpu, scene):
    good = rs.state(scene, "stand", "back", SIZE)
    for bad in (
        replace(good, joints=good.joints[:3]),
        replace(good, lit=np.zeros(9)),
        replace(good, joints=good.joints * np.nan),
        replace(good, joints=good.joints * 1e200),
    ):
        with pytest.raises(UsageError, match="frame"):
            cpu.frame(bad)


def test_choosing_a_renderer_imports_neither_numba_nor_opengl():
    program = (
        "import sys; from dancetutor_cli.film.scene import renderer, scene\n"
        "from dancetutor_cli.film.scene.gl import available\n"
        "print(sorted({'numba', 'OpenGL', 'pyrender', 'scipy'} & set(sys.modules)))"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"


def test_a_palm_on_the_pad_leaves_its_mark_and_a_raised_hand_none(scene):
    size = (640, 360)
    cpu = renderer.create(scene, size, "draft", "cpu")
    names = scene.character.skeleton.names
    state = rs.state(scene, "stand", "top", size)
    empty = cpu.frame(replace(state, joints=None)).astype(int)
    place = np.array([-0.28, 0.0, 0.28])  # a blank tile, far from both feet
    row, column = scene.camera("top", size).project(place[None], size)[0, 1::-1].astype(int)
    around = np.s_[row - 19 : row + 19, column - 19 : column + 19]
    wrist = names.index("r_radiocarpal")
    for height, seen in ((0.0, True), (0.5, False)):
        joints = state.joints.copy()
        palm = hand_marks(scene, joints)[1]
        joints[wrist, 0, 3] += place[0] - palm.heel[0]
        joints[wrist, 2, 3] += place[2] - palm.heel[1]
        joints[wrist, 1, 3] += height - palm.height
        changed = cpu.frame(replace(state, joints=joints)).astype(int)[around] - empty[around]
        cyan = np.abs(changed + empty[around] - np.array(scene.colours.right_hand)).sum(2) < 60
        assert cyan.any() == seen
        assert (changed != 0).any() == seen


def test_what_is_drawn_of_her_is_forgotten_with_the_frame(scene):
    one = renderer.create(scene, SIZE, "good", "cpu")
    one.frame(rs.state(scene, "step", "back", SIZE))
    canvas = one._canvas
    assert not canvas.nearest.any() and (canvas.spans == [canvas.nearest.shape[1], 0]).all()


@pytest.mark.parametrize("camera", ["back", "top"])
def test_tiles_that_are_left_out_would_not_have_changed(scene, camera):
    """The ground with only the tiles that something falls on, and with all of them."""
    state = rs.state(scene, "step", camera, SIZE, [(0, 0.6)])
    one = renderer.create(scene, SIZE, "good", "cpu")
    expected = one.frame(state).copy()
    kept, background = one._background
    tiles = background.tiles
    everywhere = tiles._replace(low=np.full_like(tiles.low, -1e6), high=np.full_like(tiles.high, 1e6))
    one._background = kept, background._replace(tiles=everywhere)
    np.testing.assert_array_equal(one.frame(state), expected)
    nothing = tiles._replace(low=np.full_like(tiles.low, np.inf))
    one._background = kept, background._replace(tiles=nothing)
    assert (one.frame(state) != expected).any()
