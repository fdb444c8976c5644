"""The work of `page`: the practice page of one chart, or a folder of pages with an index."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from dancetutor_cli.character.characters import load_character, name_in_gait
from dancetutor_cli.character.mesh import with_foot_colours
from dancetutor_cli.chart.music import find_music
from dancetutor_cli.chart.selection import FolderReader, Selection, UnreadableFile
from dancetutor_cli.dance.motion import Cut, shifted
from dancetutor_cli.dance.performance import pad_of, perform, piece_runner, play_of_all, playable, solve
from dancetutor_cli.dance.request import check_request, read_chart
from dancetutor_cli.dance.rig.skeleton import dancer_skeleton
from dancetutor_cli.feet.pads import load_pad
from dancetutor_cli.feet.passages import hardest_passages
from dancetutor_cli.feet.play_json import read_play
from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.feet.solved import solve_song
from dancetutor_cli.feet.solver.alternatives import alternatives
from dancetutor_cli.film.scroll import parse_segments
from dancetutor_cli.page.document import Blob, IndexEntry, document, index_page
from dancetutor_cli.run.errors import FileError, UsageError
from dancetutor_cli.run.files import FreeNames, write_atomic
from dancetutor_cli.run.pool import Task, open_workers

if TYPE_CHECKING:
    from dancetutor_cli.character.mesh import Character
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.dance.motion import Motion
    from dancetutor_cli.dance.request import DanceRequest
    from dancetutor_cli.feet.play import Play
    from dancetutor_cli.feet.solved import Solved
    from dancetutor_cli.lint.findings import Finding
    from dancetutor_cli.page.content import Content


# The practice page of one chart.

MUSIC_TYPES = {".ogg": "audio/ogg", ".oga": "audio/ogg", ".mp3": "audio/mpeg", ".wav": "audio/wav",
               ".flac": "audio/flac", ".opus": "audio/ogg"}  # fmt: skip
MOST_MUSIC = 64_000_000  # greatest size of the music in a page, bytes
NEXT = "next"
MOTION = ".npz"


@dataclass(frozen=True, slots=True)
class PageRequest:
    """A request for a page. It can be pickled, so that another process can make the page.

    dance : the chart and the way of dancing it; character : the character who dances
    music : whether the song's file goes into the page
    second : the play of a second dancer: NEXT for the next best play, the name or file of a preset, or a play as JSON;
        or the .npz file of her motion
    jobs : number of processes for the pieces of a long song
    language : the language in which the page begins, "" for the browser's
    """

    dance: DanceRequest
    character: str = "dancer"
    music: bool = False
    second: str | None = None
    jobs: int = 1
    language: str = ""


@dataclass(frozen=True, slots=True)
class Page:
    """A finished page. blob : the arrays in it; music : size of the song's file in it, bytes"""

    html: bytes
    title: str
    label: str
    warnings: tuple[str, ...]
    blob: Blob = field(repr=False)
    music: int = 0

    @property
    def sizes(self) -> dict[str, int]:
        """The number of compressed bytes of each part."""
        out = {"music": self.music} if self.music else {}
        for name, size in self.blob.sizes().items():
            part = name.partition(".")[0]
            out[part] = out.get(part, 0) + size
        return out


@dataclass(frozen=True, slots=True)
class PageSubject:
    """The subject of a page: a chart that is read and solved.

    solved : the parts of the players, one for most charts; warnings : lines for people about presets for other pads
    second_motion : the motion of a second dancer, from a file
    """

    request: PageRequest
    character: Character
    solved: tuple[Solved, ...]
    warnings: tuple[str, ...]
    second_motion: Motion | None = None

    @property
    def song(self) -> Song:
        """The song of the chart."""
        return self.solved[0].song

    @property
    def chart(self) -> Chart:
        """The chart that the page shows; a chart for two as it is written, with both parts."""
        first = self.solved[0].chart
        return first if len(self.solved) == 1 else self.song.charts[first.index]

    @property
    def title(self) -> str:
        """The title of the song, or the name of its file if it has no title."""
        return self.song.title or self.song.path.stem

    @property
    def label(self) -> str:
        """The label of the chart, for people."""
        return self.chart.label


def make_page(request: PageRequest) -> Page:
    """Read, solve, bake and pack a chart. Raises a DancetutorError of one line for any error in the request."""
    return pack_page(look_up_page(request))


