"""The limbs' colours: what is in the file, and what is said about a wrong one."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import pytest

from dancetutor_cli.feet.limbs import Limb, hex_colour, limb_colours, read_limb_colours
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import config_path

GOOD = config_path("colours.yaml").read_text("utf-8")


def test_they_come_in_the_order_of_limbs() -> None:
    colours = limb_colours()
    assert colours.by_limb[Limb.LEFT_FOOT] == colours.left_foot
    assert colours.by_limb[Limb.RIGHT_HAND] == colours.right_hand


def seen(rgb: tuple[int, int, int], matrix: tuple[tuple[float, float, float], ...]) -> list[float]:
    """A colour (linear light) as a dichromat sees it."""
    linear = [(c / 255) ** 2.2 for c in rgb]
    return [sum(m * c for m, c in zip(row, linear, strict=True)) for row in matrix]


@pytest.mark.parametrize(
    "matrix",
    [
        ((0.152, 1.053, -0.205), (0.115, 0.786, 0.099), (-0.004, -0.048, 1.052)),  # protanopia
        ((0.367, 0.861, -0.228), (0.280, 0.673, 0.047), (-0.012, 0.043, 0.969)),  # deuteranopia
        ((1.256, -0.077, -0.179), (-0.078, 0.931, 0.148), (0.005, 0.691, 0.304)),  # tritanopia
    ],
)
def test_feet_stay_apart_for_the_colour_blind(matrix: tuple[tuple[float, float, float], ...]) -> None:
    """Matrices of Machado, Oliveira and Fernandes 2009, severity 1."""
    colours = limb_colours()
    left, right = seen(colours.left_foot, matrix), seen(colours.right_foot, matrix)
    assert sum((a - b) ** 2 for a, b in zip(left, right, strict=True)) ** 0.5 > 0.25


def test_all_four_differ() -> None:
    for a, b in combinations(limb_colours().by_limb, 2):
        assert sum(abs(x - y) for x, y in zip(a, b, strict=True)) > 60


def test_hex_and_back() -> None:
    assert hex_colour(limb_colours().left_foot) in GOOD


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (GOOD.replace("left_foot", "left_leg"), "left_foot, right_foot, left_hand, right_hand"),
        (GOOD.replace('"#ff8a1f"', "orange"), "left_foot"),
        (GOOD.replace('"#ff8a1f"', "[1, 2, 3]"), "left_foot"),
        ("limbs: 3", "limbs"),
        ("", "limbs"),
        ("limbs: {", "YAML"),
    ],
)
def test_a_wrong_file_is_one_line(tmp_path: Path, text: str, says: str) -> None:
    path = tmp_path / "colours.yaml"
    path.write_text(text, "utf-8")
    with pytest.raises(FileError) as error:
        read_limb_colours(path)
    assert says in str(error.value)
    assert "\n" not in str(error.value)
