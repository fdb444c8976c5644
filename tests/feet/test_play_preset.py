"""Presets: names that exist are told with file and line, one may extend another, and roll gaps follow the window."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
from play_rows import pad_of, rows_of

from dancetutor_cli.feet.play import roll_gap
from dancetutor_cli.feet.preset import DEFAULT_PRESET, default_preset, load_preset, preset_names
from dancetutor_cli.feet.solver import itg_costs, thesis_moves
from dancetutor_cli.feet.solver.engine import cost_at
from dancetutor_cli.feet.solver.solve import solve_rows
from dancetutor_cli.feet.solver.vocabulary import MODELS
from dancetutor_cli.run.errors import DancetutorError, FileError, UsageError
from dancetutor_cli.run.reading import config_path

NAMES = ["beginner", "ddr", "itg", "pump", "smx", "stamina", "thesis"]


def written(folder: Path, text: str) -> Path:
    path = folder / "mine.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_the_presets_that_come_along() -> None:
    assert preset_names() == NAMES
    assert DEFAULT_PRESET == "itg"
    for name in preset_names():
        preset = load_preset(name)
        assert preset.name == name and preset == pickle.loads(pickle.dumps(preset)) and hash(preset)
        assert [n for n, _ in preset.weights] == list(MODELS[preset.model].weights)


@pytest.mark.parametrize("name", ["itg", "thesis"])
def test_every_value_has_a_sentence(name: str) -> None:
    preset = load_preset(name)
    lines = config_path(f"presets/{name}.yaml").read_text(encoding="utf-8").splitlines()
    for key, _ in (*preset.weights, *preset.curves, *preset.switches):
        number = next(i for i, line in enumerate(lines) if line.startswith(f"  {key}:"))
        assert "#" in lines[number] or lines[number - 1].strip().startswith("#"), key


def test_thesis_is_the_cost_model() -> None:
    thesis = load_preset("thesis")
    assert [value for _, value in thesis.weights] == [1, 12, 10, 3, 5, 15, 1, 5, 1, 2, 1000]
    assert thesis.roll_window == 0.35 and thesis.switch("allow-doublestep")


def test_a_curve_is_straight_between_its_knots_and_level_beyond_them() -> None:
    times = np.array([0, 99, 100, 101, 150, 299, 300, 2047])
    assert cost_at(((100, 500), (300, 100)), times).tolist() == [500, 500, 500, 498, 400, 102, 100, 100]
    assert cost_at(((300, 7),), times).tolist() == [7] * 8


def test_confidence_belongs_to_the_weights_it_was_measured_with(tmp_path: Path) -> None:
    assert load_preset("itg").confidence and load_preset("pump").confidence
    path = written(tmp_path, "extends: itg\nweights:\n  spin: 50\n")
    assert load_preset(path).confidence == () == load_preset("stamina").confidence


def test_a_preset_of_ones_own_extends_another(tmp_path: Path) -> None:
    path = written(tmp_path, "extends: thesis\nweights:\n  spin: 50\n")
    mine, thesis = load_preset(path), load_preset("thesis")
    assert mine.weight("spin") == 50 and mine.weight("doublestep") == thesis.weight("doublestep")
    (tmp_path / "other.yaml").write_text("extends: mine.yaml\nswitches: {allow-doublestep: false}\n")
    other = load_preset(str(tmp_path / "other.yaml"))
    assert other.weight("spin") == 50 and not other.switch("allow-doublestep") and other.name == "other"


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        (
            "extends: thesis\nweights:\n  spinn: 5\n",
            3,
            "unknown key 'spinn' in 'weights' (did you mean spin?); choose crossover, doubl",
        ),
        (
            "extends: thesis\nwheights: {}\n",
            2,
            "unknown key 'wheights' (did you mean weights?); choose extends, model",
        ),
        ("extends: thesis\nswitches:\n  brackets: true\n", 3, "choose allow-doublestep"),
        ("extends: thesis\ncurves:\n  jack: {100: 1}\n", 3, "no name is allowed here"),
        ("extends: itg\ncurves:\n  jack: 100\n", 3, "mapping of milliseconds to costs"),
        ("extends: itg\ncurves:\n  jack: {-1: 100}\n", 3, "must be a whole number from 0 to 2047 milliseconds"),
        ("extends: itg\ncurves:\n  jack: {100: 0.5}\n", 3, "curves.jack.100 must be a whole number from 0 to 1000000"),
        ("extends: itg\nconfidence: {100: 1001}\n", 2, "from 0 to 1000"),
        ("extends: thesis\nweights:\n  spin: lots\n", 3, "whole number"),
        ("extends: thesis\nweights:\n  spin: -1\n", 3, "whole number"),
        ("extends: thesis\nswitches:\n  allow-doublestep: 1\n", 3, "true or false"),
        ("extends: thesis\nroll-window: 0\n", 2, "seconds"),
        ("extends: itg\nmodel: thesis\n", 2, "'itg'"),
        ("extends: no-such\n", 1, f"choose {', '.join(NAMES)}"),
        ("extends: mine.yaml\n", 1, "extends itself"),
        ("model: thesis\nroll-window: 0.35\n", None, "switches.allow-doublestep is missing"),
        ("roll-window: 0.35\n", None, "model is missing: one of thesis, itg"),
        ("extends: thesis\nweights: 7\n", 2, "mapping"),
        ("extends: itg\npads: dance\n", 2, "list of steps types"),
        ("extends: itg\npads:\n - dance\n - danse\n", 4, "'danse' is not a steps type (did you mean dance?); their f"),
    ],
)
def test_what_is_wrong_is_named_with_file_and_line(tmp_path: Path, text: str, line: int | None, words: str) -> None:
    path = written(tmp_path, text)
    with pytest.raises(FileError) as caught:
        load_preset(path)
    place = f"{path}:{line}: " if line else f"{path}: "
    assert str(caught.value).startswith(place) and words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_preset_knows_for_which_pads_it_was_made(tmp_path: Path) -> None:
    made = {name: load_preset(name).pads for name in NAMES}
    assert made == {
        "pump": ("pump",),
        "beginner": ("dance", "pump", "smx"),
        "smx": ("smx",),
        **dict.fromkeys(("ddr", "itg", "stamina", "thesis"), ("dance",)),
    }
    mine = load_preset(written(tmp_path, "extends: itg\npads: [pump-double, dance]\n"))
    assert [mine.is_for(kind) for kind in ("dance-solo", "pump-double", "pump-single")] == [True, True, False]
    assert load_preset(written(tmp_path, "extends: pump\n")).pads == ("pump",)
    assert load_preset(written(tmp_path, "extends: itg\npads: []\n")).is_for("kb7-single")


def test_the_default_goes_by_the_steps_type() -> None:
    kinds = ("dance-single", "dance-solo", "pump-single", "PUMP-halfdouble", "kb7-single")
    assert [default_preset(kind) for kind in kinds] == ["itg", "itg", "pump", "pump", "itg"]


def test_a_strangers_preset_extends_nothing_outside_its_folder(tmp_path: Path) -> None:
    (tmp_path / "base.yaml").write_text("extends: itg\nweights: {spin: 7}\n")
    (tmp_path / "inside").mkdir()
    path = written(tmp_path / "inside", "extends: ../base.yaml\n")
    assert load_preset(path).weight("spin") == 7
    with pytest.raises(FileError, match="outside this file's folder"):
        load_preset(path, confined=True)
    (tmp_path / "inside" / "link.yaml").symlink_to(tmp_path / "base.yaml")
    with pytest.raises(FileError, match="outside this file's folder"):
        load_preset(written(tmp_path / "inside", "extends: link.yaml\n"), confined=True)


def test_an_unknown_preset_names_those_that_exist(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=", ".join(NAMES)):
        load_preset("gpt")
    with pytest.raises(DancetutorError, match="no such file or folder"):
        load_preset(tmp_path / "none.yaml")


@pytest.mark.parametrize(
    ("bpm", "window", "ticks"),
    [
        (171.0, 0.35, 24),
        (60 / 0.35, 0.35, 48),
        (172.0, 0.35, 48),
        (120.0, 0.35, 24),
        (60.0, 0.35, 16),
        (1.0, 0.35, 3),
        (120.0, 0.5, 48),
        (400.0, 0.35, 48),
    ],
)
def test_gap_of_a_roll(bpm: float, window: float, ticks: int) -> None:
    """The longest of 1, 1/2, 1/3 ... 1/16 beat that the window allows, 1/16 if none does."""
    assert roll_gap(bpm, window) == ticks


def test_confidence_follows_the_margin() -> None:
    """Between 0 and 1 by the preset's curve; sure where there is no other way, unknown where nothing is stepped."""
    rows = rows_of("1... ..1. .M.. ...1 .1.1 ..1. 1111", 24, 150.0)
    pad, preset = pad_of("dance-single"), load_preset("itg")
    found = solve_rows(rows, pad, preset)
    assert found.confidence is not None and found.margin is not None
    known = {margin: tenths / 1000 for margin, tenths in preset.confidence}
    stepped = rows.steps.any(axis=1)
    assert np.isnan(found.confidence[~stepped]).all() and stepped.sum() == 6
    for sure, margin in zip(found.confidence[stepped], found.margin[stepped], strict=True):
        below = max((knot for knot in known if knot <= margin), default=0)
        above = min((knot for knot in known if knot >= margin), default=max(known))
        assert margin < 0 or known[below] - 0.001 <= sure <= known[above]
    assert solve_rows(rows, pad, preset, margins=False).confidence is None
    assert solve_rows(rows, pad, load_preset("thesis")).confidence is None


def test_kernels_name_costs_in_the_order_of_the_vocabulary() -> None:
    """They unpack numbers by position: two names exchanged would charge the wrong cost."""
    for module, model in ((itg_costs, "itg"), (thesis_moves, "thesis")):
        for number, name in enumerate(MODELS[model].weights):
            assert getattr(module, name.replace("-", "_").upper()) == number, name
    *curves, last = MODELS["itg"].curves
    assert last == "distance"
    for number, name in enumerate(curves):
        assert getattr(itg_costs, "_F_" + name.replace("-", "_").upper()) == 1 << itg_costs._DISTANCE_BITS + number
