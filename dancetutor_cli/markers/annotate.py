"""The task of `annotate`: it marks the files of one song and returns an outcome, or an error, for each file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.chart.edits import apply, unified_diff
from dancetutor_cli.chart.pack_files import find_settings_file
from dancetutor_cli.chart.reader import load, parse
from dancetutor_cli.chart.selection import Selection, is_preferred
from dancetutor_cli.feet.preset import PresetChoice, choice_of, preset_for
from dancetutor_cli.markers import background, edit
from dancetutor_cli.markers.model import CheckLine, FileChange, NoteChange
from dancetutor_cli.markers.styles import IN_FILES, OF_EACH_FILE, OF_UCS, file_style
from dancetutor_cli.run.errors import FileError, NoChartsError
from dancetutor_cli.run.files import ChangedError, back_up, make_folder, remove_leftovers, write_atomic

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.lint.run import LintRun


@dataclass(frozen=True, slots=True)
class AnnotateRequest:
    """The user's options of `annotate`, for every file. It can be pickled.

    named : whether the user named these styles; if not, files of other programs beside the song are no error
    preset : name or file of the cost preset; None: the preset that `feet.preset` chooses for each chart
    write : whether files are written; diff : whether to make a diff; force : whether to overwrite pinned measures
    into_file : whether to add charts instead of .edit files; backup : whether to copy a file before it is changed
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
    """A chart file, and the path of its new version, which is the same without -o."""

    source: Path
    target: Path


