"""The result cache: the same result, and a new one as soon as anything it depends on changes."""

from __future__ import annotations

import hashlib
import pickle
import random
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from dancetutor_cli.lint.analysis import AnalyzeTask, analyze_file
from dancetutor_cli.lint.results import ResultCache, to_bytes
from dancetutor_cli.lint.run import LintRequest, LintRun, _batches, analyze_all
from dancetutor_cli.run.errors import UnavailableError
from dancetutor_cli.run.pool import FinishedWork, SerialWorkers, no_report
from dancetutor_cli.run.reading import charts_path

pytestmark = pytest.mark.usefixtures("own_records")

NOTES = "#TITLE:{};\n#ARTIST:A;\n#CREDIT:C;\n#BPMS:0=120;\n#NOTES:dance-single:C:Hard:9::\n1000\n0100\n0010\n0001\n;\n"


@pytest.fixture
def song(tmp_path: Path) -> Path:
    path = tmp_path / "song" / "x.sm"
    path.parent.mkdir()
    path.write_text(NOTES.format("T"))
    return path


def key(path: Path, cache: Path, **request: object) -> str:
    found = ResultCache(cache).key(LintRun(LintRequest(**request)).task(path))  # type: ignore[arg-type]
    assert found is not None
    return found


def test_a_kept_result_is_the_same(song: Path, tmp_path: Path) -> None:
    cache = ResultCache(tmp_path / "cache")
    task = LintRun(LintRequest()).task(song)
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
    assert cache.key(LintRun(LintRequest(want_rows=True)).task(song)) is None
    assert cache.key(LintRun(LintRequest()).task(song, b"data")) is None


def test_a_damaged_entry_is_no_result(song: Path, tmp_path: Path) -> None:
    cache = ResultCache(tmp_path / "cache")
    task = LintRun(LintRequest()).task(song)
    fresh = list(analyze_all([task], 1, cache))
    for entry in (tmp_path / "cache").glob("*/*"):
        entry.write_bytes(entry.read_bytes()[:-7])
    assert cache.get(cache.key(task) or "") is None
    assert list(analyze_all([task], 1, cache)) == fresh


def test_everything_that_a_result_can_hold_comes_back(song: Path, tmp_path: Path) -> None:
    cache = ResultCache(tmp_path / "cache")
    run = LintRun(LintRequest(suggest=True, alternatives=2, want_figures=True))
    demo = run.task(charts_path() / "two_left_feet" / "two_left_feet.ssc")
    odd = song.with_name("a\udcff\u2028.sm")
    song.rename(odd)
    for task in (demo, run.task(odd)):
        fresh = analyze_file(task)
        cache.put("k" * 64, fresh)
        kept = cache.get("k" * 64)
        assert kept == fresh
    assert any(chart.alternatives and chart.figures and chart.causes for chart in analyze_file(demo).charts)


def test_a_flipped_bit_or_a_cut_is_no_result(song: Path, tmp_path: Path) -> None:
    """One flipped bit of the pickle that was here changed the output unnoticed in 37 of 60 runs."""
    cache = ResultCache(tmp_path / "cache")
    task = LintRun(LintRequest()).task(song)
    key = cache.key(task) or ""
    cache.put(key, analyze_file(task))
    (entry,) = (tmp_path / "cache").glob("*/*")
    whole = entry.read_bytes()
    chance = random.Random(1)
    for _ in range(300):
        damaged = bytearray(whole)
        damaged[chance.randrange(len(whole))] ^= 1 << chance.randrange(8)
        entry.write_bytes(bytes(damaged) if chance.random() < 0.8 else whole[: chance.randrange(len(whole))])
        assert cache.get(key) is None
    entry.write_bytes(whole)
    assert cache.get(key) == analyze_file(task)
    assert cache.get(key[:2] + "0" * 62) is None  # nor does a result under another key


def test_a_pickle_in_a_shared_folder_does_not_run(song: Path, tmp_path: Path) -> None:
    class Evil:
        def __reduce__(self) -> tuple[object, ...]:
            return Path.touch, (tmp_path / "was here",)

    cache = ResultCache(tmp_path / "cache")
    key = cache.key(LintRun(LintRequest()).task(song)) or ""
    entry = tmp_path / "cache" / key[:2] / key[2:]
    entry.parent.mkdir(parents=True)
    entry.write_bytes(pickle.dumps(Evil()))
    assert cache.get(key) is None
    body = b'["x", "t", "a", null, [], [[1]], [], []]'  # a right checksum does not make a result of it
    head = to_bytes(analyze_file(LintRun(LintRequest()).task(song)), key)[: len(b"dancetutor result 1\n")]
    entry.write_bytes(head + hashlib.sha256(key.encode() + b"\0" + body).digest() + body)
    assert cache.get(key) is None
    assert not (tmp_path / "was here").exists()


