"""Cameras: everything that must be seen is, at any aspect; left is left; bad ones say what exists."""

from __future__ import annotations

import numpy as np
import pytest
import renderers_scene as rs
from hypothesis import given, settings
from hypothesis import strategies as st

from dancetutor_cli.film.layout import load_layout
from dancetutor_cli.film.scene.camera import (
    Camera,
    free_camera,
    is_front_view,
    parse_camera,
    preset_camera,
    with_pan_range,
)
from dancetutor_cli.film.scene.look import default_look, read_look
from dancetutor_cli.run.errors import FileError, UsageError
from dancetutor_cli.run.reading import config_path

LOOK = default_look()
BODY_CAMERAS = ("back", "front", "side", "three-quarter")
PAD = (np.array([-0.42, 0.0, -0.42]), np.array([0.42, 0.0, 0.42]))


def _all_vertices(character, joints):
    """Every vertex in the world, by a plain loop: each test mesh hangs on one joint."""
    points = []
    for mesh in character.meshes:
        for p, j in zip(mesh.positions, mesh.joints[:, 0], strict=True):
            points.append((joints[j] @ character.inverse_bind[j] @ [*p, 1.0])[:3])
    return np.array(points)


@settings(max_examples=40, deadline=None)
@given(
    st.sampled_from(BODY_CAMERAS), st.sampled_from(["stand", "step", "leap"]), st.sampled_from(["single", "double"]),
    st.tuples(st.integers(200, 2000), st.integers(200, 2000)),
)  # fmt: skip
def test_presets_show_all_of_her_at_any_aspect(name, kind, pad, size):
    scene = rs.scene(f"dance-{pad}")
    camera = scene.camera(name, size)
    places = camera.project(_all_vertices(scene.character, rs.pose(scene.character, kind)), size)
    low, high = scene.extent
    corners = np.array([[x, 0.0, z] for x in (low[0], high[0]) for z in (low[2], high[2])])
    places = np.concatenate([places, camera.project(corners, size)])
    assert (places[:, 2] > 0.3).all()
    assert (places[:, :2] > 0).all() and (places[:, :2] < size).all()


@pytest.mark.parametrize("name", BODY_CAMERAS)
def test_presets_are_as_near_as_they_can_be(name):
    size = (1280, 720)
    camera = preset_camera(name, PAD, size, LOOK)
    head_to_pad = camera.project(np.array([[0.0, 1.7, 0.0], [0.0, 0.0, 0.0]]), size)[:, 1]
    assert head_to_pad[1] - head_to_pad[0] > 0.5 * size[1]


def test_left_is_left_from_the_back_and_right_from_the_front():
    left_panel = np.array([[0.28, 0.0, 0.0]])
    for name, side in (("back", -1), ("front", 1), ("top", -1)):
        x = preset_camera(name, PAD, (1280, 720), LOOK).project(left_panel, (1280, 720))[0, 0]
        assert (x - 640) * side > 50


def test_a_foot_fills_more_of_the_side_by_side_box_than_it_did():
    """The box of the default layout: before, a foot was 69 pixels long sideways and 24 wide."""
    layout = load_layout("side-by-side")
    left, top, right, bottom = layout.box("dancer", layout.size, 4)
    size = right - left, bottom - top
    camera = rs.scene("dance-single").camera("back", size)
    places = camera.project(np.array([[0.27, 0, 0.0], [0.01, 0, 0.0], [0.14, 0.0, -0.08], [0.14, 0.0, 0.18]]), size)
    assert abs(places[0, 0] - places[1, 0]) > 72
    assert abs(places[2, 1] - places[3, 1]) > 47


@pytest.mark.parametrize(("steps", "least"), [("dance-single", 0.7), ("dance-double", 0.65), ("pump-double", 0.65)])
def test_three_quarter_stands_near(steps, least):
    """She is so much of the picture's height: it was 0.63 and 0.6, and half of the picture was empty floor."""
    size = (1280, 672)
    camera = rs.scene(steps).camera("three-quarter", size)
    feet, head = camera.project(np.array([[0.0, 0.0, 0.0], [0.0, 1.7, 0.0]]), size)
    assert feet[1] - head[1] > least * size[1]


@pytest.mark.parametrize("kind", ["stand", "step", "jump"])
@pytest.mark.parametrize("steps", ["dance-single", "pump-single", "dance-double"])
def test_three_quarter_shows_her_face(steps, kind):
    """It looked at the back of her head. From 30 degrees aside eyes and mouth are seen, and all of a cheek."""
    scene, size = rs.scene(steps), (1280, 672)
    joints, head = rs.pose(scene.character, kind), scene.character.skeleton.index("skullbase")
    camera = scene.camera("three-quarter", size)
    to_camera = np.array(camera.position) - joints[head, :3, 3]
    angle = np.degrees(np.arccos(joints[head, :3, 2] @ to_camera / np.linalg.norm(to_camera)))
    assert 20 < angle < 45, "neither from the front nor from the side"
    behind = np.array(scene.camera("back", size).position) - joints[head, :3, 3]
    assert joints[head, :3, 2] @ behind < 0, "from behind there is no face"


