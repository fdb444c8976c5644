"""The gl renderer against the cpu renderer, and what happens where there is no OpenGL."""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
import renderers_scene as rs

from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.film.choices import QUALITIES
from dancetutor_cli.film.scene import renderer
from dancetutor_cli.film.scene.camera import with_pan_range
from dancetutor_cli.film.scene.geometry import pack
from dancetutor_cli.film.scene.gl import available
from dancetutor_cli.film.scene.scene import Scene
from dancetutor_cli.film.scene.shared import hull_points, joint_boxes, skin_matrices
from dancetutor_cli.run.errors import UnavailableError

SIZE = (640, 360)


def similarity(first, second):
    """Mean structural similarity of two pictures (h, w, 3), Gaussian windows of sigma 1.5 on the luminance.

    Wang, Bovik, Sheikh, Simoncelli: Image quality assessment, IEEE TIP 13(4), 2004.
    """
    from scipy.ndimage import gaussian_filter

    a, b = (image.astype(np.float64) @ [0.299, 0.587, 0.114] for image in (first, second))

    def mean(x):
        return gaussian_filter(x, 1.5, truncate=3.5)

    ma, mb = mean(a), mean(b)
    va, vb, cov = mean(a * a) - ma**2, mean(b * b) - mb**2, mean(a * b) - ma * mb
    c1, c2 = (0.01 * 255) ** 2, (0.03 * 255) ** 2
    return (((2 * ma * mb + c1) * (2 * cov + c2)) / ((ma**2 + mb**2 + c1) * (va + vb + c2))).mean()


@pytest.fixture
def needs_gl():
    try:
        available.require_gl()
    except UnavailableError as error:
        pytest.skip(str(error))


def _dancer(frame, empty):
    """The part of a frame that the dancer changes."""
    rows, columns = np.nonzero((frame.astype(int) != empty).any(2))
    return np.s_[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1]


@pytest.mark.gl
@pytest.mark.parametrize("quality", QUALITIES)
def test_gl_and_cpu_draw_the_same_picture(needs_gl, quality):
    pad = rs.scene().pad
    for character in (rs.capsule_character(), load_dancer()):
        scene = Scene(character, pad)
        cpu, gl = (renderer.create(scene, SIZE, quality, kind) for kind in ("cpu", "gl"))
        for kind, camera in (("step", "back"), ("jump", "front"), ("stand", "three-quarter"), ("step", "top")):
            state = rs.state(scene, kind, camera, SIZE, [(0, 1.0), (3, 0.5)], [(3, 1)])
            expected, drawn = cpu.frame(state).copy(), gl.frame(state).copy()
            assert similarity(expected, drawn) >= 0.95
            # Most of a picture stands still and agrees: ask the same of the part that the dancer fills.
            part = _dancer(expected, cpu.frame(replace(state, joints=None)))
            assert similarity(expected[part], drawn[part]) >= 0.95, (character.name, kind, camera)
        gl.close()


def test_similarity_distinguishes_pictures():
    scene = rs.scene()
    cpu = renderer.create(scene, SIZE, "good", "cpu")
    step = cpu.frame(rs.state(scene, "step", "back", SIZE)).copy()
    stand = cpu.frame(rs.state(scene, "stand", "back", SIZE)).copy()
    part = _dancer(step, cpu.frame(rs.state(scene, None, "back", SIZE)))
    assert similarity(step, step) == pytest.approx(1.0)
    assert similarity(step[part], stand[part]) < 0.95
    assert similarity(step[part], np.roll(step, 2, axis=1)[part]) < 0.95


@pytest.mark.gl
def test_gl_frames_repeat_and_pan(needs_gl):
    scene = rs.scene()
    gl = renderer.create(scene, SIZE, "good", "gl")
    state = rs.state(scene, "step", "back", SIZE, [(1, 1.0)])
    state = replace(state, camera=with_pan_range(state.camera, -0.1, 0.1))
    first = gl.frame(state).copy()
    gl.frame(rs.state(scene, "jump", "front", SIZE))
    assert (gl.frame(state) == first).all()
    moved = gl.frame(replace(state, camera=replace(state.camera, pan=16 / SIZE[0])))
    assert (moved[:, 16:].astype(int) - first[:, :-16] == 0).mean() > 0.999
    assert gl.name == "gl" and "EGL" in gl.description
    gl.close()
    gl.close()


@pytest.mark.gl
def test_two_gl_renderers_live_side_by_side(needs_gl):
    scene = rs.scene()
    one, two = (renderer.create(scene, size, "good", "gl") for size in (SIZE, (320, 180)))
    state = rs.state(scene, "step", "back", SIZE)
    first = one.frame(state).copy()
    small = two.frame(rs.state(scene, "step", "back", (320, 180)))
    assert small.shape == (180, 320, 3) and small.std() > 10
    assert (one.frame(state) == first).all()


