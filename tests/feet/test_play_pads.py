"""Any pad: the same code solves every steps type that has panels in configs/pads.yaml, and one that only a test has."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from play_rows import check_mirror, letters, pad_of, plain, reference_of, rows_of

from dancetutor_cli.chart.names import COLUMNS
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.pads import load_pad, load_pads
from dancetutor_cli.feet.play import Rows
from dancetutor_cli.feet.preset import load_preset, preset_names
from dancetutor_cli.feet.solver.solve import solve_rows
from dancetutor_cli.run.reading import config_path

PRESETS = {name: load_preset(name) for name in preset_names()}
CROSS = """
my-cross:
  centre: [0, 0]
  home: [west, east]
  reach: 1.2
  panels:
    - [east, 1, 0, [1, 0]]
    - [middle, 0, 0, [0, 0]]
    - [north, 0, 1, [0, 1]]
    - [west, -1, 0, [-1, 0]]
    - [south, 0, -1, [0, -1]]
"""


def busy(columns: int, seed: int) -> Rows:
    """Rows of one to three steps, with holds and mines."""
    rng, held, words = np.random.default_rng(seed), -1, []
    for _ in range(60):
        word = ["."] * columns
        for p in rng.choice(columns, rng.choice([1, 1, 1, 2, 2, 3]), replace=False):
            word[p] = "1"
        if rng.random() < 0.1:
            word[rng.integers(columns)] = "M"
        if held >= 0:
            word[held] = "."
            if rng.random() < 0.4:
                word[held], held = "3", -1
        elif rng.random() < 0.2:
            held = int(rng.integers(columns))
            word[held] = "2"
        words.append("".join(word))
    words.append("".join("3" if p == held else "." for p in range(columns)))
    return rows_of(" ".join(words), 24, 140.0)


@pytest.mark.parametrize("name", sorted(PRESETS))
@pytest.mark.parametrize("steps_type", sorted(load_pads(config_path("pads.yaml"))))
def test_every_pad_in_every_preset(steps_type: str, name: str) -> None:
    rows, pad, preset = busy(COLUMNS[steps_type], 3), pad_of(steps_type), PRESETS[name]
    assert check_mirror(rows, pad, preset, left_right=True) > 0
    found = solve_rows(rows, pad, PRESETS[name])
    assert ((found.limb != Limb.NONE) == (rows.steps > 0)).all()
    assert found.cost.sum() == found.total and found.feet.max() < len(pad)


@pytest.fixture
def cross_path(tmp_path: Path) -> Path:
    path = tmp_path / "pads.yaml"
    path.write_text(CROSS, encoding="utf-8")
    return path


def test_a_new_pad_is_an_entry(cross_path: Path) -> None:
    pad = load_pad("my-cross", cross_path)
    assert pad is not None
    stream = rows_of("...1. ....1 1.... ..1.. ...1. .1... 1....", 24, 150.0)  # west, south, east, north, west, middle
    found = solve_rows(rows_of("...1. 1.... ...1. .1... ...1. 1....", 24, 150.0), pad, PRESETS["itg"])
    assert letters(found) == "...L. R.... ...L. .R... ...L. R...."
    assert solve_rows(stream, pad, PRESETS["thesis"]).total == reference_of(pad).solve(plain(stream))
    both = solve_rows(rows_of("...2. 1...1 ...3.", 24, 150.0), pad, PRESETS["itg"])
    assert "hand" in both.moves[1]  # east and south are too far apart for one foot
    near = solve_rows(rows_of("...2. 11... ...3.", 24, 150.0), pad, PRESETS["itg"])
    assert "bracket" in near.moves[1] and "hand" not in near.moves[1]


def test_rows_nobody_can_play_are_solved_around() -> None:
    rows = rows_of("1....... ...1.... 11111111 ....1... .......1", 24, 150.0)
    found = solve_rows(rows, pad_of("dance-double"), PRESETS["itg"])
    assert "unplayable" in found.moves[2] and (found.limb[2] == Limb.UNPLAYED).sum() == 2  # two brackets and two hands
    assert [i for i, names in enumerate(found.moves) if "unplayable" in names] == [2]
    assert letters(found).split()[:2] == ["L.......", "...R...."] and "?" not in letters(found).split()[4]
