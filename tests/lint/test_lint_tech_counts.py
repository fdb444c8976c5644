"""The columns of --format csv, counted a second time from the JSON rows, row by row as ITGmania goes through them."""

from __future__ import annotations

import csv
import io
import json
from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

import pytest

from dancetutor_cli.chart.model import Kind
from dancetutor_cli.chart.reader import load, parse
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.feet.overrides import Overrides
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.preset import PresetChoice, load_preset
from dancetutor_cli.feet.solver.solve import solve_chart
from dancetutor_cli.lint.analysis import AnalyzeTask, analyze_file
from dancetutor_cli.lint.configuration import load_configuration
from dancetutor_cli.lint.figures import tech_counts
from dancetutor_cli.lint.findings import TECH_COUNTS
from dancetutor_cli.lint.subject import ChartSubject
from dancetutor_cli.reports.analyze_formats import Output, Tally
from dancetutor_cli.reports.data_formats import CsvReport

# Columns of a pad: x of its panel, and the way its arrow points.
PADS = {"dance-single": [(-1, "L"), (0, "D"), (0, "U"), (1, "R")]}
STEPS = {Kind.TAP, Kind.HOLD, Kind.ROLL, Kind.LIFT}
PADS["dance-double"] = [*PADS["dance-single"], *((x + 3, way) for x, way in PADS["dance-single"])]


class Row:
    """A row as the game keeps it: which foot is on which column, heels and toes."""

    def __init__(self, row: Mapping[str, Any], pad: Sequence[tuple[int, str]]) -> None:
        self.second: float = row["second"]
        steps = [step for step in row["steps"] if step["kind"] != "roll_tap"]
        self.count = len(steps)
        self.foot = {s["column"]: s["limb"] for s in steps if s["limb"] in ("left_foot", "right_foot")}
        feet = set(self.foot.values())
        self.heel = {limb: c for limb in feet for c, _ in self._of(limb, steps, toe=False)}
        self.toe = {limb: c for limb in self.heel for c, _ in self._of(limb, steps, toe=True)}
        self.x = {limb: pad[column][0] for limb, column in self.heel.items()}
        for limb, column in self.toe.items():
            self.x[limb] = (self.x[limb] + pad[column][0]) / 2
        self.moves = row["moves"]

    @staticmethod
    def _of(limb: str, steps: Sequence[Any], *, toe: bool) -> list[tuple[int, str]]:
        return [(s["column"], limb) for s in steps if s["limb"] == limb and (s["part"] == "toe") == toe]


def counted(json_rows: Sequence[Mapping[str, Any]], steps_type: str) -> Counter[str]:
    """The game's counts, written as a loop over rows."""
    pad = PADS[steps_type]
    rows = [Row(row, pad) for row in json_rows if any(s["kind"] != "roll_tap" for s in row["steps"])]
    found: Counter[str] = Counter({"Brackets": sum(len(row.toe) for row in rows[1:])})
    for i, row in enumerate(rows):
        if i == 0:
            continue
        before = rows[i - 1]
        elapsed = int((row.second - before.second) * 1000 + 0.5 + 1e-6)  # milliseconds, half up
        if row.count == before.count == 1 and set(row.heel) & set(before.heel):
            (now,), (then,) = row.heel.values(), before.heel.values()
            if now == then and elapsed < 176:
                found["Jacks"] += 1
            if now != then and elapsed < 235:
                found["Doublesteps"] += 1
                found["ForcedDoublesteps" if "forced-doublestep" in row.moves else "UnforcedDoublesteps"] += 1
        for column, foot in row.foot.items():
            if before.foot.get(column, foot) != foot and elapsed < 300:
                way = pad[column][1]
                total = "Footswitches" if way in "UD" else "Sideswitches"
                found[total] += 1
                found[{"U": "Up", "D": "Down", "L": "Left", "R": "Right"}[way] + total] += 1
        for foot, other in (("right_foot", "left_foot"), ("left_foot", "right_foot")):
            if foot not in row.heel or foot in before.heel or other not in before.heel:
                continue
            side = 1 if foot == "right_foot" else -1
            if row.x[foot] * side >= before.x[other] * side:
                continue
            earlier = rows[i - 2] if i > 1 else None
            if earlier is None:
                kind = "Half"
            elif foot not in earlier.heel or earlier.heel[foot] == row.heel[foot]:
                continue
            else:
                kind = "Full" if pad[earlier.heel[foot]][0] * side > before.x[other] * side else "Half"
            found[f"{kind}Crossovers"] += 1
            found["Crossovers"] += 1
    return found


