"""tools/find_python.sh: the distribution's Python where it will do, else the first on the path, else one line."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

SCRIPT = Path(__file__).resolve().parent.parent / "tools" / "find_python.sh"
pytestmark = pytest.mark.skipif(os.name == "nt" or not SCRIPT.exists(), reason="a shell script of the checkout")


def python(path: Path, *, new: bool = True, venv: str = "true") -> Path:
    """A script that answers the two questions as a Python would. venv : a command of the shell, whether it has venv"""
    path.parent.mkdir(parents=True, exist_ok=True)
    answers = f'case "$2" in *ensurepip*) {venv};; *version_info*) {"true" if new else "false"};; esac'
    path.write_text(f"#!/bin/sh\n{answers}\n")
    path.chmod(0o755)
    return path


def found(own: Path, folder: Path, **more: str) -> subprocess.CompletedProcess[str]:
    environment = {"PATH": f"{folder}:/usr/bin:/bin", "OWN_PYTHON": str(own), **more}
    return subprocess.run([SCRIPT], capture_output=True, text=True, env=environment, check=False)


@pytest.mark.parametrize(
    ("own", "other", "taken"),
    [
        ({}, {}, "own"),
        ({"new": False}, {}, "other"),
        ({"venv": "false"}, {}, "other"),
        ({"venv": "false"}, {"new": False}, "apt-get install python3-venv"),
        ({"new": False}, {"new": False}, "needs Python 3.11 or newer"),
        ({"new": False}, {"venv": "false"}, "apt-get install python3-venv"),
    ],
)
def test_which_python(own: dict[str, object], other: dict[str, object], taken: str, tmp_path: Path) -> None:
    paths = {
        "own": python(tmp_path / "own" / "python3", **own),  # type: ignore[arg-type]
        "other": python(tmp_path / "bin" / "python3", **other),  # type: ignore[arg-type]
    }
    done = found(paths["own"], tmp_path / "bin")
    if taken in paths:
        assert done.returncode == 0 and done.stdout.strip() == str(paths[taken])
    else:
        assert done.returncode == 1 and done.stdout == "" and taken in done.stderr


def test_as_root_in_ci_venv_is_installed(tmp_path: Path) -> None:
    own = python(tmp_path / "own" / "python3", venv=f"test -e {tmp_path}/installed")
    for name, does in (
        ("id", "echo 0"),
        ("apt-get", f'case "$*" in *python3-venv*) touch {tmp_path}/installed;; esac'),
    ):
        program = python(tmp_path / "bin" / name)
        program.write_text(f"#!/bin/sh\n{does}\n")
    python(tmp_path / "bin" / "python3", new=False)
    assert found(own, tmp_path / "bin").returncode == 1, "only in CI"
    done = found(own, tmp_path / "bin", CI="true")
    assert done.stdout.strip() == str(own) and "installing python3-venv" in done.stderr
