"""Kernels are kept where there is room, and a kept file that is damaged only means that they are compiled again."""

from __future__ import annotations

import ast
import errno
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from module_file import loaded

from dancetutor_cli.commands.doctor import _cache
from dancetutor_cli.commands.first_run import announce_compiling
from dancetutor_cli.feet.preset import PresetChoice
from dancetutor_cli.run import trust
from dancetutor_cli.run.kernels import compiling, stored_code

MODULE = """
from dancetutor_cli.run.kernels.compiling import njit

@njit(cache=True)
def double(x):
    return 2 * x
"""


@pytest.fixture(autouse=True)
def fresh(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Ask anew where kernels go, now and after the test."""
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    stored_code._use_folder.cache_clear()
    yield
    stored_code._use_folder.cache_clear()


@pytest.fixture
def nowhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An installation and a home in which nothing can be written, by root neither; the folder for temporary files."""
    (tmp_path / "file").touch()
    monkeypatch.setattr(stored_code, "PACKAGE", tmp_path / "file" / "package")
    for name in ("XDG_CACHE_HOME", "LOCALAPPDATA", "HOME"):
        monkeypatch.setenv(name, str(tmp_path / "file" / "home"))
    monkeypatch.setenv("TMPDIR", str(tmp_path / "tmp"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "tmp"))
    monkeypatch.setattr(trust, "_TEMPORARY", ())
    monkeypatch.setattr("dancetutor_cli.feet.solver.compiled.is_compiled", lambda preset: False)
    (tmp_path / "tmp").mkdir()
    return tmp_path / "tmp"


def test_a_read_only_installation_and_home_leave_a_temporary_folder(
    nowhere: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = stored_code.kernel_folder()
    assert folder.is_writable and folder.root is not None and folder.root.parent == nowhere
    if os.name != "nt":
        assert folder.root.stat().st_mode & 0o777 == 0o700
    announce_compiling(PresetChoice())
    (line,) = capsys.readouterr().err.splitlines()
    assert str(folder.root) in line and "cannot be written" in line
    monkeypatch.setattr("dancetutor_cli.feet.solver.compiled.is_compiled", lambda preset: True)
    announce_compiling(PresetChoice())
    assert capsys.readouterr().err == ""  # nothing is compiled
    check = _cache()
    assert check.state == "without" and "cannot be written" in check.message and "NUMBA_CACHE_DIR" in check.remedy


@pytest.mark.skipif(os.name == "nt", reason="the temporary folder of Windows is the user's own")
def test_a_temporary_folder_of_another_user_is_not_used(nowhere: Path, capsys: pytest.CaptureFixture[str]) -> None:
    first = stored_code.kernel_folder().root
    assert first is not None
    first.chmod(0o777)
    stored_code._use_folder.cache_clear()
    assert not stored_code.kernel_folder().is_writable
    announce_compiling(PresetChoice())
    assert "compiles again" in capsys.readouterr().err


def test_a_user_without_a_home_has_no_cache_there(monkeypatch: pytest.MonkeyPatch) -> None:
    def none() -> Path:
        raise RuntimeError("Could not determine home directory.")

    for name in ("XDG_CACHE_HOME", "LOCALAPPDATA"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(Path, "home", none)
    assert trust.users_folder("dancetutor") is None


def test_the_folder_that_is_asked_for_is_taken(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "mine"))
    assert stored_code.kernel_folder() == stored_code.KernelFolder(tmp_path / "mine")
    (tmp_path / "file").touch()
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "file" / "mine"))
    assert "mine" in stored_code.kernel_folder().fault


