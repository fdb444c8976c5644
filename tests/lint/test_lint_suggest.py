"""Suggestions: the edit is applied to the file by this test, and the finding is gone."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from dancetutor_cli.chart.reader import load, parse
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.preset import PresetChoice, load_preset
from dancetutor_cli.feet.solver.engine import Engine, engine_for
from dancetutor_cli.feet.solver.solve import solve_chart
from dancetutor_cli.feet.solver.vocabulary import EVENTS
from dancetutor_cli.lint.analysis import AnalyzeTask, analyze_file
from dancetutor_cli.lint.check import check_chart
from dancetutor_cli.lint.configuration import load_configuration
from dancetutor_cli.lint.results import FileResult
from dancetutor_cli.lint.subject import solved_chart
from dancetutor_cli.lint.suggest import _Edited, _taps
from dancetutor_cli.run.reading import charts_path

SETTINGS = load_configuration(None).settings
PANELS = ("left", "down", "up", "right")
# Left, down, right crossed, and on round to up: a spin.
SPIN = ["1000", "0100", "0001", "0010", "1000", "0100", "0010", "0001"]


def analysed(rows: list[str], folder: Path, *, suggest: bool = True) -> FileResult:
    path = folder / "x.sm"
    notes = "\n".join(rows)
    path.write_text(f"#TITLE:T;\n#ARTIST:A;\n#CREDIT:C;\n#BPMS:0=120;\n#NOTES:dance-single:C:Hard:9::\n{notes}\n;\n")
    settings = load_configuration(None).settings
    return analyze_file(AnalyzeTask(path, PresetChoice(load_preset("thesis")), Selection(), settings, suggest=suggest))


def test_the_suggested_edit_removes_the_finding_and_brings_no_other(tmp_path: Path) -> None:
    first = analysed(SPIN, tmp_path).charts[0]
    before = first.findings
    spins = [finding for finding in before if finding.rule == "DT202"]
    assert len(spins) == 1 and spins[0].suggestion
    beat, away, to = re.fullmatch(r"move the note on beat (\S+) from (\w+) to (\w+)", spins[0].suggestion).groups()
    row = int(float(beat) * 2)  # eight rows in the measure
    cells = list(SPIN[row])
    assert cells[PANELS.index(away)] == "1" and cells[PANELS.index(to)] == "0"
    cells[PANELS.index(away)], cells[PANELS.index(to)] = "0", "1"
    edited = analysed([*SPIN[:row], "".join(cells), *SPIN[row + 1 :]], tmp_path).charts[0]
    after = edited.findings
    assert edited.cost < first.cost  # "better" is better
    assert "DT202" not in [finding.rule for finding in after]
    assert {f.rule for f in after} <= {f.rule for f in before}


def test_no_note_goes_where_a_hold_or_roll_is_or_ends() -> None:
    notes = "2010\n0100\n3001\n0010\n0400\n0010\n0300\n0001"
    song = parse(f"#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-single::Hard:9::\n{notes}\n;\n".encode(), Path("x.sm"))
    chart = song.charts[0]
    play = solve_chart(chart, load_preset("thesis"))
    for beat, taken in ((1.0, {0, 3}), (0.5, {0, 1}), (2.5, {1, 2}), (3.0, {1})):
        edits = [edit for edit in _taps(beat, play, chart) if play.rows.tick[edit.row] == round(beat * 48)]
        assert not {edit.to for edit in edits} & taken
    assert edits == []  # no tap stands in the row of a tail


def test_nothing_is_suggested_unless_asked(tmp_path: Path) -> None:
    assert all(f.suggestion is None for f in analysed(SPIN, tmp_path, suggest=False).charts[0].findings)


def test_the_file_stays_as_it_is(tmp_path: Path) -> None:
    analysed(SPIN, tmp_path)
    assert "\n".join(SPIN) in (tmp_path / "x.sm").read_text()


def test_an_edit_is_tried_once_and_rules_look_at_the_cheapest_only(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """--suggest cost 19 times the run, for every edit of every finding was solved and checked whole."""
    from dancetutor_cli.lint import suggest

    tried: list[object] = []
    checked: list[object] = []
    solved, subject_after = Engine.cost_and_events, suggest._Trial._subject_after
    monkeypatch.setattr(
        Engine, "cost_and_events",
        lambda self, rows, forced: (tried.append(rows.steps.tobytes()), solved(self, rows, forced))[1],
    )  # fmt: skip
    monkeypatch.setattr(
        suggest._Trial, "_subject_after", lambda self, edit: (checked.append(edit), subject_after(self, edit))[1]
    )
    result = analysed([*SPIN, *SPIN, *SPIN, *SPIN], tmp_path)
    assert sum(finding.suggestion is not None for finding, _ in result.all_findings()) >= 2
    assert len(checked) == len(set(checked)) <= 2  # the same edit mends all of them
    analysed(SPIN, tmp_path)
    assert 1 < len(tried) == len(set(tried))


def test_rules_are_asked_until_one_decides(tmp_path: Path) -> None:
    """First the rule that is to fall silent; and none any more when one has told what nobody told before."""
    path = tmp_path / "x.sm"
    notes = "\n".join([*SPIN, *SPIN])
    path.write_text(f"#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-single::Hard:9::\n{notes}\n;\n")
    song, settings = load(path), load_configuration(None).settings
    subject = solved_chart(song, song.charts[0], load_preset("thesis"))
    spin = next(finding for finding in check_chart(subject, settings) if finding.rule == "DT202")
    edited = _Edited(subject, settings, {("DT202", spin.beat)})
    asked = len(edited._to_ask)
    assert not edited.is_improved(("DT202", spin.beat))
    assert len(edited._to_ask) == asked - 1 and "DT202" not in edited._to_ask
    assert not edited.is_improved(("DT201", 0.0))  # the other spins are new to it
    assert len(edited._to_ask) == asked - 1
    other = _Edited(subject, settings, set())
    assert not other.is_improved(("DT209", 0.0)) and other._to_ask


@pytest.mark.parametrize("preset", ["itg", "thesis", "pump"])
def test_the_outline_of_a_way_is_that_of_the_whole_solve(preset: str) -> None:
    """What edits are judged by first: the whole cost, and whether a move still happens in a row."""
    for chart in load(charts_path() / "two_left_feet" / "two_left_feet.ssc").charts:
        pad, chosen = load_pad(chart.steps_type), load_preset(preset)
        play = solve_chart(chart, chosen)
        assert pad is not None and play is not None
        engine = engine_for(pad, chosen)
        cost, events = engine.cost_and_events(play.rows)
        assert cost == play.total
        for name in ("doublestep", "spin"):
            bit = EVENTS.index(name)
            assert (events >> bit & 1).tolist() == [name in moves for moves in play.moves]
