"""What docs/linter.md says about configuring the linter is true: its files are read, its names exist."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
import yaml

from dancetutor_cli.lint.configuration import Configuration, load_configuration
from dancetutor_cli.run.reading import config_path

ROOT = Path(__file__).resolve().parent.parent.parent
PAGE = (ROOT / "docs" / "linter.md").read_text("utf-8")
BLOCKS = re.findall(r"```yaml\n(.*?)```", PAGE, re.S)


def block(key: str) -> str:
    return next(text for text in BLOCKS if key in yaml.safe_load(text))


@pytest.fixture
def configuration(tmp_path: Path) -> Configuration:
    path = tmp_path / "dancetutor.yaml"
    path.write_text(block("overrides"), encoding="utf-8")
    return load_configuration(path)


def rules(configuration: Configuration, path: Path, steps_type: str, difficulty: str, meter: int) -> dict[str, Any]:
    return dict(configuration.settings.for_chart(path, steps_type, difficulty, meter))


def test_the_example_file_does_what_its_comments_say(configuration: Configuration, tmp_path: Path) -> None:
    assert (configuration.preset, configuration.fail_on) == ("itg", "error")
    assert configuration.baseline == tmp_path / "known.json"
    usual = rules(configuration, tmp_path / "New" / "x.sm", "dance-single", "Easy", 5)
    assert usual["DT202"]["severity"] == "error" and usual["DT205"]["max_rows"] == 6
    assert not {"DT501", "DT508", "DT401"} & set(usual)
    assert "DT204" in usual and "DT201" in usual
    assert "DT204" not in rules(configuration, tmp_path / "Old" / "x.sm", "dance-single", "Easy", 5)
    assert "DT201" not in rules(configuration, tmp_path / "x.sm", "dance-double", "Hard", 9)
    assert "DT201" in rules(configuration, tmp_path / "x.sm", "dance-double", "Hard", 8)


def test_the_configurations_it_names_are_those_there_are() -> None:
    named = re.search(r"one of configs/lint/: (.*)", PAGE)
    assert named is not None
    there = {path.stem for path in config_path("lint").glob("*.yaml")} - {"default"}
    assert set(named[1].split(", ")) == there


def test_the_ci_examples_name_what_there_is() -> None:
    hooks = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text("utf-8"))
    used = yaml.safe_load(block("repos"))["repos"][0]["hooks"]
    assert {hook["id"] for hook in used} <= {hook["id"] for hook in hooks}
    action = yaml.safe_load((ROOT / "action.yml").read_text("utf-8"))
    steps = yaml.safe_load(block("jobs"))["jobs"]["charts"]["steps"]
    assert set(steps[-1]["with"]) <= set(action["inputs"])
