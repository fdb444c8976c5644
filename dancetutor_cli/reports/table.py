"""The table of a chart: rows, cost and how often each move happens.

Rich draws the table once; every further chart fills its numbers into that drawing, so that a pack with thousands of
charts is not slowed down by its layout.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

from rich import box
from rich.console import Console
from rich.table import Table

from dancetutor_cli.jobs.result import ChartResult


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


def chart_table(chart: ChartResult, console: Console) -> str:
    """The table as text for this console, with a final newline."""
    counts = {column: sum(chart.counts.get(move, 0) for move in column.moves) for column in MOVE_COLUMNS}
    shown = tuple(column for column in MOVE_COLUMNS if column.always or counts[column])
    columns = (_ROWS, _COST, *shown)
    if sum(column.width + 1 for column in columns) > console.width:
        return _listed(chart, counts, shown)
    cells = [str(chart.row_count), str(chart.cost), *(str(counts[column] or "·") for column in shown)]
    if any(len(cell) > column.width for cell, column in zip(cells, columns, strict=True)):
        return _draw(console, columns, cells)
    drawing = _template(console, console.width, columns)
    for number, (cell, column) in enumerate(zip(cells, columns, strict=True)):
        drawing = drawing.replace(_placeholder(number, column.width), cell.rjust(column.width))
    return drawing


def _listed(chart: ChartResult, counts: dict[Column, int], shown: Sequence[Column]) -> str:
    """The same numbers one below the other, for a terminal that is too narrow for the table."""
    numbers = {"rows": chart.row_count, "cost": chart.cost}
    numbers.update({" ".join(column.header.split("\n")): counts[column] for column in shown})
    width = max(len(str(number)) for number in numbers.values())
    return "".join(f"{number!s:>{width}} {name}\n" for name, number in numbers.items())


def _placeholder(number: int, width: int) -> str:
    return chr(0xE000 + number) * width  # private use: stands nowhere else


@lru_cache(maxsize=64)
def _template(console: Console, width: int, columns: tuple[Column, ...]) -> str:
    return _draw(console, columns, [_placeholder(number, column.width) for number, column in enumerate(columns)])


def _draw(console: Console, columns: Sequence[Column], cells: Sequence[str]) -> str:
    table = Table(box=box.SIMPLE_HEAD, padding=0, show_edge=False, header_style="dim")
    for column in columns:
        table.add_column(column.header, justify="right", min_width=column.width, vertical="bottom", no_wrap=True)
    table.add_row(*cells)
    with console.capture() as capture:
        console.print(table)
    return capture.get()
