"""`dancetutor animate`: bake a dancer who plays a chart, and say how good the motion is."""

from __future__ import annotations

import json
import re
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from dancetutor_cli.commands.chart_options import (
    TABLE,
    Selection,
    character_option,
    form_option,
    gait_option,
    motion_option,
    number,
    preset_option,
    push_options,
    report_option,
    section_option,
    selection_options,
    style_option,
)
from dancetutor_cli.commands.first_run import tell_of_compiling
from dancetutor_cli.commands.long_work import LONG, confirm_long
from dancetutor_cli.commands.paths import GivenPath
from dancetutor_cli.commands.records import into
from dancetutor_cli.errors import UsageError
from dancetutor_cli.formats.writers import FORMATS
from dancetutor_cli.lint.part import FASTEST, SLOWEST
from dancetutor_cli.outputs import check_file, one_of

if TYPE_CHECKING:
    from dancetutor_cli.bake import MotionReport
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.jobs.bake import Asked
    from dancetutor_cli.jobs.baked_dance import BakedDance

_FILE = GivenPath()


@dataclass(frozen=True, slots=True)
class AnimateOptions:
    """How she shall dance; named as the fields of `jobs.bake.BakeTask`."""

    preset: str | None
    fps: float
    section: str | None
    rate: float
    play_file: Path | None
    bar: bool
    gait: str
    form: str
    motion: Path | None
    jobs: int
    style: str | None
    push: tuple[str, ...]
    trip: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Result:
    """What shall become of it."""

    output: Path | None
    report_to: str | None
    plot: Path | None
    character: str
    yes: bool
    physics: bool


@click.command()
@click.argument("file", type=_FILE)
@click.option("-o", "--output", type=_FILE, help=f"A {one_of(FORMATS)} file; default: SONG-difficulty.glb.")
@click.option(
    "--fps",
    type=click.FloatRange(1, 1000),
    callback=number,
    default=60.0,
    show_default=True,
    help="Frames per second.",
)
@section_option
@click.option(
    "--rate",
    type=click.FloatRange(SLOWEST, FASTEST),
    callback=number,
    default=1.0,
    show_default=True,
    help="Speed of the music she dances to.",
)
@click.option("--play", "play_file", type=_FILE, help="Feet from this JSON of analyze instead of the solver's.")
@report_option("Measure the motion (the dancer's, whoever dances).")
@click.option("--plot", type=_FILE, help="Draw errors, height and jerk over the song: a .svg or .png file.")
@click.option("--bar", is_flag=True, help="She holds on to the bar behind the pad, as players of hard charts do.")
@gait_option
@form_option
@motion_option
@style_option
@push_options
@click.option("--physics", is_flag=True, help="A ragdoll follows her as closely as it can: --style neutral.")
@click.option(
    "--jobs", type=click.IntRange(1, 256), default=1, show_default=True, help="Processes, for songs over two minutes."
)
@click.option("--yes", is_flag=True, help="Bake even a very long motion without asking.")
@character_option
@selection_options
@preset_option
@into("selection", Selection)
@into("dance", AnimateOptions)
@into("result", Result)
def command(file: Path, selection: Selection, dance: AnimateOptions, result: Result) -> None:
    """Bake a 3D dancer who plays one chart of FILE.

    The name of the output says what it is: .glb, which any glTF viewer plays; .npz, numpy arrays; .bvh, motion
    capture; .json, only the moves: what moves when, from where to where. A chart for two gives two files, NAME-p1 and
    NAME-p2, of one clock, each dancer on her place; with --player one.
    """
    from dancetutor_cli.character import DANCER, dressed, load_character
    from dancetutor_cli.character.partner import partner_of
    from dancetutor_cli.jobs.bake import BakeTask, ask, style_for, tasks_of
    from dancetutor_cli.jobs.baked_dance import BakedDance
    from dancetutor_cli.library import one_song
    from dancetutor_cli.lint.presets import choice_for
    from dancetutor_cli.reports.safe import safe

    output, character, report_to = result.output, result.character, result.report_to
    if output is not None:
        check_file(output, tuple(FORMATS))
    if result.plot is not None:
        check_file(result.plot, (".svg", ".png"))
    if report_to is not None and report_to != TABLE:
        check_file(Path(report_to), (".json",), or_device=True)
    if character != DANCER and output is not None and not FORMATS[output.suffix.lower()].has_motion:
        raise UsageError(f"{output}: the moves are the same for every character; leave --character out")
    dances = load_character(dressed(character, dance.gait))
    task = BakeTask(one_song(file), selection, **asdict(dance))
    if result.physics and task.style is None:
        task = replace(task, style="neutral")
    task = replace(task, style=style_for(task.style, task.push, task.trip))
    from dancetutor_cli.library.selection import note_bytes

    tell_of_compiling(choice_for(task.path, task.preset), lambda: note_bytes(task.path, task.selection))
    tasks = tasks_of(task)
    dancers = (dances, partner_of(dances)) if len(tasks) > 1 else (dances,)
    both = [ask(each) for each in tasks]
    for note in dict.fromkeys(note for asked in both for note in asked.notes):
        click.echo(f"warning: {safe(note)}", err=True)
    target = output or Path(default_name(both[0].song, both[0].chart))
    check_file(target, tuple(FORMATS))
    for asked in both:
        _allow_long(asked, file, result.yes)
    places = _Places(target, None if report_to is None or report_to == TABLE else Path(report_to), result.plot)
    made = [BakedDance(asked, each, dancer) for asked, each, dancer in zip(both, tasks, dancers, strict=True)]
    if len(made) > 1:
        made[0].other, made[1].other = made[1], made[0]
    for one in made:
        _write(one, places if one.other is None else places.of(one.asked.chart.player), report_to is not None)


