"""Charts that are looked at together say the same as each alone, however they are put together."""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from dancetutor_cli.lint import analysis
from dancetutor_cli.lint.analysis import AnalyzeTask, analyze_file, analyze_files
from dancetutor_cli.lint.results import ChartResult
from dancetutor_cli.lint.run import LintRequest, LintRun
from dancetutor_cli.lint.subject import ChartSubject
from dancetutor_cli.run.errors import FileError

pytestmark = pytest.mark.usefixtures("own_records")

KINDS = {"dance-single": 4, "dance-double": 8, "pump-single": 5}
DEMO = Path(__file__).resolve().parents[2] / "charts" / "two_left_feet" / "two_left_feet.ssc"


def rows_of(columns: int, dice: random.Random) -> Iterator[str]:
    """Rows that hold whatever a chart may hold; holds end some rows later."""
    open_holds: dict[int, int] = {}
    last = 0
    for row in range(16 * dice.randint(3, 9)):
        cells = ["0"] * columns
        for column in [column for column, end in open_holds.items() if end <= row]:
            cells[column] = "3"
            del open_holds[column]
        for _ in range(dice.choice((0, 1, 1, 1, 1, 1, 2, 3))):
            column = dice.choice((last, dice.randrange(columns), dice.randrange(columns)))
            if column not in open_holds and cells[column] == "0":
                cells[column] = dice.choice("111111111MM24F")
                last = column
                if cells[column] in "24":
                    open_holds[column] = row + dice.randint(2, 9)
        yield "".join(cells)


def song(path: Path, dice: random.Random) -> Path:
    """A file with some charts, fast ones and slow ones."""
    text = f"#TITLE:T;\n#BPMS:0={dice.choice((90, 150, 190))},8=120;\n#STOPS:12=0.5;\n"
    for number in range(dice.randint(1, 4)):
        kind = dice.choice([*KINDS])
        rows = list(rows_of(KINDS[kind], dice))
        measures = "\n,\n".join("\n".join(rows[n : n + 16]) for n in range(0, len(rows), 16))
        name = ("Easy", "Hard", "Challenge", "Edit")[number]
        text += f"#NOTES:{kind}::{name}:{dice.randint(1, 14)}::\n{measures}\n;\n"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def tasks(tmp_path_factory: pytest.TempPathFactory) -> list[AnalyzeTask]:
    folder, dice = tmp_path_factory.mktemp("songs"), random.Random(7)
    run = LintRun(LintRequest(want_figures=True, want_rows=True))
    paths = [song(folder / f"{n}.sm", dice) for n in range(9)]
    paths.insert(4, folder / "missing.sm")
    empty = folder / "empty.sm"
    empty.write_text("#TITLE:T;\n#BPMS:0=120;\n", encoding="utf-8")
    nothing = folder / "nothing.sm"
    nothing.write_text("#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-single::Hard:5::\n0000\n;\n", encoding="utf-8")
    return [run.task(path) for path in (*paths, empty, nothing, DEMO)]


@pytest.mark.parametrize("rows", [700, 10**9])
def test_windows_of_any_size_say_the_same(tasks: list[AnalyzeTask], rows: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(analysis, "_ROWS", 1)  # each chart alone
    alone = [analyze_file(task) for task in tasks]
    monkeypatch.setattr(analysis, "_ROWS", rows)
    assert list(analyze_files(tasks)) == alone
    rules = {finding.rule for result in alone for finding, _ in result.all_findings()}
    assert {"DT101", "DT201", "DT202", "DT206", "DT207", "DT213", "DT214", "DT302", "DT304", "DT305"} <= rules


@pytest.mark.parametrize("rows", [1, 700])
def test_results_come_while_other_files_wait(
    tasks: list[AnalyzeTask], rows: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A result that was kept to the end would take memory for each file of a folder."""
    monkeypatch.setattr(analysis, "_ROWS", rows)
    read: list[AnalyzeTask] = []

    def noted(task: AnalyzeTask) -> AnalyzeTask:
        read.append(task)
        return task

    waiting = [len(read) - number for number, _ in enumerate(analyze_files(map(noted, tasks)))]
    assert max(waiting) <= (1 if rows == 1 else 6)


def test_analysed_files_are_reported_before_an_error(tasks: list[AnalyzeTask], monkeypatch: pytest.MonkeyPatch) -> None:
    solve = analysis.solve_selected

    def fails(song: object, charts: object, task: AnalyzeTask) -> Iterator[object]:
        yield from solve(song, charts, task)  # type: ignore[arg-type]
        if task == tasks[2]:
            raise FileError(task.path, "is broken")

    monkeypatch.setattr(analysis, "solve_selected", fails)
    results = analyze_files([replace(task, want_rows=False) for task in tasks[:2]] + tasks[2:])
    assert [next(results).path for _ in range(2)] == [str(task.path) for task in tasks[:2]]
    with pytest.raises(FileError, match="is broken"):
        next(results)


@pytest.mark.parametrize("broken", range(8))
def test_after_a_fault_no_file_is_reported_with_charts_twice_or_missing(
    tasks: list[AnalyzeTask], broken: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    few = [replace(task, want_rows=False) for task in tasks[:4]]
    alone = [analyze_file(task) for task in few]
    told, numbers = analysis.chart_result, itertools.count()

    def fails(subject: ChartSubject, task: AnalyzeTask) -> ChartResult:
        if next(numbers) == broken:
            raise RuntimeError("a fault")
        return told(subject, task)

    monkeypatch.setattr(analysis, "chart_result", fails)
    monkeypatch.setattr(analysis, "_ROWS", 300)
    results, found = analyze_files(few), []
    with pytest.raises(RuntimeError, match="a fault"):
        for result in results:
            found.append(result)
    assert found == alone[: len(found)]
