"""The piece of work of `page`: one chart in, its practice page out."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.chart.model import TICKS_PER_BEAT, Kind
from dancetutor_cli.errors import FileError, UsageError
from dancetutor_cli.jobs.bake import BakeTask, ask, bake_asked

if TYPE_CHECKING:
    from dancetutor_cli.character.model import Character
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.jobs.bake import Asked
    from dancetutor_cli.motion.model import Motion
    from dancetutor_cli.page import Content
    from dancetutor_cli.play.model import Play
    from dancetutor_cli.play.preset import Preset

MUSIC_TYPES = {".ogg": "audio/ogg", ".oga": "audio/ogg", ".mp3": "audio/mpeg", ".wav": "audio/wav",
               ".flac": "audio/flac", ".opus": "audio/ogg"}  # fmt: skip
MOST_MUSIC = 64_000_000  # bytes that are put into a page
NEXT = "next"
BEATS_AFTER = 16  # that the page knows after the last note


@dataclass(frozen=True, slots=True)
class PageTask:
    """What page to make. Pickles, so that another process can do it.

    bake : the chart, its preset and how she dances; character : who; music : the song's file goes into the page
    beside : what a second dancer plays: NEXT, the next best play, the name or file of a preset, or a play as JSON
    """

    bake: BakeTask
    character: str = "dancer"
    music: bool = False
    beside: str | None = None


@dataclass(frozen=True, slots=True)
class Page:
    """A page that is made. sizes : compressed bytes by part, for whoever wants to know what weighs."""

    html: bytes
    title: str
    label: str
    warnings: tuple[str, ...]
    sizes: dict[str, int]


def make_page(task: PageTask) -> Page:
    """Read, solve, bake and pack. Raises a DancetutorError of one line for all that is wrong with the request."""
    from dancetutor_cli.character import load_character
    from dancetutor_cli.jobs.presets import choice_for, preset_for
    from dancetutor_cli.page import document, pack_content

    character = load_character(task.character)
    asked = ask(task.bake)
    preset = preset_for(asked.chart, task.bake.path, choice_for(task.bake.path, task.bake.preset))
    music, warnings = _music(asked.song, asked.chart) if task.music else (None, ())
    beside = _beside(task, asked, preset)
    motions = [bake_asked(one, task.bake) for one in (asked, beside) if one is not None]
    warnings = (*asked.notes, *warnings, *(note for motion in motions for note in motion.notes))
    fitted = [_retargeted(motion, character) for motion in motions]
    doc, blob = pack_content(_content(task, (asked, beside), preset, character, fitted, music))
    html = document(doc, blob, music[1] if music else None)
    title = asked.song.title or asked.song.path.stem
    return Page(html, title, asked.chart.label, warnings, _sizes(blob.sizes, music))


def _beside(task: PageTask, asked: Asked, preset: Preset) -> Asked | None:
    """The other play that a second dancer dances: the next best, another preset's, or a file's; None if none is."""
    if task.beside is None:
        return None
    from dancetutor_cli.feet import overrides_for
    from dancetutor_cli.formats.play_json import read_play
    from dancetutor_cli.jobs.feet import solve_with_feet
    from dancetutor_cli.play import alternatives, load_preset

    play: Play | None
    if task.beside == NEXT:
        overrides, _, _ = overrides_for(asked.song, asked.chart)
        found = alternatives(asked.play.rows, asked.pad, preset, 2, overrides)
        if len(found) < 2:
            raise UsageError(f"{task.bake.path}: {asked.chart.label}: there is no other way to play it")
        play = found[1].play
    elif task.beside.lower().endswith(".json"):
        play = read_play(Path(task.beside), asked.chart, asked.play.rows, asked.pad)
    else:
        play, _ = solve_with_feet(asked.song, asked.chart, load_preset(task.beside))
        assert play is not None
    return replace(asked, play=play)


def _content(
    task: PageTask,
    both: tuple[Asked, Asked | None],
    preset: Preset,
    character: Character,
    motions: list[Motion],
    music: tuple[str, bytes] | None,
) -> Content:
    from dancetutor_cli.feet import overrides_for
    from dancetutor_cli.jobs.callouts import findings_of
    from dancetutor_cli.jobs.film_plan import directions_of, note_track
    from dancetutor_cli.jobs.flips import flips_of
    from dancetutor_cli.lint.passages import hardest
    from dancetutor_cli.lint.subject import ChartSubject
    from dancetutor_cli.page import Content
    from dancetutor_cli.page.sentences import told
    from dancetutor_cli.video.scroll import parse_segments

    asked, other = both
    song, chart, play, pad = asked.song, asked.chart, asked.play, asked.pad
    overrides, ignores, _ = overrides_for(song, chart)
    solved = task.bake.play_file is None  # only of the solver's own play can it say what else would cost
    return Content(
        words=_words(song, chart, preset.name),
        play=play,
        pad=pad,
        notes=note_track(chart, play, parse_segments("")),
        ticks=_ticks(chart),
        beats=_beats(chart),
        findings=findings_of(ChartSubject(song, chart, play, pad, ignores=ignores)),
        character=character,
        motions=motions,
        directions=directions_of(pad),
        beside=Path(task.beside or "").stem,
        beside_rows=[] if other is None else np.flatnonzero((other.play.limb != play.limb).any(axis=1)).tolist(),
        passages=[told(passage) for passage in hardest(play, chart.timing)],
        flips=flips_of(play, pad, preset, overrides) if solved else (),
        music=music,
    )


def _words(song: Song, chart: Chart, preset: str) -> dict[str, str]:
    from dancetutor_cli.jobs.film_plan import bpm_text
    from dancetutor_cli.video.overlay.text import clean

    return {
        "title": clean(" ".join(part for part in (song.title or song.path.stem, song.subtitle) if part)),
        "artist": clean(song.artist),
        "badge": clean(f"{chart.difficulty} {chart.meter}"),
        "difficulty": chart.difficulty,
        "steps": chart.steps_type,
        "bpm": bpm_text(chart),
        "credit": clean(chart.tags.get("CREDIT", "") or song.tags.get("CREDIT", "")),
        "file": clean(song.path.name),
        "music": clean(song.music),
        "preset": preset,
        "index": str(chart.index),
        "meter": str(chart.meter),
    }


def _ticks(chart: Chart) -> list[int]:
    """Ticks of the notes in the order of `film_plan.note_track`."""
    keep = chart.notes.kind != Kind.KEYSOUND
    tick = chart.notes.tick[keep]
    order = np.argsort(np.asarray(chart.timing.seconds(tick), dtype=np.float64), kind="stable")
    return [int(t) for t in tick[order]]


def _beats(chart: Chart) -> list[float]:
    last = max(int(chart.notes.tick.max(initial=0)), int(chart.notes.end.max(initial=0))) // TICKS_PER_BEAT
    ticks = np.arange(last + BEATS_AFTER, dtype=np.int64) * TICKS_PER_BEAT
    return [float(second) for second in chart.timing.seconds(ticks)]


def _retargeted(motion: Motion, character: Character) -> Motion:
    from dancetutor_cli.character.retarget import retarget

    return retarget(motion, character)


def _music(song: Song, chart: Chart) -> tuple[tuple[str, bytes] | None, tuple[str, ...]]:
    from dancetutor_cli.jobs.film_request import find_music

    path, warnings = find_music(song, chart)
    if path is None:
        return None, tuple(w.replace("the film has claps on the steps instead", "the page claps") for w in warnings)
    try:
        if path.stat().st_size > MOST_MUSIC:
            limit = f"{MOST_MUSIC // 1_000_000} MB"
            raise FileError(path, f"is larger than {limit}; leave --music out and drop it on the page")
        return (MUSIC_TYPES[path.suffix.lower()], path.read_bytes()), ()
    except OSError as error:
        raise FileError(path, f"cannot be read: {error.strerror}") from error


def _sizes(arrays: dict[str, int], music: tuple[str, bytes] | None) -> dict[str, int]:
    out: dict[str, int] = {}
    for name, size in arrays.items():
        part = name.partition(".")[0]
        out[part] = out.get(part, 0) + size
    if music is not None:
        out["music"] = len(music[1])
    return out
