"""The film that the user wants, whether it can be made, and its key: the same hash, the same film."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.character.characters import BUILT_IN
from dancetutor_cli.chart.music import find_music
from dancetutor_cli.chart.names import TICKS_PER_MEASURE
from dancetutor_cli.chart.pack_files import feet_fingerprint, find_settings_file
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.request import ChartChoice, DanceRequest, check_request, read_chart, section_of
from dancetutor_cli.feet.play import Play
from dancetutor_cli.film.clock import Clock, Pass, Practice, passes_of, whole_song
from dancetutor_cli.film.layout import FilmLook
from dancetutor_cli.film.notes import NoteTrack
from dancetutor_cli.run.fingerprint import NAMED, file_hash, fingerprint, program_hash

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.film.media.encoder import Encoding


# The film that the user wants, and whether it can be made: everything that can be refused before the slow work begins.


@dataclass(frozen=True, slots=True)
class FilmRequest:
    """The film that the user wants. Pickles, so that another process can prepare it.

    dance : which chart, and how it is danced; look : how it is shown
    section : "START:END" in seconds, beats or measures, or None for the whole song
    sync : seconds by which the music plays late against the notes
    character : a name of `character.characters.BUILT_IN`, or a .glb or .vrm file
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
    """The subject of a film, read and checked.

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
        return self.choice.dancer_chart

    @property
    def chart_seconds(self) -> float:
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
    """The film behind the notes begins with the music and is as long, or lasts until after the last note."""
    from dancetutor_cli.film.media.sound import seconds_of

    return 0.0, end if music is None else max(end, seconds_of(music))


# The parts that are neither danced nor shown: before the step to which a film counts in, and after a passage.

REST_SECONDS = 0.7  # seconds of the film before it begins from which on she makes no step: she stands when it does


class Quiet(NamedTuple):
    """Seconds of the music in which nobody steps: from `since` on, before `until`."""

    since: float
    until: float

    def has(self, second: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Which of these seconds are among them."""
        return np.asarray((second >= self.since) & (second < self.until - 1e-6))


def quiet_in(passes: Sequence[Pass]) -> Quiet | None:
    """The count-in of the runs of a film, which all begin at the same second; None without a count-in."""
    one = passes[0]
    return Quiet(one.start - REST_SECONDS * max(p.rate for p in passes), one.sound_from) if one.count else None


def quiet_after(passes: Sequence[Pass]) -> Quiet | None:
    """The time after a passage, in which the dancer comes to rest; None if the film ends with the passage."""
    return Quiet(passes[-1].until, math.inf) if passes[-1].rest else None


def play_without(play: Play, quiet: Quiet | None) -> Play:
    """The play without the rows of that time; where no row is left, as it is."""
    if quiet is None:
        return play
    keep = ~quiet.has(play.rows.second)
    if keep.all() or not (play.limb[keep] >= 0).any():
        return play
    rows = replace(play.rows, **_filter_arrays(play.rows, keep))
    moves = tuple(names for names, kept in zip(play.moves, keep.tolist(), strict=True) if kept)
    return replace(play, rows=rows, moves=moves, **_filter_arrays(play, keep))


def notes_without(track: NoteTrack, quiet: Quiet | None) -> NoteTrack:
    """The notes without those of that time."""
    return track if quiet is None else replace(track, **_filter_arrays(track, ~quiet.has(track.second)))


def shown_play(play: Play, passes: Sequence[Pass]) -> Play:
    """The play without the rows in a count-in and after a passage."""
    return play_without(play_without(play, quiet_in(passes)), quiet_after(passes))


def shown_notes(track: NoteTrack, passes: Sequence[Pass]) -> NoteTrack:
    """The notes without those in a count-in and after a passage."""
    return notes_without(notes_without(track, quiet_in(passes)), quiet_after(passes))


def _filter_arrays(arrays: Any, keep: NDArray[np.bool_]) -> dict[str, Any]:
    """Of each array of a dataclass the entries to keep."""
    found = {field.name: getattr(arrays, field.name) for field in fields(arrays)}
    return {name: value[keep] for name, value in found.items() if isinstance(value, np.ndarray)}


# Everything that a film is made of, as one hash: the same hash, the same film.


def film_key(request: FilmRequest, subject: FilmSubject, encoding: Encoding) -> str:
    """Hash (hex) of the chart file, which chart, the music, what is wanted of the film, and this program.

    Every field of the request is in it, and every file in which people say whose foot it is (`chart.pack_files`).
    """
    choice = subject.choice
    part = choice.parts[0]
    player = part.player if len(choice.parts) == 1 else None
    # however chart and presets were chosen, and with all that presets extend; the chart file counts by its content
    dance = replace(request.dance, selection=Selection(index=part.index, player=player), preset=None)
    music = None if subject.music is None else file_hash(subject.music)
    words = feet_fingerprint(request.path), _findings(request.path), music
    return fingerprint(replace(request, dance=dance), choice.presets, encoding, words, program_hash())


def _findings(path: Path) -> str:
    """Which findings are called out in the picture: dancetutor.yaml says so, and files that it extends."""
    from dancetutor_cli.lint.configuration import load_configuration

    return load_configuration(find_settings_file(path.absolute().parent), found=True).settings.fingerprint()
