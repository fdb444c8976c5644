"""Feet of users' characters: they wear the colours of the markers, and are looked at from where they are seen."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from dancetutor_cli.character.characters import load_character, load_dancer
from dancetutor_cli.character.mesh import on_foot, rest_vertices, with_foot_colours
from dancetutor_cli.feet.limbs import limb_colours
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.film.scene.scene import Scene
from dancetutor_cli.film.scene.visibility import feet_hidden

NAMES = ("kaykit_rogue.glb", "m2m_human_female.glb", "m2m_human_kenney.glb")


@pytest.mark.parametrize("name", NAMES)
def test_feet_wear_the_colours_of_the_markers_and_nothing_else_changes(shared_data: Path, name: str) -> None:
    bare = load_character(str(shared_data / "characters" / name))
    worn = with_foot_colours(bare)
    assert sum(len(m.triangles) for m in worn.meshes) == sum(len(m.triangles) for m in bare.meshes)
    limbs = limb_colours()
    for side, limb in (("l", "left_foot"), ("r", "right_foot")):
        feet = [m for m in worn.meshes if m.material.name == limb]
        assert feet, limb
        for mesh in feet:
            assert on_foot(worn, mesh, side).all()
            assert mesh.material.base_color[:3] == pytest.approx(np.array(getattr(limbs, limb)) / 255)
            assert mesh.triangles.max() == len(mesh.positions) - 1
    here, there = (np.sort(rest_vertices(c), axis=0) for c in (bare, worn))
    np.testing.assert_allclose(here.min(0), there.min(0), atol=1e-9)
    np.testing.assert_allclose(here.max(0), there.max(0), atol=1e-9)


def test_the_packages_dancer_is_left_alone() -> None:
    dancer = load_dancer()
    assert with_foot_colours(dancer) is dancer


@pytest.mark.parametrize(
    ("name", "hidden"), [("dancer", False), (NAMES[0], True), (NAMES[1], False), (NAMES[2], False)]
)
def test_a_character_that_hides_its_feet_from_behind_is_found(shared_data: Path, name: str, hidden: bool) -> None:
    character = load_character(name if name == "dancer" else str(shared_data / "characters" / name))
    pad = load_pad("dance-single")
    assert pad is not None
    scene, size = Scene(character, pad), (838, 672)
    assert feet_hidden(character, scene.camera("back", size), size) == hidden
    assert not feet_hidden(character, scene.camera("front-high", size), size)
