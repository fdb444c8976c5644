"""The wheel carries everything: installed alone into an empty environment, the command runs outside the repo."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import sysconfig
import venv
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The `bin` folder of an environment that has the wheel.

    The dependencies come from the environment of the tests through a path file; packages found that way do not bring
    their own path files, so the editable install of the checkout stays out.
    """
    folder = tmp_path_factory.mktemp("wheel")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder / "dist")]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    environment = folder / "env"
    venv.create(environment, with_pip=False)
    python = environment / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    wheel = next((folder / "dist").glob("*.whl"))
    site = Path(
        subprocess.run(
            [python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"],
            check=True, capture_output=True, text=True,
        ).stdout.strip()
    )  # fmt: skip
    pip = [sys.executable, "-m", "pip", "--python", str(python), "install", "--no-deps", "--no-index", "-q", str(wheel)]
    subprocess.run(pip, check=True, capture_output=True)
    (site / "dependencies.pth").write_text(sysconfig.get_path("purelib") + "\n")
    return python.parent


def run(installed: Path, cwd: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([installed / arguments[0], *arguments[1:]], cwd=cwd, capture_output=True, text=True)


def test_the_package_is_the_wheels(installed: Path, tmp_path: Path) -> None:
    found = run(installed, tmp_path, "python", "-c", "import dancetutor_cli; print(dancetutor_cli.__file__)")
    assert Path(found.stdout.strip()).is_relative_to(installed.parent)


def test_analyze_runs_with_the_wheels_configs_and_charts(installed: Path, tmp_path: Path) -> None:
    code = "from dancetutor_cli.resources import charts_path; print(charts_path())"
    charts = Path(run(installed, tmp_path, "python", "-c", code).stdout.strip())
    assert charts.is_relative_to(installed.parent)
    result = run(installed, tmp_path, "dancetutor", "analyze", "--format", "json", str(charts))
    assert result.returncode in (0, 1), result.stderr
    files = json.loads(result.stdout)["files"]
    assert {Path(f["path"]).suffix for f in files} == {".sm", ".ssc"}
    assert all(len(f["charts"]) == 6 and all(c["rows"] for c in f["charts"]) for f in files)


def test_a_dancer_comes_out_of_the_wheel(installed: Path, tmp_path: Path) -> None:
    code = "from dancetutor_cli.resources import charts_path; print(charts_path())"
    charts = Path(run(installed, tmp_path, "python", "-c", code).stdout.strip())
    song = next(charts.rglob("*.ssc"))
    arguments = ("animate", str(song), "--difficulty", "beginner", "--section", "m1:m2", "-o", "out.glb")
    result = run(installed, tmp_path, "dancetutor", *arguments)
    assert result.returncode == 0, result.stderr
    assert (tmp_path / "out.glb").read_bytes()[:4] == b"glTF"
