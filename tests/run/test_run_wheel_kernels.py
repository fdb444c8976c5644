"""Kernels that come compiled with the package are used where they fit, and are as if not there where they do not."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
import zipfile
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from hatchling.builders.wheel import WheelBuilder
from module_file import loaded

from dancetutor_cli.commands.doctor import _cache
from dancetutor_cli.run.kernels import compiling, stored_code

ROOT = Path(__file__).resolve().parents[2]
MODULE = """
from dancetutor_cli.run.kernels.compiling import njit

@njit(cache=True)
def double(x):
    return 2 * x
"""
able = pytest.mark.skipif(
    not stored_code.is_portable(), reason="this processor, or a setting of numba's, has kernels of its own"
)


def hits(path: Path) -> bool:
    """Whether a module's kernel was fetched; that it counts right in any case."""
    for cached in (stored_code.source_digest, stored_code.maker):
        cached.cache_clear()
    module = loaded(path)
    assert module.double(4) == 8
    return bool(module.double.stats.cache_hits)


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A package with one module and its kernel, which came compiled; the user's own cache is empty."""
    package = tmp_path / "package"
    (package / "room").mkdir(parents=True)
    source = package / "room" / "some_kernels.py"
    source.write_text(MODULE, "utf-8")
    monkeypatch.setattr(stored_code, "PACKAGE", package)
    monkeypatch.setattr("dancetutor_cli.run.reading.PACKAGE", package)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "build"))
    assert not hits(source)
    shutil.copytree(stored_code.kernel_folder().of_module(source), came(package), dirs_exist_ok=True)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "mine"))
    yield package
    for cached in (stored_code.source_digest, stored_code.maker):
        cached.cache_clear()


def came(package: Path) -> Path:
    return package / "room" / "__pycache__"


def source_of(package: Path) -> Path:
    return package / "room" / "some_kernels.py"


def mine(package: Path) -> list[Path]:
    return list((package.parent / "mine").rglob("*.kernel"))


@able
def test_what_came_is_fetched_and_nothing_is_written(package: Path) -> None:
    assert hits(source_of(package)) and mine(package) == []
    assert compiling.is_kept(loaded(source_of(package)).double)
    assert _cache().state == "ok" and _cache().message.startswith(f"1 kernel in {package}, ")


@able
def test_what_came_serves_where_nothing_can_be_kept(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stored_code, "_use_folder", lambda *_: "cannot be written")
    monkeypatch.setattr(stored_code, "temporary_folder", lambda name: None)
    assert not stored_code.kernel_folder().is_writable and hits(source_of(package))


def other_maker(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stored_code, "_version", lambda name: "0.1")


def other_python(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.implementation, "cache_tag", "cpython-399")


