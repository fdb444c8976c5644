"""Charts for two: each player's notes and rows, feet, findings and fixes, and markers of both in the file."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from dancetutor_cli.chart.edits import apply
from dancetutor_cli.chart.model import Chart
from dancetutor_cli.chart.players import player_charts, written_parts
from dancetutor_cli.chart.reader import parse
from dancetutor_cli.commands import cli
from dancetutor_cli.feet.annotations import step_rows
from dancetutor_cli.feet.limbs import Limb
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.song_feet import SongFeet
from dancetutor_cli.lint.analysis import analyze_file
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.fix_edits import move_notes
from dancetutor_cli.lint.run import LintRequest, LintRun
from dancetutor_cli.lint.subject import solved_chart
from dancetutor_cli.lint.suggest import MovedNote, Suggestion
from dancetutor_cli.run.errors import UsageError

HEAD = "#TITLE:T;\n#ARTIST:A;\n#CREDIT:C;\n#OFFSET:0;\n#BPMS:0=120;\n"
FIRST = "10000000\n01000000\n00010000\n00100000\n,\n10000000\n00010000\n10000000\n00010000\n"
SECOND = "00001000\n00000001\n00001000\n00000010\n,\n00000100\n00000001\n00000110\n00000000\n"
COUPLE = "10001000\n0100[7]0100\n0001M001\n20100210\n,\n00000000\n30000300\n00011000\n1000000\n"


# Two players' notes in the same rows, told apart by their letters; in the second row they stand crosswise.
MARKED = "X00000000Y\n000Y0X0000\n00X0000Y00\n0000X00000\n,\n0X00Y00000\n0000000Y00\n00X00000Y0\n0000000000\n"


def block(kind: str, notes: str) -> str:
    return f"#NOTES:\n     {kind}:\n     :\n     Hard:\n     9:\n     0,0,0,0,0:\n{notes};\n"


def chart_of(kind: str, notes: str, markers: str = "") -> Chart:
    return parse((HEAD + block(kind, notes)).encode(), Path("x.sm")).charts[0]


def cells(chart: Chart) -> list[tuple[int, int, int]]:
    notes = chart.notes
    return list(zip(notes.tick.tolist(), notes.column.tolist(), notes.kind.tolist(), strict=True))


def test_a_couple_has_a_pad_each_and_half_of_the_columns() -> None:
    chart = chart_of("dance-couple", COUPLE)
    first, second = player_charts(chart)
    assert [one.steps_type for one in (first, second)] == ["dance-single"] * 2
    assert [one.label for one in (first, second)] == ["dance-couple Hard 9 P1", "dance-couple Hard 9 P2"]
    assert cells(first) + [(t, c + 4, k) for t, c, k in cells(second)] == sorted(
        cells(chart), key=lambda cell: (cell[1] >= 4, cell)
    )
    assert written_parts(chart) == (chart,)


@pytest.mark.parametrize("player", [0, 1])
def test_the_rows_of_a_player_are_this_players_letters(player: int) -> None:
    """Keysounds stand between the letters, and the last row is too short."""
    data = (HEAD + block("dance-couple", COUPLE)).encode()
    part = player_charts(parse(data, Path("x.sm")).charts[0])[player]
    texts = [data[a:b] for a, b in zip(part.rows.start.tolist(), part.rows.end.tolist(), strict=True)]
    wanted = [b"1000", b"0100[7]", b"0001", b"2010", b"0000", b"3000", b"0001", b"1000"], [
        b"1000", b"0100", b"M001", b"0210", b"0000", b"0300", b"1000", b"000"]  # fmt: skip
    assert texts == wanted[player]
    found = step_rows(data, part)
    steps = {(int(part.rows.tick[row]), column) for row, flags in zip(found.row, found.steps, strict=True)
             for column in flags.nonzero()[0].tolist()}  # fmt: skip
    assert steps == {(tick, column) for tick, column, kind in cells(part) if kind in (1, 2, 3, 5)}


def test_a_routine_has_one_pad_and_rows_for_each() -> None:
    chart = chart_of("dance-routine", FIRST + "&\n" + SECOND)
    first, second = player_charts(chart)
    assert [(one.steps_type, one.player, len(one.notes)) for one in (first, second)] == [
        ("dance-double", 1, 8), ("dance-double", 2, 8)]  # fmt: skip
    assert sorted(cells(first) + cells(second)) == cells(chart)
    assert written_parts(chart) == (first, second)
    assert [warning.code for warning in chart.warnings] == ["several-players"]
    assert player_charts(chart, 2) == (second,)
    alone = chart_of("dance-single", "1000\n")
    assert player_charts(alone) == written_parts(alone) == (alone,)


def test_a_routine_without_a_second_player_is_for_one() -> None:
    assert [one.player for one in player_charts(chart_of("dance-routine", FIRST))] == [1]


@pytest.fixture
def both(tmp_path: Path) -> Path:
    path = tmp_path / "two.sm"
    path.write_text(HEAD + block("dance-routine", FIRST + "&\n" + SECOND) + block("dance-couple", COUPLE))
    return path


def run(*arguments: object) -> tuple[int, str]:
    said = CliRunner().invoke(cli, [str(one) for one in arguments], standalone_mode=False)
    if said.exception is not None:
        raise said.exception
    return int(said.return_value or 0), said.output


def test_each_player_has_feet_and_findings_of_ones_own(both: Path) -> None:
    result = analyze_file(LintRun(LintRequest(want_rows=True)).task(both))
    assert [(chart.label, chart.index) for chart in result.charts] == [
        ("dance-routine Hard 9 P1", 0), ("dance-routine Hard 9 P2", 0),
        ("dance-couple Hard 9 P1", 1), ("dance-couple Hard 9 P2", 1),
    ]  # fmt: skip
    assert all(chart.playable and chart.row_count for chart in result.charts)
    status, text = run("analyze", both, "--format", "json", "--exit-zero")
    charts = json.loads(text)["files"][0]["charts"]
    assert status == 0 and [chart["player"] for chart in charts] == [1, 2, 1, 2]
    _, text = run("analyze", both, "--format", "csv", "--exit-zero")
    assert [line["player"] for line in csv.DictReader(text.splitlines())] == ["1", "2", "1", "2"]
    status, text = run("analyze", both, "--format", "json", "--player", "2", "--exit-zero")
    assert [chart["player"] for chart in json.loads(text)["files"][0]["charts"]] == [2, 2]


def test_a_fact_about_the_whole_chart_is_reported_once(both: Path) -> None:
    both.write_text(both.read_text().replace("#CREDIT:C;", "#CREDIT:;"))
    result = analyze_file(LintRun(LintRequest()).task(both))
    credit = [(finding.message, chart) for finding, chart in result.all_findings() if finding.rule == "DT502"]
    assert credit == [("the charts name no author, and #CREDIT is empty; write the name there", None)]


def test_markers_of_both_stand_in_the_file_and_go_again(both: Path) -> None:
    before = both.read_bytes()
    assert run("annotate", both, "--markers", "measure,rows")[0] == 0
    text = both.read_text()
    markers = re.findall(r"\{dt1 ([^}]*)\}", text)
    assert len(markers) == 6  # two measures of each player of the routine, two of the couple
    assert "&//{dt1 " in text and re.search(r"10001000//dt\w\w\n", text)
    assert [len(re.sub(r"[()]", "", one)) for one in markers] == [4, 4, 4, 4, 10, 3]
    assert run("annotate", both, "--markers", "measure,rows", "--check")[0] == 0
    marked = both.read_bytes()
    assert run("annotate", both, "--markers", "measure,rows")[0] == 0 and both.read_bytes() == marked
    assert run("annotate", both, "--strip")[0] == 0
    assert both.read_bytes() == before


def test_nothing_is_put_beside_a_song_that_has_only_charts_for_two(both: Path) -> None:
    before = sorted(both.parent.iterdir())
    status, said = run("annotate", both, "--markers", "sidecar,theme,smeditor")
    assert status == 0 and "only in the styles measure and rows" in said
    assert sorted(both.parent.iterdir()) == before


def test_pins_of_each_player_are_kept(both: Path) -> None:
    """The letters of a couple's row are the first player's and then the second's; in a routine each has rows."""
    run("annotate", both)
    text = both.read_text()
    swapped = re.sub(r"\{dt1 ([^}]*)\}", lambda m: "{dt1! " + m[1].translate(str.maketrans("LR", "RL")) + "}", text)
    both.write_text(swapped)
    song = parse(both.read_bytes(), both)
    for chart in song.charts:
        for part in player_charts(chart):
            overrides, _, problems = SongFeet(song).author_feet(part)
            assert len(overrides) and problems == ()
            play = solved_chart(song, part, load_preset("itg")).play
            assert play is not None
            kept = {(t, c): limb for (t, c), (limb, _) in overrides.cells().items()}
            rows = {tick: row for row, tick in enumerate(play.rows.tick.tolist())}
            assert all(int(play.limb[rows[tick], column]) == limb for (tick, column), limb in kept.items())
            assert set(kept.values()) <= {int(Limb.LEFT_FOOT), int(Limb.RIGHT_FOOT)}


