"""What the fuzzer ever found stays found, and a few seconds of it run with every test run; `make fuzz` runs longer."""

from __future__ import annotations

import random
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))
import fuzz  # noqa: E402

FOUND = sorted(path for path in fuzz.FINDS.iterdir() if path.suffix != ".md")


@pytest.fixture(autouse=True, scope="module")
def compiled(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Kernels are compiled before anybody looks at the clock."""
    path = tmp_path_factory.mktemp("whole") / "x.ssc"
    path.write_bytes(fuzz.seeds("ssc")[0])
    fuzz.KINDS["ssc"][1](path)


@pytest.mark.parametrize("path", FOUND, ids=lambda path: path.name)
def test_found_faults_are_repaired(path: Path, tmp_path: Path) -> None:
    assert fuzz.attempt(path.name.partition("-")[0], path.read_bytes(), tmp_path) is None


@pytest.mark.parametrize("kind", fuzz.KINDS)
def test_mutated_input_is_a_result_or_a_line(kind: str, tmp_path: Path) -> None:
    chance, whole = random.Random(7), fuzz.seeds(kind)
    assert whole
    end = time.monotonic() + 2
    for number in range(60):
        data = chance.choice(whole)
        data = (
            fuzz.swapped(data, chance)
            if number % 2 and kind in ("baseline", "play", "editor")
            else fuzz.mutated(data, chance)
        )
        assert fuzz.attempt(kind, data, tmp_path) is None
        if time.monotonic() > end and number > 5:
            break


def test_it_would_notice(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(path: Path) -> object:
        return path.read_bytes()[10_000]

    def endless(path: Path) -> None:
        while True:
            pass

    monkeypatch.setitem(fuzz.KINDS, "sm", (".sm", broken))
    assert "IndexError" in str(fuzz.attempt("sm", b"x", tmp_path))
    if hasattr(fuzz.signal, "SIGALRM"):
        monkeypatch.setattr(fuzz, "LONGEST", 1)
        monkeypatch.setitem(fuzz.KINDS, "sm", (".sm", endless))
        assert "takes more than" in str(fuzz.attempt("sm", b"x", tmp_path))
