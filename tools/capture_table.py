#!/usr/bin/env python3
"""Retarget captures, and clips made from them by a seed, and measure each from outside: a line for each clip.

usage: tools/capture_table.py FOLDER [--made 46] [--seed 1] [--character NAME|FILE] [--only WORD]
Clips that are made are sections of those in FOLDER, slower or faster, of people with other limbs, arms nearer to the
body, joints that tremble slowly, on floors that are not level, one in four with a fault of tools/spoil_bvh.py. Columns
are what the report says of the input and of the output: slide by height and speed (median and worst, mm), frames past
limits, percent of frames with a forearm in the trunk, and knee acceleration near straight (degrees/s^2).
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from spoil_bvh import FAULTS, joints_of, spoiled

from dancetutor_cli.character.retargeting import Retargeting, RetargetTask
from dancetutor_cli.dance.motion import Motion, sample
from dancetutor_cli.dance.physics.pipeline import CORRECTIONS, RagdollOptions
from dancetutor_cli.dance.quality.contact import stands
from dancetutor_cli.dance.quality.figures import body_of
from dancetutor_cli.dance.quality.posture import shape_figures, smoothness_figures
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.skeleton import Skeleton
from dancetutor_cli.formats.bvh import read_bvh, write_bvh
from dancetutor_cli.formats.captured import read_source
from dancetutor_cli.run.errors import DancetutorError

SECONDS = 6.0  # of a section
SLOWEST, FASTEST = 0.7, 1.3
LIMBS = ((("hip", "knee"), ("knee", "talocrural")), (("shoulder", "elbow"), ("elbow", "radiocarpal")))
LONGER = 0.12  # by which limbs are longer or shorter, at most
TREMBLE, NEARER, TILT = 2.0, 12.0, 1.5  # degrees
HEAD = (
    "| clip | slide, input | slide | past limits, input | past limits "
    "| in trunk, input | in trunk | knees, input | knees |\n| --- " + "| --- " * 8 + "|"
)


def made(sources: list[Path], count: int, seed: int) -> list[tuple[str, Motion]]:
    """So many clips, the same for the same seed, and what each is called."""
    draw = np.random.default_rng(seed)
    return [_variant(sources[k % len(sources)], draw, f"{seed}.{k}") for k in range(count)]


def _variant(source: Path, draw: np.random.Generator, label: str) -> tuple[str, Motion]:
    length = float(read_bvh(source).times[-1])
    start = draw.uniform(0.3, max(0.4, length - SECONDS))
    fault = (*FAULTS, *[""] * 9)[draw.integers(len(FAULTS) + 9)]
    motion = spoiled(source, (fault,) if fault else (), (start, start + SECONDS))
    joints = joints_of(source, motion)
    pace = draw.uniform(SLOWEST, FASTEST)
    times = motion.times[0] + np.arange(int((motion.times[-1] - motion.times[0]) / pace * motion.fps)) / motion.fps
    rotations, root = sample(motion, motion.times[0] + (times - times[0]) * pace)
    waves = draw.uniform(0.3, 2.0, (rotations.shape[1], 3)), draw.uniform(0, 2 * np.pi, (rotations.shape[1], 3))
    wave = np.radians(TREMBLE) * draw.uniform() * np.sin(2 * np.pi * times[:, None, None] * waves[0] + waves[1])
    wave[:, 0] = 0.0
    rotations = quat.multiply(rotations, quat.from_vector(wave))
    nearer = np.radians(NEARER) * draw.uniform()
    names = {node: name for name, node in joints.items()}
    for node, name in names.items():
        if name.endswith("shoulder"):
            axis = motion.skeleton.rest[joints["l_hip"]] - motion.skeleton.rest[joints["r_hip"]]
            towards = np.cross(axis, [0.0, 1.0, 0.0]) * (1.0 if name.startswith("l_") else -1.0)
            rotations[:, node] = quat.multiply(
                quat.from_vector(nearer * towards / np.linalg.norm(towards)), rotations[:, node]
            )
    skeleton, legs = _other_limbs(motion.skeleton, joints, draw)
    tilt = quat.from_vector(np.radians(TILT) * draw.uniform(-1, 1, 3) * [1.0, 0.0, 1.0])
    rotations[:, 0] = quat.multiply(tilt, rotations[:, 0])
    root = quat.rotate(tilt, root * legs)
    name = f"{label} {source.stem} x{pace:.2f}{' ' + fault if fault else ''}"
    return name, replace(motion, skeleton=skeleton, times=times, rotations=rotations, root=root)


def _other_limbs(skeleton: Skeleton, joints: dict[str, int], draw: np.random.Generator) -> tuple[Skeleton, float]:
    """The skeleton with longer or shorter legs and arms, and how much longer its legs are."""
    offsets, legs = skeleton.offsets.copy(), 1.0
    for k, bones in enumerate(LIMBS):
        times = 1.0 + LONGER * draw.uniform(-1, 1)
        for first, last in bones:
            for side in "lr":
                node, above = joints[f"{side}_{last}"], joints[f"{side}_{first}"]
                while node != above:
                    offsets[node] *= times
                    node = int(skeleton.parents[node])
        legs = times if k == 0 else legs
    return replace(skeleton, offsets=offsets), legs


def sides_of(work: Retargeting) -> tuple[list[float], list[float]]:
    """Figures of input and output: slide (median, worst, mm), frames past limits, trunk (%), knees (degrees/s^2)."""
    sides = []
    for motion in (work.input_on_body, work.ragdoll_result.motion):
        slides, body = [1000 * one.slide for one in stands(motion)] or [0.0], body_of(motion)
        shape, _ = shape_figures(body, motion.skeleton)
        smooth, _ = smoothness_figures(body, motion.skeleton)
        value = {f.name: f.value for f in (*shape, *smooth)}
        sides.append(
            [
                float(np.median(slides)),
                max(slides),
                value["frames past joint limits"],
                value["limb in torso"],
                value["knee acceleration near straight"],
            ]
        )
    a, b = sides
    return a, b


def line_of(label: str, a: list[float], b: list[float]) -> str:
    """A line of the table."""
    pairs = f"{a[0]:.0f} / {a[1]:.0f} | {b[0]:.1f} / {b[1]:.0f}"
    rest = " | ".join(f"{x:.0f} | {y:.0f}" for x, y in zip(a[2:], b[2:], strict=True)).replace("nan", "-")
    return f"| {label} | {pairs} | {rest} |"


def measured(
    sources: list[Path], count: int, seed: int, character: str, only: str = ""
) -> tuple[list[tuple[str, list[float], list[float]]], list[str]]:
    """Clips and made ones: label, figures of input and output; and a line for each that was refused."""
    values, refused = [], []
    options = RagdollOptions(CORRECTIONS)
    with tempfile.TemporaryDirectory() as folder:
        clips = [(path.stem, path) for path in sources]
        for k, (label, motion) in enumerate(made(sources, count, seed)):
            path = Path(folder) / f"{k}.bvh"
            write_bvh(path, motion)
            clips.append((label, path))
        for label, path in clips:
            if only not in label:
                continue
            try:
                work = Retargeting(RetargetTask(path, character, "neutral", options), read_source(path))
                values.append((label, *sides_of(work)))
            except DancetutorError as error:
                refused.append(f"{label}: {error}")
    return values, refused


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--made", type=int, default=46, metavar="COUNT")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--character", default="dancer")
    parser.add_argument("--only", default="", help="clips with this word in their name")
    options = parser.parse_args()
    sources = sorted(options.folder.glob("*.bvh"))
    print(HEAD)
    values, refused = measured(sources, options.made, options.seed, options.character, options.only)
    for label, before, after in values:
        print(line_of(label, before, after))
    table = np.array([after for _, _, after in values])
    print(
        f"\n{len(values)} clips: median slide over 5 mm in {(table[:, 0] > 5).sum()}, worst over 25 mm in "
        f"{(table[:, 1] > 25).sum()} (largest {table[:, 1].max():.0f}); past limits in {(table[:, 2] > 0).sum()}; "
        f"forearm in the trunk in {(table[:, 3] > 0.1).sum()}; knees over 10000 in {(table[:, 4] > 10000).sum()}"
    )
    print("\n".join(refused))


if __name__ == "__main__":
    main()
