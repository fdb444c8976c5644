"""The way from a request to a film's plan: find the dance, and put everything on the clock of the film."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.character.characters import DANCER, load_character, name_in_gait
from dancetutor_cli.character.mesh import with_foot_colours
from dancetutor_cli.chart.density import fastest_bpm
from dancetutor_cli.dance.motion import Motion
from dancetutor_cli.film.choices import parse_ahead
from dancetutor_cli.film.clock import whole_song
from dancetutor_cli.film.media.sound import SoundPlan, clicks_of
from dancetutor_cli.film.media.subtitles import cues_of, subtitle_words
from dancetutor_cli.film.notes import beat_lines, note_track, presses_of
from dancetutor_cli.film.overlay.callouts import CalloutSubject, CallStyle, callouts_of
from dancetutor_cli.film.overlay.diagram import step_rows
from dancetutor_cli.film.overlay.footer import SongShape
from dancetutor_cli.film.overlay.header import title_warnings, words_of
from dancetutor_cli.film.overlay.sprites import callout_words, highway_style
from dancetutor_cli.film.plan import FilmPlan, faces_viewer
from dancetutor_cli.film.scene.scene import Scene
from dancetutor_cli.film.scene.visibility import feet_hidden
from dancetutor_cli.film.scroll import ScrollSegments, SpeedSegments, reading_bpm, segments_of, speeds_of
from dancetutor_cli.film.words import PanelNames
from dancetutor_cli.film.work.film_dance import FilmDance, bake_film_dance, shown_notes
from dancetutor_cli.film.work.request import FilmRequest, FilmSubject
from dancetutor_cli.run.languages import load_language

if TYPE_CHECKING:
    from dancetutor_cli.character.mesh import Character
    from dancetutor_cli.chart.model import Chart
    from dancetutor_cli.feet.pads import Pad
    from dancetutor_cli.feet.play import Play
    from dancetutor_cli.feet.solved import Solved
    from dancetutor_cli.film.layout import FilmLook
    from dancetutor_cli.film.notes import Callout, Cue, NoteTrack, Presses
    from dancetutor_cli.lint.findings import Finding


PICTURE_FADE = 0.6  # seconds in which the picture goes dark at the end of a film, or before a GIF starts again
HIGH = "front-high"  # the camera of configs/picture.yaml for characters who hide their feet from behind


@dataclass(frozen=True, slots=True)
class PreparedFilm:
    """A film's plan, its sound (None for a silent film), and warnings in addition to the subject's."""

    plan: FilmPlan
    sound: SoundPlan | None
    warnings: tuple[str, ...]


def prepare(request: FilmRequest, subject: FilmSubject) -> PreparedFilm:
    """Do all slow work before the first frame. DancetutorError describes an error in one line."""
    song, chart, clock = subject.song, subject.chart, subject.clock
    dance = bake_film_dance(request, subject)
    play, pad = dance.play, dance.pad
    scrolls, speeds = segments_of(song, chart), speeds_of(song, chart)
    whole_track = note_track(chart, play, scrolls, dance.on_mines)
    track = shown_notes(whole_track, clock.passes)
    presses = presses_of(track)
    start, end = clock.passes[0].start, clock.passes[-1].until
    whole = whole_song(chart)
    seconds = np.array([clock.at(k)[0] for k in range(clock.frames)])
    who = name_in_gait(request.character, request.dance.gait)
    character, motions = _fitted(who, dance.motions, bool(request.motions))
    look = _with_feet_camera(request.look, character, pad)
    plan = FilmPlan(
        look=look,
        clock=clock,
        words=words_of(song, chart, request.look.font, load_language(look.language)),
        song=SongShape(np.unique(presses_of(whole_track).start), max(0.0, whole[0]), max(whole[1], end), (start, end)),
        notes=track,
        presses=presses,
        lines=beat_lines(chart, scrolls, clock.passes[-1].end),
        beats=scrolls.drawn_beats(chart.timing.beats(seconds)),
        speeds=speeds.at(seconds),
        scroll_bpm=_scroll_bpm(chart, track, speeds),
        directions=pad.directions,
        motions=motions,
        pad=pad,
        rows=step_rows(play, _dancers(dance)),
        character=character,
        callouts=() if request.background else _callouts(dance, _calls(look), scrolls),
        cues=tuple(_cues(dance, look)),
        fade=PICTURE_FADE if request.practice.rest and not request.background else 0.0,
    )
    notes = [note for rate, some in motions.items() for motion in some for note in _at_rate(rate, motion.notes)]
    warnings = (*notes, *title_warnings(song, plan.words, request.look.font))
    return PreparedFilm(plan, _sound(request, subject, presses), warnings)


def _sound(request: FilmRequest, subject: FilmSubject, presses: Presses) -> SoundPlan | None:
    """Return the music and the clicks of a film; None for a silent one."""
    if request.mute or request.background:
        return None
    passes = subject.clock.passes
    fade = passes[-1].rest / passes[-1].rate if subject.is_section else 1.0
    practice = replace(request.practice, claps=request.practice.claps or subject.music is None)
    clicks = clicks_of(practice, passes[0], subject.chart.timing, presses.start)
    return SoundPlan(subject.music, request.sync, clicks, fade)


def _dancers(dance: FilmDance) -> list[tuple[Play, int]]:
    """Return the play of each of several dancers, with its first column; empty for one dancer."""
    plays = [(play, one.chart.first_column) for one, play in zip(dance.solved, dance.plays, strict=True)]
    return plays if len(plays) > 1 else []


def _scroll_bpm(chart: Chart, track: NoteTrack, speeds: SpeedSegments) -> float:
    """Return the tempo from which M mods make their speed."""
    seconds, first = np.unique(track.second[track.judged], return_index=True)
    return reading_bpm(seconds, track.beat[track.judged][first], speeds.at(seconds)) or fastest_bpm(chart)


def _with_feet_camera(look: FilmLook, character: Character | None, pad: Pad) -> FilmLook:
    """Return the look with a camera that shows the feet of a character who hides them from behind.

    A camera that the user has chosen stays.
    """
    part = look.layout.dancer
    if character is None or part is None or look.camera is not None or look.layout.screen is not None:
        return look

    camera = Scene(character, pad).camera(part.camera, look.size, part.region)
    return replace(look, camera=HIGH) if feet_hidden(character, camera, look.size) else look


def _callouts(dance: FilmDance, style: CallStyle, scrolls: ScrollSegments) -> tuple[Callout, ...]:
    """Return the calls; for two dancers only common moves and mines, because only calls of mines name their dancer."""
    if len(dance.solved) == 1:
        return callouts_of(_about(dance.solved[0]), dance.play, style, scrolls, dance.on_mines)
    pairs = zip(dance.solved, dance.plays, strict=True)
    first, *others = (callouts_of(_about(one), play, style, scrolls) for one, play in pairs)
    both = [call for call in first if all(call in of_other for of_other in others)]
    return tuple(sorted([*both, *_mines_of_each(dance, style, scrolls)], key=lambda call: call.second))


def _about(one: Solved) -> CalloutSubject:
    return CalloutSubject(one.chart, one.pad, partial(_findings_of, one))


def _findings_of(one: Solved) -> tuple[Finding, ...]:
    from dancetutor_cli.lint.check import findings_of
    from dancetutor_cli.lint.subject import subject_of

    return findings_of(subject_of(one))


def _mines_of_each(dance: FilmDance, style: CallStyle, scrolls: ScrollSegments) -> Iterator[Callout]:
    """Return the calls of mines under a foot for two dancers, each with the name of its dancer."""
    mines_alone = replace(style, findings=False)
    for one in dance.solved:
        under = [mine for mine in dance.on_mines if mine.player == one.chart.player]
        for call in callouts_of(_about(one), None, mines_alone, scrolls, under):
            who = style.language.film["player"].replace("{number}", str(one.chart.player))
            yield replace(call, text=f"{who}: {call.text.replace(': ', ' ')}")


def _calls(look: FilmLook) -> CallStyle:
    ahead, language = look.ahead or parse_ahead(highway_style().callout_ahead), load_language(look.language)
    return CallStyle(callout_words(language), ahead, look.findings, faces_viewer(look), language)


def _cues(dance: FilmDance, look: FilmLook) -> list[Cue]:
    """Return the moves for subtitles; for two dancers with the player's number."""
    language = load_language(look.language)
    words, facing = subtitle_words(language), faces_viewer(look)
    cues = [
        replace(cue, text=f"P{one.chart.player}: {cue.text}") if len(dance.solved) > 1 else cue
        for one, play in zip(dance.solved, dance.plays, strict=True)
        if one.pad is not None
        for cue in cues_of(play, one.chart.timing, words, PanelNames(one.pad, facing, language))
    ]
    return sorted(cues, key=lambda cue: (cue.second, cue.text))


def _at_rate(rate: float, notes: tuple[str, ...]) -> list[str]:
    return [note if rate == 1.0 else f"at rate {rate:g}, {note}" for note in notes]


def _fitted(
    name: str, motions: Mapping[float, tuple[Motion, ...]], given: bool
) -> tuple[Character | None, Mapping[float, tuple[Motion, ...]]]:
    """Return the character who dances and the motions for its skeleton.

    The character is None for the project's dancer, whom each drawing process has.

    given : whether the motions are from files, which may already be for the character's skeleton
    """
    if not motions or (name == DANCER and not given):
        return None, motions
    from dancetutor_cli.character.onto_skeleton import onto

    character = with_foot_colours(load_character(name))

    def fitted(motion: Motion) -> Motion:
        if given and motion.skeleton.names == character.skeleton.names:
            return motion
        return onto(motion, character.skeleton)

    some = {rate: tuple(map(fitted, both)) for rate, both in motions.items()}
    return None if name == DANCER else character, some