def other_code(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    source_of(package).write_text(MODULE + "\n# more\n", "utf-8")


def other_settings(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_OPT", "1")


def other_processor(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NUMBA_CPU_NAME")
    monkeypatch.delenv("NUMBA_CPU_FEATURES")
    monkeypatch.setattr(stored_code, "_is_able", lambda: False)


def flipped(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for path in came(package).glob("*.kernel"):
        data = bytearray(path.read_bytes())
        data[len(data) // 2] ^= 1
        path.write_bytes(data)


def cut(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for path in came(package).glob("*.kernel"):
        path.write_bytes(path.read_bytes()[:-1])


@able
@pytest.mark.parametrize(
    "spoil",
    [other_maker, other_python, other_code, other_settings, flipped, cut],
)
def test_what_does_not_fit_is_compiled_here_without_a_word(
    spoil: Callable[[Path, pytest.MonkeyPatch], None],
    package: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    spoil(package, monkeypatch)
    assert not hits(source_of(package))
    assert mine(package) and hits(source_of(package))
    assert capfd.readouterr() == ("", "")


@able
def test_what_is_compiled_for_another_processor_than_its_key_says_is_not_kept(
    package: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """numba chooses once; here it was imported before, as by a program that uses this package."""
    other_processor(package, monkeypatch)
    for _ in range(2):
        assert not hits(source_of(package)) and not mine(package)


@able
def test_doctor_says_that_kernels_are_for_others(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stored_code, "_version", lambda name: "0.1")
    stored_code.maker.cache_clear()
    assert _cache().message.endswith("1 kernel for another version of Python, numba or llvmlite: not used")


@able
@pytest.mark.parametrize("said", [{}, {"NUMBA_CPU_NAME": "nehalem"}, {"NUMBA_CPU_FEATURES": "-avx2"}])
def test_kernels_are_for_a_portable_processor_unless_one_is_named(said: dict[str, str]) -> None:
    plain = {key: value for key, value in os.environ.items() if not key.startswith("NUMBA_")}
    code = (
        "from dancetutor_cli.run.kernels import compiling, stored_code\n"
        "from numba.core.registry import cpu_target\n"
        "print(stored_code.is_portable(), *cpu_target.target_context.codegen().magic_tuple()[1:])"
    )
    told = subprocess.run(
        [sys.executable, "-c", code], env=plain | said, cwd=ROOT, check=True, capture_output=True, text=True
    ).stdout.split()
    if not said:
        assert told[:2] == ["True", "x86-64-v3"] and "+avx2" in told[2] and "avx512" not in told[2]
    else:
        assert told[0] == "False" and set(said.values()) & set(told)


USE = """
import numpy as np
import dancetutor_cli
from dancetutor_cli.run.kernels.compiling import is_kept
from dancetutor_cli.dance.rig.body import _forward, world_transforms
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton

skeleton, came = dancer_skeleton(), is_kept(_forward)
turns = np.zeros((1, len(skeleton.parents), 4))
turns[..., 0] = 1
world_transforms(skeleton, turns, np.zeros((1, 3)))
print(came, sum(_forward.stats.cache_hits.values()), dancetutor_cli.__file__)
"""
really_run = subprocess.run


def compile_one(command: list[str], **options: Any) -> Any:
    """In place of `warmup`, which compiles all kernels: one."""
    if command[1:] != ["-m", "dancetutor_cli", "warmup", "--quiet"]:
        return really_run(command, **options)
    assert options.pop("check")
    said = really_run([sys.executable, "-c", USE], **options, check=True, capture_output=True, text=True)
    assert said.stdout.startswith("False 0") and str(ROOT) not in said.stdout  # a copy, with nothing kept beside it
    return said


@able
def test_a_platform_wheel_brings_its_kernels(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HATCH_BUILD_HOOK_ENABLE_CUSTOM", "true")
    monkeypatch.setattr(subprocess, "run", compile_one)
    real, link = tmp_path / "real", tmp_path / "link"
    real.mkdir()
    with suppress(OSError):  # not everybody may make links on Windows
        link.symlink_to(real)  # as macOS has one before its temporary folders
        monkeypatch.setattr(tempfile, "tempdir", str(link))
    (wheel,) = WheelBuilder(str(ROOT)).build(directory=str(tmp_path), versions=["standard"])
    version = f"cp{sys.version_info.major}{sys.version_info.minor}"
    tags = Path(wheel).stem.split("-", 2)[2]
    assert tags.startswith(f"{version}-{version}-") and not tags.endswith("any")
    site = tmp_path / "site"
    with zipfile.ZipFile(wheel) as file:
        file.extractall(site)
    brought = [path.relative_to(site).as_posix() for path in site.rglob("*.kernel")]
    assert [Path(one).parent.as_posix() for one in brought] == ["dancetutor_cli/dance/rig/__pycache__"]
    said = next(site.glob("*.dist-info/WHEEL")).read_text("utf-8")
    assert "Root-Is-Purelib: false" in said
    plain = {key: value for key, value in os.environ.items() if not key.startswith("NUMBA_")}
    env = plain | {"PYTHONPATH": str(site), "NUMBA_CACHE_DIR": str(tmp_path / "mine")}
    ran = really_run([sys.executable, "-c", USE], env=env, cwd=tmp_path, check=True, capture_output=True, text=True)
    assert ran.stdout.startswith("True 1") and str(site) in ran.stdout
    assert list((tmp_path / "mine").rglob("*.kernel")) == []


def test_the_extra_names_what_the_locked_environment_compiles_with() -> None:
    said = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["optional-dependencies"]["compiled"]
    lock = (ROOT / "requirements.lock").read_text("utf-8")
    assert {one.partition("==")[0] for one in said} == set(stored_code.COMPILERS)
    assert all(f"\n{one} " in lock or lock.startswith(f"{one} ") for one in said)
