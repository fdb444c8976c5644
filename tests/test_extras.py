"""Extras: what the package names, what a run without them says, and that plain work needs none of them."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from importlib import metadata
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from dancetutor_cli.dance.physics import style
from dancetutor_cli.film.scene.gl import available
from dancetutor_cli.run.errors import PACKAGES, UnavailableError, install_command

ROOT = Path(__file__).resolve().parent.parent
PROJECT = ROOT / "pyproject.toml"
HIDDEN = ("mujoco", "pyrender", "OpenGL", "imageio_ffmpeg", "scipy", "distributed")  # an install without extras
HIDE = f"""
from importlib.machinery import PathFinder
found = PathFinder.find_spec
def find_spec(cls, name, path=None, target=None):
    return None if name.partition(".")[0] in {HIDDEN} else found(name, path, target)
PathFinder.find_spec = classmethod(find_spec)
"""


def plain(tmp_path: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """The command as it runs where no extra is installed and PATH has no ffmpeg."""
    site = tmp_path / "site"
    site.mkdir(exist_ok=True)
    (site / "sitecustomize.py").write_text(HIDE)  # for worker processes, too
    environment = {"PATH": str(tmp_path), "HOME": str(tmp_path), "PYTHONPATH": str(site)}
    return subprocess.run(
        [sys.executable, "-m", "dancetutor_cli", *arguments],
        capture_output=True,
        text=True,
        env=environment,
        check=False,
    )


@pytest.mark.skipif(not PROJECT.exists(), reason="not in an installed package")
def test_the_names_are_those_of_the_package() -> None:
    extras = tomllib.loads(PROJECT.read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    for extra, name in PACKAGES.items():
        assert [re.split(r"[>;\s]", requirement)[0] for requirement in extras[extra]] == [name]
    assert extras["all"] == ["dancetutor[ffmpeg,gl,physics]"]


def test_without_an_extra_one_line_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(available, "find_spec", lambda name: None)
    with pytest.raises(UnavailableError, match=r"pip install pyrender==0.1.45\. Or use --renderer cpu\.$"):
        available.require_gl()
    available.gpu_device.cache_clear()
    assert available.gpu_device() is None
    monkeypatch.setitem(sys.modules, "mujoco", None)
    assert not style.is_installed()
    with pytest.raises(UnavailableError, match=f"{install_command('physics')}$"):
        style.engine()


def test_plain_work_needs_no_extra(tmp_path: Path) -> None:
    song = ROOT / "charts" / "two_left_feet" / "two_left_feet.ssc"
    for arguments in (
        ("analyze", str(song), "--exit-zero"),
        ("animate", str(song), "--index", "0", "--section", "0:4", "--report", "-o", str(tmp_path / "a.glb")),
        ("page", str(song), "--index", "0", "-o", str(tmp_path / "a.html")),
        ("render", str(song), "--index", "0", "--section", "8:8.1", "--size", "64x64", "--frames", str(tmp_path / "f")),
    ):
        done = plain(tmp_path, *arguments)
        assert done.returncode == 0, (arguments, done.stderr)


@pytest.mark.parametrize(
    ("arguments", "extra"),
    [
        (("--style", "lazy", "-o", "a.glb"), "physics"),
        (("--renderer", "gl", "--frames", "a"), "gl"),
        (("-o", "a.mp4"), "ffmpeg"),
    ],
)
def test_commands_that_need_an_extra_say_so(arguments: tuple[str, ...], extra: str, tmp_path: Path) -> None:
    song = str(ROOT / "charts" / "two_left_feet" / "two_left_feet.ssc")
    name = "animate" if extra == "physics" else "render"
    done = plain(
        tmp_path, name, song, "--index", "0", "--section", "8:9", *arguments[:-1], str(tmp_path / arguments[-1])
    )
    assert done.returncode == 2, done.stderr
    assert install_command(extra) in done.stderr.strip().splitlines()[-1]  # type: ignore[arg-type]
    assert "internal error" not in done.stderr


def test_doctor_says_what_is_missing(tmp_path: Path) -> None:
    done = plain(tmp_path, "doctor")
    said = " ".join(done.stdout.split())
    assert done.returncode == 2, "no ffmpeg: no films"
    for extra in ("physics", "gl", "ffmpeg"):
        assert install_command(extra) in said  # type: ignore[arg-type]


def needed(names: list[str]) -> set[str]:
    """Packages and all that they need without extras, as installed here."""
    found: set[str] = set()
    while names:
        name = canonicalize_name(Requirement(names[0]).name)
        names = names[1:]
        if name not in found:
            found.add(name)
            wanted = [Requirement(line) for line in metadata.requires(name) or []]
            names += [str(one) for one in wanted if one.marker is None or one.marker.evaluate({"extra": ""})]
    return found


@pytest.mark.skipif(not PROJECT.exists(), reason="not in an installed package")
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="measured on Linux")
def test_a_plain_install_is_no_heavier_than_400_megabytes() -> None:
    plain = tomllib.loads(PROJECT.read_text(encoding="utf-8"))["project"]["dependencies"]
    sizes = {
        name: sum(Path(file.locate()).stat().st_size for file in metadata.files(name) or () if file.locate().is_file())
        for name in needed(plain)
    }
    assert sum(sizes.values()) < 400e6, sizes
    assert not {"scipy", "mujoco-core", "pyrender", "imageio-ffmpeg"} & set(sizes)
