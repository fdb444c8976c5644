"""Pictures by Pillow: the bytes that imageio gives, and moving ones with every frame at its time."""

from __future__ import annotations

import re
from pathlib import Path

import imageio.v3 as iio
import numpy as np
import pytest
from PIL import Image, ImageSequence

from dancetutor_cli.run.pictures import picture_bytes, read_palette, write_gif, write_webp

PACKAGE = Path(__file__).resolve().parent.parent / "dancetutor_cli"


@pytest.mark.parametrize(
    ("suffix", "shape"), [(".png", (9, 3)), (".png", (9, 3, 3)), (".png", (3, 4, 4)), (".webp", (20, 30, 3))]
)
def test_a_picture_is_imageios_to_the_byte(suffix: str, shape: tuple[int, ...]) -> None:
    pixels = np.random.default_rng(1).integers(0, 256, shape, dtype=np.uint8)
    options = {"compress_level": 2} if suffix == ".png" else {"quality": 86, "method": 6}
    expected = iio.imwrite("<bytes>", pixels, extension=suffix, plugin="pillow", is_batch=False, **options)
    assert picture_bytes(pixels, suffix, **options) == expected  # type: ignore[arg-type]


@pytest.mark.parametrize("fps", [10, 25, 30, 60])
def test_a_gif_has_its_pixels_and_its_time(tmp_path: Path, fps: int) -> None:
    rng = np.random.default_rng(2)
    frames = rng.integers(0, 255, (12, 20, 30), dtype=np.uint8)
    frames[1::2, 5:, :] = frames[::2, 5:, :]  # most stays as it is
    frames[7] = frames[6]
    palette = rng.permutation(np.repeat(np.arange(256, dtype=np.uint8)[:, None], 3, axis=1))
    write_gif(tmp_path / "a.gif", iter(frames), palette, fps)
    shown, begins = [], [0]
    with Image.open(tmp_path / "a.gif") as film:
        assert film.info["loop"] == 0
        for picture in ImageSequence.Iterator(film):
            shown.append(np.asarray(picture.convert("RGB")))
            begins.append(begins[-1] + picture.info["duration"])
    assert begins[-1] == pytest.approx(1000 * len(frames) / fps, abs=10)
    for picture, begin in zip(shown, begins, strict=False):
        np.testing.assert_array_equal(picture, palette[frames[round(begin * fps / 1000)]])


def test_a_webp_has_all_frames(tmp_path: Path) -> None:
    frames = [np.full((20, 30, 3), 20 * k, dtype=np.uint8) for k in range(10)]
    write_webp(tmp_path / "a.webp", iter(frames), len(frames), 30)
    with Image.open(tmp_path / "a.webp") as film:
        shown = [np.asarray(picture.convert("RGB")).mean() for picture in ImageSequence.Iterator(film)]
    assert shown == pytest.approx([20 * k for k in range(10)], abs=3)


def test_the_colours_of_a_palette(tmp_path: Path) -> None:
    colors = np.random.default_rng(3).integers(0, 256, (256, 3), dtype=np.uint8)
    (tmp_path / "p.png").write_bytes(picture_bytes(colors.reshape(16, 16, 3)))
    np.testing.assert_array_equal(read_palette(tmp_path / "p.png"), colors)


def test_pictures_are_written_in_one_place() -> None:
    saving = re.compile(r"""\.save\(|imwrite|imopen|libwebp""")
    files = [path for path in PACKAGE.rglob("*.py") if saving.search(path.read_text(encoding="utf-8"))]
    assert files == [PACKAGE / "run" / "pictures.py"]