@dataclass(frozen=True, slots=True)
class _Places:
    """Where all that is made goes. report : JSON of the report; plot : its picture; None: nowhere"""

    output: Path
    report: Path | None
    plot: Path | None

    def of(self, player: int) -> _Places:
        """The same for one of two: NAME-p1.glb, NAME-p2.glb."""
        parts = (self.output, self.report, self.plot)
        return _Places(*(path and path.with_stem(f"{path.stem}-p{player}") for path in parts))  # type: ignore[arg-type]


def _allow_long(asked: Asked, file: Path, yes: bool) -> None:
    first, last = (float(second) for second in asked.play.rows.second[[0, -1]])
    start, end = asked.section or (first, last)
    seconds = min(end, last) - max(start, first)
    if seconds > LONG and not yes:
        confirm_long(f"{file}: the motion would last {seconds / 60:.0f} minutes", "Bake")


def _write(dance: BakedDance, places: _Places, report: bool) -> None:
    form = FORMATS[places.output.suffix.lower()]
    measured = report or places.plot is not None
    for note in dance.notes(form.has_motion or measured):
        click.echo(f"warning: {note}", err=True)
    click.echo(f"{places.output}: {form.write(places.output, dance)}, {dance.label}")
    if measured:
        from dancetutor_cli.bake import mines_of
        from dancetutor_cli.bake import report as report_of
        from dancetutor_cli.bake.quality.retargeting import with_distances

        asked = dance.asked
        whole = report_of(dance.own_motion, mines_of(asked.play, asked.pad))
        _report(with_distances(whole, dance.styled.distances, dance.task.style), report, places)


def default_name(song: Song, chart: Chart) -> str:
    """SONG-difficulty.glb, in characters that every file system takes."""
    name = f"{song.title or song.path.stem}-{chart.difficulty or 'chart'}".lower()
    plain = re.sub(r"[^\w.-]+", "_", name).strip("._")
    return f"{plain or 'dance'}.glb"


def _report(report: MotionReport, asked_for: bool, places: _Places) -> None:
    if asked_for:
        from dancetutor_cli.reports.motion_report import print_report

        print_report(report)
        for note in report.notes:
            click.echo(f"note: {note}")
    if places.report is not None:
        from dancetutor_cli.files import write_atomic
        from dancetutor_cli.reports.motion_report import as_json

        write_atomic(places.report, (json.dumps(as_json(report), indent=1) + "\n").encode())
        click.echo(f"{places.report}: the report")
    if places.plot is not None:
        from dancetutor_cli.reports.motion_plot import write_plot

        write_plot(places.plot, report)
        click.echo(f"{places.plot}: the plot")
