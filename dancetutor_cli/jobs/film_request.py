"""What film is wanted, and whether it can be made: everything that can be refused before the dear work begins."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.character import BUILT_IN
from dancetutor_cli.chart.model import TICKS_PER_MEASURE
from dancetutor_cli.dance.request import ChartChoice, DanceRequest, check_request, read_chart, section_of
from dancetutor_cli.fingerprint import NAMED
from dancetutor_cli.library.music import find_music
from dancetutor_cli.video.clock import Clock
from dancetutor_cli.video.film_look import FilmLook
from dancetutor_cli.video.practice import Practice, passes_of, whole_song

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song


@dataclass(frozen=True, slots=True)
class FilmRequest:
    """What film is wanted. Pickles, so that another process can prepare it.

    dance : which chart, and how it is danced; look : how it is shown
    section : "START:END" in seconds, beats or measures, or None for the whole song
    sync : seconds by which the music plays late against the notes
    character : a name of `character.BUILT_IN`, or a .glb or .vrm file
    background : the film that a game plays behind the notes: as long as the music, and of the dancer alone
    motions : files of a baked motion that is drawn in place of the request's own dance, one for each dancer
    """

    dance: DanceRequest
    look: FilmLook
    fps: int = 30
    section: str | None = None
    sync: float = 0.0
    mute: bool = False
    practice: Practice = field(default_factory=Practice)
    character: str = field(default="dancer", metadata={NAMED: BUILT_IN})
    background: bool = False
    motions: tuple[Path, ...] = ()

    @property
    def path(self) -> Path:
        """The chart file."""
        return self.dance.path


@dataclass(frozen=True, slots=True)
class FilmSubject:
    """What a film is about, read and checked.

    music : the song's file, None for a film without; section : whether only a part is wanted
    """

    choice: ChartChoice
    clock: Clock
    music: Path | None
    section: bool
    warnings: tuple[str, ...]

    @property
    def song(self) -> Song:
        """The song."""
        return self.choice.song

    @property
    def chart(self) -> Chart:
        """The chart that the film shows."""
        return self.choice.shown

    @property
    def written(self) -> float:
        """Length of the chart as written, empty measures included, unless only a section is wanted; seconds."""
        if self.section:
            return 0.0
        end = np.array([len(self.chart.measures.line) * TICKS_PER_MEASURE], dtype=np.int64)
        return float(self.chart.timing.seconds(end)[0])


def look_up(request: FilmRequest) -> FilmSubject:
    """Read the chart, choose the section and find the music. DancetutorError if there is nothing to render."""
    if request.look.layout.dancer is not None:
        check_request(request.dance)
    choice = read_chart(request.dance, request.section)
    song, chart = choice.song, choice.shown
    music, missing = (None, None) if request.mute else find_music(song, chart)
    instead = "the film ends after the last note" if request.background else "the film has claps on the steps instead"
    warnings = () if missing is None else (f"{missing}; {instead}",)
    whole = whole_song(chart)
    start, end = whole if request.section is None else section_of(choice, request.section, whole[1])
    if request.background:
        start, end = _with_the_music(end, music)
    practice = request.practice
    if request.section is None or end >= whole[1]:
        practice = replace(practice, rest=0.0)
    clock = Clock(passes_of(chart, practice, request.dance.rates, start, end), request.fps)
    return FilmSubject(choice, clock, music, request.section is not None, (*warnings, *choice.warnings))


def _with_the_music(end: float, music: Path | None) -> tuple[float, float]:
    """The film behind the notes begins with the music and is as long, or lasts until after the last note."""
    from dancetutor_cli.video.media.sound import seconds_of

    return 0.0, end if music is None else max(end, seconds_of(music))
