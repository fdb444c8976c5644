"""The quality report of a motion: a table for people, plain data for programs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.table import Table

    from dancetutor_cli.bake import MotionReport

_DISTANCES = ("minimum", "maximum", "mean", "deviation")


def print_report(report: MotionReport) -> None:
    """The figures as a table on standard output."""
    from rich.console import Console
    from rich.table import Table

    table = Table(title="Quality of the motion")
    for name, justify in (("figure", "left"), ("value", "right"), ("goal", "right"), ("met", "center")):
        table.add_column(name, justify=justify)  # type: ignore[arg-type]
    for f in report.figures:
        unit = f" {f.unit}" if f.unit else ""
        goal = "" if f.goal is None else f"{'at least' if f.at_least else 'at most'} {f.goal:g}{unit}"
        value = "nothing to measure" if f.value != f.value else f"{f.value:.4g}{unit}"
        table.add_row(f.name, value, goal, {None: "", True: "yes", False: "NO"}[f.met])
    Console().print(table)
    if report.distances:
        Console().print(_distances(report))


def _distances(report: MotionReport) -> Table:
    from rich.table import Table

    table = Table(title="Distance of the ragdoll, cm")
    table.add_column("retargeting point")
    for name in _DISTANCES:
        table.add_column(name, justify="right")
    for name, values in report.distances.items():
        table.add_row(name, *(f"{value:.2f}" for value in values))
    return table


def as_json(report: MotionReport) -> dict[str, Any]:
    """The report as plain data; a figure that could not be measured is null."""
    figures = [
        {
            "name": f.name,
            "value": None if f.value != f.value else f.value,
            "unit": f.unit,
            "goal": f.goal,
            "at_least": f.at_least,
            "met": f.met,
        }
        for f in report.figures
    ]
    errors = [None if e != e else round(float(e), 4) for e in report.contact_errors]
    out = {
        "schema": 1,
        "figures": figures,
        "met": report.met,
        "notes": list(report.notes),
        "contact_errors_ms": errors,
    }
    if report.distances:
        out["distances_cm"] = {n: dict(zip(_DISTANCES, values, strict=True)) for n, values in report.distances.items()}
    return out
