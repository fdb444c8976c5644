"""What a .glb's animation draws, read back from the file alone: feet, palms, contacts, and how large the file is."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from glb_channels import channels_of

from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.chart.reader import load
from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.keys import reaches
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.performance import as_heard
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import palm_points, points_in_world, sole_points, world_transforms
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_chart
from dancetutor_cli.formats.glb import write_glb
from dancetutor_cli.run.reading import charts_path

ROOT = Path(__file__).resolve().parents[2]
FASTER, STREAM = 2.0, (1.2, 3.5)  # 17 steps per second, more than any chart of the corpus keeps up


def drawn(path: Path, motion: Motion) -> Motion:
    """What a viewer draws of the file at each key of the motion."""
    channels, skeleton = channels_of(path), motion.skeleton
    at = motion.times - min(0.0, motion.times[0])
    rotations = np.tile([1.0, 0.0, 0.0, 0.0], (len(at), len(skeleton.names), 1))
    for j, name in enumerate(skeleton.names):
        if (name, "rotation") in channels:
            times, turned = channels[name, "rotation"]
            turned = quat.normalize(turned[:, [3, 0, 1, 2]])
            if len(times) == 1:
                rotations[:, j] = turned[0]
                continue
            after = np.clip(np.searchsorted(times, at), 1, len(times) - 1)
            share = np.clip((at - times[after - 1]) / (times[after] - times[after - 1]), 0.0, 1.0)
            rotations[:, j] = quat.slerp(turned[after - 1], turned[after], share)
    times, root = channels["HumanoidRoot", "translation"]
    places = np.column_stack([np.interp(at, times, root[:, k]) for k in range(3)])
    return replace(motion, rotations=rotations, root=places)


def fast(faster: float = FASTER, **more: object) -> Motion:
    song = load(charts_path() / "two_left_feet" / "two_left_feet.ssc")
    chart = next(c for c in song.charts if c.difficulty == "Challenge")
    play, pad = solve_chart(chart, load_preset("itg")), load_pad(chart.steps_type)
    assert play is not None and pad is not None
    timing = chart.timing.at_rate(faster)
    return bake(timing, as_heard(play, timing), pad, **more)  # type: ignore[arg-type]


@pytest.fixture(scope="module", params=["free", "bar"])
def written(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Motion]:
    motion = fast(bar=request.param == "bar")
    path = tmp_path_factory.mktemp("glb") / "fast.glb"
    write_glb(path, load_dancer(), motion)
    return path, motion


@pytest.mark.parametrize("bar", [False, True])
def test_two_minutes_of_the_fastest_stream_are_small(tmp_path: Path, bar: bool) -> None:
    start, end = STREAM
    part, rounds = fast(section=STREAM, bar=bar), round(120.0 / (end - start))
    once = (part.times >= start) & (part.times < end - 1e-6)
    times = np.concatenate([part.times[once] + k * (end - start) for k in range(rounds)])
    rotations, root = np.tile(part.rotations[once], (rounds, 1, 1)), np.tile(part.root[once], (rounds, 1))
    grips = tuple(replace(g, start=0.0, end=200.0) for g in part.grips[:1])
    long = replace(part, times=times, rotations=rotations, root=root, contacts=(), grips=grips)
    write_glb(tmp_path / "still.glb", load_dancer())
    write_glb(tmp_path / "long.glb", load_dancer(), long)
    assert len({c.start for c in part.contacts}) / (end - start) > 16
    assert (tmp_path / "long.glb").stat().st_size - (tmp_path / "still.glb").stat().st_size < 5_000_000


def test_feet_stand_where_they_stood(written: tuple[Path, Motion]) -> None:
    path, motion = written
    seen = drawn(path, motion)
    for points in sole_points(motion.skeleton):
        right, shown = (points_in_world(m.skeleton, points, m.rotations, m.root) for m in (motion, seen))
        assert np.linalg.norm(right - shown, axis=-1).max() < 1e-4


def test_contacts_stay_exact(written: tuple[Path, Motion]) -> None:
    path, motion = written
    after = report(drawn(path, motion))
    assert after["contacts missed"].value == 0 and after["contact error"].value <= 1.0
    assert after["penetration"].is_met


def test_usual_charts_are_exact(tmp_path: Path) -> None:
    motion = fast(faster=1.0)  # the same chart as it is: no figure of the feet is worse in the file
    write_glb(tmp_path / "a.glb", load_dancer(), motion)
    seen = drawn(tmp_path / "a.glb", motion)
    for points in sole_points(motion.skeleton):
        right, shown = (points_in_world(m.skeleton, points, m.rotations, m.root) for m in (motion, seen))
        assert np.linalg.norm(right - shown, axis=-1).max() < 3e-5
    before, after = report(motion), report(seen)
    for name in ("contact error", "plant slide", "penetration", "foot in foot", "contacts missed"):
        assert after[name].value == pytest.approx(before[name].value, abs=0.02), name
    size = (tmp_path / "a.glb").stat().st_size - (ROOT / "dancetutor_cli/character/data/dancer.glb").stat().st_size
    assert size * 120.0 / np.ptp(motion.times) < 3_600_000


def test_palms_stay_and_free_hands_are_near(written: tuple[Path, Motion]) -> None:
    path, motion = written
    seen = drawn(path, motion)
    for side, palm in enumerate(palm_points(motion.skeleton)):
        right, shown = (points_in_world(m.skeleton, (palm,), m.rotations, m.root)[:, 0] for m in (motion, seen))
        off = np.linalg.norm(right - shown, axis=-1)
        touching = np.zeros(len(off), dtype=bool)
        for start, end in [(c.start, c.end) for c in motion.contacts if c.limb == Limb.LEFT_HAND + side]:
            touching |= (motion.times > start - 0.05) & (motion.times < end + 0.05)
        assert off[touching].max(initial=0.0) < 1e-4
        assert off.max() < 0.008
        for grip in motion.grips:
            if grip.side == side:
                assert off[(motion.times >= grip.start) & (motion.times <= grip.end)].max(initial=0.0) < 1e-3


def test_every_frame_is_exact(written: tuple[Path, Motion]) -> None:
    """A viewer at the file's frame rate sees all of her as she was baked, head, arms and braid too."""
    path, motion = written
    seen = drawn(path, motion)
    frame = np.abs(motion.times * motion.fps - np.rint(motion.times * motion.fps)) < 1e-6
    right, shown = (world_transforms(m.skeleton, m.rotations[frame], m.root[frame])[0] for m in (motion, seen))
    assert np.linalg.norm(right - shown, axis=-1).max() < 3e-4
    turned = quat.angle_between(motion.rotations[frame], seen.rotations[frame])  # of fingers and eyes, too
    assert (turned * reaches(motion.skeleton)).max() < 3e-4


def test_each_joint_has_no_more_keys_than_it_needs(written: tuple[Path, Motion]) -> None:
    path, motion = written
    channels = channels_of(path)
    keys = {name: len(times) for (name, what), (times, _) in channels.items() if what == "rotation"}
    assert keys["l_knee"] == keys["r_talocrural"] == len(motion.times)
    frames = np.ptp(motion.times) * motion.fps
    assert keys["l_eyelid_joint"] < 0.3 * frames  # a blink now and then
    assert keys["l_metacarpophalangeal_3"] < 0.35 * frames  # fingers curl slowly
    assert keys["skullbase"] < 1.2 * frames
    if motion.bar is None:
        assert keys["l_elbow"] < 1.2 * frames
