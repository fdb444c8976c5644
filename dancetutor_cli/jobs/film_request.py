"""What film is wanted, and whether it can be made: everything that can be refused before the dear work begins."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.chart.model import TICKS_PER_BEAT, TICKS_PER_MEASURE
from dancetutor_cli.errors import DancetutorError, MissingFileError, UsageError
from dancetutor_cli.jobs.part import FASTEST, SLOWEST, check_part, part_of
from dancetutor_cli.jobs.selection import Selection
from dancetutor_cli.video.clock import Clock, Pass
from dancetutor_cli.video.film_look import FilmLook

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.play.preset import Preset

LEAD_IN, LEAD_OUT = 2.0, 3.0  # seconds before the first and after the last note


@dataclass(frozen=True, slots=True)
class Practice:
    """What helps to learn. rates : speeds of the runs in turn; loop : number of runs (0: one for each rate)

    count_in : beats counted before each run; claps : a clap on each step; metronome : a tick on each beat
    """

    rates: tuple[float, ...] = (1.0,)
    loop: int = 0
    count_in: int = 0
    claps: bool = False
    metronome: bool = False


@dataclass(frozen=True, slots=True)
class Request:
    """What film is wanted. Pickles, so that another process can prepare it.

    path : the chart file; selection : which chart
    preset : name or file of the cost preset; None: what `jobs.presets` finds for the chart
    section : "START:END" in seconds, beats or measures, or None for the whole song
    play : a JSON file of analyze whose feet hold instead of the solver's
    character : a name of `character.BUILT_IN`, or a .glb or .vrm file
    bar : she holds the bar behind the pad; gait : name or file of how she walks on and off
    motion : file with numbers of the motion that are other than those of configs/motion.yaml
    sync : seconds by which the music plays late against the notes
    """

    path: Path
    selection: Selection
    look: FilmLook
    fps: int = 30
    preset: str | None = None
    section: str | None = None
    sync: float = 0.0
    mute: bool = False
    practice: Practice = Practice()
    play: Path | None = None
    character: str = "dancer"
    bar: bool = False
    gait: str = "flat"
    motion: Path | None = None


@dataclass(frozen=True, slots=True)
class Subject:
    """The chart that a request is about, read and checked.

    preset : with which the feet are found
    music : the song's file, None for a film without; section : whether only a part is wanted
    """

    song: Song
    chart: Chart
    preset: Preset
    clock: Clock
    music: Path | None
    section: bool
    warnings: tuple[str, ...]

    @property
    def written(self) -> float:
        """Length of the chart as written, empty measures included, unless only a section is wanted; seconds."""
        if self.section:
            return 0.0
        end = np.array([len(self.chart.measures.line) * TICKS_PER_MEASURE], dtype=np.int64)
        return float(self.chart.timing.seconds(end)[0])


def look_up(request: Request) -> Subject:
    """Read the chart, choose the section and find the music. DancetutorError if there is nothing to render."""
    from dancetutor_cli import chart as charts
    from dancetutor_cli.jobs.presets import choice_for, mismatch, preset_for

    if request.look.layout.dancer is not None:
        from dancetutor_cli.jobs.bake import check_motion

        check_motion(request.motion, request.gait)
    if request.section is not None:
        check_part(request.section)
    choice = choice_for(request.path, request.preset)
    song = charts.load(request.path)
    chart = request.selection.one(song)
    preset = preset_for(chart, request.path, choice)
    music, warnings = (None, ()) if request.mute else find_music(song, chart)
    if unfit := mismatch(preset, chart.steps_type):
        warnings = (*warnings, f"{chart.label}: {unfit}")
    start, end = _section(request, song, chart, preset)
    clock = Clock(passes_of(chart, request.practice, start, end), request.fps)
    return Subject(song, chart, preset, clock, music, request.section is not None, warnings)


def parse_rates(text: str) -> tuple[float, ...]:
    """ "0.5,0.75,1.0" to numbers; UsageError outside `part.SLOWEST` to `part.FASTEST`."""
    try:
        rates = tuple(float(part) for part in text.split(","))
    except ValueError:
        rates = ()
    if not rates or not all(SLOWEST <= rate <= FASTEST for rate in rates):
        raise UsageError(
            f"rate '{text}': give speeds from {SLOWEST:g} to {FASTEST:g}, separated by commas, as 0.5,0.75,1"
        )
    return rates


def passes_of(chart: Chart, practice: Practice, start: float, end: float) -> tuple[Pass, ...]:
    """The runs through a section, slower ones first as asked for, each with its count-in."""
    lead = 0.0
    if practice.count_in:
        beat = 60 / chart.timing.bpm_at(round(float(chart.timing.beats(np.array([start]))[0]) * TICKS_PER_BEAT))
        lead = practice.count_in * beat
    count = practice.loop or len(practice.rates)
    rates = (practice.rates[i % len(practice.rates)] for i in range(count))
    return tuple(Pass(start - lead, end, rate, start if lead else -math.inf, practice.count_in) for rate in rates)


def whole_song(chart: Chart) -> tuple[float, float]:
    """Start and end of the film of a whole chart, seconds of the music: from its beginning to after the last note."""
    notes = chart.notes
    if len(notes) == 0:
        raise DancetutorError(f"{chart.label}: the chart has no notes, so there is nothing to render")
    ticks = np.array([notes.tick.min(), max(notes.tick.max(), notes.end.max())])
    first, last = chart.timing.seconds(ticks)
    return min(0.0, float(first) - LEAD_IN), float(last) + LEAD_OUT


def _section(request: Request, song: Song, chart: Chart, preset: Preset) -> tuple[float, float]:
    whole = whole_song(chart)
    if request.section is None:
        return whole
    return part_of(request.section, song, chart, preset, whole[1])


def find_music(song: Song, chart: Chart) -> tuple[Path | None, tuple[str, ...]]:
    """The chart's own or the song's music; None and a warning if it is missing.

    FileError if its name leads out of the song's folder.
    """
    from dancetutor_cli.library.music import music_file

    try:
        return music_file(song, chart), ()
    except MissingFileError as error:
        return None, (f"{error}; the film has claps on the steps instead",)