def test_a_note_of_one_player_is_repaired_and_the_other_keeps_all(tmp_path: Path) -> None:
    path = tmp_path / "couple.sm"
    spin = ["1000", "0100", "0001", "0010", "1000", "0100", "0010", "0001"]  # all the way round
    path.write_text(HEAD + block("dance-couple", "".join(f"1000{row}\n" for row in spin)))
    before = parse(path.read_bytes(), path).charts[0]
    status, text = run("analyze", path, "--player", "2", "--preset", "thesis", "--fix", "DT202")
    assert status == 0 and "[dance-couple Hard 9 P2] move the note" in text
    after = parse(path.read_bytes(), path).charts[0]
    assert cells(player_charts(after)[0]) == cells(player_charts(before)[0])
    assert len(set(cells(player_charts(after)[1])) ^ set(cells(player_charts(before)[1]))) == 2


@pytest.fixture
def marked(tmp_path: Path) -> Path:
    path = tmp_path / "marked.sm"
    path.write_text(HEAD + block("pump-double", MARKED))
    return path


def test_letters_of_marked_notes_stand_from_left_to_right_whosever_they_are(marked: Path) -> None:
    before = marked.read_bytes()
    assert run("annotate", marked, "--markers", "measure,rows")[0] == 0
    song = parse(marked.read_bytes(), marked)
    sides = re.findall(r"\{dt1 ([^}]*)\}", marked.read_text())
    assert [len(re.sub(r"[()]", "", one)) for one in sides] == [7, 5]
    text = marked.read_text().replace(f"{{dt1 {sides[0]}}}", "{dt1! (LL)(LR)(RR)(L)}")
    marked.write_text(text)
    song = parse(text.encode(), marked)
    said = [SongFeet(song).author_feet(part)[0].cells() for part in player_charts(song.charts[0])]
    left, right = (int(Limb.LEFT_FOOT), int(Limb.RIGHT_FOOT))
    feet = [{column: int(limb) for (_, column), (limb, _) in sorted(cells.items())} for cells in said]
    assert feet == [{0: left, 5: right, 2: right, 4: left}, {9: left, 3: left, 7: right}]
    assert run("annotate", marked, "--strip", "--force")[0] == 0
    assert marked.read_bytes() == before


