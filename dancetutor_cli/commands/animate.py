"""`dancetutor animate`: bake a dancer who plays a chart, and measure the quality of the motion."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from dancetutor_cli.chart.selection import Selection, note_bytes, one_song
from dancetutor_cli.chart.timing import FASTEST, SLOWEST, heard_second
from dancetutor_cli.commands.arguments import LONG, GivenPath, Number, confirm_long, default_name, warn
from dancetutor_cli.commands.first_run import announce_compiling
from dancetutor_cli.commands.option_groups import GroupedCommand
from dancetutor_cli.commands.shared_options import (
    TABLE,
    DanceOptions,
    character_option,
    check_targets,
    dance_options,
    into,
    jobs_option,
    preset_option,
    ragdoll_options,
    report_option,
    section_option,
    selection_options,
    write_report,
    yes_option,
)
from dancetutor_cli.formats.writers import FORMATS, MOVES, write_dancer
from dancetutor_cli.run.errors import UsageError
from dancetutor_cli.run.files import check_file, one_of

if TYPE_CHECKING:
    from dancetutor_cli.character.animation import AnimatedDancer
    from dancetutor_cli.dance.performance import Performance
    from dancetutor_cli.dance.request import ChartChoice

_FILE = GivenPath()
AFTER = 2.5  # limit of a section's end, seconds after the last row


@dataclass(frozen=True, slots=True)
class AnimateOptions:
    """The options without those of the charts and of the dance."""

    output: Path | None
    report_to: str | None
    plot: Path | None
    character: str
    yes: bool
    physics: bool
    section: str | None
    fps: float
    rate: float
    jobs: int


@click.command(cls=GroupedCommand)
@click.argument("file", type=GivenPath(untrusted=True))
@click.option(
    "-o",
    "--output",
    type=_FILE,
    metavar="FILE",
    help=f"Name of the output: a {one_of((*FORMATS, MOVES))} file.  [default: SONG-difficulty.glb]",
)
@click.option(
    "--fps",
    type=Number(1, 1000),
    default=60,
    show_default=True,
    metavar="N",
    help="Frames per second.",
)
@section_option
@click.option(
    "--rate",
    type=Number(SLOWEST, FASTEST),
    default=1,
    show_default=True,
    metavar="RATE",
    help="Speed of the music, 1 is normal.",
)
@report_option("Measure the motion, and print a table or write JSON.")
@click.option(
    "--plot",
    type=_FILE,
    metavar="FILE.svg|.png",
    help="Draw a diagram over time: errors, height and jerk of the motion.",
)
@dance_options
@ragdoll_options
@click.option("--physics", is_flag=True, help="The same as --style neutral.")
@jobs_option("songs over two minutes")
@yes_option
@character_option
@selection_options
@preset_option
@into("selection", Selection)
@into("dance", DanceOptions)
@into("options", AnimateOptions)
def command(file: Path, selection: Selection, dance: DanceOptions, options: AnimateOptions) -> None:
    """Write the motion of a 3D dancer who plays one chart of FILE.

    The ending of the output name sets the format: .glb for any glTF viewer, .npz with numpy arrays, .bvh for motion
    capture tools, or .json with only the steps of each foot. A chart for two players gives two files, NAME-p1 and
    NAME-p2; --player writes only one.
    """
    from dancetutor_cli.character.animation import AnimatedDancer, Animation
    from dancetutor_cli.character.characters import DANCER, load_character, name_in_gait
    from dancetutor_cli.character.mesh import partner_of
    from dancetutor_cli.dance.performance import perform, piece_runner, solve
    from dancetutor_cli.dance.request import check_request, choice_for, read_chart, with_style

    if options.output is not None:
        check_file(options.output, (*FORMATS, MOVES))
    check_targets(options.report_to, options.plot)
    output, character = options.output, options.character
    if output is not None and output.suffix.lower() == MOVES:
        without = {"character": character != DANCER, "push": dance.push, "trip": dance.trip}
        if unused := [name for name, given in without.items() if given]:
            raise UsageError(f"{output}: has only the steps, which --{unused[0]} does not change; leave it out")
    dances = load_character(name_in_gait(character, dance.gait))
    request = replace(dance.request(one_song(file), selection), rates=(options.rate,), fps=options.fps)
    if options.physics and request.style is None:
        request = replace(request, style="neutral")
    request = with_style(request)
    announce_compiling(choice_for(request.path, request.preset), lambda: note_bytes(request.path, selection))
    check_request(request)
    choice = read_chart(request, options.section)
    performance = perform(solve(request, choice), request, options.rate)
    warn(choice.warnings)
    target = output or default_name(choice.song, choice.parts[0], ".glb")
    check_file(target, (*FORMATS, MOVES))
    section = _section(choice, options.section, performance)
    _allow_long(performance, section, file, options.yes)
    places = _Places(target, options.report_to, options.plot)
    animation = Animation(performance, section, piece_runner(options.jobs))
    for k, who in enumerate((dances,) if len(performance.dancers) == 1 else (dances, partner_of(dances))):
        player = choice.parts[k].player
        own = places if len(performance.dancers) == 1 else places.of(player)
        _write(AnimatedDancer(animation, k, who), own)


def _section(choice: ChartChoice, section: str | None, performance: Performance) -> tuple[float, float] | None:
    """Return the start and the end of a section in seconds of the music as it is heard; None for the whole chart."""
    from dancetutor_cli.dance.request import section_of

    if section is None:
        return None
    plays = [one.solved.play for one in performance.dancers]
    last = max(float(play.rows.second[-1]) for play in plays if play is not None)
    start, end = section_of(choice, section, last + AFTER)
    return heard_second(start, performance.rate), heard_second(end, performance.rate)


@dataclass(frozen=True, slots=True)
class _Places:
    """The output files. report_to : as `report_option` gives it; plot : the diagram, or None"""

    output: Path
    report_to: str | None
    plot: Path | None

    def of(self, player: int) -> _Places:
        """Return the files of one of two players: NAME-p1.glb, NAME-p2.glb."""

        def named(path: Path) -> Path:
            return path.with_stem(f"{path.stem}-p{player}")

        is_file = self.report_to not in (None, TABLE)
        report_to = str(named(Path(str(self.report_to)))) if is_file else self.report_to
        return _Places(named(self.output), report_to, self.plot and named(self.plot))


def _allow_long(performance: Performance, section: tuple[float, float] | None, file: Path, yes: bool) -> None:
    rows = [one.play.rows.second for one in performance.dancers]
    first, last = min(float(seconds[0]) for seconds in rows), max(float(seconds[-1]) for seconds in rows)
    start, end = section or (first, last)
    seconds = min(end, last) - max(start, first)
    if seconds > LONG and not yes:
        confirm_long(f"{file}: the motion would last {seconds / 60:.0f} minutes", "Bake")


def _write(dance: AnimatedDancer, places: _Places) -> None:
    measured = places.report_to is not None or places.plot is not None
    warn(dance.notes(places.output.suffix.lower() != MOVES or measured))
    click.echo(f"{places.output}: {write_dancer(places.output, dance)}, {dance.label}")
    if measured:
        from dancetutor_cli.dance.quality.contact import mines_of
        from dancetutor_cli.dance.quality.report import report as report_of
        from dancetutor_cli.dance.quality.report import with_distances

        dancer = dance.animation.performance.dancers[dance.number]
        whole = report_of(dance.baked_piece.motion, mines_of(dancer.play, dancer.pad))
        report = with_distances(whole, dance.baked_piece.distances, dance.animation.performance.request.style)
        write_report(report, places.report_to, places.plot)
