"""Animations of other programs: between two keys a value goes in a line, or stays as it is."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np
import pytest

from dancetutor_cli.dance.physics.captured import CapturedMotion
from dancetutor_cli.formats.captured import read_source

TIMES = (0.0, 0.5, 1.0)
HEIGHTS = (1.0, 2.0, 4.0)


def animation(path: Path, interpolation: str) -> Path:
    """A node that is lifted by three keys, and one that is turned about x in the same way."""
    turns = [(np.sin(height / 4), 0.0, 0.0, np.cos(height / 4)) for height in HEIGHTS]
    data = struct.pack("<3f", *TIMES)
    data += b"".join(struct.pack("<3f", 0.0, height, 0.0) for height in HEIGHTS)
    data += b"".join(struct.pack("<4f", *turn) for turn in turns)
    spans = ((0, 12, "SCALAR"), (12, 36, "VEC3"), (48, 48, "VEC4"))
    samplers = [{"input": 0, "output": output, "interpolation": interpolation} for output in (1, 2)]
    channels = [
        {"sampler": 0, "target": {"node": 0, "path": "translation"}},
        {"sampler": 1, "target": {"node": 1, "path": "rotation"}},
    ]
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "hips", "children": [1]}, {"name": "spine", "translation": [0, 0.5, 0]}],
        "buffers": [{"byteLength": len(data)}],
        "bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": size} for at, size, _ in spans],
        "accessors": [{"bufferView": n, "componentType": 5126, "count": 3, "type": kind}
                      for n, (_, _, kind) in enumerate(spans)],
        "animations": [{"name": "lift", "samplers": samplers, "channels": channels}],
    }  # fmt: skip
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    path.write_bytes(b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks)
    return path


@pytest.mark.parametrize(
    ("interpolation", "expected"),
    [("LINEAR", [1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.4, 2.8, 3.2, 3.6, 4.0]), ("STEP", [1.0] * 5 + [2.0] * 5 + [4.0])],
)
def test_values_between_keys(tmp_path: Path, interpolation: str, expected: list[float]) -> None:
    motion = read_source(animation(tmp_path / "a.glb", interpolation))
    assert isinstance(motion, CapturedMotion) and len(motion.times) == len(expected)
    hips, spine = (motion.names.index(name) for name in ("hips", "spine"))
    assert motion.places[:, hips, 1] == pytest.approx(expected, abs=1e-5)
    angles = 2 * np.arctan2(motion.turns[:, spine, 1], motion.turns[:, spine, 0])
    if interpolation == "STEP":
        assert angles == pytest.approx(np.array(expected) / 2, abs=1e-5)
    else:  # between keys the sum of quaternions is not quite the angle in between
        assert angles == pytest.approx(np.array(expected) / 2, abs=0.02)