def test_a_damaged_file_is_compiled_again_and_repaired(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    source = tmp_path / "some_kernels.py"
    source.write_text(MODULE)
    assert loaded(source).double(4) == 8
    files = sorted((tmp_path / "cache").glob("*/*"))
    assert [path.suffix for path in files] == [".kernel"]
    whole = [path.read_bytes() for path in files]
    assert loaded(source).double.stats.cache_hits == {}
    for path, data in zip(files, whole, strict=True):
        flipped = bytearray(data)
        flipped[len(data) // 2] ^= 1
        for damaged in (b"", data[:7], data[: len(data) // 2], data[:-1], bytes(flipped)):
            path.write_bytes(damaged)
            module = loaded(source)
            assert module.double(4) == 8
            assert not module.double.stats.cache_hits  # compiled anew ...
            again = loaded(source)
            assert again.double(4) == 8
            assert again.double.stats.cache_hits  # ... and kept


def test_a_full_disk_only_means_that_nothing_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    source = tmp_path / "some_kernels.py"
    source.write_text(MODULE)

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(stored_code, "write_file", full)
    module = loaded(source)
    assert module.double(4) == 8
    assert not list((tmp_path / "cache").glob("*/*"))
    monkeypatch.undo()
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    assert loaded(source).double(4) == 8


def test_kernels_that_came_with_a_read_only_installation_are_used(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source = tmp_path / "some_kernels.py"
    source.write_text(MODULE)
    assert loaded(source).double(4) == 8
    assert list((tmp_path / "__pycache__").glob("*.kernel"))
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "elsewhere"))
    module = loaded(source)
    assert module.double(4) == 8
    assert module.double.stats.cache_hits


def test_a_command_runs_with_nothing_to_write_to(tmp_path: Path) -> None:
    """The program itself, whose installation is made read-only for it: a kernel that nobody can keep still runs."""
    (tmp_path / "some_kernels.py").write_text(MODULE)
    code = (
        "from pathlib import Path; from dancetutor_cli.run.kernels import stored_code as k\n"
        "k.use_folder = lambda folder: 'cannot be written'; k.temporary_folder = lambda name: None\n"
        "import some_kernels; print(some_kernels.double(4), k.kernel_folder().is_writable)"
    )
    ran = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True)
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, "8 False\n", "")


def test_a_kernel_is_compiled_again_when_what_it_is_made_of_changes(tmp_path: Path) -> None:
    """Kernels go into each other, also from room to room, and constants of other modules into kernels."""
    shutil.copytree(stored_code.PACKAGE, tmp_path / "p", ignore=shutil.ignore_patterns("__pycache__", "_data"))
    for source, others in (
        ("film/scene/cpu/floor.py", ["film/scene/cpu/standing.py", "film/scene/cpu/raster.py"]),
        ("dance/physics/hair.py", ["dance/rig/limbs.py", "dance/rig/body.py"]),
        ("dance/ik/full_body.py", ["dance/rig/limbs.py", "dance/rig/body.py", "dance/rig/body.py"]),
        ("film/scene/cpu/shade.py", ["film/scene/geometry.py", "feet/limbs.py"]),
        ("dance/quadratic.py", ["dance/quadratic.py"]),
    ):
        found = {
            path.relative_to(tmp_path / "p").as_posix()
            for path in stored_code.source_modules(tmp_path / "p" / source, tmp_path / "p")
        }
        assert found >= {source, *others}
    source = tmp_path / "p" / "dance" / "physics" / "hair.py"
    before = stored_code.source_digest.__wrapped__(source)
    source.write_text(source.read_text("utf-8") + "# more\n", "utf-8")
    assert stored_code.source_digest.__wrapped__(source) != before


def _kernels(tree: ast.AST) -> Iterator[tuple[ast.FunctionDef, bool]]:
    """The kernels of a module, and whether they are inner ones."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            said = " ".join(ast.unparse(one) for one in node.decorator_list)
            if "njit" in said or "kernel" in said:
                yield node, "inner" in said


def _named(tree: ast.AST, inside: frozenset[ast.AST]) -> Iterator[str]:
    """Names that are read in a module outside of its kernels, but for a function's own variables."""
    for node in ast.iter_child_nodes(tree):
        if node in inside:
            continue
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load):
            yield node.id
        elif isinstance(node, ast.ImportFrom | ast.Import):
            continue
        found = _named(node, inside)
        if isinstance(node, ast.FunctionDef):
            stored = {one.id for one in ast.walk(node) if isinstance(one, ast.Name) and isinstance(one.ctx, ast.Store)}
            found = (name for name in found if name not in stored)
        yield from found


