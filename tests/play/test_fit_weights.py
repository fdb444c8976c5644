"""tools/fit_weights.py learns what a label says, and a fit that has not seen a chart is scored on it."""

from __future__ import annotations

import json
import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType

import pytest

from dancetutor_cli import play

SCRIPT = Path(__file__).parents[2] / "tools" / "fit_weights.py"
HEADER = "#OFFSET:0;#BPMS:0=150;\n#NOTES:dance-single::Hard:5:0:\n"


@pytest.fixture(scope="module")
def script() -> ModuleType:
    spec = spec_from_file_location("fit_weights", SCRIPT)
    assert spec is not None and spec.loader is not None
    module = module_from_spec(spec)
    sys.modules["fit_weights"] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def labels(tmp_path: Path) -> Path:
    """Somebody who rather switches feet than crosses over: left, down, down again with the other foot, right."""
    songs = {"one": ("1000 0100 0100 0001", "LRLR"), "two": ("0001 0100 0100 1000", "RLRL")}
    out = []
    for name, (rows, feet) in songs.items():
        (tmp_path / f"{name}.sm").write_text(HEADER + "\n".join([*rows.split(), *["0000"] * 4, ";"]))
        entries = [
            {"beat": number / 2, "feet": {str(word.index("1")): foot}}
            for number, (word, foot) in enumerate(zip(rows.split(), feet, strict=True))
        ]
        label = {"name": name, "kind": "mine", "chart": f"{name}.sm", "rows": entries}
        out.append({**label, "steps_type": "dance-single", "difficulty": "Hard"})
    (tmp_path / "labels.json").write_text(json.dumps(out))
    return tmp_path


def test_a_fit_takes_over_what_labels_say(script: ModuleType, labels: Path) -> None:
    home = play.load_preset("itg")
    known = script.load_labels(labels)
    assert script.score(known, home) == {"mine": (4, 8)}
    losses = script.Losses(known, home)
    fitted = script.fit(losses, [0, 1], ["footswitch", "facing"], 2)
    assert script.score(known, fitted) == {"mine": (8, 8)}
    assert fitted.weight("footswitch") < home.weight("footswitch")
    assert losses.total([0, 1], fitted) < losses.total([0, 1], home)


def test_the_result_is_a_preset(script: ModuleType, labels: Path, tmp_path: Path) -> None:
    home = play.load_preset("itg")
    path = tmp_path / "mine.yaml"
    path.write_text(script.written(home.with_values(weights={"footswitch": 321}), home, "itg"))
    mine = play.load_preset(path)
    assert mine.weight("footswitch") == 321 and mine.weight("spin") == home.weight("spin")


def test_charts_that_a_fit_has_not_seen(script: ModuleType, labels: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The two charts are mirror images, so what one says is right for the other."""
    losses = script.Losses(script.load_labels(labels), play.load_preset("itg"))
    assert script.leave_one_out(losses, ["footswitch"], 1, script.show) == {"mine": (8, 8)}
    said = capsys.readouterr().out.splitlines()
    assert said == [f"  without {name}: mine 4/4 = 100.00 %" for name in ("one", "two")]
