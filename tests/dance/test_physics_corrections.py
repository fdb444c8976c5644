"""Corrections of captured motion: what tools/spoil_bvh.py breaks is whole again, and the report says both."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

from dancetutor_cli.character.retargeting import Retargeting, RetargetTask
from dancetutor_cli.dance.physics.pipeline import RagdollOptions
from dancetutor_cli.dance.physics.plants import PIVOT, Plants, planted, tidied
from dancetutor_cli.dance.physics.repin import AnkleTracks
from dancetutor_cli.dance.quality.figures import MotionReport
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.formats.bvh import write_bvh
from dancetutor_cli.formats.captured import read_source

_SPEC = importlib.util.spec_from_file_location("spoil_bvh", Path(__file__).parents[2] / "tools" / "spoil_bvh.py")
assert _SPEC is not None and _SPEC.loader is not None
tool = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(tool)
ALL = ("knees", "feet", "limits")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("spoiled")


def retargeted(source: Path, fault: str, folder: Path, corrections: tuple[str, ...] = ALL) -> Retargeting:
    path = folder / f"{fault}.bvh"
    if not path.exists():
        write_bvh(path, tool.spoiled(source, (fault,), (0.1, 6.0)))
    return Retargeting(RetargetTask(path, "dancer", "neutral", RagdollOptions(corrections)), read_source(path))


def value(report: MotionReport, name: str) -> float:
    return report[name].value


def test_knees_that_pop_do_not_any_more(shared_data: Path, folder: Path) -> None:
    report = retargeted(shared_data / "bvh" / "pymo_8walk.bvh", "popping", folder).report()
    assert value(report, "knee acceleration near straight, input") > 15000
    assert report["knee angle"].is_met and report["knee acceleration near straight"].is_met is not False


def test_feet_that_skate_stand(shared_data: Path, folder: Path) -> None:
    report = retargeted(shared_data / "bvh" / "pymo_8walk.bvh", "skating", folder).report()
    assert value(report, "slide per plant, input") > 30
    for name in ("slide per plant", "plant slide", "penetration", "frames past joint limits"):
        assert report[name].is_met, report[name]


def test_impossible_elbows_become_possible(shared_data: Path, folder: Path) -> None:
    source = shared_data / "bvh" / "pymo_8walk.bvh"
    report = retargeted(source, "elbows", folder).report()
    assert value(report, "elbows bent backward, input") > 100
    assert report["elbows bent backward"].value == 0 == report["frames past limits"].value
    loose = retargeted(source, "elbows", folder, ()).report()
    assert loose["elbows bent backward"].value > 100, "without the correction they stay"


def skating(seconds: float = 1.5, rate: float = 100.0) -> AnkleTracks:
    """Both feet flat, 5 cm of skating while they stand, a step in the middle."""
    t = np.arange(round(seconds * rate)) / rate
    height = dancer_skeleton().rest[dancer_skeleton().index("l_talocrural")][1]
    lifted = 0.1 * np.sin(np.pi * np.clip((t - 0.6) / 0.3, 0, 1))
    places = np.zeros((len(t), 2, 3))
    places[..., 0] = [0.1, -0.1]
    places[..., 1] = (height + lifted)[:, None]
    places[..., 2] = (0.05 * np.sin(6 * t) + 0.3 * np.clip((t - 0.6) / 0.3, 0, 1))[:, None]
    return AnkleTracks(places, np.tile(quat.IDENTITY, (len(t), 2, 1)))


def test_a_planted_foot_does_not_move_at_all_and_goes_smoothly_between() -> None:
    feet = skating()
    down = feet.places[..., 1] < 0.0851
    made, held = planted(dancer_skeleton(), feet, Plants(down, down))
    for side in (0, 1):
        for first, end in Plants(down, down).spans(side):
            assert np.ptp(made.places[first:end, side], axis=0).max() < 1e-12
    assert (held[down] == 1).all() and held.min() < 0.5
    speed = np.linalg.norm(np.diff(made.places[:, 0], axis=0), axis=1) * 100
    assert speed.max() < 1.35 * np.linalg.norm(np.diff(feet.places[:, 0], axis=0), axis=1).max() * 100


def test_short_holds_and_short_gaps_are_none() -> None:
    flags = np.zeros((100, 2), dtype=bool)
    flags[10:40, 0], flags[43:60, 0], flags[80:83, 0] = True, True, True
    made = tidied(Plants(flags, flags), 100.0)
    assert made.spans(0).tolist() == [[10, 60]] and not made.heel[:, 1].any()


def test_a_foot_that_turns_far_while_it_lies_pivots() -> None:
    feet = skating()
    turn = quat.from_axis_angle(np.array([0.0, 1.0, 0.0]), np.linspace(0, 3 * PIVOT, len(feet.places)))
    whole = np.ones((len(feet.places), 2), dtype=bool)
    made, _ = planted(dancer_skeleton(), AnkleTracks(feet.places, np.stack((turn, turn), axis=1)), Plants(whole, whole))
    assert np.degrees(quat.angle_between(made.turns[0, 0], made.turns[-1, 0])) > 60