@pytest.mark.gl
def test_many_triangles_on_one_pixel_of_no_dancer(needs_gl):
    scene = rs.scene()
    gl = renderer.create(scene, SIZE, "good", "gl")
    cpu = renderer.create(scene, SIZE, "good", "cpu")
    state = rs.state(scene, None, "back", SIZE, [(0, 1.0)])
    assert np.abs(gl.frame(state).astype(int) - cpu.frame(state)).max() <= 1


def test_without_libraries_the_error_says_what_to_install(monkeypatch):
    monkeypatch.setattr(available, "_library", lambda name: None)
    available.gpu_device.cache_clear()
    with pytest.raises(UnavailableError) as caught:
        renderer.create(rs.scene(), SIZE, "good", "gl")
    assert str(caught.value) == (
        "No OpenGL found. Debian/Ubuntu: apt-get install libegl1 libgl1. Or use --renderer cpu."
    )
    assert renderer.create(rs.scene(), SIZE, "good", "auto").name == "cpu"
    available.gpu_device.cache_clear()


def test_auto_takes_the_gpu_only_where_there_is_one(monkeypatch):
    monkeypatch.setattr(available, "gpu_device", lambda: None)
    assert renderer.create(rs.scene(), SIZE, "good", "auto").name == "cpu"
    asked = []
    monkeypatch.setattr(available, "gpu_device", lambda: 0)
    monkeypatch.setattr(renderer, "_create_gl", lambda *arguments: asked.append(arguments))
    renderer.create(rs.scene(), SIZE, "good", "auto")
    assert len(asked) == 1


@pytest.mark.gl
def test_gl_loads_no_window_library(needs_gl):
    program = (
        "import sys; from dancetutor_cli.film.scene.gl.available import load_pyrender; load_pyrender();"
        "print(sorted(m for m in sys.modules if m.split('.')[0] in ('pyglet', 'tkinter')))"
    )
    environment = {k: v for k, v in os.environ.items() if k not in ("PYOPENGL_PLATFORM", "DISPLAY")}
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, env=environment)
    assert run.returncode == 0, run.stderr
    assert run.stdout.strip() == "[]"


@pytest.mark.gl
def test_arguments_by_reference_are_known_to_pyopengl(needs_gl):
    """As on Python 3.12, where their type has a name that PyOpenGL 3.1.0 does not know."""
    from dancetutor_cli.film.scene.gl import available as compat

    compat.load_pyrender()
    from OpenGL.plugins import FormatHandler

    kind = type(ctypes.byref(ctypes.c_int()))
    for plugin in FormatHandler.all():
        plugin.check = [name for name in plugin.check or [] if not name.endswith(".CArgObject")]
    assert FormatHandler.match(kind) is None
    compat._register_references()
    assert FormatHandler.match(kind).load().__name__ == "CtypesParameterHandler"


@pytest.mark.parametrize("kind", ["stand", "step", "leap"])
def test_boxes_on_her_joints_hold_her_closely_in_any_pose(kind):
    scene = Scene(load_dancer(), rs.scene().pad)
    mesh = pack(scene.character)
    matrices = skin_matrices(scene, rs.pose(scene.character, kind))
    places = hull_points(joint_boxes(mesh.positions, mesh.joints, mesh.weights), matrices)
    corners = np.concatenate([mesh.positions, np.ones((len(mesh.positions), 1))], axis=1)
    skinned = np.einsum("vk,vkrc,vc->vr", mesh.weights, matrices[mesh.joints], corners)
    ways = np.random.default_rng(5).normal(size=(50, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    beyond = (places @ ways.T).max(axis=0) - (skinned @ ways.T).max(axis=0)
    assert beyond.min() > -1e-5
    assert beyond.max() < 0.2  # metres


@pytest.mark.gl
@pytest.mark.parametrize("quality", ["draft", "good"])
@pytest.mark.parametrize(("kind", "camera"), [("step", "back"), ("jump", "three-quarter")])
def test_only_floor_that_nothing_falls_on_is_left_alone(needs_gl, monkeypatch, quality, kind, camera):
    state = rs.state(rs.scene(), kind, camera, SIZE, [(0, 0.6), (2, 1.0)])
    drawing = renderer.create(rs.scene(), SIZE, quality, "gl")
    from dancetutor_cli.film.scene.gl import renderer as gl  # where there is OpenGL

    try:
        frame = drawing.frame(state).copy()
        some, rectangles = [], gl.rectangles
        monkeypatch.setattr(gl, "rectangles", lambda touched: some.append(touched) or rectangles(touched | True))
        assert drawing.frame(state).tobytes() == frame.tobytes()
        assert 0.02 < (some[0] | some[1]).mean() < 0.5  # of the picture's tiles, without feet and with
    finally:
        drawing.close()
