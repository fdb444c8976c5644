"""`dancetutor animate`: bake a dancer who plays a chart, and say how good the motion is."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from dancetutor_cli.commands.selection import Selection, preset_option, selection_options
from dancetutor_cli.errors import DancetutorError, FileError, UsageError

if TYPE_CHECKING:
    from dancetutor_cli.bake import Report
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.motion.model import Motion

SUFFIXES = (".npz", ".glb")
AFTER = 2.5  # seconds after the last row that a section may still reach
_TABLE = "-"  # the value of --report without a file


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), help="A .npz or .glb file; default: SONG-difficulty.glb."
)
@click.option("--fps", type=click.FloatRange(1, 1000), default=60.0, show_default=True, help="Frames per second.")
@click.option("--section", metavar="START:END", help="Only this part: seconds, or beats (16b:32b) or measures (4m:8m).")
@click.option(
    "--report", "report_to", is_flag=False, flag_value=_TABLE, metavar="[FILE.json]", help="Measure the motion."
)
@selection_options
@preset_option
def command(
    file: Path,
    output: Path | None,
    fps: float,
    section: str | None,
    report_to: str | None,
    preset: str,
    **selection: Any,
) -> None:
    """Bake a 3D dancer who plays one chart of FILE.

    The motion goes to a .glb file, which any glTF viewer plays, or to a .npz file of numpy arrays.
    """
    from dancetutor_cli import chart as charts
    from dancetutor_cli.bake import bake, mines_of, report
    from dancetutor_cli.pads import load_pad
    from dancetutor_cli.play import load_preset, solve_chart

    song = charts.load(file)
    chart = Selection(**selection).one(song)
    target = output or Path(default_name(song, chart))
    _check_target(target)
    play, pad = solve_chart(chart, load_preset(preset)), load_pad(chart.steps_type)
    if play is None or pad is None:
        raise UsageError(f"{file}: no pad is known for steps type '{chart.steps_type}', so there is nobody to bake")
    if not (play.limb >= 0).any():
        raise DancetutorError(f"{file}: {chart.label}: the chart has no steps, so there is nothing to dance")
    end = float(play.rows.second[-1]) + AFTER
    motion = bake(chart, play, pad, fps=fps, section=_seconds(section, chart, end))
    write_motion(target, motion)
    click.echo(f"{target}: {len(motion.times)} frames, {motion.times[-1] - motion.times[0]:.1f} s, {chart.label}")
    if report_to is not None:
        _print_report(report(motion, mines_of(play, pad)), report_to)


def default_name(song: Song, chart: Chart) -> str:
    """SONG-difficulty.glb, in characters that every file system takes."""
    name = f"{song.title or song.path.stem}-{chart.difficulty or 'chart'}".lower()
    plain = re.sub(r"[^\w.-]+", "_", name).strip("._")
    return f"{plain or 'dance'}.glb"


def write_motion(path: Path, motion: Motion) -> None:
    """Write a motion in the format that the file's name asks for."""
    if path.suffix.lower() == ".npz":
        from dancetutor_cli.formats.npz import write_npz

        write_npz(path, motion)
    else:
        from dancetutor_cli.character import load_dancer
        from dancetutor_cli.formats.glb import write_glb

        write_glb(path, load_dancer(), motion)


def _check_target(path: Path) -> None:
    """Refuse before the work what could not be written after it."""
    if path.suffix.lower() not in SUFFIXES:
        raise UsageError(f"{path}: the name must end in {' or '.join(SUFFIXES)}")
    if path.is_dir():
        raise FileError(path, "is a folder; give a file name")
    if not path.parent.is_dir():
        raise FileError(path, "its folder does not exist")


def _seconds(section: str | None, chart: Chart, end: float) -> tuple[float, float] | None:
    if section is None:
        return None
    from dancetutor_cli.chart.section import parse_section

    return parse_section(section, chart.timing, end)


def _print_report(report: Report, target: str) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table(title="Quality of the motion")
    for name, justify in (("figure", "left"), ("value", "right"), ("goal", "right"), ("met", "center")):
        table.add_column(name, justify=justify)  # type: ignore[arg-type]
    for f in report.figures:
        unit = f" {f.unit}" if f.unit else ""
        goal = "" if f.goal is None else f"{'at least' if f.at_least else 'at most'} {f.goal:g}{unit}"
        table.add_row(f.name, f"{f.value:.4g}{unit}", goal, {None: "", True: "yes", False: "NO"}[f.met])
    Console().print(table)
    if target != _TABLE:
        from dancetutor_cli.files import write_atomic

        write_atomic(Path(target), (json.dumps(as_json(report), indent=1) + "\n").encode())
        click.echo(f"{target}: the report")


def as_json(report: Report) -> dict[str, Any]:
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
    return {"schema": 1, "figures": figures, "met": report.met, "contact_errors_ms": errors}
