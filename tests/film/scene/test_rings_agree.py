"""The rings under the feet have the same numbers in the film's two renderers and on the practice page."""

from __future__ import annotations

import re

import pytest

from dancetutor_cli.film.scene.cpu.floor import LIT, RING
from dancetutor_cli.film.scene.renderer import PLANTED, _strength
from dancetutor_cli.run.reading import PACKAGE


@pytest.mark.parametrize("shader", ["film/scene/gl/shaders/ground.frag", "page/shaders/stage.frag"])
def test_shaders_draw_the_ring_of_the_rasteriser(shader: str) -> None:
    text = (PACKAGE / shader).read_text(encoding="utf-8")
    planted = re.search(r"planted = smoothstep\(([\d.]+), ([\d.]+), near\)", text)
    band = re.search(
        r"clamp\(\(([\d.]+) \+ ([\d.]+) \* planted - abs\(d - \(([\d.]+) - ([\d.]+) \* planted\)\)\)", text
    )
    lit = re.search(r"lit\.rgb \* \(([\d.]+) \+ ([\d.]+) \* keep\)", text)
    assert planted is not None and band is not None and lit is not None
    assert tuple(map(float, planted.groups())) == PLANTED
    wide, more, off, nearer = map(float, band.groups())
    assert (wide, more, off, -nearer) == RING
    assert tuple(map(float, lit.groups())) == pytest.approx((LIT, 1 - LIT))


def test_the_page_fades_lifted_feet_as_films_do() -> None:
    text = (PACKAGE / "page/js/feet.js").read_text(encoding="utf-8")
    start = re.search(r"\(near - ([\d.]+)\) / ([\d.]+)\)", text)
    fade = re.search(r"planted \+ \(1 - planted\) \* \(([\d.]+) \+ ([\d.]+) \* near\)", text)
    assert start is not None and fade is not None
    low, width = map(float, start.groups())
    assert (low, low + width) == pytest.approx(PLANTED)
    floor, rise = map(float, fade.groups())
    for near in (0.0, 0.4, 0.8, PLANTED[0]):
        assert _strength(near) == pytest.approx(floor + rise * near)
    assert _strength(1.0) == 1.0