def test_inner_kernels_are_only_called_by_kernels() -> None:
    """Called from Python they would crash: no module that has or imports one names it outside of a kernel."""
    root = stored_code.PACKAGE
    trees = {path: ast.parse(path.read_text("utf-8")) for path in sorted(root.rglob("*.py"))}
    inner = {
        (path.relative_to(root.parent).with_suffix("").as_posix().replace("/", "."), node.name)
        for path, tree in trees.items()
        for node, is_inner in _kernels(tree)
        if is_inner and path.parent.name != "solver"  # whose stay functions of Python's
    }
    assert len(inner) > 40
    repository = Path(__file__).parents[2]
    others = [path for part in ("tests", "tools", "research") for path in (repository / part).rglob("*.py")]
    trees.update({path: ast.parse(path.read_text("utf-8")) for path in others})
    for path, tree in trees.items():
        inside = frozenset(node for node, _ in _kernels(tree))
        module = (
            path.relative_to(root.parent).with_suffix("").as_posix().replace("/", ".") if root in path.parents else ""
        )
        known = {name for home, name in inner if home == module}
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom):
                known |= {one.asname or one.name for one in node.names if (node.module, one.name) in inner}
        assert not known or not known & set(_named(tree, inside)), path


def test_it_is_known_whether_a_kernel_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    module, folder = tmp_path / "twice.py", tmp_path / "kernels"
    module.write_text(MODULE, "utf-8")
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(folder))
    kernel = loaded(module).double
    assert not compiling.is_kept(kernel)
    kernel(3)
    assert compiling.is_kept(kernel) and compiling.is_kept(loaded(module).double)
    module.write_text(MODULE.replace("2 *", "3 *"), "utf-8")
    stored_code.source_digest.cache_clear()
    assert not compiling.is_kept(loaded(module).double)


def test_a_kept_kernel_needs_little_of_numba(tmp_path: Path) -> None:
    (tmp_path / "fetched.py").write_text(
        "import numpy as np\nfrom dancetutor_cli.run.kernels.compiling import njit\n\n\n"
        "@njit(cache=True)\ndef mean(values):\n    return (values + values).sum() / len(values) / 2\n\n\n"
        "print(mean(np.arange(5.0)))\n"
    )
    code = "import sys; sys.path.insert(0, '.'); import fetched; print(*sorted(sys.modules))"
    env = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "kept")}
    first, second = (
        subprocess.run([sys.executable, "-c", code], cwd=tmp_path, env=env, capture_output=True, text=True, check=True)
        for _ in range(2)
    )
    for run, fetched in ((first, False), (second, True)):
        said, modules = run.stdout.splitlines()
        assert said == "2.0" and "scipy.linalg" not in modules.split()
        assert ("numba.typed.typeddict" not in modules.split()) == fetched  # gathered only where something is compiled


def test_doctor_counts_the_kernels_of_each_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package, mine = tmp_path / "package", tmp_path / "mine"
    for folder in (package, mine):
        folder.mkdir()
    monkeypatch.setattr("dancetutor_cli.run.reading.PACKAGE", package)
    monkeypatch.setattr(stored_code, "PACKAGE", package)
    monkeypatch.setattr(stored_code, "kernel_folder", lambda: stored_code.KernelFolder(mine, True, ""))
    head = bytes(2 * stored_code.CHECKSUM) + stored_code.maker()
    for name in ("a.f.1.kernel", "a.f.2.kernel", "b.f.1.kernel"):
        (package / name).write_bytes(head)
    assert _cache().message == f"2 kernels in {package}, new ones go into {mine}"
    (mine / "c.f.1.kernel").write_bytes(head)
    assert _cache().message == f"1 kernel in {mine}, 2 kernels in {package}"
