"""From a request to a film's plan: read the chart, solve the feet, bake the dancer, and lay everything on the clock."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.chart.model import TICKS_PER_BEAT, Kind
from dancetutor_cli.errors import UsageError
from dancetutor_cli.jobs.callouts import callouts_of
from dancetutor_cli.jobs.cues import cues_of
from dancetutor_cli.jobs.film_request import Request, Subject, whole_song
from dancetutor_cli.lint.subject import ChartSubject
from dancetutor_cli.play.model import StepKind
from dancetutor_cli.video.film import FilmPlan
from dancetutor_cli.video.film_look import FilmLook
from dancetutor_cli.video.media.sound import Click, SoundPlan
from dancetutor_cli.video.media.subtitles import subtitle_style
from dancetutor_cli.video.notes import BeatLines, NoteTrack, Presses
from dancetutor_cli.video.overlay.captions import SongShape, Words
from dancetutor_cli.video.overlay.diagram import StepRows
from dancetutor_cli.video.overlay.sprites import highway_style, quantisation
from dancetutor_cli.video.overlay.text import Typeface, clean
from dancetutor_cli.video.scroll import ScrollSegments, parse_segments, parse_speeds

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from dancetutor_cli.character.model import Character
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.chart.timing import Timing
    from dancetutor_cli.motion.model import Motion
    from dancetutor_cli.pads import Pad
    from dancetutor_cli.play.model import Play


CLAP, TICK, ACCENT = 1150.0, 1600.0, 2200.0  # Hz


@dataclass(frozen=True, slots=True)
class Prepared:
    """A film's plan, its sound (None: silent), and warnings that the subject had not yet."""

    plan: FilmPlan
    sound: SoundPlan | None
    warnings: tuple[str, ...]


def prepare(request: Request, subject: Subject) -> Prepared:
    """Do everything dear that comes before the first frame. DancetutorError says in one line what is wrong."""
    from dancetutor_cli.jobs.feet import solve_with_feet
    from dancetutor_cli.pads import load_pad

    song, chart, clock = subject.song, subject.chart, subject.clock
    play, ignores = solve_with_feet(song, chart, subject.preset)
    pad = load_pad(chart.steps_type)
    if play is None or pad is None:
        raise UsageError(f"{request.path}: no pad is known for steps type '{chart.steps_type}'")
    if request.play is not None:
        from dancetutor_cli.formats.play_json import read_play

        play = read_play(request.play, chart, play.rows, pad)
    scrolls = parse_segments(timing_tag(song, chart, "SCROLLS"))
    track = note_track(chart, play, scrolls)
    presses = presses_of(track)
    start, end = clock.passes[0].start, clock.passes[-1].end
    whole = whole_song(chart)
    seconds = np.array([clock.at(k)[0] for k in range(clock.frames)])
    character, motions = _fitted(request.character, _motions(request, subject, play, pad))
    plan = FilmPlan(
        look=request.look,
        clock=clock,
        words=words_of(song, chart, request.look),
        song=SongShape(np.unique(presses.start), max(0.0, whole[0]), max(whole[1], end), (start, end)),
        notes=track,
        presses=presses,
        lines=beat_lines(chart, scrolls, end),
        beats=scrolls.shown(chart.timing.beats(seconds)),
        speeds=parse_speeds(timing_tag(song, chart, "SPEEDS"), chart.timing.seconds_of_beats).at(seconds),
        fastest_bpm=fastest_bpm(chart),
        directions=directions_of(pad),
        motions=motions,
        pad=pad,
        rows=step_rows(play),
        character=character,
        callouts=callouts_of(ChartSubject(song, chart, play, pad, ignores=ignores), highway_style().callouts, scrolls),
        cues=cues_of(play, chart.timing, subtitle_style().moves),
    )
    fade = 0.0 if request.section else 1.0
    sound = None if request.mute else SoundPlan(subject.music, request.sync, clicks_of(request, subject, presses), fade)
    notes = [note for rate, motion in motions.items() for note in _at_rate(rate, motion.notes)]
    return Prepared(plan, sound, (*notes, *title_warnings(song, plan.words, request.look)))


