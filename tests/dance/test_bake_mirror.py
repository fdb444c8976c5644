"""What is true of a play is true of its mirror image: mirrored feet dance the mirrored motion, from root to gaze."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bake_mirror import apart, mirrored_motion, mirrored_play
from bake_plays import MEDLEY, L, R, chart, pad, plan_of, play, stream
from dance_requests import solved_one

from dancetutor_cli.chart.reader import load
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.settings import default_settings
from dancetutor_cli.dance.trajectory.height import jump_lean
from dancetutor_cli.feet.pads import Pad, load_pad
from dancetutor_cli.feet.play import Play
from dancetutor_cli.run.reading import charts_path

SINGLE = np.array([3, 1, 2, 0])
MOST_MM, MOST_DEGREES = 1.0, 0.5
DEMO = charts_path() / "two_left_feet" / "two_left_feet.ssc"
REAL = (  # charts of the corpus with jumps, gallops, mines, holds, hands and crossed feet; seconds of a section
    ("*/g0349_*.s*", "dance-single", 40.0),
    ("*/g0282_*.s*", "dance-single", 64.0),
    ("*/g0003_POSS*.s*", "dance-single", 80.0),
    ("*/g0026_boss*.s*", "dance-double", 26.0),
    ("*/g0090_ace*.s*", "dance-double", 46.0),
    ("*/g0262_*.s*", "dance-double", 11.0),
)


def mirrorable(path: Path, index: int) -> tuple[Timing, Play, Pad, np.ndarray]:
    """Timing, play and pad of a chart, and the column that each one is in the mirror image."""
    one = solved_one(path, Selection(index=index), "thesis")
    assert one.play is not None and one.pad is not None
    columns = one.pad.mirror_columns(left_right=True)
    assert columns is not None
    return one.chart.timing, one.play, one.pad, columns


def check(path: Path, index: int, section: tuple[float, float] | None, **how: Any) -> None:
    timing, played, own, columns = mirrorable(path, index)
    one, image = (bake(timing, p, own, section=section, **how) for p in (played, mirrored_play(played, columns)))
    for part, (far, turned) in apart(one, mirrored_motion(image)).items():
        assert far < MOST_MM and turned < MOST_DEGREES, f"{part}: {far:.2f} mm, {turned:.2f} degrees"


@pytest.mark.parametrize("index", range(len(load(DEMO).charts)))
def test_the_demo_song(index: int) -> None:
    check(DEMO, index, None)


@pytest.mark.parametrize("gait", ["flat", "heels"])
def test_the_demo_song_at_the_bar(gait: str) -> None:
    check(DEMO, 3, (0.0, 12.0), bar=True, gait=gait)


@pytest.mark.parametrize(("name", "steps_type", "start"), REAL)
def test_real_charts(corpus: Path, name: str, steps_type: str, start: float) -> None:
    path = sorted(corpus.glob(name))[0]
    index = [c.index for c in load(path).charts if c.steps_type == steps_type][-1]
    check(path, index, (start, start + 10.0))


SCENES = {
    "medley": (MEDLEY, {}),
    "a gallop led by the left": ([(2.0, {0: L}), (3.0, {1: L}), (3.1, {3: R}), (4.0, {0: L})], {}),
    "a spin": ([(2.0, {0: L, 3: R}), (3.0, {0: R, 3: L}), (4.0, {0: L, 3: R}), (5.0, {1: L, 2: R})], {}),
    "mines under both feet": ([(2.0, {0: L, 3: R}), (3.0, {}), (3.4, {}), (4.0, {2: R})], {1: [0, 3], 2: [0]}),
    "jumps only": ([(2.0 + 0.4 * k, {(0, 1)[k % 2]: L, (2, 3)[k % 3 // 2]: R}) for k in range(8)], {}),
    "a stream": (stream(2.0, 32, 0.1), {}),
}


@pytest.mark.parametrize("scene", SCENES)
def test_plays_by_hand(scene: str) -> None:
    events, mines = SCENES[scene]
    one = play(events, mines=mines)
    motion, image = (bake(chart().timing, p, pad()) for p in (one, mirrored_play(one, SINGLE)))
    for part, (far, turned) in apart(motion, mirrored_motion(image)).items():
        assert far < MOST_MM and turned < MOST_DEGREES, f"{part}: {far:.2f} mm, {turned:.2f} degrees"


def test_any_gallop_leans_whoever_leads_the_song() -> None:
    """The same song, once with a gallop led by the left foot and once by the right one."""
    leans = []
    for first, second, columns in ((L, R, (1, 3)), (R, L, (1, 0))):
        events = [(2.0, {0: L}), (2.5, {3: R}), (4.0, {columns[0]: first}), (4.1, {columns[1]: second})]
        plan = plan_of(chart().timing, play(events), pad())
        assert plan.lead == 0
        leans.append(jump_lean(plan, np.arange(3.0, 5.0, 0.01), default_settings().jump))
    assert np.abs(leans[0]).max() > np.radians(1.0)
    np.testing.assert_allclose(leans[0], leans[1] * [-1.0, 1.0], atol=1e-9)


def test_the_foot_that_steps_first_leads_and_she_comes_from_its_side() -> None:
    timing, played, own, columns = mirrorable(DEMO, 3)
    for one, lead in ((played, 0), (mirrored_play(played, columns), 1)):
        plan = plan_of(timing, one, own)
        alone = next(limbs[limbs >= 0] for limbs in one.limb if (limbs >= 0).sum() == 1)
        assert plan.lead == lead == alone[0]
        assert [np.sign(track.start[0]) for track in plan.feet] == [1 - 2 * lead] * 2


def test_the_mirror_sees_a_difference() -> None:
    """The test itself: a foot that is not mirrored is told."""
    one = play(stream(2.0, 8, 0.5))
    motion = bake(chart().timing, one, pad())
    assert apart(motion, mirrored_motion(motion))["legs"][0] > 50.0
    moved = replace(motion, root=motion.root + np.array([0.002, 0.0, 0.0]))
    assert apart(motion, moved)["root"][0] == pytest.approx(2.0)
    assert load_pad("dance-single").mirror_columns(left_right=True).tolist() == SINGLE.tolist()  # type: ignore[union-attr]
