"""The table of a chart: rows, cost and how often each move happens."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

from dancetutor_cli.jobs.result import ChartResult
from dancetutor_cli.reports.terminal import Terminal


class Column(NamedTuple):
    """A column of the table. `moves` are those it counts; one that is not `always` shows where there are any."""

    header: str
    width: int
    moves: tuple[str, ...]
    always: bool = True


MOVE_COLUMNS = (
    Column("double\nsteps", 6, ("doublestep",)),
    Column("forced\ndouble\nsteps", 6, ("forced-doublestep",)),
    Column("cross\nover\n135°", 5, ("crossover-half",)),
    Column("cross\nover\n180°", 5, ("crossover-full",)),
    Column("spins", 5, ("spin",)),
    Column("jump\nfoot\nswitch", 6, ("jump-footswitch",)),
    Column("foot\nswitch", 6, ("footswitch-up", "footswitch-down"), always=False),
    Column("side\nswitch", 6, ("sideswitch-left", "sideswitch-right"), always=False),
    Column("hold\nswitch", 6, ("holdswitch",), always=False),
    Column("brackets", 8, ("bracket",), always=False),
    Column("jacks", 5, ("jack",)),
    Column("candles", 7, ("candle",)),
    Column("gallops", 7, ("gallop",)),
    Column("hands", 5, ("hand",)),
)
_ROWS, _COST = Column("rows", 5, ()), Column("cost", 6, ())


def chart_table(chart: ChartResult, terminal: Terminal) -> str:
    """The table as text for this terminal, with a final newline."""
    counts = {column: sum(chart.counts.get(move, 0) for move in column.moves) for column in MOVE_COLUMNS}
    shown = tuple(column for column in MOVE_COLUMNS if column.always or counts[column])
    columns = (_ROWS, _COST, *shown)
    if sum(column.width + 1 for column in columns) > terminal.width:
        return _listed(chart, counts, shown)
    cells = [str(chart.row_count), str(chart.cost), *(str(counts[column] or "·") for column in shown)]
    widths = tuple(max(column.width, len(cell)) for column, cell in zip(columns, cells, strict=True))
    numbers = " ".join(cell.rjust(width) for cell, width in zip(cells, widths, strict=True))
    return f"{_header(terminal, columns, widths)}{numbers}\n"


def _listed(chart: ChartResult, counts: dict[Column, int], shown: Sequence[Column]) -> str:
    """The same numbers one below the other, for a terminal that is too narrow for the table."""
    numbers = {"rows": chart.row_count, "cost": chart.cost}
    numbers.update({" ".join(column.header.split("\n")): counts[column] for column in shown})
    width = max(len(str(number)) for number in numbers.values())
    return "".join(f"{number!s:>{width}} {name}\n" for name, number in numbers.items())


@lru_cache(maxsize=64)
def _header(terminal: Terminal, columns: Sequence[Column], widths: Sequence[int]) -> str:
    """The names of the columns, each above its numbers' ends, and a line below."""
    names = [column.header.split("\n") for column in columns]
    height = max(map(len, names))
    lines = zip(*([""] * (height - len(name)) + name for name in names), strict=True)
    rule = ("-" if terminal.plain else "─") * (sum(widths) + len(widths) - 1)
    return (
        "".join(
            " ".join(terminal.paint(word.rjust(width), "dim") for word, width in zip(line, widths, strict=True)) + "\n"
            for line in lines
        )
        + f"{rule}\n"
    )