def note_track(chart: Chart, play: Play | None, scrolls: ScrollSegments) -> NoteTrack:
    """The notes as the highway draws them; keysounds are not notes to see."""
    table = chart.notes
    keep = table.kind != Kind.KEYSOUND
    tick, end = table.tick[keep], np.where(table.end[keep] >= 0, table.end[keep], table.tick[keep])
    limb = np.full(len(table), -1, dtype=np.int8)
    if play is not None and len(play.rows):
        row = np.searchsorted(play.rows.tick, table.tick)
        row = np.clip(row, 0, len(play.rows) - 1)
        found = (play.rows.tick[row] == table.tick) & (table.column < play.limb.shape[1])
        limb[found] = play.limb[row[found], table.column[found]]
    second = _seconds(chart.timing, tick)
    order = np.argsort(second, kind="stable")
    track = NoteTrack(
        second=second,
        end_second=_seconds(chart.timing, end),
        beat=scrolls.shown(tick / TICKS_PER_BEAT),
        end_beat=scrolls.shown(end / TICKS_PER_BEAT),
        column=table.column[keep],
        kind=table.kind[keep],
        limb=limb[keep],
        quantisation=quantisation(tick),
        judged=table.judged[keep],
    )
    return NoteTrack(*(getattr(track, field.name)[order] for field in fields(NoteTrack)))


def step_rows(play: Play) -> StepRows:
    """The rows with steps that a person sees; the virtual taps of rolls are not among them."""
    shown = play.rows.steps != StepKind.NONE
    shown &= play.rows.steps != StepKind.ROLL_TAP
    keep = shown.any(axis=1)
    limb = np.where(shown, play.limb, np.int8(-1))
    return StepRows(play.rows.second[keep], limb[keep], play.feet[keep])


def presses_of(track: NoteTrack) -> Presses:
    """Every press of a panel: taps, lifts, and holds and rolls from head to tail."""
    step = track.judged & np.isin(track.kind, (Kind.TAP, Kind.LIFT, Kind.HOLD, Kind.ROLL))
    return Presses(track.second[step], track.end_second[step], track.column[step], track.limb[step])


