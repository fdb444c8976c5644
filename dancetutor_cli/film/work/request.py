"""The request for a film, the check whether the film can be made, and its key: equal keys mean equal films."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.character.characters import BUILT_IN
from dancetutor_cli.chart.music import find_music
from dancetutor_cli.chart.names import TICKS_PER_MEASURE
from dancetutor_cli.chart.pack_files import feet_fingerprint, find_settings_file
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.request import ChartChoice, DanceRequest, check_request, read_chart, section_of
from dancetutor_cli.film.clock import Clock, Practice, passes_of, whole_song
from dancetutor_cli.film.layout import FilmLook
from dancetutor_cli.run.stored_files import NAMED, file_hash, fingerprint, program_hash

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.film.media.encoder import Encoding


@dataclass(frozen=True, slots=True)
class FilmRequest:
    """The film that the user wants. A request can be pickled, so that another process can prepare the film.

    dance : the chart and the way of dancing it; look : the look of the picture
    section : "START:END" in seconds, beats or measures, or None for the whole song
    sync : seconds by which the music is later than the notes
    character : a name of `character.characters.BUILT_IN`, or a .glb or .vrm file
    background : a film for a game to play behind the notes, with only the dancer, and as long as the music
    motions : files of baked motions that replace the request's own dance, one for each dancer
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
    """The subject of a film, read and checked.

    music : the song's file, None for a film without music; is_section : whether it shows only a part of the song
    """

    choice: ChartChoice
    clock: Clock
    music: Path | None
    is_section: bool
    warnings: tuple[str, ...]

    @property
    def song(self) -> Song:
        """The song of the chart."""
        return self.choice.song

    @property
    def chart(self) -> Chart:
        """The chart that the film shows."""
        return self.choice.dancer_chart

    @property
    def chart_seconds(self) -> float:
        """The length of the chart as written, with empty measures, seconds; 0 for a film of a section."""
        if self.is_section:
            return 0.0
        end = np.array([len(self.chart.measures.line) * TICKS_PER_MEASURE], dtype=np.int64)
        return float(self.chart.timing.seconds(end)[0])


def look_up(request: FilmRequest) -> FilmSubject:
    """Read the chart, find the section and the music. DancetutorError if there is nothing to render."""
    if request.look.layout.dancer is not None:
        check_request(request.dance)
    choice = read_chart(request.dance, request.section)
    song, chart = choice.song, choice.dancer_chart
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
    """Return start and end of a film behind the notes: as long as the music, but at least until after the last note."""
    from dancetutor_cli.film.media.sound import seconds_of

    return 0.0, end if music is None else max(end, seconds_of(music))


def film_key(request: FilmRequest, subject: FilmSubject, encoding: Encoding) -> str:
    """Return a hash (hex) of the chart file, the choice of the chart, the music, the request, and this program.

    The hash includes every field of the request, and every file in which people set feet (`chart.pack_files`).
    """
    choice = subject.choice
    part = choice.parts[0]
    player = part.player if len(choice.parts) == 1 else None
    # The key is independent of the way in which chart and presets were chosen. It has all presets that these extend,
    # and the content of the chart file.
    dance = replace(request.dance, selection=Selection(index=part.index, player=player), preset=None)
    music = None if subject.music is None else file_hash(subject.music)
    inputs = feet_fingerprint(request.path), _settings_fingerprint(request.path), music
    return fingerprint(replace(request, dance=dance), choice.presets, encoding, inputs, program_hash())


def _settings_fingerprint(path: Path) -> str:
    """Return a fingerprint of the settings for findings: dancetutor.yaml and the files that it extends; "" without one.

    The settings of the program itself are part of its hash.
    """
    settings = find_settings_file(path.absolute().parent)
    if settings is None:
        return ""
    from dancetutor_cli.lint.configuration import load_configuration

    return load_configuration(settings, found=True).settings.fingerprint()
