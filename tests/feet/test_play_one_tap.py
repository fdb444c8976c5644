"""One tap elsewhere: what is solved anew around it is what solving the edited rows whole gives, to the tie."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from dancetutor_cli.chart.model import Chart
from dancetutor_cli.chart.reader import load, parse
from dancetutor_cli.feet.overrides import Overrides
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.play import Rows, StepKind, prepare
from dancetutor_cli.feet.preset import default_preset, load_preset
from dancetutor_cli.feet.solver.engine import Engine, engine_for
from dancetutor_cli.feet.solver.solve import OneTap, forced_limbs, move_tap
from dancetutor_cli.feet.solver.store import BASE, MOVES
from dancetutor_cli.run.reading import charts_path

DEMO = charts_path() / "two_left_feet" / "two_left_feet.ssc"


def edits_of(rows: Rows) -> list[tuple[int, int, int]]:
    """Every tap and every column without step, mine or hold in its row."""
    found, ends = [], np.full(rows.steps.shape[1], -1)
    for row in range(len(rows)):
        ends = np.maximum(ends, rows.hold_end[row])
        free = (rows.steps[row] == StepKind.NONE) & ~rows.mines[row] & (ends < rows.tick[row])
        for column in np.flatnonzero(rows.steps[row] == StepKind.TAP).tolist():
            found += [(row, column, to) for to in np.flatnonzero(free).tolist()]
    return found


def assert_same(engine: Engine, rows: Rows, overrides: Overrides | None = None, every: int = 1) -> int:
    """Compare with whole solves; how many edits were shorter than the rows."""
    one = OneTap(engine, rows, lambda edited: forced_limbs(edited, overrides))
    _, _, path = engine.solved(rows, forced_limbs(rows, overrides))
    short = 0
    for row, column, to in edits_of(rows)[::every]:
        said = one.outline_with(row, column, to)
        edited = move_tap(rows, row, column, to)
        _, nodes, whole = engine.solved(edited, forced_limbs(edited, overrides))
        events = engine.events(path)
        events[said.first : said.first + len(said.events)] = said.events
        assert said.total == nodes.row[len(rows), BASE], (row, column, to)
        assert events.tolist() == engine.events(whole).tolist(), (row, column, to)
        short += len(said.events) < len(rows) // 2
    return short


def rows_of(chart: Chart, preset: str) -> tuple[Engine, Rows]:
    pad, chosen = load_pad(chart.steps_type), load_preset(preset)
    assert pad is not None
    return engine_for(pad, chosen), prepare(chart, pad, chosen.roll_window)


@pytest.mark.parametrize("preset", ["itg", "thesis", "pump"])
def test_every_edit_is_what_the_whole_solve_says(preset: str) -> None:
    short = 0
    for chart in load(DEMO).charts:
        short += assert_same(*rows_of(chart, preset), every=7)
    assert short > 50  # and it is not the whole that is solved


def test_rolls_and_holds_make_others_of_the_rows_around() -> None:
    """A tap that cuts a roll short, or stands in one, changes the rows before it."""
    notes = "4000\n0010\n0100\n3001\n,\n2000\n0010\n3100\n0001\n,\n4010\n0100\n0010\n0100\n,\n3000\n0001\n1000\n0010"
    song = parse(f"#TITLE:T;\n#BPMS:0=90;\n#NOTES:dance-single::Hard:9::\n{notes}\n;\n".encode(), Path("x.sm"))
    engine, rows = rows_of(song.charts[0], "itg")
    taps = np.argwhere(rows.steps == StepKind.ROLL_TAP)
    assert len(taps) > 3
    assert_same(engine, rows)
    for row, column in taps.tolist():  # a tap in the midst of a roll, that goes elsewhere
        steps = rows.steps.copy()
        steps[row, column] = StepKind.TAP
        assert_same(engine, replace(rows, steps=steps))


def test_feet_that_people_laid_down_are_kept() -> None:
    chart = load(DEMO).charts[0]
    engine, rows = rows_of(chart, "itg")
    row = np.arange(3, len(rows), 5)
    column = rows.steps[row].argmax(axis=1)
    cells = zip(rows.tick[row].tolist(), column.tolist(), strict=True)
    overrides = Overrides.of({cell: (n % 2, 0) for n, cell in enumerate(cells)})
    assert_same(engine, rows, overrides, every=5)


def test_tables_that_start_again_are_no_matter() -> None:
    """A long run empties the solver's tables; what was known of the rows is then solved again."""
    chart = load(DEMO).charts[0]
    pad, preset = load_pad(chart.steps_type), load_preset("itg")
    assert pad is not None
    engine = Engine(pad, preset)
    rows = prepare(chart, pad, preset.roll_window)
    one = OneTap(engine, rows, lambda _: None)
    edit = next(edit for edit in edits_of(rows) if edit[0] > 20)
    before, era = one.outline_with(*edit), engine.era
    engine.tables.counts[MOVES] = 3_000_000
    after = one.outline_with(*edit)
    assert engine.era == era + 1
    assert (after.total, after.first, after.events.tolist()) == (before.total, before.first, before.events.tolist())


def test_real_charts(corpus: Path) -> None:
    files = sorted(path for path in corpus.rglob("*") if path.suffix.lower() in (".sm", ".ssc"))[::45]
    short = 0
    for path in files:
        for chart in load(path).charts[:2]:
            if load_pad(chart.steps_type) is not None:
                short += assert_same(*rows_of(chart, default_preset(chart.steps_type)), every=97)
    assert short > 10