def beat_lines(chart: Chart, scrolls: ScrollSegments, end: float) -> BeatLines:
    """One line per beat, from beat 0 to the end of the film."""
    last = max(int(chart.notes.tick.max(initial=0)), int(chart.notes.end.max(initial=0)))
    beats = np.arange(min(last // TICKS_PER_BEAT + 64, 2_000_000), dtype=np.int64)
    second = _seconds(chart.timing, beats * TICKS_PER_BEAT)
    keep = second <= end + 60
    return BeatLines(second[keep], scrolls.shown(beats.astype(np.float64))[keep])


def _seconds(timing: Timing, ticks: NDArray[np.int64]) -> NDArray[np.float64]:
    return np.asarray(timing.seconds(ticks), dtype=np.float64)


def timing_tag(song: Song, chart: Chart, name: str) -> str:
    """A timing tag as it holds for the chart: its own if it has split timing, else the song's."""
    return (song.tags if chart.timing is song.timing else chart.tags).get(name, "")


def directions_of(pad: Pad) -> tuple[float | None, ...]:
    """Where each panel's arrow points, degrees clockwise from up, None for a middle panel; as drawn on the pad."""
    return tuple(math.degrees(math.atan2(x, y)) % 360 if x or y else None for x, y in pad.arrows.tolist())


def words_of(song: Song, chart: Chart, look: FilmLook) -> Words:
    """The words of the picture, with the transliterated title where the font lacks the original's letters."""
    face = Typeface(look.font)
    title = _readable(face, song, song.title or song.path.stem, "TITLETRANSLIT")
    subtitle = _readable(face, song, song.subtitle, "SUBTITLETRANSLIT")
    artist = _readable(face, song, song.artist, "ARTISTTRANSLIT")
    credit = clean(chart.tags.get("CREDIT", ""))
    detail = f"{chart.steps_type} · {bpm_text(chart)} BPM"
    return Words(
        title=" ".join(part for part in (title, subtitle) if part),
        artist=artist,
        badge=face.drawable(f"{chart.difficulty} {chart.meter}"),
        difficulty=chart.difficulty,
        detail=face.drawable(detail),
        credit=face.drawable(f"steps by {credit}") if credit else "",
    )


def _readable(face: Typeface, song: Song, text: str, tag: str) -> str:
    plain = face.drawable(text)
    other = song.tags.get(tag, "")
    return face.drawable(other) if "?" in plain and plain != text and other else plain


def title_warnings(song: Song, words: Words, look: FilmLook) -> tuple[str, ...]:
    """Say so where letters of title or artist cannot be drawn."""
    missing = Typeface(look.font).missing(clean(song.title + song.artist))
    lost = "?" in words.title.replace("?", "", song.title.count("?")) or "?" in words.artist
    if not missing or not lost:
        return ()
    font = "no font here" if look.font is None else f"neither {look.font} nor a font of the system"
    return (f"{font} has letters for {missing[:12]!r} in title or artist; give one with --font FILE",)


def clicks_of(request: Request, subject: Subject, presses: Presses) -> tuple[Click, ...]:
    """Claps on steps (always where the music is missing), ticks on beats, and the count before each run."""
    practice, chart = request.practice, subject.chart
    out: list[Click] = []
    if practice.claps or subject.music is None:
        out += [Click(float(second), CLAP, 0.55) for second in np.unique(presses.start)]
    one = subject.clock.passes[0]
    until = one.end if practice.metronome else one.sound_from
    if practice.metronome or practice.count_in:
        span = chart.timing.beats(np.array([one.start, max(one.start, until)]))
        beats = np.arange(math.ceil(span[0] - 1e-6), math.ceil(span[1] - 1e-6))
        seconds = chart.timing.seconds_of_beats(beats.astype(np.float64))
        out += [Click(float(s), ACCENT if b % 4 == 0 else TICK, 0.4) for b, s in zip(beats, seconds, strict=True)]
    return tuple(out)


def bpm_shares(chart: Chart) -> list[tuple[float, float]]:
    """(BPM, seconds it lasts) of every stretch of the chart, up to its last note."""
    last = max(int(chart.notes.tick.max(initial=0)), int(chart.notes.end.max(initial=0)), 1)
    ticks = [tick for tick, _ in chart.timing.bpms if tick < last]
    seconds = _seconds(chart.timing, np.array([*ticks, last], dtype=np.int64))
    values = (float(value) for _, value in chart.timing.bpms)
    return [(bpm, float(length)) for bpm, length in zip(values, np.diff(seconds), strict=False)]


def fastest_bpm(chart: Chart) -> float:
    """The highest BPM that matters: what is as fast lasts at least 2 % of the chart, so bursts of gimmicks are not."""
    shares = sorted(bpm_shares(chart), reverse=True)
    total, heard = sum(length for _, length in shares), 0.0
    for bpm, length in shares:
        heard += length
        if heard >= 0.02 * total:
            return bpm
    return 120.0


def bpm_text(chart: Chart) -> str:
    """ "128", or "90-180" where the song changes."""
    lasting = [bpm for bpm, length in bpm_shares(chart) if length > 0.5] or [fastest_bpm(chart)]
    low, high = f"{min(lasting):.0f}", f"{max(lasting):.0f}"
    return low if low == high else f"{low}-{high}"


def _motions(request: Request, subject: Subject, play: Play, pad: Pad) -> dict[float, Motion]:
    """The dancer's motion at each rate of the film, on the clock that is heard there: she falls as fast as all do."""
    if request.look.layout.dancer is None:
        return {}
    from dancetutor_cli.bake import bake
    from dancetutor_cli.jobs.bake import at_rate
    from dancetutor_cli.motion.settings import load_settings

    passes = subject.clock.passes
    return {
        rate: bake(
            subject.chart,
            at_rate(play, rate),
            pad,
            fps=request.fps,
            section=(passes[0].start / rate, passes[-1].end / rate),
            rate=rate,
            bar=request.bar,
            gait=request.gait,
            settings=load_settings(request.motion),
        )
        for rate in sorted({one.rate for one in passes})
    }


def _at_rate(rate: float, notes: tuple[str, ...]) -> list[str]:
    return [note if rate == 1.0 else f"at rate {rate:g}, {note}" for note in notes]


def _fitted(name: str, motions: dict[float, Motion]) -> tuple[Character | None, dict[float, Motion]]:
    """The character who dances and the motions for its skeleton; None for the dancer, whom who draws has at hand."""
    from dancetutor_cli.character import DANCER, load_character

    if not motions or name == DANCER:
        return None, motions
    from dancetutor_cli.character.retarget import retarget

    character = load_character(name)
    return character, {rate: retarget(motion, character) for rate, motion in motions.items()}
