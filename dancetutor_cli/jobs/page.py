"""The piece of work of `page`: one chart in, its practice page out."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.errors import FileError, UsageError
from dancetutor_cli.jobs.bake import BakeTask, ask, bake_asked, tasks_of
from dancetutor_cli.jobs.page_two import findings_of_two, pair_of, passages_of_two

if TYPE_CHECKING:
    from dancetutor_cli.character.mesh import Character
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.jobs.bake import Asked
    from dancetutor_cli.jobs.page_two import Pair
    from dancetutor_cli.motion.baked import Motion
    from dancetutor_cli.page import Content
    from dancetutor_cli.play.played import Play
    from dancetutor_cli.play.preset import Preset

MUSIC_TYPES = {".ogg": "audio/ogg", ".oga": "audio/ogg", ".mp3": "audio/mpeg", ".wav": "audio/wav",
               ".flac": "audio/flac", ".opus": "audio/ogg"}  # fmt: skip
MOST_MUSIC = 64_000_000  # bytes that are put into a page
NEXT = "next"


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


@dataclass(frozen=True, slots=True)
class AskedPage:
    """A page that can be made: its chart is read and solved. pair : both plays of a chart for two"""

    task: PageTask
    character: Character
    asked: Asked
    pair: Pair | None

    @property
    def title(self) -> str:
        """Of the song; that of its file where it has none."""
        return self.asked.song.title or self.asked.song.path.stem

    @property
    def label(self) -> str:
        """Of the chart, for people."""
        return self.asked.chart.label


def make_page(task: PageTask) -> Page:
    """Read, solve, bake and pack. Raises a DancetutorError of one line for all that is wrong with the request."""
    return pack_page(ask_page(task))


def ask_page(task: PageTask) -> AskedPage:
    """The quick part of `make_page`: read and solve."""
    from dancetutor_cli.character import dressed, load_character
    from dancetutor_cli.character.feet import with_foot_colours

    character = with_foot_colours(load_character(dressed(task.character, task.bake.gait)))
    tasks = tasks_of(task.bake)
    pair = pair_of(tasks) if len(tasks) > 1 else None
    if pair is not None and task.beside is not None:
        raise UsageError(
            f"{task.bake.path}: --beside is for one dancer, and the chart is for two: choose with --player"
        )
    return AskedPage(task, character, ask(task.bake) if pair is None else pair.both, pair)


def pack_page(page: AskedPage) -> Page:
    """The rest of it: bake and pack."""
    from dancetutor_cli.lint.presets import choice_for, preset_for
    from dancetutor_cli.page import document, pack_content

    task, character, asked, pair = page.task, page.character, page.asked, page.pair
    preset = preset_for(asked.chart, task.bake.path, choice_for(task.bake.path, task.bake.preset))
    music, warnings = _music(asked.song, asked.chart) if task.music else (None, ())
    beside = _beside(task, asked, preset)
    motions = pair.motions() if pair else [bake_asked(one, task.bake) for one in (asked, beside) if one is not None]
    warnings = (*asked.notes, *warnings, *(note for motion in motions for note in motion.notes))
    fitted = [_retargeted(motion, character) for motion in motions]
    content = _content(task, (asked, beside), preset, character, fitted, music)
    if pair is not None:
        found = list(findings_of_two(pair))
        content = replace(content, findings=found, passages=passages_of_two(pair), pair=True)
    doc, blob = pack_content(content)
    html = document(doc, blob, music[1] if music else None)
    return Page(html, page.title, page.label, warnings, _sizes(blob.sizes, music))


def _beside(task: PageTask, asked: Asked, preset: Preset) -> Asked | None:
    """The other play that a second dancer dances: the next best, another preset's, or a file's; None if none is."""
    if task.beside is None:
        return None
    from dancetutor_cli.feet import overrides_for
    from dancetutor_cli.formats.play_json import read_play
    from dancetutor_cli.lint.solved import solved_chart
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
        play = solved_chart(asked.song, asked.chart, load_preset(task.beside)).play
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
    from dancetutor_cli.lint.check import findings_of
    from dancetutor_cli.lint.passages import hardest
    from dancetutor_cli.lint.subject import ChartSubject
    from dancetutor_cli.page import Content
    from dancetutor_cli.page.facts import beats_of, ticks_of, words_of
    from dancetutor_cli.page.flips import flips_of
    from dancetutor_cli.page.sentences import told
    from dancetutor_cli.play.let_go import without_unplayable
    from dancetutor_cli.video.scroll import parse_segments
    from dancetutor_cli.video.tracks import note_track

    asked, other = both
    song, chart, play, pad = asked.song, asked.chart, asked.play, asked.pad
    # Of two each one's part is so already; and only of the solver's own play for one can it say what else would cost.
    shown = play if chart.players else without_unplayable(play, pad)[0]
    solved = task.bake.play_file is None and not chart.players
    overrides, ignores, problems = overrides_for(song, chart)
    subject = ChartSubject(song, chart, play, pad, overrides, ignores, problems)
    return Content(
        words=words_of(song, chart, preset.name),
        play=replace(play, moves=shown.moves, events=None),
        pad=pad,
        notes=note_track(chart, shown, parse_segments("")),
        ticks=ticks_of(chart),
        beats=beats_of(chart),
        findings=() if chart.players else findings_of(subject),
        character=character,
        motions=motions,
        directions=pad.directions,
        beside=Path(task.beside or "").stem,
        beside_rows=[] if other is None else np.flatnonzero((other.play.limb != play.limb).any(axis=1)).tolist(),
        passages=[told(passage) for passage in hardest(play, chart.timing)],
        flips=flips_of(play, pad, preset, overrides) if solved else (),
        music=music,
    )


def _retargeted(motion: Motion, character: Character) -> Motion:
    from dancetutor_cli.character.retarget import retarget

    return retarget(motion, character)


def _music(song: Song, chart: Chart) -> tuple[tuple[str, bytes] | None, tuple[str, ...]]:
    from dancetutor_cli.library.music import find_music

    path, missing = find_music(song, chart)
    if path is None:
        return None, (f"{missing}; the page claps",)
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
