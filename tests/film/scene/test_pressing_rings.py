"""The ring under a foot says which part of it presses: white on the panel, a faint trace beside it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import renderers_scene as rs

from dancetutor_cli.film.scene import renderer
from dancetutor_cli.film.scene.gl import available
from dancetutor_cli.film.scene.scene import PANEL, foot_marks
from dancetutor_cli.film.scene.shared import RING_SHARE, feet_on_floor
from dancetutor_cli.run.errors import UnavailableError

SIZE = (320, 320)
COLUMN = 2  # the middle panel of Pump, with the right foot over its right edge
PRESSED = 10  # column of `feet_on_floor`


def seen(lit, by, kind="cpu"):
    """The rings under her feet from above, uint8 (h, w, 3), without what the panel's light alone draws."""
    scene = rs.scene("pump-single")
    state = rs.state(scene, "step", "top", SIZE, lit=[(COLUMN, lit)], by=[(COLUMN, by)])
    made = renderer.create(scene, SIZE, "good", kind)
    return scene, state, made.frame(state).astype(int)


@pytest.mark.parametrize("kind", ["cpu", pytest.param("gl", marks=pytest.mark.gl)])
def test_a_ring_is_white_where_it_presses_and_faint_beside(kind):
    if kind == "gl":
        try:
            available.require_gl()
        except UnavailableError as error:
            pytest.skip(str(error))
    scene, state, pressed = seen(1.0, 1, kind)
    *_, usual = seen(0.0, 1, kind)
    mark = foot_marks(scene, state.joints)[1]
    (x, z), edge = np.mean((mark.heel, mark.toe), axis=0), PANEL / 2
    assert abs(x) < edge + 0.06 and abs(abs(x) - edge) < 0.06, "the foot stands over the panel's edge"
    off = 0.052 + 0.013  # a ring's middle is so far from the line between heel and toe
    sides = {"on": x - np.sign(x) * off, "beside": x + np.sign(x) * off}
    at = {name: state.camera.project(np.array([[side, 0.0, z]]), SIZE)[0, :2] for name, side in sides.items()}
    around = {name: tuple(slice(round(c) - 2, round(c) + 3) for c in place[::-1]) for name, place in at.items()}
    assert pressed[around["on"]].min(axis=2).max() > 230, "white"
    colour = np.array(scene.colours.right_foot)
    far = {name: np.abs(frame[around["beside"]] - colour).sum(axis=2).min() for name, frame in
           (("pressed", pressed), ("usual", usual))}  # fmt: skip
    assert far["usual"] < 60 and far["pressed"] > 150, far


def test_only_the_limb_that_presses_says_so():
    """Not the other foot, not on a panel that is dark or far away, and not in the air; two dancers each for herself."""
    scene, state, _ = seen(0.8, 1)
    feet = feet_on_floor(scene, state)
    assert feet[1, PRESSED] == pytest.approx(0.8) and feet[0, PRESSED] == 0
    for other in ({"lit": [(COLUMN, 0.0)]}, {"by": [(COLUMN, 0)]}, {"lit": [(0, 1.0)], "by": [(0, 1)]}):
        wish = {"lit": [(COLUMN, 0.8)], "by": [(COLUMN, 1)], **other}
        assert feet_on_floor(scene, rs.state(scene, "step", "top", SIZE, **wish))[1, PRESSED] == 0
    high = state.joints.copy()
    high[:, 1, 3] += 0.05
    assert feet_on_floor(scene, replace(state, joints=high))[1, PRESSED] == 0
    assert 0 < RING_SHARE < 0.5