def look_up_page(request: PageRequest) -> PageSubject:
    """Read and solve a chart, which is the fast part of `make_page`."""
    character = with_foot_colours(load_character(name_in_gait(request.character, request.dance.gait)))
    check_request(request.dance)
    choice = read_chart(request.dance)
    if len(choice.parts) > 1 and request.second is not None:
        raise UsageError(
            f"{request.dance.path}: --second is for one dancer, and the chart is for two: choose with --player"
        )
    second = _second_motion(request)
    return PageSubject(request, character, solve(request.dance, choice), choice.warnings, second)


def pack_page(page: PageSubject) -> Page:
    """Bake the motions and pack the page, which is the slow part of `make_page`."""
    from dancetutor_cli.character.onto_skeleton import onto
    from dancetutor_cli.page.content import pack_content

    request, solved = page.request, page.solved
    music, warnings = _music(page.song, page.chart) if request.music else (None, ())
    second = _second_play(page)
    motions = [motion for some in (solved, second) if some for motion in _motions(request, some)]
    motions += [] if page.second_motion is None else [page.second_motion]
    warnings = (*page.warnings, *warnings, *(note for motion in motions for note in motion.notes))
    fitted = [onto(motion, page.character.skeleton) for motion in motions]
    doc, blob = pack_content(_content(page, second, fitted, music))
    html = document(doc, blob, music[1] if music else None)
    return Page(html, page.title, page.label, warnings, blob, len(music[1]) if music else 0)


def _motions(request: PageRequest, solved: tuple[Solved, ...]) -> list[Motion]:
    """Return the motion of each dancer at her place on the common pad, without walks onto the pad or off it."""
    performance = perform(solved, request.dance)
    whole = Cut(*performance.span, walks_on=False, walks_off=False)
    done = performance.bake(whole, run=piece_runner(request.jobs))
    return [shifted(one.motion, *who.place) for one, who in zip(done, performance.dancers, strict=True)]


def _second_play(page: PageSubject) -> tuple[Solved, ...]:
    """Return the play of a second dancer: the next best, another preset's, or a file's; empty without this dancer."""
    wanted, path, one = page.request.second, page.request.dance.path, page.solved[0]
    if wanted is None or wanted.lower().endswith(MOTION):
        return ()
    assert one.play is not None and one.pad is not None
    if wanted.lower().endswith(".json"):
        return (replace(one, play=read_play(Path(wanted), one.chart, one.play.rows)),)
    if wanted != NEXT:
        return tuple(solve_song(one.song, [(one.chart, load_preset(wanted))]))
    found = alternatives(one.play.rows, one.pad, one.preset, 2, one.overrides)
    if len(found) < 2:
        raise UsageError(f"{path}: {one.chart.label}: there is no other way to play it")
    return (replace(one, play=found[1].play),)


def _second_motion(request: PageRequest) -> Motion | None:
    """Return the motion of a second dancer from a file of `animate` or `retarget`, None if there is no such file."""
    from dancetutor_cli.formats.npz import read_npz

    if request.second is None or not request.second.lower().endswith(MOTION):
        return None
    motion = read_npz(Path(request.second))
    if missing := set(dancer_skeleton().names) - set(motion.skeleton.names):
        what = f"its skeleton has no {min(missing)}"
        raise FileError(Path(request.second), f"{what}; `dancetutor retarget` brings a capture onto the dancer's")
    return motion


def _content(
    page: PageSubject, second: tuple[Solved, ...], motions: list[Motion], music: tuple[str, bytes] | None
) -> Content:
    from dancetutor_cli.film.notes import note_track
    from dancetutor_cli.page.content import Content
    from dancetutor_cli.page.facts import beats_of, flips_of, ticks_of, words_of

    solved, chart, pad = page.solved, page.chart, pad_of(page.solved)
    first = solved[0]
    shown = play_of_all(solved, [playable(one, page.request.dance.rates) for one in solved])
    play = first.play if len(solved) == 1 else shown
    assert play is not None
    # The costs of other feet are known only for the solver's own play for one player.
    alone = page.request.dance.play is None and len(solved) == 1
    return Content(
        words=words_of(page.song, chart, first.preset.name),
        play=replace(play, moves=shown.moves, events=None),
        pad=pad,
        notes=note_track(chart, shown, parse_segments("")),
        ticks=ticks_of(chart),
        beats=beats_of(chart),
        findings=list(_findings_by_player(solved)),
        character=page.character,
        motions=motions,
        directions=pad.directions,
        second_name=Path(page.request.second or "").stem,
        second_rows=[row for one in second for row in _rows_that_differ(one.play, play)]
        if second or len(solved) > 1
        else _rows_with_other_limbs(motions[1:], play),
        passages=_passages(solved),
        flips=flips_of(play, pad, first.preset, overrides)
        if alone and (overrides := first.overrides) is not None
        else (),
        pair=len(solved) > 1,
        language=page.request.language,
        music=music,
    )


