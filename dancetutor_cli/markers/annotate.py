"""The piece of work of `annotate`: the files of one song in, what became of each out; a failure is part of that."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.chart.edits import apply, unified
from dancetutor_cli.chart.reader import load, parse
from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.feet.preset import mismatch, preset_for
from dancetutor_cli.markers import background, edit
from dancetutor_cli.markers.comments import (
    BACKGROUND,
    EDIT,
    FILE_STYLES,
    MEASURE,
    ROWS,
    SIDECAR,
    TEXT,
    UCS_STYLES,
    FileChange,
    Lack,
)
from dancetutor_cli.run.errors import FileError, NoChartsError
from dancetutor_cli.run.files import ChangedError, back_up, make_folder, remove_leftovers, write_atomic

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.feet.preset import Preset
    from dancetutor_cli.lint.run import LintRun
    from dancetutor_cli.markers.planning import FilePlan, MarkerPlan


@dataclass(frozen=True, slots=True)
class AnnotateRequest:
    """The work on every file. Pickles.

    named : whether the user asked for these styles; if not, other files beside the song are no error
    preset : name or file of the cost preset; None: what `feet.preset` finds for each chart
    write : whether files are written at all; diff : whether a diff is wanted; force : pinned measures too
    into_file : added charts instead of .edit files; backup : keep the old bytes beside a file that is changed
    """

    styles: tuple[str, ...]
    preset: str | None
    selection: Selection
    named: bool = True
    strip: bool = False
    force: bool = False
    into_file: bool = False
    write: bool = True
    backup: bool = False
    diff: bool = False


@dataclass(frozen=True, slots=True)
class Item:
    """A chart file, and where its new version goes: the same path unless -o says otherwise."""

    source: Path
    target: Path


@dataclass(frozen=True, slots=True)
class AnnotateOutcome:
    """The result for a file: lines for people, mostly.

    problems : contradictions in what people said about feet; lacks : what is missing or stale
    changed : whether anything is or would be different; companions : such files beside the chart file
    unselected : the charts of a file of which none was meant
    """

    source: Path
    error: str | None = None
    notes: tuple[str, ...] = ()
    problems: tuple[str, ...] = ()
    lacks: tuple[str, ...] = ()
    unselected: tuple[str, ...] = ()
    counts: tuple[tuple[str, int], ...] = ()
    changed: bool = False
    companions: tuple[Path, ...] = ()
    diff: tuple[str, ...] = ()


def annotate_song(items: Sequence[Item], request: AnnotateRequest) -> list[AnnotateOutcome]:
    """Annotate the files of one song, or take the markers out. Never raises for what is wrong with a file.

    Of a .sm and a .ssc only the .ssc speaks for the song in `data.sme` and in .edit files.
    `UsageError` (no such preset) is raised: it is not about a file.
    """
    if request.write:
        for folder in sorted({item.target.parent for item in items}):
            remove_leftovers(folder)
    ssc = any(item.source.suffix.lower() == ".ssc" for item in items)
    return [_attempt(item, request, ssc and item.source.suffix.lower() != ".ssc") for item in items]


def _attempt(item: Item, request: AnnotateRequest, second: bool) -> AnnotateOutcome:
    try:
        return _annotate(item, request, second)
    except NoChartsError as error:  # music of a menu: nothing to write
        return AnnotateOutcome(item.source, notes=(str(error),))
    except FileError as error:
        return AnnotateOutcome(item.source, error=str(error))
    except OSError as error:
        return AnnotateOutcome(item.source, error=str(FileError(item.source, error.strerror or str(error))))


def _annotate(item: Item, request: AnnotateRequest, second: bool) -> AnnotateOutcome:
    song = load(item.source)
    if song.format == "ucs":
        request, beside = _request_for_ucs(item.source, request)
        second = False
    else:
        beside = [style for style in request.styles if style in FILE_STYLES and (style == SIDECAR or not second)]
    if request.into_file and not request.strip and EDIT in beside:
        beside.remove(EDIT)
    work = _Work(item, request, song, tuple(beside))
    if request.strip:
        work.strip()
    else:
        work.write()
    return work.outcome()


def _request_for_ucs(path: Path, request: AnnotateRequest) -> tuple[AnnotateRequest, list[str]]:
    """What of a request can be done for a .ucs, into which nothing is written; FileError if nothing of it."""
    wanted = [TEXT if style in (MEASURE, ROWS) else style for style in request.styles]
    beside = [style for style in UCS_STYLES if style in wanted]
    if not beside and not request.strip:
        there = "measure (a text beside it) and sidecar"
        raise FileError(path, f"a .ucs file has no place for the markers {', '.join(wanted)}; choose {there}")
    return replace(request, styles=(), into_file=False), beside


class _Work:
    """One file in work: the planned changes, then the changes themselves."""

    def __init__(self, item: Item, request: AnnotateRequest, song: Song, beside: tuple[str, ...]) -> None:
        self.item, self.request, self.song, self.beside = item, request, song, beside
        self.changes: list[FileChange] = []
        self.lacks: list[Lack] = []
        self.problems: list[Lack] = []
        self.notes: list[str] = []
        self.errors: list[str] = []
        self.counts: Counter[str] = Counter()

    def write(self) -> None:
        """Plan all styles that are asked for."""
        from dancetutor_cli.markers import planning

        choice = _configured(self.request.preset).presets(self.item.source)
        added = EDIT in self.request.styles and self.request.into_file
        base = self._without_added() if added else self.song

        def preset_of(chart: Chart) -> Preset:
            return preset_for(chart, self.item.source, choice)

        feet = list(planning.solve_charts(base, self._charts(base), preset_of, self.notes, self.problems))
        for chart in (one.chart for one in feet):
            if unfit := mismatch(preset_of(chart), chart.steps_type):
                self.notes.append(f"{base.path}: {chart.label}: {unfit}")
        plan = planning.mark(base, feet, self.request.styles, self.request.force)
        if added:
            planning.add_charts(base, self.song, plan, feet)
        planning.checked(base, plan)
        self._take(plan)
        alone = [one for one in feet if not (one.chart.players or one.chart.player)]
        if self.beside and len(alone) < len(feet):
            self.notes.append(
                f"{base.path}: charts for two players can have markers only in the styles measure and rows"
            )
        for style in self.beside if alone or not feet else ():
            try:
                for planned in planning.write(style, self.song, self.item.target.parent, alone):
                    self._add(planned)
            except FileError as error:
                self.errors.append(str(error))

    def strip(self) -> None:
        """Plan the removal of all styles that are asked for."""
        from dancetutor_cli.markers import planning

        base = self._without_added() if EDIT in self.request.styles else self.song
        added = base
        if BACKGROUND in self.request.styles:
            base = self._without_background(base)
        charts = self._charts(base)
        plan = planning.unmark(base, charts, self.request.styles, self.request.force)
        planning.checked(base, plan)
        self._take(plan)
        if base is not added:
            self.lacks.append(Lack("has a film in its background changes to take out"))
        if added is not self.song:
            self.lacks.append(Lack("has charts for two pads to take out"))
        for style in self.beside if self._in_place else ():
            try:
                for planned in planning.strip(style, self.song, charts):
                    self._add(planned)
            except FileError as error:
                if self.request.named:
                    raise
                self.notes.append(str(error))

    def outcome(self) -> AnnotateOutcome:
        """Bring the changes to the disk if that is wanted, and say what became of the file."""
        selection = self.request.selection
        if self.request.write:
            for change in self.changes:
                self._bring(change)
        return AnnotateOutcome(
            self.item.source,
            error="; ".join(self.errors) or None,
            notes=tuple(self.notes),
            problems=tuple(problem.at(self.item.source) for problem in self.problems),
            lacks=tuple(lack.at(self.item.source) for lack in self.lacks),
            unselected=()
            if selection.is_all or self._charts(self.song)
            else tuple(f"{c.index} {c.label}" for c in self.song.charts),
            counts=tuple(sorted(self.counts.items())),
            changed=any(change.needed for change in self.changes),
            companions=tuple(change.path for change in self.changes[1:] if change.needed),
            diff=tuple(self._diff()) if self.request.diff else (),
        )

    def _diff(self) -> Iterator[str]:
        for change in self.changes:
            yield from unified(str(change.path), change.old, change.new)

    @property
    def _in_place(self) -> bool:
        return self.item.source == self.item.target

    def _charts(self, song: Song) -> list[Chart]:
        """The charts that are meant; those that we added ourselves have no feet to write."""
        return [chart for chart in self.request.selection.charts(song) if not edit.is_ours(chart)]

    def _without_added(self) -> Song:
        """The song without the charts that an earlier run has added for the charts that are meant."""
        splices = edit.without_added(self.song, self._charts(self.song))
        return parse(apply(self.song.data, splices), self.song.path) if splices else self.song

    def _without_background(self, song: Song) -> Song:
        """The song without the entries of films; the very same object if there are none."""
        splices = background.remove(song)
        return parse(apply(song.data, splices), song.path) if splices else song

    def _take(self, plan: MarkerPlan) -> None:
        self.changes.append(FileChange(self.item.target, self.song.data, plan.data))
        self.lacks += plan.lacks
        self.notes += plan.notes
        self.counts += plan.counts

    def _add(self, planned: FilePlan | FileError) -> None:
        if isinstance(planned, FileError):
            self.errors.append(str(planned))
            return
        change, lacks = planned
        self.changes.append(change)
        self.lacks += lacks

    def _bring(self, change: FileChange) -> None:
        """Bring one change to the disk; with -o also what is the same as before, so that the copy is whole."""
        if self._in_place and not change.needed:
            return
        if not change.path.parent.is_dir():
            make_folder(change.path.parent)
        if self.request.backup and change.path.exists():
            back_up(change.path)
        if change.new is None:
            change.path.unlink(missing_ok=True)
            return
        try:
            write_atomic(change.path, change.new, expect=change.old if self._in_place else None)
        except ChangedError:
            if change.path.read_bytes() != change.new:  # else another run has just done the same
                raise


@cache
def _configured(preset: str | None) -> LintRun:
    """Knows the presets of each file's charts; the same for `analyze`, so that both find the same feet."""
    from dancetutor_cli.lint.run import LintRequest, LintRun

    return LintRun(LintRequest(preset=preset))


def annotate_task(
    report: Callable[[int], None], items: Sequence[Item], request: AnnotateRequest
) -> list[AnnotateOutcome]:
    """`annotate_song` as worker processes call it."""
    return annotate_song(items, request)
