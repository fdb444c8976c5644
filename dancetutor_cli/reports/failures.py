"""A table of what failed in a run over many charts."""

from __future__ import annotations

from collections.abc import Iterable


def failures_table(rows: Iterable[tuple[str, str, str]]) -> None:
    """Print (file, chart, error) to standard error."""
    from rich.console import Console
    from rich.table import Table

    from dancetutor_cli.reports.safe import safe

    table = Table(title="Failed", title_justify="left")
    for name in ("file", "chart", "why"):
        table.add_column(name, overflow="fold")
    for row in rows:
        table.add_row(*(safe(cell) for cell in row))
    Console(stderr=True, markup=False, highlight=False).print(table)