def _rows_that_differ(other: Play | None, play: Play) -> list[int]:
    """Return the rows that two plays step with different limbs."""
    assert other is not None
    rows: list[int] = np.flatnonzero((other.limb != play.limb).any(axis=1)).tolist()
    return rows


def _rows_with_other_limbs(motions: Sequence[Motion], play: Play) -> list[int]:
    """Return the rows of a play that the contacts of some motions step with other limbs."""
    limbs = play.limb
    touches = [c for motion in motions for c in motion.contacts if c.row < len(limbs) and c.column < limbs.shape[1]]
    return sorted({c.row for c in touches if limbs[c.row, c.column] != c.limb})


def _findings_by_player(solved: tuple[Solved, ...]) -> Iterator[Finding]:
    """Return the findings of the linter; in a chart for two, each with its player."""
    from dancetutor_cli.lint.check import findings_of
    from dancetutor_cli.lint.subject import subject_of

    for one in solved:
        for found in findings_of(subject_of(one)):
            if len(solved) == 1:
                yield found
                continue
            column = None if found.note_column is None else found.note_column + one.chart.first_column
            yield replace(found, message=f"P{one.chart.player}: {found.message}", note_column=column)


def _passages(solved: tuple[Solved, ...]) -> list[dict[str, Any]]:
    """Return the hardest passages, the hardest first; in a chart for two, each with its player."""
    from dancetutor_cli.page.facts import passage_object, without_repeats

    pairs = [(found, one.chart) for one in solved if one.play for found in hardest_passages(one.play, one.chart.timing)]
    if len(solved) == 1:
        return without_repeats([passage_object(passage) for passage, _ in pairs])
    pairs.sort(key=lambda one: -one[0].score)
    return without_repeats([passage_object(passage, chart.player) for passage, chart in pairs])


def _music(song: Song, chart: Chart) -> tuple[tuple[str, bytes] | None, tuple[str, ...]]:
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


# The practice pages of a folder of charts, and an index with links to them.

INDEX = "index.html"


@dataclass(frozen=True, slots=True)
class PageJob:
    """A page of a batch: its request, its file, and its entry in the index."""

    request: PageRequest
    target: Path
    entry: IndexEntry


@dataclass(frozen=True, slots=True)
class PageOutcome:
    """The outcome of a page: it is written, or `error` says why not."""

    job: PageJob
    size: int = 0
    warnings: tuple[str, ...] = ()
    error: str | None = None


def page_jobs(
    request: PageRequest, target: Path, exclude: Sequence[str] = ()
) -> tuple[list[PageJob], list[UnreadableFile]]:
    """Return the pages of all matching charts below `request.dance.path`, and the files that cannot be read.

    Charts without a pad or without notes are left out. Files are named like the films of a batch.
    """
    from dancetutor_cli.film.overlay.text import clean
    from dancetutor_cli.film.work.batch import DEFAULT_NAME, file_name

    jobs: list[PageJob] = []
    reader = FolderReader((request.dance.path,), exclude)
    taken = FreeNames(Path(INDEX).stem)
    for song in reader.songs():
        for chart in request.dance.selection.charts(song):
            if not len(chart.notes) or load_pad(chart.steps_type) is None:
                continue
            name = taken.take(file_name(DEFAULT_NAME, song, chart))
            dance = replace(request.dance, path=song.path, selection=Selection(index=chart.index))
            entry = IndexEntry(
                f"{name}.html", clean(song.title) or song.path.stem, clean(song.artist), clean(chart.label)
            )
            jobs.append(PageJob(replace(request, dance=dance, jobs=1), target / entry.file, entry))
    return jobs, reader.unreadable


def make_all(jobs: list[PageJob], processes: int) -> Iterator[PageOutcome]:
    """Make pages in several processes, and yield each outcome when its page is done."""
    workers = open_workers(min(processes, max(len(jobs), 1)))
    try:
        for k, job in enumerate(jobs):
            workers.submit(Task(k, _make, (job,)))
        for done in workers.results():
            job = jobs[done.key]
            yield PageOutcome(job, error=str(done.error)) if done.error is not None else PageOutcome(job, *done.result)
    finally:
        workers.close()


def write_index(folder: Path, outcomes: list[PageOutcome], title: str) -> None:
    """Write the index of the pages that were made, in the order of the charts."""
    write_atomic(folder / INDEX, index_page([one.job.entry for one in outcomes if one.error is None], title))


def _make(job: PageJob) -> tuple[int, tuple[str, ...]]:
    page = make_page(job.request)
    write_atomic(job.target, page.html)
    return len(page.html), page.warnings
