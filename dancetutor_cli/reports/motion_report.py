"""The quality report of a motion: a table for people, plain data for programs, curves as a picture."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from dancetutor_cli.dance.quality.figures import MotionReport
from dancetutor_cli.dance.units import Array
from dancetutor_cli.run import markup
from dancetutor_cli.run.errors import UsageError
from dancetutor_cli.run.files import write_atomic
from dancetutor_cli.run.pictures import picture_bytes

if TYPE_CHECKING:
    from rich.table import Table


_NOTHING = 5e-4  # smaller values, in any unit, are shown as 0
_DISTANCES = ("minimum", "maximum", "mean", "deviation")


def print_report(report: MotionReport) -> None:
    """Print the figures as a table on standard output."""
    from rich.console import Console
    from rich.table import Table

    table = Table(title="Quality of the motion")
    for name, justify in (("figure", "left"), ("value", "right"), ("goal", "right"), ("met", "center")):
        table.add_column(name, justify=justify)  # type: ignore[arg-type]
    for f in report.figures:
        unit = f" {f.unit}" if f.unit else ""
        goal = "" if f.goal is None else f"{'at least' if f.at_least else 'at most'} {f.goal:g}{unit}"
        value = "nothing to measure" if f.value != f.value else f"{_number(f.value)}{unit}"
        table.add_row(f.name, value, goal, {None: "", True: "yes", False: "NO"}[f.is_met])
    Console().print(table)
    if report.distances:
        Console().print(_distances(report))


def _number(value: float) -> str:
    """Return a figure for people: three digits that count, none of numbers near 0, no exponent below 10,000."""
    return f"{0 if abs(value) < _NOTHING else value:.{4 if abs(value) >= 1000 else 3}g}"


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
    """Return the report as plain data; a figure that could not be measured is null."""
    figures = [
        {
            "name": f.name,
            "value": None if f.value != f.value else f.value,
            "unit": f.unit,
            "goal": f.goal,
            "at_least": f.at_least,
            "met": f.is_met,
        }
        for f in report.figures
    ]
    errors = [None if e != e else round(float(e), 4) for e in report.contact_errors]
    out = {
        "schema": 1,
        "figures": figures,
        "met": report.is_met,
        "notes": list(report.notes),
        "contact_errors_ms": errors,
    }
    if report.distances:
        out["distances_cm"] = {n: dict(zip(_DISTANCES, values, strict=True)) for n, values in report.distances.items()}
    return out


# Curves of a motion over the song as a picture: contact errors, height of the centre of mass, jerk.

WIDTH, PANEL, LEFT, TOP, GAP = 1200, 200, 70, 30, 50  # pixels
INK, GRID, LINE, INPUT = "#222222", "#dddddd", "#3060c0", "#999999"


def write_curves(path: Path, report: MotionReport) -> None:
    """Write the report's curves as .svg or .png. Raises UsageError for another suffix, FileError if writing fails."""
    if path.suffix.lower() == ".svg":
        write_atomic(path, _svg(report).encode())
    elif path.suffix.lower() == ".png":
        write_atomic(path, _png(report))
    else:
        raise UsageError(f"{path}: a plot's name must end in .svg or .png")


class _Panel(NamedTuple):
    """A diagram of one figure. lines : (n, 2) pixels each, the input before the output; ends : t0, t1, low, high

    is_dotted : whether the curve is drawn as single points: those of contacts, between which nothing is measured
    """

    title: str
    top: float
    lines: list[Array]
    ends: tuple[float, float, float, float]
    is_dotted: bool

    @property
    def colours(self) -> tuple[str, ...]:
        """The colours of the lines."""
        return (LINE,) if len(self.lines) == 1 else (INPUT, LINE)


def _panels(report: MotionReport) -> Iterator[_Panel]:
    for k, (title, (times, values)) in enumerate(report.curves.items()):
        columns = values.reshape(len(times), -1)
        good = np.isfinite(columns).all(axis=1)
        t, v = times[good], columns[good]
        if not len(t):
            continue
        low, high = float(v.min()), float(v.max())
        high = high if high > low else low + 1.0
        first, last = float(times.min()), float(max(times.max(), times.min() + 1e-3))
        top = TOP + k * (PANEL + GAP)
        x = LEFT + (t - first) / (last - first) * (WIDTH - LEFT - 20)
        y = top + PANEL * (1.0 - (v - low) / (high - low))
        lines = [np.column_stack((x, column)) for column in y.T]
        yield _Panel(title, top, lines, (first, last, low, high), is_dotted="contact" in title)


def _svg(report: MotionReport) -> str:
    parts = [markup.tag("rect", width="100%", height="100%", fill="white")]
    for panel in _panels(report):
        size = {"width": WIDTH - LEFT - 20, "height": PANEL}
        parts.append(markup.tag("rect", x=LEFT, y=panel.top, **size, fill="none", stroke=GRID))
        parts += [markup.tag("text", text, x=x, y=y, font_size=12, fill=INK) for x, y, text in _labels(panel)]
        for points, colour in zip(panel.lines, panel.colours, strict=True):
            if panel.is_dotted:
                parts += [markup.tag("circle", cx=float(x), cy=float(y), r=1.6, fill=colour) for x, y in points]
            else:
                line = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
                parts.append(markup.tag("polyline", points=line, fill="none", stroke=colour, stroke_width=0.8))
    size = {"width": WIDTH, "height": TOP + len(report.curves) * (PANEL + GAP)}
    inside = "\n".join(["", *parts, ""])
    return markup.tag("svg", inside, xmlns="http://www.w3.org/2000/svg", **size, font_family="sans-serif") + "\n"


def _png(report: MotionReport) -> bytes:
    from PIL import Image, ImageDraw

    image = Image.new("RGB", (WIDTH, TOP + len(report.curves) * (PANEL + GAP)), "white")
    draw = ImageDraw.Draw(image)
    for panel in _panels(report):
        top = panel.top
        draw.rectangle((LEFT, top, WIDTH - 20, top + PANEL), outline=GRID)
        for x, y, text in _labels(panel):
            draw.text((x, y - 11), text, fill=INK)
        for points, colour in zip(panel.lines, panel.colours, strict=True):
            if panel.is_dotted:
                for x, y in points:
                    draw.ellipse((x - 1.6, y - 1.6, x + 1.6, y + 1.6), fill=colour)
            else:
                draw.line([(float(x), float(y)) for x, y in points], fill=colour)
    return picture_bytes(np.asarray(image))


def _labels(panel: _Panel) -> list[tuple[float, float, str]]:
    top, (first, last, low, high) = panel.top, panel.ends
    title = panel.title + (" (grey: input)" if len(panel.lines) > 1 else "")
    return [
        (LEFT, top - 6, title),
        (8, top + 12, f"{high:.4g}"),
        (8, top + PANEL, f"{low:.4g}"),
        (LEFT, top + PANEL + 16, f"{first:.1f} s"),
        (WIDTH - 90, top + PANEL + 16, f"{last:.1f} s"),
    ]
