"""The text form: finding lines, safe titles, colours, the table."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from dataclasses import replace

import pytest
from click.testing import CliRunner
from rich import box
from rich.color import ColorSystem
from rich.console import Console
from rich.table import Table

from dancetutor_cli.commands import cli
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.results import ChartResult, FileResult
from dancetutor_cli.reports import text_report
from dancetutor_cli.reports.analyze_formats import Output, Tally, clock
from dancetutor_cli.reports.terminal import Terminal, terminal_of
from dancetutor_cli.reports.text_report import TextReport, chart_table
from dancetutor_cli.run.reading import charts_path

FINDING = Finding("DT201", "doublestep", "warning", "twice", 133, 2, 1, 16.0, 4, 7.512, 12, 0)
CHART = ChartResult(
    0, "dance-single", "Hard", 8, "", True, 540, 86, {"doublestep": 3, "crossover-half": 14}, (FINDING,), None
)
FILE = FileResult("charts/x.ssc", "Title", "Artist", None, (), (), (CHART,))


class Screen(io.StringIO):
    def isatty(self) -> bool:
        return True


def printed(*results: FileResult, stream: io.StringIO | None = None) -> tuple[str, str]:
    out, errors = stream or io.StringIO(), io.StringIO()
    report, tally = TextReport(Output(out, errors)), Tally()
    report.begin()
    for result in results:
        tally.add(result)
        report.add(result)
    report.end(tally)
    return out.getvalue(), errors.getvalue()


def test_a_finding_is_one_line_in_lint_form() -> None:
    out, _ = printed(FILE)
    assert (
        "charts/x.ssc:133:2 DT201 doublestep: twice [dance-single Hard 8] measure 4 beat 16 0:07.512"
        in out.splitlines()
    )
    assert out.splitlines()[-1] == "1 file, 1 chart: 1 warning"


def test_a_finding_about_the_file_has_no_chart() -> None:
    about_file = Finding("DT104", "odd-tag", "warning", "strange offset", 3, 1)
    out, _ = printed(replace(FILE, findings=(about_file,), charts=()))
    assert "charts/x.ssc:3:1 DT104 odd-tag: strange offset" in out.splitlines()


def test_numbers_of_the_table_stand_under_their_names() -> None:
    out, _ = printed(FILE)
    lines = out.splitlines()
    numbers = next(n for n, line in enumerate(lines) if " 540 " in line)
    header, values = lines[numbers - 2], lines[numbers]
    assert header.split()[:2] == ["rows", "units"]
    ends = {value: values.index(value) + len(value) for value in ("540", "86", "3", "14")}
    assert ends["540"] == header.index("rows") + 4
    assert ends["86"] == header.index("units") + 5
    assert ends["3"] == header.index("DS") + 2
    assert ends["14"] >= header.index("135°") + 4 >= ends["14"] - 1
    assert max(map(len, lines)) < 80 or "DT201" in max(lines, key=len)


def test_the_table_is_as_rich_draws_it() -> None:
    for colours in (None, ColorSystem.STANDARD):
        drawing = io.StringIO()
        console = Console(file=drawing, width=100, color_system="standard" if colours else None, force_terminal=True)
        drawn = Table(box=box.SIMPLE_HEAD, padding=0, show_edge=False, header_style="dim")
        columns = [column for column in text_report.MOVE_COLUMNS if column.always or CHART.counts.get(column.moves[0])]
        for column in (text_report._ROWS, text_report._COST, *columns):
            options = {"min_width": column.width, "vertical": "bottom", "no_wrap": True}
            drawn.add_column(column.header, justify="right", **options)
        counts = [sum(CHART.counts.get(move, 0) for move in column.moves) for column in columns]
        drawn.add_row(str(CHART.row_count), str(CHART.cost), *(str(count or "·") for count in counts))
        console.print(drawn)
        assert chart_table(CHART, Terminal(100, colours)) == drawing.getvalue()


def test_the_tables_of_a_file_have_the_same_columns() -> None:
    other = replace(CHART, row_count=1_234_567, counts={"sideswitch-left": 3, "doublestep": 1})
    tables = [chart_table(one, Terminal(120), [CHART, other]).splitlines() for one in (CHART, other)]
    assert tables[0][:-1] == tables[1][:-1] and "SS" in "".join(tables[0][:-1])
    assert {len(line) for table in tables for line in table[-2:]} == {len(tables[0][-1])}
    assert chart_table(CHART, Terminal(120)).splitlines()[0] != tables[0][0]


def test_without_a_terminal_nobody_asks_rich() -> None:
    code = (
        "import io, sys; from dancetutor_cli.reports.terminal import terminal_of\n"
        "print(terminal_of(io.StringIO()).width, 'rich' in sys.modules)"
    )
    environment = {name: value for name, value in os.environ.items() if name not in ("FORCE_COLOR", "COLUMNS")}
    run = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True)
    assert run.stdout == "100 False\n"
    environment["COLUMNS"] = "77"
    run = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True)
    assert run.stdout == "77 True\n"


def test_letters_that_a_stream_lacks_make_a_plain_line() -> None:
    stream = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    assert terminal_of(stream).plain
    assert "-----" in chart_table(CHART, Terminal(plain=True)) and "─" not in chart_table(CHART, Terminal(plain=True))


def test_a_number_wider_than_its_column_is_not_cut() -> None:
    out, _ = printed(replace(FILE, charts=(replace(CHART, cost=123456789),)))
    assert "123456789" in out


def test_no_colours_without_a_terminal() -> None:
    assert "\x1b" not in printed(FILE)[0]


def test_colours_on_a_terminal_unless_no_color(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.delenv("NO_COLOR", raising=False)
    assert "\x1b[1;33mDT201" in printed(FILE, stream=Screen())[0]
    monkeypatch.setenv("NO_COLOR", "1")
    assert "\x1b" not in printed(FILE, stream=Screen())[0]


def test_titles_cannot_steer_the_terminal_nor_rich() -> None:
    out, _ = printed(replace(FILE, title="\x1b[2J[red]pwn[/red]", artist="a\x9bb"))
    assert "\x1b" not in out and "\x9b" not in out
    assert "[red]pwn[/red]" in out


def test_an_unreadable_file_is_one_line_among_the_errors() -> None:
    out, errors = printed(FileResult("bad.sm", "", "", "bad.sm:3: no\ncharts", (), (), ()), FILE)
    assert errors == "dancetutor: bad.sm:3: no charts\n"
    assert "1 file could not be read" in out


def test_a_chart_without_a_pad_has_no_table() -> None:
    out, _ = printed(replace(FILE, charts=(replace(CHART, playable=False, findings=()),)))
    assert "rows" not in out


@pytest.mark.parametrize(
    ("second", "text"),
    [(7.5124, "0:07.512"), (62.5, "1:02.500"), (59.9996, "1:00.000"), (-0.25, "-0:00.250"), (-0.0001, "0:00.000")],
)
def test_clock(second: float, text: str) -> None:
    assert clock(second) == text


def test_columns_that_most_charts_do_not_need_show_only_where_they_count() -> None:
    assert "brackets" not in printed(FILE)[0]
    counted = replace(CHART, counts={**CHART.counts, "bracket": 7, "footswitch-up": 2, "footswitch-down": 3})
    out, _ = printed(replace(FILE, charts=(counted,)))
    lines = out.splitlines()
    values = next(line for line in lines if " 540 " in line)
    header = lines[lines.index(values) - 2]
    assert values[: header.index("brackets") + len("brackets")].endswith(" 7")
    assert " 5 " in values


@pytest.mark.parametrize("name", ["github", "gitlab", "sarif", "junit"])
def test_formats_for_review_name_the_rule_once_beside_the_message(name: str) -> None:
    song = charts_path() / "two_left_feet" / "two_left_feet.ssc"
    said = CliRunner().invoke(cli, ["analyze", str(song), "--select", "DT509", "--format", name], standalone_mode=False)
    message = "plays 2.7 levels easier than its meter 11, like 8.3 "
    shown = {"github": "title=DT509 meter-off::", "gitlab": '"description": "'}.get(name, "meter-off: ")
    assert f"{shown}{message}" in said.stdout
