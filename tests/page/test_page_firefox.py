"""The page in Firefox: opens, draws, plays."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from page_firefox import Firefox
from PIL import Image

NOW = "Number(document.querySelector('.strip').getAttribute('aria-valuenow'))"


def test_firefox_draws_and_plays(page_file: Path, tmp_path: Path) -> None:
    firefox = Firefox()
    try:
        firefox.open(page_file)
        assert firefox.run("window.hacked") is None
        firefox.run("document.querySelector('[aria-label=\"To the next row\"]').click()")
        firefox.wait(f"{NOW} > 1")
        x, y, w, h = (int(v) for v in firefox.run(
            "(b => [b.x, b.y, b.width, b.height])(document.querySelector('.view').getBoundingClientRect())"
        ))  # fmt: skip
        pixels = np.asarray(Image.open(firefox.picture(tmp_path / "a.png")).convert("RGB")).astype(int)
        view = pixels[y : y + h, x : x + w]
        for colour in ((255, 138, 31), (22, 194, 207)):  # her shoes, or the feet from above where WebGL is missing
            assert (np.abs(view - np.array(colour)).max(axis=2) <= 40).mean() > 0.0005
        start = firefox.run(NOW)
        firefox.run("document.querySelector('.play').click()")
        firefox.wait(f"{NOW} > {start} + 0.4")
    finally:
        firefox.close()
