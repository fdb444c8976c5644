"""What wears a foot's colour keeps it in her own shadow: orange is not brown there, whoever draws."""

from __future__ import annotations

import colorsys
from dataclasses import replace

import numpy as np
import pytest
import renderers_scene as rs

from dancetutor_cli.character.mesh import Material
from dancetutor_cli.feet.limbs import limb_colours
from dancetutor_cli.film.scene import renderer
from dancetutor_cli.film.scene.gl import available
from dancetutor_cli.film.scene.look import default_look, read_look
from dancetutor_cli.film.scene.scene import Scene
from dancetutor_cli.run.errors import FileError, UnavailableError
from dancetutor_cli.run.reading import config_path

SIZE = (320, 180)


def _head_in(name, kind):
    """Colours 0..1 (n, 3) of her head's side in the shade, where the head wears the left foot's colour."""
    r, g, b = (c / 255 for c in limb_colours().left_foot)
    plain = rs.capsule_character()
    meshes = tuple(replace(m, material=Material(name, (r, g, b, 1.0))) for m in plain.meshes if m.name == "head")
    scene = Scene(replace(plain, meshes=meshes), rs.scene().pad)
    with_light_behind = "0.5,1.45,0.9/0,1.62,0"  # the sun stands at the camera's left
    state = replace(rs.state(scene, "stand", with_light_behind, SIZE), joints=rs.pose(plain))
    made = renderer.create(scene, SIZE, "good", kind)
    with_her = made.frame(state).astype(float)
    without = made.frame(replace(state, joints=None)).astype(float)
    pixels = with_her[(np.abs(with_her - without).max(2) > 0)] / 255
    return pixels[(pixels[:, 0] > 2 * pixels[:, 2]) & (pixels[:, 0] > 0.25)]


def _darkest(pixels):
    """The colour that a twentieth of the pixels is darker than."""
    return pixels[np.argsort(pixels.sum(1))[len(pixels) // 20]]


@pytest.mark.parametrize("kind", ["cpu", pytest.param("gl", marks=pytest.mark.gl)])
def test_orange_stays_orange_in_the_shade(kind):
    if kind == "gl":
        try:
            available.require_gl()
        except UnavailableError as error:
            pytest.skip(str(error))
    wanted = np.array(limb_colours().left_foot) / 255
    limb, cloth = _darkest(_head_in("left_foot", kind)), _darkest(_head_in("cloth", kind))
    assert max(cloth) < 0.55, "the test looks at no shade"
    assert max(limb) > 0.7 * max(wanted)
    hues = [colorsys.rgb_to_hsv(*colour)[0] * 360 for colour in (limb, wanted)]
    assert abs(hues[0] - hues[1]) < 4


def test_how_much_is_a_number_of_the_picture(tmp_path):
    text = config_path("picture.yaml").read_text(encoding="utf-8")
    assert 0 < default_look().toon.limbs < 1
    path = tmp_path / "picture.yaml"
    path.write_text(text.replace(f"limbs: {default_look().toon.limbs:g} ", "limbs: 1.5 "), encoding="utf-8")
    with pytest.raises(FileError, match=r"toon\.limbs"):
        read_look(path)
