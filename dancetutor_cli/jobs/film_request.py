"""What film is wanted, and whether it can be made: everything that can be refused before the dear work begins."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.chart.model import TICKS_PER_MEASURE
from dancetutor_cli.jobs.chosen import chosen
from dancetutor_cli.library.music import find_music
from dancetutor_cli.library.selection import Selection
from dancetutor_cli.lint.part import part_of
from dancetutor_cli.motion.forms import USUAL
from dancetutor_cli.video.clock import Clock
from dancetutor_cli.video.film_look import FilmLook
from dancetutor_cli.video.practice import Practice, passes_of, whole_song

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.play.preset import Preset


@dataclass(frozen=True, slots=True)
class FilmRequest:
    """What film is wanted. Pickles, so that another process can prepare it.

    path : the chart file; selection : which chart
    preset : name or file of the cost preset; None: what `lint.presets` finds for the chart
    section : "START:END" in seconds, beats or measures, or None for the whole song
    play : a JSON file of analyze whose feet hold instead of the solver's
    character : a name of `character.BUILT_IN`, or a .glb or .vrm file
    bar : she holds the bar behind the pad; gait : name or file of how she walks on and off
    form : name or file of how she stands and turns
    motion : file with numbers of the motion that are other than those of configs/motion.yaml
    background : the film that a game plays behind the notes: as long as the music, and of the dancer alone
    style : name or file of the style in which a ragdoll follows the dancer; None: no ragdoll
    push, trip : what befalls her, as `jobs.bake.wishes_of` takes it; only with a style
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
    practice: Practice = field(default_factory=Practice)
    play: Path | None = None
    character: str = "dancer"
    bar: bool = False
    gait: str = "flat"
    motion: Path | None = None
    form: str = USUAL
    style: str | None = None
    push: tuple[str, ...] = ()
    trip: tuple[float, ...] = ()
    background: bool = False


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


def look_up(request: FilmRequest) -> Subject:
    """Read the chart, choose the section and find the music. DancetutorError if there is nothing to render."""
    if request.look.layout.dancer is not None:
        from dancetutor_cli.jobs.bake import check_motion, check_style, wishes_of

        check_motion(request.motion, request.gait, request.form)
        check_style(request.style)
        wishes_of(request.push, request.trip)
    song, chart, preset, notes = chosen(request.path, request.selection, request.preset, request.section, both=True)
    music, missing = (None, None) if request.mute else find_music(song, chart)
    instead = "the film ends after the last note" if request.background else "the film has claps on the steps instead"
    warnings = () if missing is None else (f"{missing}; {instead}",)
    start, end = _section(request, song, chart, preset)
    if request.background:
        start, end = _with_the_music(end, music)
    practice = request.practice
    if request.section is None or end >= whole_song(chart)[1]:
        practice = replace(practice, rest=0.0)
    clock = Clock(passes_of(chart, practice, start, end), request.fps)
    return Subject(song, chart, preset, clock, music, request.section is not None, (*warnings, *notes))


def _with_the_music(end: float, music: Path | None) -> tuple[float, float]:
    """The film behind the notes begins with the music and is as long, or lasts until after the last note."""
    from dancetutor_cli.video.media.sound import seconds_of

    return 0.0, end if music is None else max(end, seconds_of(music))


def _section(request: FilmRequest, song: Song, chart: Chart, preset: Preset) -> tuple[float, float]:
    whole = whole_song(chart)
    if request.section is None:
        return whole
    return part_of(request.section, song, chart, preset, whole[1])
