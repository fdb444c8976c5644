"""Preset `thesis` is exact: a slow solver written from the cost-model page agrees, on real and random charts."""

from __future__ import annotations

import csv
import random
import tempfile
from fractions import Fraction
from functools import cache
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from play_reference import Reference, Row, rows_of

from dancetutor_cli.chart.model import Chart, Kind
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.chart.reader import load, parse
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.play import Play, prepare_rows
from dancetutor_cli.feet.preset import Preset, load_preset
from dancetutor_cli.feet.solver.solve import solve_chart, solve_rows
from dancetutor_cli.run.errors import DancetutorError

LETTERS = {Kind.TAP: "1", Kind.HOLD: "2", Kind.ROLL: "4", Kind.MINE: "M", Kind.LIFT: "L"}
LIMBS = {Limb.LEFT_FOOT: "L", Limb.RIGHT_FOOT: "R", Limb.LEFT_HAND: "l", Limb.RIGHT_HAND: "r"}


def reference_rows(chart: Chart) -> list[Row]:
    """The rows of a chart by the reference's own rules, from its judged notes."""
    n = chart.notes
    notes = [
        (Fraction(int(t), TICKS_PER_BEAT), int(c), LETTERS[Kind(k)], Fraction(int(e), TICKS_PER_BEAT))
        for t, c, k, e, judged in zip(n.tick, n.column, n.kind, n.end, n.judged, strict=True)
        if judged and Kind(k) in LETTERS
    ]
    return rows_of(notes, lambda beat: chart.timing.bpm_at(int(beat * TICKS_PER_BEAT)))


def ways_of(play: Play) -> list[dict[int, str]]:
    return [{c: LIMBS[Limb(v)] for c, v in enumerate(row) if v >= 0} for row in play.limb]


def assert_same(chart: Chart) -> None:
    """Same rows, same total, and the play's own path is legal and costs in each row what the play says."""
    preset = load_preset("thesis")
    rows = reference_rows(chart)
    reference = Reference(chart.steps_type)
    play = solve_chart(chart, preset)
    assert play is not None
    assert [Fraction(int(t), TICKS_PER_BEAT) for t in play.rows.tick] == [row.beat for row in rows]
    assert reference.cost_of(rows, ways_of(play)) == play.cost.sum(axis=1).tolist()
    assert play.total == reference.solve(rows)


def sampled(corpus: Path, count: int, longest: int) -> list[Chart]:
    """A fixed sample of dance charts that the slow solver gets through in time."""
    found: list[Chart] = []
    files = sorted(p for p in corpus.rglob("*") if p.suffix.lower() in (".sm", ".ssc"))
    random.Random(11).shuffle(files)
    for path in files:
        try:
            song = load(path)
        except DancetutorError:
            continue
        limit = {"dance-single": longest, "dance-double": longest // 2}
        found.extend(c for c in song.charts if len(c.notes) <= limit.get(c.steps_type, 0))
        if len(found) >= count:
            break
    return found[:count]


def test_a_few_hundred_real_charts(corpus: Path) -> None:
    chosen = sampled(corpus, 200, 700)
    assert len(chosen) == 200
    assert {c.steps_type for c in chosen} == {"dance-single", "dance-double"}
    for chart in chosen:
        assert_same(chart)


def test_every_known_cost(corpus: Path, shared_data: Path) -> None:
    preset = load_preset("thesis")
    by_file: dict[str, list[dict[str, str]]] = {}
    for row in csv.DictReader((shared_data / "charts" / "thesis_costs.csv").open()):
        by_file.setdefault(row["path"], []).append(row)
    wrong = []
    for path, rows in by_file.items():
        song = load(corpus / path)
        for row in rows:
            plays = [
                solve_chart(c, preset)
                for c in song.charts
                if (c.steps_type, str(c.meter)) == (row["steps_type"], row["meter"])
            ]
            if (int(row["rows"]), int(row["cost"])) not in [(len(p.rows), p.total) for p in plays if p]:
                wrong.append(row)
    assert wrong == []


@st.composite
def chart_text(draw: st.DrawFn, steps_type: str) -> str:
    """Note data of a few measures: taps, jumps, hands, holds, rolls and mines, more of them than real charts have."""
    columns = len(load_pad(steps_type))  # type: ignore[arg-type]
    held: list[str] = [""] * columns
    lines = []
    for _ in range(draw(st.integers(1, 4)) * 4):
        row = ""
        for column in range(columns):
            if held[column]:
                cell = draw(st.sampled_from("00003"))
                held[column] = "" if cell == "3" else held[column]
            else:
                cell = draw(st.sampled_from("0000000111M24L" if steps_type == "dance-single" else "0" * 16 + "111M24L"))
                held[column] = cell if cell in "24" else ""
            row += cell
        lines.append(row)
    lines.append("".join("3" if h else "0" for h in held))
    lines.extend(["0" * columns] * (-len(lines) % 4))
    bpm = draw(st.sampled_from(["60", "128", "171.5", "400"]))
    measures = [lines[i : i + 4] for i in range(0, len(lines), 4)]
    data = ",\n".join("\n".join(m) + "\n" for m in measures)
    return f"#OFFSET:0;#BPMS:0={bpm};\n#NOTES:{steps_type}:x:Hard:1:0:\n{data};"


@pytest.mark.parametrize("steps_type", ["dance-single", "dance-double"])
def test_random_charts(steps_type: str) -> None:
    @settings(max_examples=150, deadline=None)
    @given(chart_text(steps_type))
    def check(text: str) -> None:
        assert_same(parse(text.encode(), Path("random.sm")).charts[0])

    check()


@settings(max_examples=100, deadline=None)
@given(chart_text("dance-single"))
def test_doublesteps_forbidden(text: str) -> None:
    chart = parse(text.encode(), Path("random.sm")).charts[0]
    preset = no_doublesteps()
    pad = load_pad(chart.steps_type)
    assert pad is not None
    play = solve_rows(prepare_rows(chart, pad, 0.35), pad, preset)
    assert play.total == Reference("dance-single", allow_doublestep=False).solve(reference_rows(chart))


@cache
def no_doublesteps() -> Preset:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "strict.yaml"
        path.write_text("extends: thesis\nswitches:\n  allow-doublestep: false\n")
        return load_preset(path)


def test_the_same_play_on_every_run(corpus: Path) -> None:
    chart = sampled(corpus, 1, 700)[0]
    first, second = (solve_chart(chart, load_preset("thesis")) for _ in range(2))
    assert first is not None and second is not None
    assert (first.limb == second.limb).all()
    assert (first.facing == second.facing).all()
