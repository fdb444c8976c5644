"""The stage: surfaces face the right way, and panels are where the motion puts the feet."""

from __future__ import annotations

import numpy as np
import pytest
import renderers_scene as rs

from dancetutor_cli.dance.context import panels_on_ground
from dancetutor_cli.feet.pads import load_pads
from dancetutor_cli.film.scene.look import default_look
from dancetutor_cli.film.scene.scene import PANEL, SurfaceKind, build_stage, tiles_of
from dancetutor_cli.run.reading import config_path

PADS = sorted(load_pads(config_path("pads.yaml")).items())


@pytest.mark.parametrize("pad", [pad for _, pad in PADS], ids=[name for name, _ in PADS])
def test_tiles_lie_under_the_panels_of_every_pad(pad):
    tiles = tiles_of(pad)
    places = panels_on_ground(pad)
    for column, (x, z) in enumerate(places):
        a = int((tiles.corner[0] - x) // PANEL)
        b = int((z - tiles.corner[1]) // PANEL)
        assert tiles.panel[a, b] == column
        middle = (tiles.corner[0] - (a + 0.5) * PANEL, tiles.corner[1] + (b + 0.5) * PANEL)
        np.testing.assert_allclose(middle, (x, z), atol=1e-9)
    assert sorted(tiles.panel[tiles.panel >= 0]) == list(range(len(pad.panels)))
    assert tiles.panel.shape[0] % 3 == 0 and tiles.panel.shape[1] == 3


def test_arrows_point_as_the_pad_says():
    pads = dict(PADS)
    tiles = tiles_of(pads["dance-single"])
    for column, (x, z) in enumerate([(1, 0), (0, -1), (0, 1), (-1, 0)]):  # her left is +X, the screen +Z
        np.testing.assert_allclose(tiles.arrow[tiles.panel == column][0], (x, z))
    pump = tiles_of(pads["pump-single"])
    np.testing.assert_allclose(pump.arrow[pump.panel == 1][0], np.array([1, 1]) / np.sqrt(2))
    assert not pump.arrow[pump.panel == 2].any()


def test_surfaces_are_seen_from_inside_the_room():
    stage = build_stage(rs.scene("dance-double").pad, default_look().stage)
    inside = np.array([0.0, 1.0, 0.0])
    for corners, kind in zip(stage.corners, stage.kinds, strict=True):
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        towards = np.dot(normal, inside - corners.mean(0))
        if kind == SurfaceKind.PAD_SIDE:
            assert towards < 0  # a box seen from outside
        else:
            assert towards > 0
        np.testing.assert_allclose(corners[0] + corners[2], corners[1] + corners[3], atol=1e-9)  # parallelograms
