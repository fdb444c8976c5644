"""The piece of work of `annotate`: the files of one song in, what became of each out; a failure is part of that."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from dancetutor_cli.errors import FileError
from dancetutor_cli.files import back_up, remove_leftovers, write_atomic
from dancetutor_cli.jobs.selection import Selection

if TYPE_CHECKING:
    from dancetutor_cli.markers.model import Change


@dataclass(frozen=True, slots=True)
class Order:
    """What shall be done with every file. Pickles.

    write : whether files are written at all; diff : whether a diff is wanted; force : pinned measures too
    into_file : added charts instead of .edit files; backup : keep the old bytes beside a file that is changed
    """

    styles: tuple[str, ...]
    preset: str
    selection: Selection
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
class Outcome:
    """What became of a file. lacks, notes : lines for people; changed : the files that are or would be different."""

    source: Path
    error: str | None = None
    notes: tuple[str, ...] = ()
    lacks: tuple[str, ...] = ()
    counts: tuple[tuple[str, int], ...] = ()
    changed: tuple[Path, ...] = ()
    diff: tuple[str, ...] = ()


def annotate_song(items: Sequence[Item], order: Order) -> list[Outcome]:
    """Annotate the files of one song, or take the markers out. Never raises for what is wrong with a file.

    `UsageError` (no such preset) is raised: it is not about a file.
    """
    if order.write:
        for folder in sorted({item.target.parent for item in items}):
            remove_leftovers(folder)
    return [_attempt(item, order) for item in items]


def _attempt(item: Item, order: Order) -> Outcome:
    try:
        return _annotate(item, order)
    except FileError as error:
        return Outcome(item.source, error=str(error))
    except OSError as error:
        return Outcome(item.source, error=str(FileError(item.source, error.strerror or str(error))))


def _annotate(item: Item, order: Order) -> Outcome:
    from dancetutor_cli import chart as reader
    from dancetutor_cli.markers import plan as planning
    from dancetutor_cli.markers.model import Change

    song = reader.load(item.source)
    charts = order.selection.charts(song)
    notes: list[str] = []
    if order.strip:
        plan = planning.unmark(song, charts, order.styles, order.force)
    else:
        from dancetutor_cli.play import load_preset

        feet = list(planning.solve_charts(song, charts, load_preset(order.preset), notes))
        plan = planning.mark(song, feet, order.styles, order.force)
    planning.checked(song, plan)
    changes = [Change(item.target, song.data, plan.data)]
    if order.write:
        for change in changes:
            _write(item, change, order)
    return Outcome(
        item.source,
        notes=(*notes, *plan.notes),
        lacks=tuple(lack.at(item.source) for lack in plan.lacks),
        counts=tuple(sorted(plan.counts.items())),
        changed=tuple(change.path for change in changes if change.needed),
        diff=tuple(_diff(changes)) if order.diff else (),
    )


def _write(item: Item, change: Change, order: Order) -> None:
    """Bring one change to the disk; with -o also what is the same as before, so that the copy is whole."""
    in_place = item.source == item.target
    if in_place and not change.needed:
        return
    change.path.parent.mkdir(parents=True, exist_ok=True)
    if order.backup and change.path.exists():
        back_up(change.path)
    if change.new is not None:
        write_atomic(change.path, change.new, expect=change.old if in_place else None)
    elif in_place:
        change.path.unlink(missing_ok=True)


def _diff(changes: Sequence[Change]) -> Iterator[str]:
    from dancetutor_cli.markers.diff import unified

    for change in changes:
        yield from unified(str(change.path), change.old, change.new)


def annotate_task(report: Callable[[int], None], items: Sequence[Item], order: Order) -> list[Outcome]:
    """`annotate_song` as worker processes call it."""
    return annotate_song(items, order)
