"""The result cache: the same result, and a new one as soon as anything it depends on changes."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from dancetutor_cli.errors import UnavailableError
from dancetutor_cli.jobs.analyze import Task
from dancetutor_cli.jobs.analyze_all import analyze_all
from dancetutor_cli.jobs.cache import ResultCache
from dancetutor_cli.jobs.lint_run import LintRun, Request
from dancetutor_cli.jobs.pool import Done, SerialWorkers

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
    changed = [
        key(song, cache, ignore=["spin"]),
        key(song, cache, assignments=["DT205.max_rows=3"]),
        key(song, cache, suggest=True),
        key(song, cache, alternatives=2),
        key(song, cache, want_figures=True),
    ]
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


def test_what_could_not_be_opened_is_not_kept(tmp_path: Path) -> None:
    task = LintRun(Request()).task(tmp_path / "nowhere.sm")
    cache = ResultCache(tmp_path / "cache")
    (result,) = analyze_all([task], 1, cache)
    assert result.error and not (tmp_path / "cache").exists()


def test_a_breakdown_is_not_kept(song: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Dying(SerialWorkers):
        def done(self) -> Iterator[Done]:
            yield from (Done(task.key, error=UnavailableError("killed")) for task in self._queue)

    monkeypatch.setattr("dancetutor_cli.jobs.analyze_all._WORTH_WORKERS", 1)
    monkeypatch.setattr("dancetutor_cli.jobs.pool.open_workers", lambda jobs, report: Dying(report))
    cache = ResultCache(tmp_path / "cache")
    (result,) = analyze_all([LintRun(Request()).task(song)], 2, cache)
    assert result.error and "killed" in result.error and not (tmp_path / "cache").exists()


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


def test_a_file_that_cannot_be_read_as_a_chart_is_kept_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    paths = [tmp_path / f"{n}.sm" for n in range(3)]
    for path in paths:
        path.write_text("no chart at all")
    cache = ResultCache(tmp_path / "cache")
    tasks = [LintRun(Request()).task(path) for path in paths]
    first = list(analyze_all(tasks, 1, cache))
    monkeypatch.setattr("dancetutor_cli.jobs.analyze_all.analyze_file", None)  # nothing is left to do
    worked: list[Path] = []
    assert list(analyze_all(tasks, 1, cache, lambda task: worked.append(task.path))) == first
    assert all(result.error for result in first) and worked == []


def test_work_is_announced_once(song: Path, tmp_path: Path) -> None:
    worked: list[Path] = []
    task = LintRun(Request()).task(song)
    list(analyze_all([task, task], 1, None, lambda one: worked.append(one.path)))
    assert worked == [song]
