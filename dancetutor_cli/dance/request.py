"""The dance that the user requests, and its chart: read and checked before the slow work begins."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.chart.pack_files import find_settings_file
from dancetutor_cli.chart.reader import load
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.settings import USUAL, load_settings
from dancetutor_cli.feet.preset import PresetChoice, choice_of, mismatch_message, preset_for
from dancetutor_cli.lint.sections import check_part, part_of
from dancetutor_cli.run.errors import UsageError
from dancetutor_cli.run.stored_files import NAMED

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.feet.preset import Preset

FPS = 60.0  # frames per second of a baked dance, unless a file with another rate is requested


def _style_sources(style: str) -> object:
    from dancetutor_cli.dance.physics.blend import style_sources

    return style_sources(style)


@dataclass(frozen=True, slots=True)
class DanceRequest:
    """The dance that the user requests. It can be pickled, so that another process can bake it.

    path : the chart file; selection : the chart in it
    preset : name or file of the solver's costs; None: the preset that `feet.preset` finds for the chart
    play : a JSON file of analyze whose feet replace the feet of the solver
    rates : speeds of the music, 1 is the original; a note that is not played at the fastest rate is not danced at any
    rate
    fps : regular keys per second
    bar : whether the dancer holds the bar behind the pad; gait : name or file of the way she walks on and off
    form : name or file of the way she stands and turns
    motion : file with numbers that replace numbers of configs/motion.yaml
    style : name or file of the style in which a ragdoll follows the dancer, or a blend, as
    `dance.physics.blend.load_choice` takes it; None: no ragdoll
    push, trip : disturbances, as `dance.physics.pushes.parse_push` takes them, and seconds of the song; only with a
    style
    """

    path: Path
    selection: Selection
    preset: str | None = None
    play: Path | None = None
    rates: tuple[float, ...] = (1.0,)
    fps: float = FPS
    bar: bool = False
    gait: str = field(default="flat", metadata={NAMED: "gaits"})
    form: str = field(default=USUAL, metadata={NAMED: "forms"})
    motion: Path | None = None
    style: str | None = field(default=None, metadata={NAMED: _style_sources})
    push: tuple[str, ...] = ()
    trip: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class ChartChoice:
    """The chart of a request. chart : as it is written; parts : the part of each dancer; most charts have one part

    presets : the solver's costs, for each part; warnings : lines for the user about pads that do not fit a preset
    """

    song: Song
    chart: Chart
    parts: tuple[Chart, ...]
    presets: tuple[Preset, ...]
    warnings: tuple[str, ...]

    @property
    def dancer_chart(self) -> Chart:
        """The part of a single dancer; for two dancers, the chart as it is written."""
        return self.parts[0] if len(self.parts) == 1 else self.chart


def check_request(request: DanceRequest) -> None:
    """Check the files and names of a request before the slow work. Raises FileError or UsageError.

    Raises UnavailableError if a style is requested and its engine is not installed.
    """
    from dancetutor_cli.dance.gait import load_gait

    load_settings(request.motion, request.form)
    load_gait(request.gait)
    if request.style is not None:
        from dancetutor_cli.dance.physics.blend import load_choice
        from dancetutor_cli.dance.physics.style import engine

        load_choice(request.style)
        engine()
    if request.push:
        from dancetutor_cli.dance.physics.pushes import parse_push

        for push in request.push:
            parse_push(push)


def with_style(request: DanceRequest) -> DanceRequest:
    """Return the request with the style `neutral` if it has a push or trip but names no style."""
    return replace(request, style="neutral") if request.style is None and (request.push or request.trip) else request


def choice_for(path: Path, given: str | None) -> PresetChoice:
    """Return the presets for the charts of a file, with the nearest dancetutor.yaml up the folder tree."""
    if given is not None:
        return choice_of(given)
    settings = find_settings_file(path.absolute().parent)
    if settings is None:
        return choice_of(None)
    from dancetutor_cli.lint.configuration import load_configuration

    return choice_of(None, load_configuration(settings, found=True).presets)


def read_chart(request: DanceRequest, section: str | None = None) -> ChartChoice:
    """Read the file and choose the chart. Raises a DancetutorError of one line for each error in the request.

    section : checked here, so that an error in it is reported before a chart is read
    """
    from dancetutor_cli.dance.performance import check_alone

    if section is not None:
        check_part(section)
    choice = choice_for(request.path, request.preset)
    song = load(request.path)
    first = request.selection.only_chart(song)
    chart = song.charts[first.index]
    parts: tuple[Chart, ...] = (first,)
    if request.selection.player is None and len(chart.players) > 1:
        check_alone(request, chart)
        parts = tuple(one for one in chart.players if len(one.notes)) or parts
    presets = tuple(preset_for(part, request.path, choice) for part in parts)
    pairs = zip(parts, presets, strict=True)
    lines = [f"{part.label}: {unfit}" for part, preset in pairs if (unfit := mismatch_message(preset, part.steps_type))]
    return ChartChoice(song, chart, parts, presets, tuple(dict.fromkeys(lines)))


def section_of(chart: ChartChoice, section: str, end: float) -> tuple[float, float]:
    """Return the first and last second of a section that the user wrote. `end` is the largest allowed second."""
    return part_of(section, chart.song, chart.parts[0], chart.presets[0], end)


def no_pad(request: DanceRequest, chart: Chart) -> UsageError:
    """Return the error for a steps type without a known pad."""
    return UsageError(
        f"{request.path}: no pad is known for steps type '{chart.steps_type}', so there is nobody to bake"
    )
