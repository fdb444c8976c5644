"""The page in Firefox and in WebKit: opens, draws, plays, and keeps what was played."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from page_firefox import Firefox
from page_webkit import WebKit
from PIL import Image

NOW = "Number(document.querySelector('.strip').getAttribute('aria-valuenow'))"
PRESS = "document.dispatchEvent(new KeyboardEvent('keydown', {key: 'd', code: 'KeyD', bubbles: true}))"
BODY = PRESS.replace("document.", "document.body.", 1)  # keys come to an element


@pytest.mark.parametrize("engine", [Firefox, WebKit])
def test_another_engine_draws_plays_and_keeps(engine: type[Firefox | WebKit], page_file: Path, tmp_path: Path) -> None:
    browser = engine()
    try:
        browser.open(page_file)
        assert browser.run("window.hacked ?? ''") == ""
        browser.run("document.querySelector('[aria-label=\"To the next row\"]').click()")
        browser.wait(f"{NOW} > 1")
        x, y, w, h = (int(v) for v in browser.run(
            "(b => [b.x, b.y, b.width, b.height])(document.querySelector('.view').getBoundingClientRect())"
        ))  # fmt: skip
        pixels = np.asarray(Image.open(browser.picture(tmp_path / "a.png")).convert("RGB")).astype(int)
        view = pixels[y : y + h, x : x + w]
        for colour in ((255, 138, 31), (22, 194, 207)):  # her shoes, or the feet from above where WebGL is missing
            assert (np.abs(view - np.array(colour)).max(axis=2) <= 40).mean() > 0.0005
        start = browser.run(NOW)
        browser.run("document.querySelector('.play').click()")
        browser.wait(f"{NOW} > {start} + 0.4")
        browser.run("document.querySelector('#panel-along .toggle').click()")
        browser.run(BODY)
        browser.run("document.querySelector('.play').click()")
        browser.wait("document.querySelector('.results .score') !== null")
        assert "Today" in browser.run("document.querySelector('.results .score').textContent")
    finally:
        browser.close()