def nps_and_breakdown(song_path: Path, index: int) -> tuple[float, str]:
    """Steps a second over all, and the streams, from the notes alone."""
    chart = load(song_path).charts[index]
    notes = chart.notes
    ticks = sorted({t for t, k, j in zip(notes.tick.tolist(), notes.kind.tolist(), notes.judged.tolist(), strict=True)
                    if k in STEPS and j})  # fmt: skip
    if len(ticks) < 2:
        return 0.0, ""
    first, last = chart.timing.seconds(notes.tick[[0, 0]] * 0 + [ticks[0], ticks[-1]])
    per_measure = Counter(tick // 192 for tick in ticks)
    words = []
    for dense, group in groupby(range(max(per_measure) + 1), lambda m: per_measure[m] >= 16):
        length = len(list(group))
        words.append(str(length) if dense else f"({length})")
    text = " ".join(words)
    while text.startswith("("):
        text = text.partition(") ")[2] if ") " in text else ""
    if text.endswith(")"):
        text = text.rpartition(" (")[0]
    return (len(ticks) - 1) / (last - first), text


def test_real_charts_are_counted_the_same_from_their_json(corpus: Path) -> None:
    settings = load_configuration(None).settings
    sums: Counter[str] = Counter()
    breakdowns = 0
    for path in sorted(corpus.rglob("*.sm"))[::9]:
        which = Selection("dance-single,dance-double")
        result = analyze_file(AnalyzeTask(path, PresetChoice(), which, settings, want_rows=True, want_figures=True))
        for chart in result.charts:
            assert chart.rows is not None
            expected = counted(json.loads(chart.rows), chart.steps_type)
            assert chart.figures is not None and dict(chart.figures.tech) == {
                name: expected[name] for name in TECH_COUNTS
            }, (path.name, chart.label)
            mean, breakdown = nps_and_breakdown(path, chart.index)
            assert chart.figures.nps_mean == pytest.approx(mean, abs=1e-6)
            assert chart.figures.breakdown == breakdown
            sums.update(expected)
            breakdowns += "(" in breakdown
    assert all(sums[name] for name in TECH_COUNTS) and breakdowns, sums  # every column was put to the test


def tech(rows: Sequence[str], feet: str, *, bpm: int = 150, quant: int = 8, offset: str = "0") -> dict[str, int]:
    """Counts of a chart whose rows are 8ths and whose feet are laid down; "(LR)" is one row."""
    measures = [
        [*rows[n : n + quant], *["0000"] * (quant - len(rows[n : n + quant]))] for n in range(0, len(rows), quant)
    ]
    notes = "\n,\n".join("\n".join(measure) for measure in measures)
    song = parse(
        f"#TITLE:T;\n#OFFSET:{offset};\n#BPMS:0={bpm};\n#NOTES:dance-single::Hard:9::\n{notes}\n;\n".encode(),
        Path("x.sm"),
    )
    chart, letters, cells = song.charts[0], iter(feet), {}
    for number, row in enumerate(rows):
        for column in (c for c, note in enumerate(row) if note != "0"):
            letter = next(letters)
            cells[number * 192 // quant, column] = ("LR".index(letter.upper()), 2 if letter.islower() else 0)
    play = solve_chart(chart, load_preset("itg"), Overrides.of(cells))
    found = tech_counts(ChartSubject(song, chart, play, load_pad("dance-single")))
    return {name: number for name, number in found.items() if number}


L, D, U, R = "1000", "0100", "0010", "0001"


@pytest.mark.parametrize(
    ("rows", "feet", "expected"),
    [
        ([L, R, L, R], "LRLR", {}),
        # From its own side past the other foot: full. From the middle: half.
        ([R, D, L, D, R], "RLRLR", {"Crossovers": 1, "FullCrossovers": 1}),
        ([U, D, L, D, R], "RLRLR", {"Crossovers": 1, "HalfCrossovers": 1}),
        # The feet stay crossed for five rows: the left foot has crossed once, and the right foot once more.
        ([L, D, R, D, R, D, L], "LRLRLRL", {"Crossovers": 1, "FullCrossovers": 1}),
        ([L, D, D, R], "LRLR", {"Footswitches": 1, "DownFootswitches": 1}),
        ([L, U, U, R], "LRLR", {"Footswitches": 1, "UpFootswitches": 1}),
        ([U, L, L, R], "RLRL", {"Sideswitches": 1, "LeftSideswitches": 1, "Crossovers": 1, "HalfCrossovers": 1}),
        ([L, D, U, R], "LRRL", {"Doublesteps": 1, "UnforcedDoublesteps": 1}),
    ],
)  # fmt: skip
def test_small_charts(rows: list[str], feet: str, expected: dict[str, int]) -> None:
    assert tech(rows, feet) == expected


def test_slow_steps_count_for_nothing() -> None:
    assert tech([L, L], "LL", bpm=200) == {"Jacks": 1}
    assert tech([L, L], "LL", bpm=120) == {}
    assert "Doublesteps" not in tech([L, D], "LL", bpm=120)
    assert "Footswitches" not in tech([L, D, D], "LRL", bpm=90)


@pytest.mark.parametrize("offset", ["0", "7.123", "-33.333", "0.009"])
def test_the_offset_changes_no_count(offset: str) -> None:
    """At 100 BPM 8ths are 0.3 s apart, exactly the limit of a footswitch."""
    assert "Footswitches" not in tech([L, D, D, R, U, U, L], "LRLRLRL", bpm=100, offset=offset)


def test_a_bracket_counts_for_its_foot() -> None:
    assert tech([R, "1100", R], "RLlR") == {"Brackets": 1}


def test_the_first_row_is_no_bracket_as_in_the_game() -> None:
    assert tech(["1100", R], "LlR") == {}


def test_the_table_has_the_counts(tmp_path: Path) -> None:
    path = tmp_path / "x.sm"
    path.write_text(
        "#TITLE:T;\n#BPMS:0=200;\n#NOTES:dance-single::Hard:9::\n1000\n1000\n1000\n1000\n1000\n1000\n1000\n1000\n;\n"
    )
    result = analyze_file(
        AnalyzeTask(path, PresetChoice(), Selection(), load_configuration(None).settings, want_figures=True)
    )
    stream = io.StringIO()
    report = CsvReport(Output(stream, io.StringIO()))
    report.begin()
    report.add(result)
    report.end(Tally())
    line = next(csv.DictReader(io.StringIO(stream.getvalue())))
    assert set(TECH_COUNTS) <= set(line)
    assert [line["Jacks"], line["Crossovers"], line["rows"]] == ["7", "0", "8"]
    assert float(line["nps_mean"]) == pytest.approx(1 / 0.15, abs=1e-3)


def test_hands_are_those_of_dt302(tmp_path: Path) -> None:
    """Three panels down, though the feet bracket two of them."""
    path = tmp_path / "x.sm"
    path.write_text("#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-single::Easy:3::\n1000\n0100\n1101\n0000\n;\n")
    task = AnalyzeTask(path, PresetChoice(), Selection(), load_configuration(None).settings, want_figures=True)
    result = analyze_file(task)
    assert [finding.rule for finding in result.charts[0].findings].count("DT302") == 1
    stream = io.StringIO()
    report = CsvReport(Output(stream, io.StringIO()))
    report.begin()
    report.add(result)
    assert next(csv.DictReader(io.StringIO(stream.getvalue())))["Hands"] == "1"