@pytest.mark.parametrize(
    ("text", "turned"),
    [("back", False), ("front", True), ("front-high", True), ("side", False), ("three-quarter", True), ("top", False),
     ("1.5,1.8,-4/0,0.9,0", False), ("1.5,1.8,4/0,0.9,0", True), ("0,3,0/0,0,0", False)],
)  # fmt: skip
def test_from_the_front_the_pad_is_turned(text, turned):
    """Arrows turn with the pad where, and only where, her left panel is on the right of the picture."""
    assert is_front_view(text, LOOK) == turned
    camera = parse_camera(text, PAD, (1280, 720), LOOK)
    left, right = camera.project(np.array([[0.28, 0.0, 0.0], [-0.28, 0.0, 0.0]]), (1280, 720))[:, 0]
    if abs(left - right) > 100:
        assert (left > right) == turned


def test_the_screen_side_is_far_from_the_back_and_up_from_the_top():
    up, down = np.array([[0.0, 0.0, 0.28]]), np.array([[0.0, 0.0, -0.28]])
    for name in ("back", "top"):
        camera = preset_camera(name, PAD, (1280, 720), LOOK)
        assert camera.project(up, (1280, 720))[0, 1] < camera.project(down, (1280, 720))[0, 1] - 50


def test_a_region_moves_the_dancer_but_not_the_rest():
    size = (1280, 720)
    region = (0.0, 0.1, 0.6, 0.9)
    camera = preset_camera("back", PAD, size, LOOK, region)
    places = camera.project(np.array([[0.0, 0.0, -0.42], [0.0, 1.7, 0.0], [0.7, 1.4, 0.0], [-0.7, 1.4, 0.0]]), size)
    assert (places[:, 0] > 0).all() and (places[:, 0] < 0.6 * 1280).all()
    assert (places[:, 1] > 72 - 1).all() and (places[:, 1] < 0.9 * 720 + 1).all()
    assert abs(places[1, 0] - 0.3 * 1280) < 1  # she is upright in the middle of it


def test_matrix_agrees_with_similar_triangles():
    camera = Camera((0.0, 1.0, -4.0), (0.0, 1.0, 0.0), focal=1.0, centre=(0.5, 0.5))
    place = camera.project(np.array([[-0.5, 1.5, 1.0]]), (200, 100))[0]
    # 5 m away, half a metre to the right and up, 100 pixels focal length: 10 pixels from the middle.
    np.testing.assert_allclose(place, [110.0, 40.0, 5.0])


@given(st.tuples(*[st.floats(-5, 5)] * 3), st.tuples(*[st.floats(-5, 5)] * 3))
def test_axes_are_orthonormal_and_upright(position, target):
    if np.linalg.norm(np.subtract(position, target)) < 0.01:
        return
    axes = free_camera(position, target, LOOK).axes()
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-9)
    assert axes[1, 1] >= -1e-9  # up is up
    # Right-handed seen along the view: right x up points back to the camera.
    np.testing.assert_allclose(np.cross(axes[0], axes[1]), -axes[2], atol=1e-9)


def test_straight_down_has_the_screen_side_up():
    axes = free_camera((0.0, 3.0, 0.0), (0.0, 0.0, 0.0), LOOK).axes()
    np.testing.assert_allclose(axes, [[-1, 0, 0], [0, 0, 1], [0, -1, 0]], atol=1e-12)


def test_a_free_camera_puts_its_target_into_the_middle():
    camera = parse_camera("1.5,1.8,-4/0.2,0.9,0", PAD, (640, 360), LOOK)
    np.testing.assert_allclose(camera.project(np.array([[0.2, 0.9, 0.0]]), (640, 360))[0, :2], [320, 180])


def test_pan_moves_by_whole_pixels_within_its_range():
    camera = with_pan_range(preset_camera("back", PAD, (200, 100), LOOK), -0.25, 0.1)
    point = np.array([[0.1, 0.2, 0.3]])
    still = camera.project(point, (200, 100))[0]
    for pan, pixels in ((0.0, 0), (0.052, 10), (-0.2, -40), (0.5, 20), (-0.9, -50)):
        moved = Camera(**{**_fields(camera), "pan": pan}).project(point, (200, 100))[0]
        np.testing.assert_allclose(moved - still, [pixels, 0, 0], atol=1e-9)


def _fields(camera):
    return {name: getattr(camera, name) for name in Camera.__dataclass_fields__}


@pytest.mark.parametrize("text", ["behind", "1,2,3", "1,2/3,4,5", "1,2,x/0,0,0", "1,2,nan/0,0,0", "1,2,3/1,2,3"])
def test_bad_cameras_are_usage_errors(text):
    with pytest.raises(UsageError):
        parse_camera(text, PAD, (640, 360), LOOK)


def test_an_unknown_camera_lists_those_that_exist():
    with pytest.raises(UsageError, match=", ".join(LOOK.cameras)):
        parse_camera("behind", PAD, (640, 360), LOOK)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("azimuth: 180", "azimut: 180", "azimut"),
        ("field: 28", "field: 0", "field must be"),
        ("tile: 0.84", "tile: 0", "stage.tile"),
        ("elevation: 62", "elevation: 5", "light.elevation"),
        ("outline_width: 0.005", "outline_width: thick", "outline_width"),
    ],
)
def test_a_wrong_look_names_the_key(tmp_path, old, new, message):
    text = config_path("picture.yaml").read_text("utf-8")
    assert old in text
    path = tmp_path / "picture.yaml"
    path.write_text(text.replace(old, new), "utf-8")
    with pytest.raises(FileError, match=message):
        read_look(path)