@dataclass(frozen=True, slots=True)
class AnnotateOutcome:
    """The result for a file, mostly as lines for people.

    problems : contradictions in feet that people have set; lacks : missing or stale markers
    changed : whether anything has changed or would change; companions : changed files beside the chart file
    unselected : the charts of the file, if none was selected
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
    """Write or remove the markers of one song's files. Errors of a file are in its outcome, not raised.

    If there are a .sm and a .ssc, only the .ssc is used for `data.sme` and .edit files. Raises `UsageError` for an
    unknown preset, because that is not about one file.
    """
    if request.write:
        for folder in sorted({item.target.parent for item in items}):
            remove_leftovers(folder)
    is_pair = any(is_preferred(item.source) for item in items)
    return [_attempt(item, request, is_pair and not is_preferred(item.source)) for item in items]


def _attempt(item: Item, request: AnnotateRequest, is_sm_of_pair: bool) -> AnnotateOutcome:
    try:
        return _annotate(item, request, is_sm_of_pair)
    except NoChartsError as error:  # the music of a menu has no charts to mark
        return AnnotateOutcome(item.source, notes=(str(error),))
    except FileError as error:
        return AnnotateOutcome(item.source, error=str(error))
    except OSError as error:
        return AnnotateOutcome(item.source, error=str(FileError(item.source, error.strerror or str(error))))


def _annotate(item: Item, request: AnnotateRequest, is_sm_of_pair: bool) -> AnnotateOutcome:
    song = load(item.source)
    if song.format == "ucs":
        request, file_styles = _request_for_ucs(item.source, request)
    else:
        possible = OF_EACH_FILE if is_sm_of_pair else IN_FILES
        file_styles = [style for style in request.styles if style in possible]
    if request.into_file and not request.strip and "edit" in file_styles:
        file_styles.remove("edit")
    work = _Work(item, request, song, tuple(file_styles))
    if request.strip:
        work.strip()
    else:
        work.write()
    return work.outcome()


def _request_for_ucs(path: Path, request: AnnotateRequest) -> tuple[AnnotateRequest, list[str]]:
    """Return the part of a request that is possible for a .ucs file, which is never changed.

    Raises FileError if none is.
    """
    file_styles = list(dict.fromkeys(OF_UCS[style] for style in request.styles if style in OF_UCS))
    if not file_styles and not request.strip:
        there = "measure (a text beside it) and sidecar"
        raise FileError(path, f"a .ucs file has no place for the markers {', '.join(request.styles)}; choose {there}")
    return replace(request, styles=(), into_file=False), file_styles


class _Work:
    """The work on one file: planning the changes, then writing them. file_styles : the styles that write other files"""

    def __init__(self, item: Item, request: AnnotateRequest, song: Song, file_styles: tuple[str, ...]) -> None:
        self.item, self.request, self.song, self.file_styles = item, request, song, file_styles
        self.changes: list[FileChange] = []
        self.lacks: list[CheckLine] = []
        self.problems: list[CheckLine] = []
        self.notes: list[str] = []
        self.errors: list[str] = []
        self.counts: Counter[str] = Counter()

    def write(self) -> None:
        """Plan the requested styles.

        Charts that the program added are removed while feet are found, and added again last.
        """
        from dancetutor_cli.markers import plan

        presets = _presets(self.request.preset, self.item.source)
        into_file = "edit" in self.request.styles and self.request.into_file
        song = self._without_added() if into_file else self.song
        found = plan.solve_charts(song, self._charts(song), lambda chart: preset_for(chart, self.item.source, presets))
        self.notes += found.notes
        self.problems += found.problems
        change = plan.mark(song, found.charts, self.request.styles, self.request.force)
        data = apply(song.data, change.splices)
        if into_file:
            data, lacks = plan.with_lane_split_charts(song, self.song, data, found.charts)
            change.lacks += lacks
        plan.check(song, data)
        self._add_chart_file(data, change)
        alone = [one for one in found.charts if not (one.chart.players or one.chart.player)]
        if self.file_styles and len(alone) < len(found.charts):
            self.notes.append(
                f"{song.path}: charts for two players can have markers only in the styles measure and rows"
            )
        for name in self.file_styles if alone or not found.charts else ():
            try:
                for planned in file_style(name).write(self.song, self.item.target.parent, alone):
                    self._add_beside(planned)
            except FileError as error:
                self.errors.append(str(error))

    def strip(self) -> None:
        """Plan the removal of the requested styles."""
        from dancetutor_cli.markers import plan

        own = self._without_added() if "edit" in self.request.styles else self.song
        song = self._without_background(own) if "background" in self.request.styles else own
        charts = self._charts(song)
        change = plan.unmark(song, charts, self.request.styles, self.request.force)
        data = apply(song.data, change.splices)
        plan.check(song, data)
        self._add_chart_file(data, change)
        if song is not own:
            self.lacks.append(CheckLine("has a film in its background changes to take out"))
        if own is not self.song:
            self.lacks.append(CheckLine("has charts for two pads to take out"))
        for name in self.file_styles if self._in_place else ():
            try:
                for planned in file_style(name).strip(self.song, charts):
                    self._add_beside(planned)
            except FileError as error:
                if self.request.named:
                    raise
                self.notes.append(str(error))

    def outcome(self) -> AnnotateOutcome:
        """Write the changes if requested, and return the outcome."""
        selection = self.request.selection
        if self.request.write:
            for change in self.changes:
                self._write_change(change)
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
            changed=any(change.is_change for change in self.changes),
            companions=tuple(change.path for change in self.changes[1:] if change.is_change),
            diff=tuple(self._diff()) if self.request.diff else (),
        )

    def _diff(self) -> Iterator[str]:
        for change in self.changes:
            yield from unified_diff(str(change.path), change.old, change.new)

    @property
    def _in_place(self) -> bool:
        return self.item.source == self.item.target

    def _charts(self, song: Song) -> list[Chart]:
        """Return the selected charts, except those that the program has added."""
        return [chart for chart in self.request.selection.charts(song) if not edit.is_ours(chart)]

    def _without_added(self) -> Song:
        """Return the song without the charts that an earlier run has added for the selected charts."""
        splices = edit.without_added(self.song, self._charts(self.song))
        return parse(apply(self.song.data, splices), self.song.path) if splices else self.song

    def _without_background(self, song: Song) -> Song:
        """Return the song without the entries of films; the same object if there are none."""
        splices = background.remove_entries(song)
        return parse(apply(song.data, splices), song.path) if splices else song

    def _add_chart_file(self, data: bytes, change: NoteChange) -> None:
        self.changes.append(FileChange(self.item.target, self.song.data, data))
        self.lacks += change.lacks
        self.notes += change.notes
        self.counts += change.counts

    def _add_beside(self, change: FileChange) -> None:
        if change.error is not None:
            self.errors.append(str(change.error))
            return
        self.changes.append(change)
        self.lacks += change.lacks

    def _write_change(self, change: FileChange) -> None:
        """Write one change; with -o, unchanged files are written too, so that the copy is complete."""
        if self._in_place and not change.is_change:
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


def _presets(preset: str | None, path: Path) -> PresetChoice:
    """Return the presets for the charts of a file, as in `analyze`, so that both commands find the same feet."""
    if find_settings_file(path.absolute().parent) is None:
        return _unconfigured(preset)
    return _configured(preset).presets(path)


_unconfigured = cache(choice_of)  # solvers are kept for each preset


@cache
def _configured(preset: str | None) -> LintRun:
    from dancetutor_cli.lint.run import LintRequest, LintRun

    return LintRun(LintRequest(preset=preset))
