"""StepManiaX: its pads, the feet on them, notes that only it writes, real charts."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from play_rows import letters, pad_of, rows_of

from dancetutor_cli.chart.model import Chart, Kind
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.chart.timing import Timing
from dancetutor_cli.dance.bake import bake
from dancetutor_cli.dance.quality.report import report
from dancetutor_cli.feet.annotations import step_rows
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.preset import default_preset, load_preset
from dancetutor_cli.feet.solver.solve import solve_chart, solve_rows

SMX, ITG = load_preset("smx"), load_preset("itg")
_OF_DANCE = [0, 1, 3, 4]  # the columns of smx-single that dance-single has


def read(*rows: str, steps_type: str = "smx-single", suffix: str = ".sm") -> Chart:
    text = f"#TITLE:T;#BPMS:0=120;#NOTES:{steps_type}::Hard:16::\n" + "\n".join(rows) + "\n;"
    return parse(text.encode(), Path(f"x{suffix}")).charts[0]


def cells(chart: Chart) -> list[tuple[int, int, str, int]]:
    """(row of eight, column, kind, row of the end) of every note; an end of -24 ticks is none."""
    notes = chart.notes
    found = zip(notes.tick.tolist(), notes.column.tolist(), notes.kind.tolist(), notes.end.tolist(), strict=True)
    return [(tick // 24, column, Kind(kind).name, end // 24) for tick, column, kind, end in found]


@pytest.mark.parametrize("steps_type", ["smx-beginner", "smx-single", "smx-double6", "smx-double10"])
def test_its_pads_have_a_preset(steps_type: str) -> None:
    assert default_preset(steps_type) == "smx" and SMX.is_for(steps_type)
    assert not SMX.is_for("dance-single") and not ITG.is_for(steps_type)


_ROWS = st.lists(st.tuples(*[st.sampled_from("......1112M4")] * 4), min_size=1, max_size=24)


@settings(max_examples=60, deadline=None)
@given(_ROWS, st.sampled_from([12, 24, 96]))
def test_without_its_middle_panel_the_feet_are_those_of_dance(drawn: list[tuple[str, ...]], gap: int) -> None:
    dance, middle = [], []
    for row in drawn:
        word = "".join(row).replace("2", "1")
        dance.append(word)
        middle.append(f"{word[:2]}.{word[2:]}")
    one = solve_rows(rows_of(" ".join(dance), gap), pad_of("dance-single"), ITG)
    five = solve_rows(rows_of(" ".join(middle), gap), pad_of("smx-single"), SMX)
    assert five.total == one.total and one.limb.tolist() == five.limb[:, _OF_DANCE].tolist()
    assert (five.limb[:, 2] == Limb.NONE).all()


def test_either_foot_takes_the_middle_panel() -> None:
    pad = pad_of("smx-single")
    stream = letters(solve_rows(rows_of("1.... ....1 ..1.. ....1 1.... ..1.. 1...."), pad, SMX))
    assert stream == "L.... ....R ..L.. ....R L.... ..R.. L...."
    both = solve_rows(rows_of("2.... ..1.1 3...."), pad, SMX)
    assert "bracket" in both.moves[1]  # the middle panel and a side one, heel and toe


def test_two_letters_are_one_note() -> None:
    rows = ("00200", "00000", "00DL01", "00000", "DM0001", "00000", "30000", "00001")
    chart = read(*rows)
    assert cells(chart) == [
        (0, 2, "HOLD", 2), (2, 4, "TAP", -1), (4, 0, "MINE", -1), (4, 4, "TAP", -1), (6, 0, "MINE", -1),
        (7, 4, "TAP", -1),
    ]  # fmt: skip
    assert not chart.warnings
    text = b"#TITLE:T;#BPMS:0=120;#NOTES:smx-single::Hard:16::\n" + "\n".join(rows).encode() + b"\n;"
    written = step_rows(text, chart)
    assert np.argwhere(written.steps).tolist() == [[0, 2], [1, 4], [2, 4], [3, 4]]


def test_other_games_are_reported() -> None:
    (warning,) = read("2000", "0000", "DL000", "0001", steps_type="dance-single").warnings
    assert warning.code == "stepmaniax-note" and "1 row" in warning.message
    assert "unmatched-head" in {one.code for one in read("2000", "0000", "D000", "0001").warnings}


def test_editors_have_names_of_their_own_for_its_modes() -> None:
    assert read("100000", steps_type="smx-dual").steps_type == "smx-double6"
    assert read("1000000000", steps_type="SMX-Full").steps_type == "smx-double10"


def test_a_team_of_two_stands_on_both_pads() -> None:
    chart = read("1000000000", "0000000000", "&", "0000000001", "0000000000", steps_type="smx-team")
    assert [part.steps_type for part in chart.players] == ["smx-double10"] * 2
    assert [part.notes.column.tolist() for part in chart.players] == [[0], [9]]


def test_every_panel_is_pressed_when_the_chart_says() -> None:
    rows = "1.... ....1 ..1.. .1... ...1. ..1.. 1...1 ..1.. 2.... ..1.. ....1 3.... ..1.. .1.1. ..1.. 1...."
    play = solve_rows(rows_of(rows, 48), pad_of("smx-single"), SMX)
    motion = bake(Timing(((0, 140),)), play, pad_of("smx-single"))
    errors = report(motion).contact_errors
    assert len(errors) == (play.limb >= 0).sum() and np.abs(errors).max() < 1.0


def test_real_charts_have_feet(corpus: Path) -> None:
    files = sorted(corpus.rglob("*.ssc"))
    songs = [parse(path.read_bytes(), path) for path in files if b"smx-" in path.read_bytes()]
    charts = [chart for song in songs for chart in song.charts]
    assert len(charts) == 20
    for chart in charts:
        play = solve_chart(chart, SMX)
        assert play is not None and not [names for names in play.moves if "unplayable" in names]
