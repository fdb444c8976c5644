"""The page's modules under Node: unit tests, and their types."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TESTS = sorted((Path(__file__).parent / "js").glob("*.test.mjs"))


@pytest.mark.parametrize("path", TESTS, ids=lambda path: path.stem)
def test_modules_do_what_they_say(path: Path) -> None:
    node = shutil.which("node")
    if node is None:
        pytest.skip("no Node here; Debian/Ubuntu: apt-get install nodejs")
    done = subprocess.run([node, "--test", str(path)], capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_modules_types_are_right() -> None:
    local = Path(__file__).parent / "node_modules" / ".bin" / "tsc"
    tsc = str(local) if local.exists() else shutil.which("tsc")
    if tsc is None:
        pytest.skip("no TypeScript here; `make page-tools` puts it into tests/page/node_modules")
    done = subprocess.run([tsc, "-p", str(ROOT)], capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stdout
