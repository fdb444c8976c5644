"""Pads: the geometry of docs/cost-model.md, symmetry, and what a wrong file says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from dancetutor_cli.chart.names import COLUMNS
from dancetutor_cli.feet.pads import load_pad, load_pads
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import config_path

STEPS_TYPES = (
    "dance-single", "dance-double", "dance-solo", "dance-threepanel", "pump-single", "pump-halfdouble", "pump-double",
    "smx-beginner", "smx-single", "smx-double6", "smx-double10",
)  # fmt: skip
DEMO = """
demo-pad:
  centre: [0, 0]
  home: [a, b]
  reach: 1.5
  panels:
    - [a, -1, 0, [-1, 0]]
    - [b, 1, 0, [1, 0]]
"""


def test_dance_pads_are_those_of_the_cost_model() -> None:
    single, double = load_pad("dance-single"), load_pad("DANCE-DOUBLE")
    assert single is not None and double is not None
    assert single.panels.tolist() == [[-1, 0], [0, -1], [0, 1], [1, 0]]
    assert double.panels.tolist() == [*single.panels.tolist(), [2, 0], [3, -1], [3, 1], [4, 0]]
    assert single.centre == (0, 0) and double.centre == (1.5, 0)
    assert np.argwhere(single.neighbours).tolist() == [[0, 1], [0, 2], [1, 0], [1, 3], [2, 0], [2, 3], [3, 1], [3, 2]]


@pytest.mark.parametrize("steps_type", STEPS_TYPES)
def test_every_pad_fits_its_steps_type_and_is_symmetric(steps_type: str) -> None:
    pad = load_pad(steps_type)
    assert pad is not None
    assert len(pad) == COLUMNS[steps_type] == len(set(pad.names))
    mirror = pad.mirror_columns(left_right=True)
    assert mirror is not None and sorted(mirror) == list(range(len(pad)))
    assert np.allclose(pad.panels[mirror], pad.panels * [-1, 1] + [2 * pad.centre[0], 0])
    assert np.allclose(pad.arrows[mirror], pad.arrows * [-1, 1])
    assert pad.home == (mirror[pad.home[1]], mirror[pad.home[0]])
    assert pad.neighbours.any(axis=1).all() == (steps_type != "dance-threepanel")  # its panels are too far apart


def test_no_pad_for_other_steps_types() -> None:
    assert load_pad("kb7-single") is None
    assert set(load_pads(config_path("pads.yaml"))) >= set(STEPS_TYPES)


def test_a_pad_of_ones_own(tmp_path: Path) -> None:
    path = tmp_path / "pads.yaml"
    path.write_text(DEMO)
    pad = load_pad("demo-pad", path)
    assert pad is not None and pad.names == ("a", "b") and pad.home == (0, 1)
    assert load_pad("dance-single", path) is None


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        (
            "reach",
            "reech",
            5,
            "unknown key 'reech' in 'demo-pad' (did you mean reach?); choose panels, centre, home, reach",
        ),
        ("  reach: 1.5\n", "", 2, "demo-pad.reach is missing; it must be a number"),
        ("[a, b]", "[a, c]", 4, "two different panels of a, b"),
        ("[0, 0]", "[0, x]", 3, "demo-pad.centre[1] must be a number, not 'x'"),
        ("[b, 1, 0, [1, 0]]", "[b, -1, 0, [1, 0]]", 8, "same name or place"),
        ("[b, 1, 0, [1, 0]]", "[b, 1, 0]", 8, "must be a panel, [name, x, y, [arrow x, arrow y]]"),
        ("[0, 0]", "[0, .nan]", 3, "a number must be finite"),
        ("panels:", "panels: [", 9, "expected"),
    ],
)
def test_a_wrong_file_is_named_with_its_line(tmp_path: Path, old: str, new: str, line: int, words: str) -> None:
    path = tmp_path / "pads.yaml"
    path.write_text(DEMO.replace(old, new))
    with pytest.raises(FileError) as caught:
        load_pads(path)
    assert words in str(caught.value)
    if "expected" not in words:
        assert caught.value.line == line


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="no such file or folder"):
        load_pads(tmp_path / "none.yaml")


@pytest.mark.parametrize(
    ("steps_type", "middles"),
    [
        ("dance-single", [0.0]),
        ("dance-solo", [0.0]),
        ("dance-threepanel", [0.0]),
        ("pump-single", [0.0]),
        ("dance-double", [0.0, 3.0]),
        ("pump-double", [0.0, 3.0]),
        ("pump-halfdouble", [0.0, 3.0]),
        ("smx-beginner", [0.0]),
        ("smx-single", [0.0]),
        ("smx-double6", [0.0, 3.0]),
        ("smx-double10", [0.0, 3.0]),
    ],
)
def test_squares_of_nine_panels(steps_type: str, middles: list[float]) -> None:
    pad = load_pad(steps_type)
    assert pad is not None
    assert pad.squares[:, 0].tolist() == middles and not pad.squares[:, 1].any()
