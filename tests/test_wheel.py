"""The wheel carries everything: installed alone into an empty environment, the command runs outside the repo."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import venv
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The `bin` folder of an environment that has the wheel.

    The dependencies come from the environment of the tests through a path file; packages found that way do not bring
    their own path files, so the editable install of the checkout stays out.
    """
    folder = tmp_path_factory.mktemp("wheel") / "Jürgen Müller's Töne"  # as homes are called
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


@pytest.fixture
def read_only(installed: Path) -> Iterator[list[str]]:
    """What comes before a command so that it runs with the wheel, but can write neither there nor at home."""
    inside = [path for path in (installed.parent, *installed.parent.rglob("*")) if not path.is_symlink()]
    modes = {path: path.stat().st_mode for path in inside}
    for path in inside:
        path.chmod(modes[path] & ~0o222)
    before = []
    if hasattr(os, "getuid") and os.getuid() == 0:  # modes bind root only without this right
        if shutil.which("setpriv") is None:
            pytest.skip("root can write everywhere, and there is no setpriv to take that from it")
        before = ["setpriv", "--bounding-set", "-dac_override", "--inh-caps", "-dac_override"]
    try:
        yield before
    finally:
        for path, mode in modes.items():
            path.chmod(mode)


def run(installed: Path, cwd: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([installed / arguments[0], *arguments[1:]], cwd=cwd, capture_output=True, text=True)


def test_the_package_is_the_wheels(installed: Path, tmp_path: Path) -> None:
    found = run(installed, tmp_path, "python", "-c", "import dancetutor_cli; print(dancetutor_cli.__file__)")
    assert Path(found.stdout.strip()).is_relative_to(installed.parent)


def test_analyze_runs_with_the_wheels_configs_and_charts(installed: Path, tmp_path: Path) -> None:
    code = "from dancetutor_cli.run.reading import charts_path; print(charts_path())"
    charts = Path(run(installed, tmp_path, "python", "-c", code).stdout.strip())
    assert charts.is_relative_to(installed.parent)
    result = run(installed, tmp_path, "dancetutor", "analyze", "--format", "json", str(charts))
    assert result.returncode in (0, 1), result.stderr
    files = json.loads(result.stdout)["files"]
    assert {Path(f["path"]).suffix for f in files} == {".sm", ".ssc"}
    assert all(len(f["charts"]) == 6 and all(c["rows"] for c in f["charts"]) for f in files)


def test_a_dancer_comes_out_of_the_wheel(installed: Path, tmp_path: Path) -> None:
    code = "from dancetutor_cli.run.reading import charts_path; print(charts_path())"
    charts = Path(run(installed, tmp_path, "python", "-c", code).stdout.strip())
    song = next(charts.rglob("*.ssc"))
    arguments = ("animate", str(song), "--difficulty", "beginner", "--section", "m1:m2", "-o", "out.glb")
    result = run(installed, tmp_path, "dancetutor", *arguments)
    assert result.returncode == 0, result.stderr
    assert (tmp_path / "out.glb").read_bytes()[:4] == b"glTF"


@pytest.mark.skipif(os.name == "nt", reason="modes of folders mean nothing there")
def test_it_runs_read_only_without_a_home_on_an_old_console(
    installed: Path, read_only: list[str], tmp_path: Path
) -> None:
    """An empty home that cannot be written, an installation that cannot either, odd paths, a console of 1981."""
    home = tmp_path / "home"
    home.mkdir(mode=0o500)
    song = tmp_path / "Lieder Größe ♥" / "mein Lied"
    song.mkdir(parents=True)
    for suffix in ("sm", "ssc"):
        shutil.copy(ROOT / "charts" / "two_left_feet" / f"two_left_feet.{suffix}", song / f"Zwei linke Füße.{suffix}")
    asked = subprocess.run(
        [*read_only, installed / "python", "-c", "open(__import__('dancetutor_cli').__file__, 'a')"],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert "Permission denied" in asked.stderr
    plain = {"PATH": os.environ["PATH"], "HOME": str(home)}
    for more in ({"LC_ALL": "C", "PYTHONIOENCODING": "ascii"}, {"PYTHONIOENCODING": "cp437"}):
        for arguments, status, says in (
            ([], 0, b"Try next"),
            (["analyze", str(song), "--full"], 1, b"DT202"),
            (["annotate", str(song), "--check"], 1, b"have no feet yet"),
            (["annotate", str(song), "-o", str(tmp_path / "mit Füßen")], 0, b"2 files: 2 "),
            (["analyze", str(song / "nicht da ♥.sm")], 2, b""),
            (["doctor"], 0, b"disk"),
        ):
            done = subprocess.run(
                [*read_only, installed / "dancetutor", *arguments],
                cwd=tmp_path, env={**plain, **more}, capture_output=True, check=False,
            )  # fmt: skip
            assert done.returncode == status and says in done.stdout, (arguments, done.stdout, done.stderr)
            assert b"internal error" not in done.stderr and b"Traceback" not in done.stderr
    assert {path.suffix for path in (tmp_path / "mit Füßen").rglob("*.s*")} == {".sm", ".ssc"}
