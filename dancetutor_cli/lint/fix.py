"""The piece of work of `analyze --fix`: one file and what is to be mended in it; what became of it comes back."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from dancetutor_cli.chart.edits import unified
from dancetutor_cli.lint.analysis import AnalyzeTask, load_song
from dancetutor_cli.lint.configuration import preset_for
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.run.errors import FileError, NoChartsError
from dancetutor_cli.run.files import ChangedError, back_up, remove_leftovers, write_atomic

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart
    from dancetutor_cli.feet.preset import Preset
    from dancetutor_cli.lint.mend import AppliedFix, FixSession, SkippedFinding

NEVER_WRITTEN = "a .ucs file is never written; mend it in its editor"


@dataclass(frozen=True, slots=True)
class FixOrder:
    """What shall be mended in one file.

    task : the file, with its configuration; safe : the safe fixes are wanted
    findings : those that were asked for, each with the player of a chart for two in whose part it is, else 0
    write : whether the file is written; backup : keep the old bytes beside it
    """

    task: AnalyzeTask
    findings: tuple[tuple[Finding, int], ...]
    safe: bool = False
    write: bool = True
    backup: bool = False


@dataclass(frozen=True, slots=True)
class FixOutcome:
    """What became of a file.

    fixed : what was, or would be, changed; unfixed : findings that were asked for and are as they were; error : or None
    diff : the lines of the change; notes : what to know besides
    """

    fixed: tuple[AppliedFix, ...] = ()
    unfixed: tuple[SkippedFinding, ...] = ()
    error: str | None = None
    diff: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


def fix_file(order: FixOrder) -> FixOutcome:
    """Mend one file, proved before it is written. Never raises for what is wrong with the file."""
    try:
        return _fix(order)
    except NoChartsError as error:  # music of a menu: nothing to mend
        return FixOutcome(notes=(str(error),))
    except FileError as error:
        return FixOutcome(error=str(error))
    except OSError as error:
        return FixOutcome(error=str(FileError(order.task.path, error.strerror or str(error))))


def _fix(order: FixOrder) -> FixOutcome:
    from dancetutor_cli.lint.mend import FixSession, SkippedFinding

    task = order.task
    song = load_song(task)
    if song.format == "ucs":
        label = song.charts[0].label
        return FixOutcome(unfixed=tuple(SkippedFinding(label, finding, NEVER_WRITTEN) for finding, _ in order.findings))
    if order.write:
        remove_leftovers(task.path.parent)

    def preset_of(chart: Chart) -> Preset:
        return preset_for(chart, task.path, task.presets)

    mending = FixSession(song, task.settings, preset_of)
    if order.safe:
        for chart in task.selection.charts(song):
            mending.safe(chart.index)
    for finding, player in order.findings:
        mending.finding(finding.chart or 0, finding, player)
    new = mending.song.data
    if order.write and new != song.data:
        _write(order, song.data, new)
    diff = tuple(unified(str(task.path), song.data, new))
    return FixOutcome(tuple(mending.fixed), tuple(mending.unfixed), None, diff, tuple(_notes(order, mending)))


def _write(order: FixOrder, old: bytes, new: bytes) -> None:
    path = order.task.path
    if order.backup:
        back_up(path)
    try:
        write_atomic(path, new, expect=old)
    except ChangedError:
        if path.read_bytes() != new:  # else another run has just done the same
            raise


def _notes(order: FixOrder, mending: FixSession) -> Iterator[str]:
    """What else the author has to do, as far as something was changed that is played."""
    if all(one.fix.is_silent for one in mending.fixed):
        return
    path = order.task.path
    if b"{dt1 " in mending.song.data:
        yield f"{path}: has feet in its measures that were found before; `dancetutor annotate` brings them up to date"


def pick(findings: Sequence[tuple[Finding, int]], rule: str, number: int | None) -> tuple[tuple[Finding, int], ...]:
    """The findings of a rule, or the one of that number, from 1; empty if there is none."""
    found = tuple(one for one in findings if one[0].rule == rule)
    return found if number is None else found[number - 1 : number]