def test_a_full_disk_leaves_nothing_behind(song: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(self: Path, target: Path) -> None:
        raise OSError(28, "No space left on device")

    cache = ResultCache(tmp_path / "cache")
    result = analyze_file(LintRun(LintRequest()).task(song))
    monkeypatch.setattr(Path, "replace", full)
    cache.put("k" * 64, result)
    assert [path for path in (tmp_path / "cache").rglob("*") if path.is_file()] == []


def test_what_could_not_be_opened_is_not_kept(tmp_path: Path) -> None:
    task = LintRun(LintRequest()).task(tmp_path / "nowhere.sm")
    cache = ResultCache(tmp_path / "cache")
    (result,) = analyze_all([task], 1, cache)
    assert result.error and not (tmp_path / "cache").exists()


def test_a_breakdown_is_not_kept(song: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Dying(SerialWorkers):
        def results(self) -> Iterator[FinishedWork]:
            yield from (FinishedWork(task.key, error=UnavailableError("killed")) for task in self._queue)

    monkeypatch.setattr("dancetutor_cli.lint.run._WORTH_WORKERS", 1)
    monkeypatch.setattr("dancetutor_cli.run.pool.open_workers", lambda jobs: Dying(no_report))
    cache = ResultCache(tmp_path / "cache")
    (result,) = analyze_all([LintRun(LintRequest()).task(song)], 2, cache)
    assert result.error and "killed" in result.error and not (tmp_path / "cache").exists()


def test_of_files_sent_together_only_the_one_that_breaks_a_worker_is_lost(
    song: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As a worker that the system kills, for it has taken too much memory: what it had in hand fails as one."""

    class Dying(SerialWorkers):
        def results(self) -> Iterator[FinishedWork]:
            while self._queue:
                task = self._queue.popleft()
                deadly = any(one.path.name == "5.sm" for one in task.arguments[0])
                error = UnavailableError("killed") if deadly else None
                yield FinishedWork(task.key, None if deadly else task.function(*task.arguments), error)

    tasks = []
    for n in range(40):
        path = song.with_name(f"{n}.sm")
        path.write_text(NOTES.format(n))
        tasks.append(LintRun(LintRequest()).task(path))
    whole = list(analyze_all(tasks, 1, None))
    monkeypatch.setattr("dancetutor_cli.run.pool.open_workers", lambda jobs: Dying(no_report))
    found = list(analyze_all(tasks, 2, None))
    assert [n for n, one in enumerate(found) if one.error] == [5] and "killed" in str(found[5].error)
    assert [*found[:5], *found[6:]] == [*whole[:5], *whole[6:]]


@pytest.mark.parametrize(("tasks", "jobs"), [(0, 2), (1, 2), (8, 2), (435, 2), (4000, 16)])
def test_files_go_to_workers_many_at_once_and_one_by_one_in_the_end(tasks: int, jobs: int) -> None:
    batches = [*_batches(tasks, jobs)]
    assert [place for batch in batches for place in batch] == list(range(tasks))
    sizes = [len(batch) for batch in batches]
    assert sizes == sorted(sizes, reverse=True) and max(sizes, default=1) <= 8
    assert all(size == 1 for size in sizes[-jobs:])
    assert len(batches) <= max(tasks / 8 + 8 * jobs * 4, 1)


def test_workers_give_the_same_in_the_same_order(song: Path) -> None:
    tasks: list[AnalyzeTask] = []
    for n in range(9):
        path = song.with_name(f"{n}.sm")
        path.write_text("nothing" if n == 4 else NOTES.format(n))
        tasks.append(LintRun(LintRequest()).task(path))
    assert list(analyze_all(tasks, 2, None)) == list(analyze_all(tasks, 1, None))


def test_a_kept_result_needs_neither_numpy_nor_numba_nor_rich(song: Path, tmp_path: Path) -> None:
    code = (
        "import sys\nfrom dancetutor_cli.__main__ import main\n"
        "try:\n    main(['analyze', sys.argv[1]])\nexcept SystemExit:\n    pass\n"
        "sys.stderr.write(' '.join({'numpy', 'llvmlite', 'numba', 'scipy', 'rich'} & set(sys.modules)))\n"
    )
    environment = {"DANCETUTOR_CACHE": str(tmp_path / "cache"), "PATH": "", "SYSTEMROOT": "C:\\Windows"}
    environment["DANCETUTOR_KERNELS"] = "compiled"
    said = [
        subprocess.run([sys.executable, "-c", code, str(song)], env=environment, capture_output=True, text=True)
        for _ in range(2)
    ]
    assert {"numpy", "llvmlite"} <= set(said[0].stderr.split())
    assert said[1].stderr == ""
    assert said[1].stdout == said[0].stdout != ""


def test_a_file_that_cannot_be_read_as_a_chart_is_kept_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    paths = [tmp_path / f"{n}.sm" for n in range(3)]
    for path in paths:
        path.write_text("no chart at all")
    cache = ResultCache(tmp_path / "cache")
    tasks = [LintRun(LintRequest()).task(path) for path in paths]
    first = list(analyze_all(tasks, 1, cache))
    monkeypatch.setattr("dancetutor_cli.lint.run.analyze_files", iter)  # nothing is left to do
    worked: list[Path] = []
    assert list(analyze_all(tasks, 1, cache, lambda task: worked.append(task.path))) == first
    assert all(result.error for result in first) and worked == []


def test_work_is_announced_once(song: Path, tmp_path: Path) -> None:
    worked: list[Path] = []
    task = LintRun(LintRequest()).task(song)
    list(analyze_all([task, task], 1, None, lambda tasks: worked.extend(one.path for one in tasks)))
    assert worked == [song, song]
