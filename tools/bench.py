#!/usr/bin/env python3
"""Measure speed and print a table: each `tools/bench_*.py` has a `measure()` that returns `Row`s.

usage: tools/bench.py [NAME ...]      e.g. tools/bench.py solver analyze
"""

from __future__ import annotations

import importlib
import os
import platform
import sys
from collections.abc import Iterable
from pathlib import Path

from rich.console import Console
from rich.table import Table

HERE = Path(__file__).resolve().parent
# (name, value, unit, goal, peer): goal and peer are text, "" where there is none.
Row = tuple[str, float, str, str, str]


def rows_of(names: Iterable[str]) -> Iterable[tuple[str, list[Row]]]:
    sys.path.insert(0, str(HERE))
    for name in names:
        yield name, importlib.import_module(f"bench_{name}").measure()


def number(value: float) -> str:
    """A measured value as text."""
    return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.3g}"


def main() -> None:
    known = sorted(p.stem.removeprefix("bench_") for p in HERE.glob("bench_*.py"))
    wanted = sys.argv[1:] or known
    if unknown := [n for n in wanted if n not in known]:
        sys.exit(f"no benchmark named {', '.join(unknown)}; there are: {', '.join(known)}")
    table = Table(title=f"Python {platform.python_version()}, {os.cpu_count()} cores, {platform.machine()}")
    for column in ("what", "measured", "unit", "goal", "peer"):
        table.add_column(column, justify="right" if column == "measured" else "left")
    for name, rows in rows_of(wanted):
        for what, value, unit, goal, peer in rows:
            table.add_row(f"{name}: {what}", number(value), unit, goal, peer)
    Console(width=140).print(table)


if __name__ == "__main__":
    main()
