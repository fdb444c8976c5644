"""Pictures: milliseconds of one core for a frame of 1280x720, by renderer and quality, and what starting costs."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from dancetutor_cli.character.characters import load_dancer
from dancetutor_cli.dance.rig.body import joint_matrices
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.film.choices import QUALITIES, Quality, RendererKind
from dancetutor_cli.film.scene.renderer import create
from dancetutor_cli.film.scene.scene import FrameState, Scene
from dancetutor_cli.run.errors import UnavailableError

Row = tuple[str, float, str, str, str]
SIZE = (1280, 720)
FRAMES = 40
_COLD = """
import time
begun = time.perf_counter()
import bench_picture
scene, states = bench_picture.dancing()
frame = bench_picture.create(scene, bench_picture.SIZE, "good", "cpu").frame(states[0])
print(time.perf_counter() - begun)
"""


def dancing() -> tuple[Scene, list[FrameState]]:
    """The dancer stepping and turning her arms on the spot, `FRAMES` frames, seen from the back."""
    pad = load_pad("dance-single")
    assert pad is not None
    scene = Scene(load_dancer(), pad)
    skeleton = scene.character.skeleton
    phase = 2 * np.pi * np.arange(FRAMES) / FRAMES
    rotations = np.zeros((FRAMES, len(skeleton.names), 4))
    rotations[..., 0] = 1.0
    for name, axis, size in (("l_hip", 3, 0.3), ("r_hip", 3, -0.3), ("l_shoulder", 3, 0.8), ("r_shoulder", 1, 0.6)):
        half = size * (1 - np.cos(phase)) / 4
        rotations[:, skeleton.index(name), 0] = np.cos(half)
        rotations[:, skeleton.index(name), axis] = np.sin(half)
    root = np.tile(skeleton.rest[0], (FRAMES, 1))
    root[:, 1] += 0.06 * np.maximum(0.0, np.sin(phase))
    joints = joint_matrices(skeleton, rotations, root)
    camera = scene.camera("back", SIZE)
    lit = np.maximum(0.0, np.sin(phase[:, None] + np.arange(scene.panels)))
    return scene, [
        FrameState(j, camera, level, np.arange(scene.panels) % 2) for j, level in zip(joints, lit, strict=True)
    ]


def _per_frame(kind: RendererKind, quality: Quality) -> float:
    """Median of the milliseconds of processor time (gl: of the clock, its driver has threads of its own)."""
    scene, states = dancing()
    renderer = create(scene, SIZE, quality, kind)
    renderer.frame(states[0])
    clock = time.thread_time if kind == "cpu" else time.perf_counter
    times = []
    for state in states:
        begun = clock()
        renderer.frame(state)
        times.append(1000 * (clock() - begun))
    renderer.close()
    return statistics.median(times)


def _start(cache: str) -> float:
    """Seconds from nothing but Python to the first frame, numba's cache in a folder of its own."""
    run = subprocess.run(
        [sys.executable, "-c", _COLD],
        capture_output=True,
        text=True,
        check=True,
        cwd=Path(__file__).resolve().parent,
        env={**os.environ, "NUMBA_CACHE_DIR": cache},
    )
    return float(run.stdout.split()[-1])


def measure() -> list[Row]:
    """Rows of (name, value, unit, goal, peer)."""
    rows: list[Row] = []
    goals = {"draft": "9", "good": "15", "best": ""}
    for quality in QUALITIES:
        rows.append((f"cpu {quality}, 720p", _per_frame("cpu", quality), "ms a frame", goals[quality], ""))
    try:
        peers: dict[Quality, str] = {"good": "pyrender as it comes 252", "draft": "the same without shadow 131"}
        for quality, peer in peers.items():
            rows.append((f"gl {quality}, 720p", _per_frame("gl", quality), "ms a frame", "32", peer))
    except UnavailableError:
        rows.append(("gl: no OpenGL here", 0.0, "ms a frame", "32", ""))
    with tempfile.TemporaryDirectory() as cache:
        rows.append(("first frame, nothing compiled", _start(cache), "s", "30", ""))
        rows.append(("first frame, numba cache full", _start(cache), "s", "3", ""))
    return rows
