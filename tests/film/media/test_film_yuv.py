"""Colours as the encoder gets them: BT.709, checked against the formula in floating point and ffmpeg's decoder."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest

from dancetutor_cli.film.media.encoder import Encoding, encode_segment
from dancetutor_cli.film.media.yuv import yuv420
from dancetutor_cli.run import ffmpeg


def _expected(frame: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    r, g, b = (frame[..., k].astype(float) / 255 for k in range(3))
    luma = 0.2126 * r + 0.7152 * g + 0.0722 * b
    blue, red = (b - luma) / 1.8556, (r - luma) / 1.5748
    blue, red = (c.reshape(c.shape[0] // 2, 2, -1, 2).mean(axis=(1, 3)) for c in (blue, red))
    return 16 + 219 * luma, 128 + 224 * blue, 128 + 224 * red


def test_planes_are_those_of_bt709() -> None:
    frame = np.random.default_rng(5).integers(0, 256, (36, 64, 3), dtype=np.uint8)
    frame[:4, :4], frame[:4, 4:8], frame[4:8, :4] = 0, 255, (255, 0, 0)
    out = yuv420(frame, np.empty(36 * 64 * 3 // 2, dtype=np.uint8)).astype(float)
    y, u, v = np.split(out, [36 * 64, 36 * 64 * 5 // 4])
    for got, expected in zip((y, u, v), _expected(frame), strict=True):
        assert np.abs(got - expected.reshape(-1)).max() < 0.51


def test_sizes_that_do_not_fit_are_refused() -> None:
    with pytest.raises(ValueError, match="does not fit"):
        yuv420(np.zeros((3, 4, 3), dtype=np.uint8), np.empty(18, dtype=np.uint8))


def test_a_film_has_the_colours_of_its_frames(tmp_path: Path) -> None:
    colours = [(235, 60, 80), (20, 190, 200), (255, 140, 30), (12, 13, 22), (255, 255, 255)]
    frame = np.repeat(np.repeat(np.array(colours, dtype=np.uint8)[None], 32, axis=1), 64, axis=0)
    film = tmp_path / "film.mp4"
    encode_segment([frame] * 3, Encoding("mp4", (160, 64), 30, "best"), film)
    command = [ffmpeg.executable(), "-v", "error", "-i", str(film), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    shown = np.frombuffer(subprocess.run(command, capture_output=True, check=True).stdout, dtype=np.uint8)
    middles = shown.reshape(3, 64, 160, 3)[1, 32, 16::32].astype(int)
    assert np.abs(middles - np.array(colours)).max() <= 4
