"""--alternatives, causes of doublesteps, kinds of ties: what is told is true when the chart is solved anew."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from dancetutor_cli.chart.reader import parse
from dancetutor_cli.commands.analyze import command
from dancetutor_cli.feet.limbs import MEANING
from dancetutor_cli.feet.overrides import Overrides
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solver.solve import solve_chart
from dancetutor_cli.lint.figures import alternatives_of, causes_of, with_causes
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.subject import ChartSubject

ROOT = Path(__file__).resolve().parent.parent.parent
DEMO = ROOT / "charts" / "two_left_feet" / "two_left_feet.ssc"
PRESET = load_preset("itg")


def subject(rows: list[str]) -> ChartSubject:
    notes = "\n".join(rows)
    song = parse(f"#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-single::Hard:9::\n{notes}\n;\n".encode(), Path("x.sm"))
    play = solve_chart(song.charts[0], PRESET, margins=True)
    return ChartSubject(song, song.charts[0], play, load_pad("dance-single"))


def cost_with(chart: ChartSubject, letters: dict[float, str]) -> int:
    """What the chart costs when these rows are stepped by these limbs."""
    cells = {}
    for beat, row in letters.items():
        tick = round(beat * 48)
        columns = sorted(chart.chart.notes.column[chart.chart.notes.tick == tick].tolist())
        for column, letter in zip(columns, row, strict=True):
            cells[tick, column] = tuple(map(int, MEANING[letter]))
    play = solve_chart(chart.chart, PRESET, Overrides.of(cells))
    assert play is not None
    return play.total


def _letter(chart: ChartSubject, row: int) -> str:
    assert chart.play is not None
    return "LR"[int(chart.play.limb[row].max())]


def test_another_play_costs_what_it_is_said_to() -> None:
    rows = ["1000", "0010", "0001", "0010", "0100", "1000", "0001", "0001"]
    chart = subject(rows)
    assert chart.play is not None
    found = alternatives_of(chart, PRESET, 6)
    assert len(found) == 6 and [one.extra for one in found] == sorted(one.extra for one in found)
    for one in found:
        assert one.extra == sum(cost for _, cost in one.terms)
        assert [abs(cost) for _, cost in one.terms] == sorted((abs(cost) for _, cost in one.terms), reverse=True)
        letters = {beat / 2: _letter(chart, beat) for beat in range(len(rows))}
        for run in one.runs:
            beats = [run.first_beat + n / 2 for n in range(len(run.other.split(" ")))]
            assert beats[-1] == run.last_beat and run.best != run.other
            letters |= dict(zip(beats, run.other.split(" "), strict=True))
        assert cost_with(chart, letters) == chart.play.total + one.extra


def test_no_other_play_and_no_chart() -> None:
    assert alternatives_of(subject(["0000"]), PRESET, 3) == ()
    assert alternatives_of(subject(["1000"]), PRESET, 0) == ()


def test_the_command_reports_them_in_text_and_json() -> None:
    options = [str(DEMO), "--index", "3", "--alternatives", "2", "--exit-zero"]
    text = CliRunner().invoke(command, options, standalone_mode=False).stdout
    assert "the next best feet:" in text and text.count(" instead of ") >= 2
    found = json.loads(CliRunner().invoke(command, [*options, "--format", "json"], standalone_mode=False).stdout)
    (chart,) = found["files"][0]["charts"]
    assert len(chart["alternatives"]) == 2 and set(chart["alternatives"][0]) == {"extra", "terms", "runs"}


def test_a_doublestep_is_reported_with_what_makes_it() -> None:
    chart = subject(["2000", "0100", "0010", "0001", "3000", "0000", "0000", "0000"])
    causes = causes_of(chart, PRESET)
    assert [(cause.beat, cause.forced, cause.cause, cause.at_beat, cause.column) for cause in causes] == [
        (1.0, True, "hold", 0.0, 0), (1.5, True, "hold", 0.0, 0),
    ]  # fmt: skip
    finding = Finding("DT201", "doublestep", "warning", "twice", 1, 1, 0, 1.0)
    other = Finding("DT202", "spin", "warning", "round", 1, 1, 0, 1.0)
    told = with_causes([finding, other], causes, ("left", "down", "up", "right"))
    assert [one.message for one in told] == ["twice, because of the hold on beat 0 (left)", "round"]


def test_the_cause_of_a_doublestep_is_printed() -> None:
    words = [str(DEMO), "--difficulty", "hard", "--steps-type", "dance-single", "--select", "DT201", "--full"]
    told = [CliRunner().invoke(command, [*words, *more], standalone_mode=False).stdout for more in ((), ("--suggest",))]
    forced = [line for line in told[1].splitlines() if line.startswith("forced doublestep")]
    assert "forced doublestep on beat 21: the other foot is on the hold from beat 20 ←" in forced
    assert "forced doublestep on" not in told[0]


@pytest.mark.parametrize(
    ("rows", "beat", "kind"),
    [(["1001", "0000", "0100", "1001"], 2.0, "resolved"), (["0100", "0010", "0100", "0010"], 0.0, "open")],
)
def test_ties_are_of_two_kinds(rows: list[str], beat: float, kind: str, tmp_path: Path) -> None:
    path = tmp_path / "x.sm"
    notes = "\n".join(rows)
    path.write_text(f"#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-single::Hard:9::\n{notes}\n;\n")
    result = CliRunner().invoke(command, [str(path), "--format", "json", "--exit-zero"], standalone_mode=False)
    (chart,) = json.loads(result.stdout)["files"][0]["charts"]
    assert {"beat": beat, "kind": kind} in chart["ambiguous"]
