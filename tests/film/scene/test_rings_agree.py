"""The rings under the feet have the same numbers in the film's two renderers and on the practice page."""

from __future__ import annotations

import re

import pytest

from dancetutor_cli.film.scene.cpu.floor import LIT, RING
from dancetutor_cli.film.scene.shared import _UNDER, PLANTED, _strength
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


def test_the_page_lights_the_ground_in_the_words_of_the_film() -> None:
    film, page = (
        (PACKAGE / path).read_text(encoding="utf-8")
        for path in ("film/scene/gl/shaders/ground.frag", "page/shaders/stage.frag")
    )
    names = {
        "at.xyz": "world",
        "at.xz": "world.xz",
        "float light": "float on",
        "light >": "on >",
        "(1.0), light)": "(1.0), on)",
    }
    for old, new in names.items():
        film = film.replace(old, new)
    for part in ("float left =", "float keep =", "band *= on", "ring_colour = mix"):
        own, theirs = ([line.strip() for line in text.splitlines() if part in line] for text in (page, film))
        assert own and own == theirs, part


def test_the_page_fades_lifted_feet_as_films_do() -> None:
    text = (PACKAGE / "page/js/feet.js").read_text(encoding="utf-8")
    start = re.search(r"\(near - ([\d.]+)\) / ([\d.]+)\)", text)
    fade = re.search(r"planted \+ \(1 - planted\) \* \(([\d.]+) \+ ([\d.]+) \* near\)", text)
    assert start is not None and fade is not None
    low, width = map(float, start.groups())
    assert (low, low + width) == pytest.approx(PLANTED)
    under = re.search(r"const UNDER = ([\d.]+);", text)
    assert under is not None and float(under[1]) == _UNDER
    floor, rise = map(float, fade.groups())
    for near in (0.0, 0.4, 0.8, PLANTED[0]):
        assert _strength(near) == pytest.approx(floor + rise * near)
    assert _strength(1.0) == 1.0
