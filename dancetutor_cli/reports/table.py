"""The table of a chart: rows, cost and how often each move happens.

Rich draws the table once; every further chart fills its numbers into that drawing, so that a pack with thousands of
charts is not slowed down by its layout.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from rich import box
from rich.console import Console
from rich.table import Table

from dancetutor_cli.jobs.result import ChartResult

# Header -> name of the move that is counted.
MOVE_COLUMNS = {
    "double\nsteps": "doublestep",
    "forced\ndouble\nsteps": "forced-doublestep",
    "cross\nover\n135°": "crossover-half",
    "cross\nover\n180°": "crossover-full",
    "spins": "spin",
    "jump\nfoot\nswitch": "jump-footswitch",
    "jacks": "jack",
    "candles": "candle",
    "gallops": "gallop",
    "hands": "hand",
}
_HEADERS = ("rows", "cost", *MOVE_COLUMNS)
_WIDTHS = (5, 5, 6, 6, 5, 5, 5, 6, 5, 7, 7, 5)


def chart_table(chart: ChartResult, console: Console) -> str:
    """The table as text for this console, with a final newline."""
    values = [chart.row_count, chart.cost, *(chart.counts.get(move, 0) for move in MOVE_COLUMNS.values())]
    cells = [str(value) if value or not place else "·" for place, value in enumerate(values)]
    if any(len(cell) > width for cell, width in zip(cells, _WIDTHS, strict=True)):
        return _draw(console, cells)
    drawing = _template(console, console.width)
    for number, (cell, width) in enumerate(zip(cells, _WIDTHS, strict=True)):
        drawing = drawing.replace(_placeholder(number, width), cell.rjust(width))
    return drawing


def _placeholder(number: int, width: int) -> str:
    return chr(0xE000 + number) * width  # private use: stands nowhere else


@lru_cache(maxsize=4)
def _template(console: Console, width: int) -> str:
    return _draw(console, [_placeholder(number, width) for number, width in enumerate(_WIDTHS)])


def _draw(console: Console, cells: Sequence[str]) -> str:
    table = Table(box=box.SIMPLE_HEAD, padding=0, show_edge=False, header_style="dim")
    for header, width in zip(_HEADERS, _WIDTHS, strict=True):
        table.add_column(header, justify="right", min_width=width, vertical="bottom", no_wrap=True)
    table.add_row(*cells)
    with console.capture() as capture:
        console.print(table)
    return capture.get()
