"""Two who dance together are two people, whose feet are exact; alone each is who she was; mirror images stay so."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.motion import Motion, sample
from dancetutor_cli.dance.performance import Performance, perform, solve
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.dance.trajectory.groove import carriage

HEAD = "#TITLE:T;\n#OFFSET:0;\n#BPMS:0=70;\n#NOTES:dance-{}::Easy:3::\n{};\n"
OWN = ["1000", "0001", "0100", "0001", "0010", "1000", "0001", "1000", "0000", "0000", "0000", "0000", "1000", "0100"]
EVEN = np.arange(0.5, 12.0, 1 / 30)
MIRROR = [3, 1, 2, 0]  # of each column the one on the other side


def _mirrored(row: str) -> str:
    return "".join(row[k] for k in MIRROR)


def danced(folder: Path, kind: str, rows: list[str]) -> Performance:
    rows = rows + ["0" * len(rows[0])] * (-len(rows) % 4)
    path = folder / f"{kind}.sm"
    path.write_text(HEAD.format(kind, "\n,\n".join("\n".join(rows[k : k + 4]) for k in range(0, len(rows), 4))))
    wanted = DanceRequest(path, Selection())
    return perform(solve(wanted), wanted)


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> list[Motion]:
    """Both dance the same notes."""
    both = danced(tmp_path_factory.mktemp("pair"), "couple", [row + row for row in OWN])
    return [one.motion for one in both.bake()]


def in_chest(motion: Motion, times: np.ndarray) -> np.ndarray:
    """Both wrists (f, 6) in the axes of the chest, metres."""
    skeleton = motion.skeleton
    places, world = world_transforms(skeleton, *sample(motion, times))
    chest = skeleton.index("vt4")
    wrists = [places[:, skeleton.index(f"{side}_radiocarpal")] - places[:, chest] for side in "lr"]
    return np.column_stack([quat.rotate(quat.conjugate(world[:, chest]), wrist) for wrist in wrists])


def blinks(motion: Motion) -> np.ndarray:
    """Seconds at which lids close."""
    lid = motion.rotations[:, motion.skeleton.index("l_eyelid_joint")]
    shut = quat.angle_between(lid, quat.IDENTITY) > np.radians(45.0)
    return motion.times[1:][shut[1:] & ~shut[:-1]]


def test_arms_gaze_and_blinks_differ(pair: list[Motion]) -> None:
    one, other = pair
    apart = np.linalg.norm((in_chest(one, EVEN) - in_chest(other, EVEN)).reshape(-1, 2, 3), axis=2)
    assert np.median(apart) > 0.05 and (apart > 0.03).mean() > 0.75, "hands are elsewhere nearly all the time"
    gazes = []
    for motion in pair:
        _, world = world_transforms(motion.skeleton, *sample(motion, EVEN))
        gazes.append(quat.rotate(world[:, motion.skeleton.index("skullbase")], np.array([0.0, 0.0, 1.0])))
    turned = np.degrees(np.arccos(np.clip((gazes[0] * gazes[1]).sum(axis=1), -1.0, 1.0)))
    assert np.percentile(turned, 75) > 4.0 and turned.max() > 8.0
    first, second = (blinks(motion) for motion in pair)
    assert len(first) > 2 and len(second) > 2
    assert np.abs(first[:, None] - second[None]).min() > 0.05


def test_each_carries_her_arms_in_phrases_of_her_own(tmp_path: Path) -> None:
    both = danced(tmp_path, "couple", [row + row for row in OWN]).dancers
    times = np.arange(0.5, 10.0, 1 / 60)
    ways = [carriage(one.plan, times, one.context) for one in both]
    assert np.abs(ways[0] - ways[1]).mean() > 0.2


def test_feet_of_both_are_exact_and_joints_within_their_limits(pair: list[Motion]) -> None:
    starts = []
    for motion in pair:
        measured = report(motion)
        assert np.abs(measured.contact_errors).max() < 1.0
        for name in ("contacts missed", "plant slide", "penetration", "foot in foot", "frames past joint limits"):
            assert measured[name].is_met is not False, f"{name}: {measured[name].value}"
        starts.append([contact.start for contact in motion.contacts])
    assert starts[0] == starts[1]


def test_in_the_mirror_image_of_a_chart_each_stays_who_she_was(tmp_path: Path) -> None:
    """The left one's image is the right one of the mirrored chart: her wrists are the mirrored wrists."""
    (tmp_path / "a").mkdir()
    rows = [own + ("0000" if k == 4 else own) for k, own in enumerate(OWN)]
    image = [_mirrored(row[4:]) + _mirrored(row[:4]) for row in rows]
    pairs = [danced(tmp_path, "couple", rows), danced(tmp_path / "a", "couple", image)]
    assert [one.context.person for one in pairs[0].dancers] == [0, 1]
    assert [one.context.person for one in pairs[1].dancers] == [1, 0]
    mine = in_chest(pairs[0].bake()[1].motion, EVEN)
    theirs = in_chest(pairs[1].bake()[0].motion, EVEN)
    swapped = theirs[:, [3, 4, 5, 0, 1, 2]] * [-1.0, 1.0, 1.0, -1.0, 1.0, 1.0]
    assert np.abs(mine - swapped).max() < 0.002


def test_two_who_are_each_others_mirror_image_are_two_people_all_the_same(tmp_path: Path) -> None:
    both = danced(tmp_path, "couple", [row + _mirrored(row) for row in OWN])
    assert sorted(one.context.person for one in both.dancers) == [0, 1]
    one, other = (in_chest(done.motion, EVEN) for done in both.bake())
    swapped = other[:, [3, 4, 5, 0, 1, 2]] * [-1.0, 1.0, 1.0, -1.0, 1.0, 1.0]
    assert np.median(np.abs(one - swapped)) > 0.01


def test_the_phase_of_the_second_dancer_is_drawn_for_each_song(tmp_path: Path) -> None:
    """It was 1.9 s in all songs. Breaths are apart by a third of a breath at least."""
    phases = []
    for length in range(8, len(OWN) + 1):
        first, second = danced(tmp_path, "couple", [row + row for row in OWN[:length]]).dancers
        breath = second.context.settings.layers.breath_time
        assert first.context.phase == 0.0 and 0.3 <= second.context.phase / breath % 1.0 <= 0.7
        phases.append(second.context.phase)
    assert np.ptp(phases) > 5.0 and len(set(phases)) > 2


def test_a_single_dancer_has_person_0(tmp_path: Path) -> None:
    (alone,) = danced(tmp_path, "single", OWN).dancers
    assert alone.context.person == 0 and alone.context.own == () and alone.context.phase == 0.0
