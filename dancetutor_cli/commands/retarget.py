"""`dancetutor retarget`: captured motion through the ragdoll onto a character."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from dancetutor_cli.commands.arguments import GivenPath, warn
from dancetutor_cli.commands.option_groups import GroupedCommand
from dancetutor_cli.commands.shared_options import (
    character_option,
    check_targets,
    into,
    ragdoll_options,
    report_option,
    write_report,
)
from dancetutor_cli.formats.writers import FORMATS, describe_keys
from dancetutor_cli.run.errors import UsageError, choose_text
from dancetutor_cli.run.files import check_file, one_of, write_atomic

if TYPE_CHECKING:
    from dancetutor_cli.character.retargeting import Retargeting

SUFFIXES = (*FORMATS, ".mp4", ".html")
_FILE = GivenPath()
_CORRECTIONS = ("knees", "feet", "limits")  # as in physics.pipeline; a test compares both


@dataclass(frozen=True, slots=True)
class RetargetOptions:
    """The options of `retarget`."""

    output: Path
    character: str
    animation: str | None
    style: str | None
    correct: str
    report_to: str | None
    plot: Path | None
    push: tuple[str, ...]
    trip: tuple[float, ...]
    with_input: bool


@click.command(cls=GroupedCommand)
@click.argument("file", type=GivenPath(untrusted=True))
@click.option(
    "-o",
    "--output",
    type=_FILE,
    required=True,
    metavar="FILE",
    help=f"Name of the output: a {one_of(SUFFIXES)} file; a .html page shows input and output.",
)
@character_option
@click.option("--animation", metavar="NAME", help="Use this animation of a .glb.  [default: its first]")
@ragdoll_options
@click.option(
    "--correct",
    default=",".join(_CORRECTIONS),
    show_default=True,
    metavar="LIST",
    help="Correct these faults: knees that pop, feet that skate, joints past their limits; or none.",
)
@report_option("Measure the motion, and print a table or write JSON.")
@click.option(
    "--plot",
    type=_FILE,
    metavar="FILE.svg|.png",
    help="Draw a diagram over time: the faults of the motion and its distance from the ragdoll.",
)
@click.option(
    "--with-input",
    is_flag=True,
    help="In a film, show the input on the left and, on the output, the distance of each point from it.",
)
@into("options", RetargetOptions)
def command(file: Path, options: RetargetOptions) -> None:
    """Put the motion of FILE (.bvh, .glb, .vrm or .npz) on a character. A ragdoll follows it.

    The joints are found by their names; those of H-Anim, CMU, Mixamo, Unreal, Rigify and others are known. The limbs
    keep their directions, and the feet stand where the captured feet stood, in proportion to the character's legs.
    """
    from dancetutor_cli.character.retargeting import Retargeting, RetargetTask
    from dancetutor_cli.dance.physics.pipeline import parse_ragdoll_options
    from dancetutor_cli.formats.captured import read_source

    check_file(options.output, SUFFIXES)
    if options.with_input and options.output.suffix.lower() != ".mp4":
        raise UsageError(
            f"--with-input shows two dancers in a film: {options.output} must end in .mp4; a .html page shows both"
        )
    check_targets(options.report_to, options.plot)
    ragdoll = parse_ragdoll_options(options.push, options.trip)
    ragdoll = replace(ragdoll, corrections=corrections_of(options.correct), own_legs=True)
    task = RetargetTask(file, options.character, options.style or "neutral", ragdoll)
    work = Retargeting(task, read_source(file, options.animation))
    words = _write_output(work, options.output, options.with_input)
    warn(work.ragdoll_result.motion.notes)
    click.echo(f"{options.output}: {words}")
    if options.report_to is not None or options.plot is not None:
        write_report(work.report(), options.report_to, options.plot)


def corrections_of(text: str) -> tuple[str, ...]:
    """Return the corrections in a list from the command line. Raises UsageError for an unknown word."""
    words = [] if text.strip() in ("", "none") else [word.strip() for word in text.split(",")]
    for word in words:
        if word not in _CORRECTIONS:
            raise UsageError(f"--correct: there is no correction '{word}'{choose_text(word, (*_CORRECTIONS, 'none'))}")
    return tuple(word for word in _CORRECTIONS if word in words)


def _write_output(work: Retargeting, output: Path, with_input: bool) -> str:
    """Bake the motion and write it; return a summary for people."""
    from dancetutor_cli.dance.physics.style import engine

    engine()  # raises an error if MuJoCo is not installed, before the character is read
    motion = work.output_on_character
    suffix = output.suffix.lower()
    if suffix == ".mp4":
        from dancetutor_cli.film.work.motion_film import Comparison, write_motion_film

        seconds = float(motion.times[-1] - motion.times[0])
        compared = Comparison(work.input_on_character, *work.point_paths()) if with_input else None
        return f"{write_motion_film(output, work.character, motion, compared)} frames, {seconds:.1f} s"
    if suffix == ".html":
        from dancetutor_cli.page.capture import CaptureContent, capture_page

        content = CaptureContent(work.title, work.character, motion, *work.point_paths(), *work.input_figure)
        write_atomic(output, capture_page(content))
    else:
        FORMATS[suffix](output, work.character, motion)
    return describe_keys(motion)
