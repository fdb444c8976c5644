"""The result cache: the same result, and a new one as soon as anything it depends on changes."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from dancetutor_cli.jobs.analyze import Task
from dancetutor_cli.jobs.analyze_all import analyze_all
from dancetutor_cli.jobs.cache import ResultCache
from dancetutor_cli.jobs.lint_run import LintRun, Request

NOTES = "#TITLE:{};\n#ARTIST:A;\n#CREDIT:C;\n#BPMS:0=120;\n#NOTES:dance-single:C:Hard:9::\n1000\n0100\n0010\n0001\n;\n"


@pytest.fixture
def song(tmp_path: Path) -> Path:
    path = tmp_path / "song" / "x.sm"
    path.parent.mkdir()
    path.write_text(NOTES.format("T"))
    return path


def key(path: Path, cache: Path, **request: object) -> str:
    found = ResultCache(cache).key(LintRun(Request(**request)).task(path))  # type: ignore[arg-type]
    assert found is not None
    return found


def test_a_kept_result_is_the_same(song: Path, tmp_path: Path) -> None:
    cache = ResultCache(tmp_path / "cache")
    task = LintRun(Request()).task(song)
    fresh = list(analyze_all([task], 1, cache))
    kept = cache.get(cache.key(task) or "")
    assert [kept] == fresh == list(analyze_all([task], 1, cache))


def test_the_key_changes_with_all_that_counts(song: Path, tmp_path: Path) -> None:
    cache = tmp_path / "cache"
    first = key(song, cache)
    assert key(song, cache) == first
    changed = [key(song, cache, ignore=["spin"]), key(song, cache, assignments=["DT205.max_rows=3"]),
               key(song, cache, suggest=True)]  # fmt: skip
    (song.parent / "x.ogg").write_bytes(b"music")
    changed.append(key(song, cache))
    song.with_suffix(".ssc").write_text("#NOTEDATA:;")
    changed.append(key(song, cache))
    (song.parent / "dancetutor.yaml").write_text("rules: {spin: error}\n")
    changed.append(key(song, cache))
    song.write_text(NOTES.format("U"))
    changed.append(key(song, cache))
    assert len({first, *changed}) == 1 + len(changed)


def test_another_file_beside_it_does_not_matter(song: Path, tmp_path: Path) -> None:
    first = key(song, tmp_path / "cache")
    (song.parent / "other.sm").write_text(NOTES.format("O"))
    assert key(song, tmp_path / "cache") == first


def test_json_and_standard_input_are_not_kept(song: Path, tmp_path: Path) -> None:
    cache = ResultCache(tmp_path / "cache")
    assert cache.key(LintRun(Request(want_rows=True)).task(song)) is None
    assert cache.key(LintRun(Request()).task(song, b"data")) is None


def test_a_damaged_entry_is_no_result(song: Path, tmp_path: Path) -> None:
    cache = ResultCache(tmp_path / "cache")
    task = LintRun(Request()).task(song)
    fresh = list(analyze_all([task], 1, cache))
    for entry in (tmp_path / "cache").glob("*/*"):
        entry.write_bytes(entry.read_bytes()[:-7])
    assert cache.get(cache.key(task) or "") is None
    assert list(analyze_all([task], 1, cache)) == fresh


def test_an_error_is_not_kept(tmp_path: Path) -> None:
    cache = ResultCache(tmp_path / "cache")
    (tmp_path / "bad.sm").write_text("nothing")
    task = LintRun(Request()).task(tmp_path / "bad.sm")
    assert next(analyze_all([task], 1, cache)).error
    assert not (tmp_path / "cache").exists()


def test_workers_give_the_same_in_the_same_order(song: Path) -> None:
    tasks: list[Task] = []
    for n in range(9):
        path = song.with_name(f"{n}.sm")
        path.write_text("nothing" if n == 4 else NOTES.format(n))
        tasks.append(LintRun(Request()).task(path))
    assert list(analyze_all(tasks, 2, None)) == list(analyze_all(tasks, 1, None))


def test_a_kept_result_needs_neither_numpy_nor_numba(song: Path, tmp_path: Path) -> None:
    code = (
        "import sys\nfrom dancetutor_cli.__main__ import main\n"
        "try:\n    main(['analyze', sys.argv[1]])\nexcept SystemExit:\n    pass\n"
        "sys.stderr.write(' '.join({'numpy', 'numba', 'scipy'} & set(sys.modules)))\n"
    )
    environment = {"DANCETUTOR_CACHE": str(tmp_path / "cache"), "PATH": "", "SYSTEMROOT": "C:\\Windows"}
    said = [
        subprocess.run([sys.executable, "-c", code, str(song)], env=environment, capture_output=True, text=True)
        for _ in range(2)
    ]
    assert "numba" in said[0].stderr
    assert said[1].stderr == ""
    assert said[1].stdout == said[0].stdout != ""
