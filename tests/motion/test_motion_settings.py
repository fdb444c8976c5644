"""The motion file: every number explained, wrong names and values refused with what exists."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from dancetutor_cli.errors import FileError
from dancetutor_cli.motion.settings import default_settings, load_settings
from dancetutor_cli.resources import config_path


def test_every_number_has_a_sentence() -> None:
    for line in config_path("motion.yaml").read_text(encoding="utf-8").splitlines():
        if line.startswith("  "):
            value, _, sentence = line.partition("#")
            assert ":" in value and len(sentence.strip()) > 10, line


def test_default_file_is_read() -> None:
    assert 0.2 < default_settings().step.longest <= 1.0


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda d: d["step"].update(speed=1), "no step.speed; there are longest"),
        (lambda d: d["step"].pop("longest"), "step.longest is missing"),
        (lambda d: d["jump"].update(far="wide"), "jump.far must be a number"),
        (lambda d: d["jump"].update(far=-1), "jump.far must be between"),
        (lambda d: d.update(legs={}), "no legs; there are step"),
        (lambda d: d.update(step=3), "step must hold"),
    ],
)
def test_wrong_files_are_refused(change, said: str, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    data = yaml.safe_load(config_path("motion.yaml").read_text(encoding="utf-8"))
    change(data)
    path = tmp_path / "motion.yaml"
    path.write_text(yaml.safe_dump(data), encoding="utf-8")
    with pytest.raises(FileError, match=said):
        load_settings(path)


def test_no_yaml_is_said(tmp_path: Path) -> None:
    path = tmp_path / "motion.yaml"
    path.write_text("step: [1, 2", encoding="utf-8")
    with pytest.raises(FileError, match="not YAML"):
        load_settings(path)
    with pytest.raises(FileError, match="no such file"):
        load_settings(tmp_path / "none.yaml")
