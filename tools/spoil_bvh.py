#!/usr/bin/env python3
"""Make the faults that motion capture has out of a clean BVH file: knees that pop, feet that skate, impossible elbows.

usage: tools/spoil_bvh.py IN.bvh OUT.bvh [--faults popping,skating,elbows] [--section START:END]
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np

from dancetutor_cli.character.humanoid import humanoid_of
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.dance.rig import quaternion as quat
from dancetutor_cli.dance.rig.body import world_transforms
from dancetutor_cli.formats.bvh import read_bvh, write_bvh

POP_EVERY, POP_FRAMES = 0.4, 0.05  # seconds from pop to pop of one knee, and that it stays straight
POP_BEND = 25.0  # degrees of bend below which a knee snaps
SKATE, SKATE_HERTZ, SUNK = 0.05, 0.6, 0.015  # metres to either side, and below the floor
ELBOW_EVERY, ELBOW_SECONDS, ELBOW_DEGREES = 1.0, 0.4, 45.0
FAULTS = ("popping", "skating", "elbows")


def joints_of(path: Path, motion: Motion) -> dict[str, int]:
    """Index in the file of each joint of the rig."""
    found = humanoid_of(path, motion.skeleton.names, motion.skeleton.parents).joints()
    return {name: node for node, name in found.items()}


def popping(motion: Motion, joints: dict[str, int]) -> Motion:
    """Knees that are nearly straight snap straight for some frames, as legs do whose IK reaches for too far a foot."""
    rotations = motion.rotations.copy()
    positions, world = world_transforms(motion.skeleton, motion.rotations, motion.root)
    parents, offsets = motion.skeleton.parents, motion.skeleton.offsets
    for k, side in enumerate("lr"):
        straight = ((motion.times - motion.times[0] + k * POP_EVERY / 2) % POP_EVERY) < POP_FRAMES
        hip, knee, ankle = (joints[f"{side}_{name}"] for name in ("hip", "knee", "talocrural"))
        u, v = positions[:, knee] - positions[:, hip], positions[:, ankle] - positions[:, knee]
        bend = np.degrees(np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), np.sum(u * v, axis=1)))
        part = straight & (bend < POP_BEND)
        thigh = quat.multiply(quat.between(u, u + v), world[:, hip])[part]
        shank = quat.multiply(thigh, quat.between(offsets[ankle], offsets[knee]))
        rotations[part, hip] = quat.multiply(quat.conjugate(world[part, parents[hip]]), thigh)
        rotations[part, knee] = quat.multiply(quat.conjugate(thigh), shank)
        rotations[part, ankle] = quat.multiply(quat.conjugate(shank), world[part, ankle])
    return replace(motion, rotations=rotations)


def skating(motion: Motion, joints: dict[str, int]) -> Motion:
    """The whole body slides to and fro over the floor, and a little into it."""
    t = 2 * np.pi * SKATE_HERTZ * (motion.times - motion.times[0])
    slid = np.column_stack((SKATE * np.sin(t), np.full(len(t), -SUNK), SKATE * np.cos(1.3 * t)))
    return replace(motion, root=motion.root + slid)


def elbows(motion: Motion, joints: dict[str, int]) -> Motion:
    """Both elbows bend backward for a while, again and again."""
    rotations = motion.rotations.copy()
    positions, world = world_transforms(motion.skeleton, motion.rotations, motion.root)
    share = np.clip(1.5 * np.sin(np.pi * ((motion.times % ELBOW_EVERY) / ELBOW_SECONDS)), 0.0, 1.0)
    share[(motion.times % ELBOW_EVERY) > ELBOW_SECONDS] = 0.0
    for side in "lr":
        upper, elbow, wrist = (joints[f"{side}_{name}"] for name in ("shoulder", "elbow", "radiocarpal"))
        u, v = positions[:, elbow] - positions[:, upper], positions[:, wrist] - positions[:, elbow]
        normal = np.cross(u, v)
        sine = np.linalg.norm(normal, axis=1)
        bend = np.arctan2(sine, np.sum(u * v, axis=1))
        back = quat.from_axis_angle(
            normal / np.maximum(sine, 1e-9)[:, None], -share * (bend + np.radians(ELBOW_DEGREES))
        )
        turned = quat.multiply(back, world[:, elbow])
        rotations[:, elbow] = quat.multiply(quat.conjugate(world[:, motion.skeleton.parents[elbow]]), turned)
    return replace(motion, rotations=rotations)


def spoiled(path: Path, faults: tuple[str, ...], section: tuple[float, float] | None = None) -> Motion:
    """The motion of a file with faults, its frames within a section, seconds."""
    motion = read_bvh(path)
    if section is not None:
        part = (motion.times >= section[0]) & (motion.times <= section[1])
        times = motion.times[part] - motion.times[part][0]
        motion = replace(motion, times=times, rotations=motion.rotations[part], root=motion.root[part])
    for fault in faults:
        motion = {"popping": popping, "skating": skating, "elbows": elbows}[fault](motion, joints_of(path, motion))
    return motion


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("source", type=Path)
    parser.add_argument("target", type=Path)
    parser.add_argument("--faults", default=",".join(FAULTS))
    parser.add_argument("--section", metavar="START:END", help="seconds")
    options = parser.parse_args()
    first, last = (float(x) for x in options.section.split(":")) if options.section else (0.0, np.inf)
    write_bvh(options.target, spoiled(options.source, tuple(options.faults.split(",")), (first, last)))
    print(f"{options.target}: {options.faults}")


if __name__ == "__main__":
    main()