THREE = "X000Y0000Z\n0X00Y000Z0\n00X00YZ000\n0000000000\n"


def test_three_in_the_same_rows_have_feet_and_markers_each(tmp_path: Path) -> None:
    path = tmp_path / "three.sm"
    path.write_text(HEAD + block("pump-double", THREE))
    before = path.read_bytes()
    result = analyze_file(LintRun(LintRequest(want_rows=True)).task(path))
    assert [(chart.label, chart.row_count) for chart in result.charts] == [
        (f"pump-double Hard 9 P{player}", 3) for player in (1, 2, 3)
    ]
    assert run("annotate", path, "--markers", "measure,rows")[0] == 0
    (marker,) = re.findall(r"\{dt1 ([^}]*)\}", path.read_text())
    assert re.fullmatch(r"(\([LR]{3}\)){3}", marker)
    assert run("annotate", path, "--markers", "measure,rows", "--check")[0] == 0
    assert run("annotate", path, "--strip")[0] == 0 and path.read_bytes() == before


@pytest.mark.parametrize(("command", "suffix"), [("animate", "json"), ("page", "html"), ("render", "mp4")])
def test_no_picture_has_three_but_each_dances_alone(tmp_path: Path, command: str, suffix: str) -> None:
    path, out = tmp_path / "three.sm", tmp_path / f"out.{suffix}"
    path.write_text(HEAD + block("pump-double", THREE))
    with pytest.raises(
        UsageError, match=r"is for 3 players, and at most two dancers fit in one picture: .* --player 1 to 3"
    ):
        run(command, path, "-o", out)
    assert not out.exists()


def test_the_third_of_three_is_baked(tmp_path: Path) -> None:
    path, out = tmp_path / "three.sm", tmp_path / "p3.json"
    path.write_text(HEAD + block("pump-double", THREE))
    assert run("animate", path, "--player", "3", "-o", out)[0] == 0
    assert json.loads(out.read_text())


def test_a_head_without_an_end_beside_marked_notes_is_nobodys_step(tmp_path: Path) -> None:
    path = tmp_path / "marked.sm"
    path.write_text(HEAD + block("pump-double", MARKED + ",\n2000000000\n0000000000\n00000x0000\n000X000Y00\n"))
    assert run("annotate", path, "--markers", "measure,rows")[0] == 0
    sides = re.findall(r"\{dt1 ([^}]*)\}", path.read_text())
    assert [len(re.sub(r"[()]", "", one)) for one in sides] == [7, 5, 2]
    assert run("annotate", path, "--check", "--markers", "measure,rows")[0] == 0


def test_a_marked_note_keeps_its_letter_when_it_is_moved(tmp_path: Path) -> None:
    path = tmp_path / "marked.sm"
    path.write_text(HEAD + block("pump-double", MARKED))
    chart = parse(path.read_bytes(), path).charts[0]
    edit = Suggestion((MovedNote(0, 9, 6),), "moved")
    finding = Finding("DT202", "spin", "warning", "m", line=int(chart.rows.line[0]))
    fix = move_notes(path.read_bytes(), player_charts(chart)[1], finding, edit)
    assert fix is not None
    after = parse(apply(path.read_bytes(), fix.splices), path).charts[0]
    assert [cell[1] for cell in cells(player_charts(after)[1]) if cell[0] == 0] == [6]
    assert cells(player_charts(after)[0]) == cells(player_charts(chart)[0])


def test_one_player_is_baked(both: Path, tmp_path: Path) -> None:
    out = tmp_path / "p2.json"
    assert run("animate", both, "--index", "1", "--player", "2", "-o", out)[0] == 0
    assert json.loads(out.read_text())
