"""What all tests share: where the test data is, and skipping with a reason where it is absent."""

from __future__ import annotations

import os
import tarfile
from pathlib import Path

import pytest
from hypothesis import settings
from module_file import tool

from dancetutor_cli.run.trust import TREES

os.environ.setdefault("DANCETUTOR_KERNELS", "compiled")  # whatever is compiled already, and in every process of a test
settings.register_profile("any machine", deadline=None)  # what a busy machine takes says nothing of the code
settings.load_profile("any machine")
ROOT = Path(__file__).resolve().parent.parent
SHARED = ROOT.parent / "shared"


def _shared(name: str) -> Path:
    path = SHARED / "data" / name
    if not path.exists():
        pytest.skip(f"test data ../shared/data/{name} is not here")
    return path


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """The folder ../shared/data, or a skip."""
    return _shared(".")


@pytest.fixture(scope="session")
def corpus() -> Path:
    """The 435 real chart files, unpacked once into build/ (git ignores it), or a skip."""
    archive = _shared("charts/charts.tar.xz")
    target = ROOT / "build" / "corpus"
    if not (target / ".complete").exists():
        target.mkdir(parents=True, exist_ok=True)
        with tarfile.open(archive) as tar:
            tool("unpacking").unpack(tar, target)
        (target / ".complete").touch()
    return target / "dev"


@pytest.fixture(scope="session")
def hostile() -> Path:
    """The odd and broken files with expectations.csv; they are the project's own."""
    return ROOT / "tests" / "data" / "hostile"


@pytest.fixture(autouse=True)
def plain_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    """What the surroundings say of a terminal (pytest-xdist sets COLUMNS) must not change what is printed."""
    for name in ("COLUMNS", "LINES", "NO_COLOR", "FORCE_COLOR"):
        monkeypatch.delenv(name, raising=False)


@pytest.fixture(autouse=True)
def own_trees(monkeypatch: pytest.MonkeyPatch) -> None:
    """What a command of one test has read is nothing to the next."""
    monkeypatch.setenv(TREES, "[]")


@pytest.fixture
def own_records(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of the test's own for kept results and records of films, and not that of whoever runs the tests."""
    folder = tmp_path_factory.mktemp("cache")
    monkeypatch.setenv("DANCETUTOR_CACHE", str(folder))
    return folder
