"""Two who dance side by side: each comes and goes on her own outer side, and nobody is in the other."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from dancetutor_cli.character.animation import AnimatedDancer, Animation
from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.character.mesh import partner_of
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.motion import Motion, shifted
from dancetutor_cli.dance.performance import Performance, perform, play_of_all, solve
from dancetutor_cli.dance.quality.figures import body_of
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.dance.rig.limbs import Capsule, depth

pytestmark = pytest.mark.usefixtures("own_records")

Array = np.ndarray
HEAD = "#TITLE:T;\n#OFFSET:0;\n#BPMS:0=120;\n"
EMPTY = "00000000\n,\n" * 2
# outer panels, and then both stand on their inner ones, beside each other, for some steps
COUPLE = EMPTY + "10000001\n01000010\n00100100\n10000001\n,\n" + "00011000\n00100100\n00011000\n01000010\n,\n" * 2
# the first one begins on the left half and ends on the right one; the second one the other way round
LEFT, RIGHT = "10000000\n01000000\n00010000\n00100000\n,\n", "00000001\n00000010\n00001000\n00000100\n,\n"
ROUTINE = LEFT * 2 + "00001000\n00000100\n00000001\n00000010\n,\n" + RIGHT
BACK = RIGHT * 2 + "00010000\n00100000\n10000000\n01000000\n,\n" + LEFT
RADII = {"hip": 0.068, "knee": 0.048, "talocrural": 0.035, "shoulder": 0.045, "elbow": 0.036, "radiocarpal": 0.026}
CHAINS = [("l_hip", "l_knee", "l_talocrural"), ("l_shoulder", "l_elbow", "l_radiocarpal"), ("HumanoidRoot", "vt4")]
TRUNK, HAND = 0.12, 0.10  # metres: radius of the trunk; of the hand beyond the wrist


def danced(folder: Path, kind: str, notes: str, player: int | None = None) -> Performance:
    path = folder / "two.sm"
    path.write_text(HEAD + f"#NOTES:{kind}::Hard:9::\n{notes};\n")
    request = DanceRequest(path, Selection(player=player))
    return perform(solve(request), request)


def capsules(motion: Motion, times: Array) -> list[list[Capsule]]:
    """Legs, arms with hands, and the trunk at some of the motion's own even times."""
    body = body_of(motion)
    near = np.searchsorted(body.times, times - 1e-6)
    out = []
    for chain in (*CHAINS[:2], *(tuple(f"r{n[1:]}" for n in chain) for chain in CHAINS[:2]), CHAINS[2]):
        places = [body.joints[near, motion.skeleton.index(name)] for name in chain]
        if chain[-1].endswith("radiocarpal"):
            along = places[-1] - places[-2]
            places[-1] = places[-1] + HAND * along / np.linalg.norm(along, axis=1, keepdims=True)
        radii = [RADII.get(name[2:], TRUNK) for name in chain]
        out.append([(places[k], places[k + 1], radii[k], radii[k + 1]) for k in range(len(chain) - 1)])
    return out


def nearest(motions: Sequence[Motion]) -> Array:
    """How deep any limb of one is in any of the other at each time that both have; below 0 apart, metres."""
    first, last = max(m.times[0] for m in motions), min(m.times[-1] for m in motions)
    times = np.arange(np.ceil(first * 60), np.floor(last * 60) + 1) / 60
    one, other = (capsules(motion, times) for motion in motions)
    return np.asarray(np.maximum.reduce([depth(a, b) for a in one for b in other]))


@pytest.fixture(scope="module")
def couple(tmp_path_factory: pytest.TempPathFactory) -> Performance:
    return danced(tmp_path_factory.mktemp("couple"), "dance-couple", COUPLE)


def sides(performance: Performance) -> tuple[tuple[int, int] | None, ...]:
    return tuple(one.context.sides for one in performance.dancers)


def test_no_limb_of_one_is_ever_in_the_other(couple: Performance) -> None:
    """From the walk on to the walk off, and while both stand on their inner panels."""
    assert sides(couple) == ((0, 0), (1, 1))
    pairs = zip(couple.bake(), couple.dancers, strict=True)
    motions = [shifted(one.motion, *dancer.place) for one, dancer in pairs]
    assert nearest(motions).max() < 0.0
    for motion, outward in zip(motions, (1.0, -1.0), strict=True):  # the first player's pad is on the left, +x
        assert motion.ground is not None
        for x in motion.root[[0, -1], 0]:
            assert outward * x > 0.84 + 0.1, "beside the pad, on her own side"


def test_a_dancer_who_goes_through_the_other_is_found(couple: Performance) -> None:
    pairs = zip(couple.dancers, ((0, 1), (1, 0)), strict=True)
    motions = [shifted(bake(couple.timing, one.play, one.pad, sides=side), *one.place) for one, side in pairs]
    assert nearest(motions).max() > 0.05


def test_dancers_who_change_places_go_to_the_other_side(tmp_path: Path) -> None:
    both = danced(tmp_path, "dance-routine", EMPTY + ROUTINE + "&\n" + EMPTY + BACK)
    assert sides(both) == ((0, 1), (1, 0))
    for one in both.dancers:
        assert one.context.sides is not None
        came, goes = one.context.sides
        assert np.sign(one.plan.feet[0].start[0]) == 1.0 - 2.0 * came
        assert np.sign(one.plan.feet[0].moves[-1].target[0]) == 1.0 - 2.0 * goes


def test_both_files_of_animate_have_the_same_ways(couple: Performance, tmp_path: Path) -> None:
    for player in (1, 2):
        assert sides(danced(tmp_path, "dance-couple", COUPLE, player)) == (None,), "alone she comes as her notes say"
    animation, who = Animation(couple), load_dancer()
    files = [AnimatedDancer(animation, k, one) for k, one in enumerate((who, partner_of(who)))]
    for file, one in zip(files, couple.dancers, strict=True):
        assert file.moves == (one.plan, one.context.bar) and file.place == one.place
    assert files[0].motion.times[0] == files[1].motion.times[0]


def test_a_roll_is_shown_with_the_taps_of_the_preset(tmp_path: Path) -> None:
    """Both players' plays as one have the same rows as the plays: a shorter roll window has more taps."""
    preset, path = tmp_path / "often.yaml", tmp_path / "roll.sm"
    preset.write_text("extends: itg\nroll-window: 0.15\n")
    path.write_text(HEAD + "#NOTES:dance-couple::Hard:9::\n40000010\n00000000\n30000010\n00000001\n;\n")
    solved = solve(DanceRequest(path, Selection(), preset=str(preset)))
    plays = [one.play for one in solved if one.play is not None]
    assert len(plays) == 2
    assert plays[0].rows.tick.tolist() == [*range(0, 96, 12)]  # eight taps, an eighth of a second apart
    shown = play_of_all(solved, plays)
    assert shown.rows.tick.tolist() == sorted({*plays[0].rows.tick.tolist(), *plays[1].rows.tick.tolist()})
    assert ((shown.limb >= 0) == (shown.rows.steps > 0)).all()
