"""The piece of work of `page`: one chart in, its practice page out."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dancetutor_cli.chart.model import TICKS_PER_BEAT, Kind
from dancetutor_cli.errors import FileError
from dancetutor_cli.jobs.bake import BakeTask, ask, bake_asked

if TYPE_CHECKING:
    from dancetutor_cli.character.model import Character
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.jobs.bake import Asked
    from dancetutor_cli.motion.model import Motion

MUSIC_TYPES = {".ogg": "audio/ogg", ".oga": "audio/ogg", ".mp3": "audio/mpeg", ".wav": "audio/wav",
               ".flac": "audio/flac", ".opus": "audio/ogg"}  # fmt: skip
MOST_MUSIC = 64_000_000  # bytes that are put into a page
BEATS_AFTER = 16  # that the page knows after the last note


@dataclass(frozen=True, slots=True)
class PageTask:
    """What page to make. Pickles, so that another process can do it.

    bake : the chart, its preset and how she dances; character : who; music : the song's file goes into the page
    """

    bake: BakeTask
    character: str = "dancer"
    music: bool = False


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
    from dancetutor_cli.page import document, pack_content

    character = load_character(task.character)
    asked = ask(task.bake)
    music, warnings = _music(asked.song, asked.chart) if task.music else (None, ())
    motions = [_retargeted(bake_asked(asked, task.bake), character)]
    doc, blob = pack_content(_content(task, asked, character, motions, music))
    html = document(doc, blob, music[1] if music else None)
    return Page(html, asked.song.title or asked.song.path.stem, asked.chart.label, warnings, _sizes(blob.sizes, music))


def _content(
    task: PageTask, asked: Asked, character: Character, motions: list[Motion], music: tuple[str, bytes] | None
) -> Any:
    from dancetutor_cli.feet import overrides_for
    from dancetutor_cli.jobs.callouts import findings_of
    from dancetutor_cli.jobs.film_plan import directions_of, note_track
    from dancetutor_cli.lint.subject import ChartSubject
    from dancetutor_cli.page import Content
    from dancetutor_cli.video.scroll import parse_segments

    song, chart, play, pad = asked.song, asked.chart, asked.play, asked.pad
    _, ignores, _ = overrides_for(song, chart)
    return Content(
        words=_words(song, chart, task.bake.preset),
        play=play,
        pad=pad,
        notes=note_track(chart, play, parse_segments("")),
        ticks=_ticks(chart),
        beats=_beats(chart),
        findings=findings_of(ChartSubject(song, chart, play, pad, ignores=ignores)),
        character=character,
        motions=motions,
        directions=directions_of(pad),
        music=music,
    )


def _words(song: Song, chart: Chart, preset: str) -> dict[str, str]:
    from dancetutor_cli.jobs.film_plan import bpm_text
    from dancetutor_cli.video.text import clean

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
        "preset": Path(preset).stem,
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
