"""`dancetutor annotate`: write L/R foot markers into chart files, or remove them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import click

from dancetutor_cli.chart.selection import Selection, find_files, note_bytes
from dancetutor_cli.commands.arguments import GivenPath, WholeNumber, report_error, warn, within_folders
from dancetutor_cli.commands.first_run import announce_compiling
from dancetutor_cli.commands.folder_run import JoinedWarnings
from dancetutor_cli.commands.option_groups import GroupedCommand
from dancetutor_cli.commands.shared_options import (
    exclude_option,
    into,
    preset_option,
    quiet_option,
    same_fields,
    selection_options,
    verbose_option,
)
from dancetutor_cli.markers.styles import STRIPPED, STYLES
from dancetutor_cli.reports.terminal import colour_diff
from dancetutor_cli.run.errors import UsageError, choose_text, plural
from dancetutor_cli.run.files import check_folder
from dancetutor_cli.run.foreign_text import safe

if TYPE_CHECKING:
    from dancetutor_cli.markers.annotate import AnnotateOutcome, AnnotateRequest, Item

_MANY = 24  # number of songs from which worker processes save time


def _styles(_: click.Context, __: click.Parameter, value: str | None) -> tuple[str, ...] | None:
    if value is None:
        return None
    names = [name.strip() for name in value.split(",") if name.strip()]
    for name in names:
        if name not in STRIPPED:
            raise UsageError(f"there is no kind of markers '{name}'{choose_text(name, STYLES)}")
    if not names:
        raise UsageError(f"--markers: name one or more of {', '.join(STYLES)}")
    return tuple(name for name in STRIPPED if name in names)


@dataclass(frozen=True, slots=True)
class AnnotateOptions:
    """The options of `annotate` without the selection of charts; see `markers.annotate.AnnotateRequest`."""

    styles: tuple[str, ...] | None
    strip: bool
    check: bool
    diff: bool
    dry_run: bool
    output: Path | None
    into_file: bool
    force: bool
    backup: bool
    preset: str | None
    jobs: int | None
    verbose: bool
    quiet: bool
    exclude: tuple[str, ...]


@click.command(cls=GroupedCommand)
@click.argument("paths", nargs=-1, required=True, type=GivenPath(untrusted=True), metavar="PATH...")
@click.option(
    "--markers", "styles", callback=_styles, metavar="KIND[,KIND]",
    help=f"How to write the feet: {', '.join(STYLES)} (theme shows them during play). "
    "With --strip also background: the entry that render --into-file added.  [default: measure; with "
    "--strip: all]",
)  # fmt: skip
@click.option("--strip", is_flag=True, help="Remove the markers: all, or only those of --markers.")
@click.option("--check", is_flag=True, help="Write nothing; exit status 1 if feet are missing or stale.")
@click.option("--diff", is_flag=True, help="Write nothing; print what would change.")
@click.option("--dry-run", is_flag=True, help="Write nothing; print which files would change.")
@click.option(
    "-o",
    "--output",
    type=GivenPath(),
    metavar="DIR",
    help="Name of the output: a folder for the changed files.  [default: into the files]",
)
@click.option(
    "--into-file",
    is_flag=True,
    help="Write into the chart file: with --markers edit, add the charts there, not in .edit files.",
)
@click.option("--force", is_flag=True, help="Also overwrite or remove pinned measures, {dt1! ...}.")
@click.option("--backup", is_flag=True, help="Keep the old file as NAME.bak.")
@click.option(
    "--jobs",
    type=WholeNumber(1),
    metavar="N",
    help="Number of processes.  [default: one per core, as memory allows]",
)
@quiet_option
@verbose_option
@exclude_option
@preset_option
@selection_options
@into("selection", Selection)
@into("options", AnnotateOptions)
def command(paths: tuple[Path, ...], selection: Selection, options: AnnotateOptions) -> int:
    """Write L/R foot markers into chart files, or remove them.

    PATH is a .sm, .ssc or .ucs file, or a folder with such files. Only comments are added; --strip restores the file
    byte for byte. A .ucs file cannot hold them, so its feet go into NAME.feet.txt beside it.

    Exit status: 0 done, 1 feet are missing or stale (--check), 2 a file cannot be read or written.
    """
    from dancetutor_cli.feet.preset import choice_of
    from dancetutor_cli.markers.annotate import AnnotateRequest

    if not options.strip and "background" in (options.styles or ()):
        raise UsageError(
            "the kind 'background' is a film: `render --background --into-file` writes it; --strip removes it"
        )
    if selection.player is not None:
        raise UsageError("--player is for analyze, animate, render and page; annotate writes both players' feet")
    wanted = options.styles or (STRIPPED if options.strip else STYLES[:1])
    if options.into_file and "edit" not in wanted:
        raise UsageError("--into-file belongs to the markers 'edit'; add --markers edit")
    writes = not (options.check or options.diff or options.dry_run)
    named = options.styles is not None
    fields = same_fields(options, AnnotateRequest) | {"styles": wanted}
    request = AnnotateRequest(**fields, selection=selection, named=named, write=writes)
    files = find_files(paths, options.exclude)
    files = files if options.output is not None else within_folders(paths, files)
    songs = _songs(_items(paths, options.output, files))
    messages = _Messages(request, options.check, options.quiet, JoinedWarnings(every=options.verbose))
    messages.begin()
    if not request.strip:
        announce_compiling(
            choice_of(request.preset),
            lambda: sum(note_bytes(item.source, Selection()) for song in songs for item in song),
            quiet=options.quiet,
        )
    try:
        for outcome in _outcomes(songs, request, options.jobs):
            messages.show(outcome)
    finally:
        messages.warn()
    return messages.end()


def _items(paths: Sequence[Path], output: Path | None, files: Sequence[Path]) -> list[Item]:
    """Return each file with its target.

    With -o DIR, a file goes into DIR; a file in a folder keeps its relative path below DIR.
    """
    from dancetutor_cli.markers.annotate import Item

    if output is None:
        return [Item(path, path) for path in files]
    check_folder(output)
    items: dict[Path, Item] = {}
    for path in files:
        folder = next((p for p in paths if p != path and path.is_relative_to(p)), path.parent)
        target = output / path.relative_to(folder)
        target = path if target.exists() and target.samefile(path) else target
        if target in items:
            raise UsageError(f"{path} and {items[target].source} would both become {target}; annotate them separately")
        items[target] = Item(path, target)
    return list(items.values())


def _songs(items: Sequence[Item]) -> list[tuple[Item, ...]]:
    """Return the files in groups, one for each song: files of one song share the files beside them."""
    songs: dict[tuple[Path, str], list[Item]] = {}
    for item in items:
        songs.setdefault((item.source.parent, item.source.stem.lower()), []).append(item)
    return [tuple(song) for song in songs.values()]


def _outcomes(
    songs: Sequence[tuple[Item, ...]], request: AnnotateRequest, jobs: int | None
) -> Iterator[AnnotateOutcome]:
    """Yield the outcome of each file as soon as it is known, in the order of the files."""
    from dancetutor_cli.markers.annotate import annotate_song

    wanted = jobs or _fitting_jobs(len(songs))
    if min(wanted, len(songs)) <= 1:
        for song in songs:
            yield from annotate_song(song, request)
        return
    from dancetutor_cli.run.pool import in_order

    for outcomes in in_order(wanted, annotate_song, [(song, request) for song in songs]):
        yield from outcomes


def _fitting_jobs(songs: int) -> int:
    if songs < _MANY:
        return 1
    from dancetutor_cli.run.pool import default_jobs

    return default_jobs()


@dataclass
class _Messages:
    """The messages and the exit status of a run."""

    request: AnnotateRequest
    check: bool
    quiet: bool
    warnings: JoinedWarnings
    files: Counter[str] = field(default_factory=Counter)
    lacking: bool = False
    unselected: list[str] = field(default_factory=list)
    skipped: int = 0
    folders: int = 0

    def begin(self) -> None:
        if "rows" in self.request.styles and not self.request.strip and not self.quiet:
            from dancetutor_cli.markers.rows import WARNING

            warn([WARNING])

    def show(self, outcome: AnnotateOutcome) -> None:
        for note in (*outcome.notes, *(() if self.check else outcome.problems)):
            self.warnings.add(outcome.source, note)
        if outcome.error is not None:
            if outcome.source.is_dir():
                self.folders += 1
            else:
                self.files["failed"] += 1
            report_error(outcome.error)
            return
        self.files["changed" if outcome.changed else "unchanged"] += 1
        if outcome.unselected:
            self.unselected += outcome.unselected
            self.skipped += 1
        self.lacking |= bool(outcome.lacks or outcome.problems)
        if self.check:
            for line in (*outcome.problems, *outcome.lacks):
                click.echo(safe(line))
        if self.request.diff:
            for line in colour_diff(outcome.diff):
                click.echo(line)
        elif not self.check and not self.quiet and not outcome.unselected:
            details = _leftover_message(outcome) if self.request.strip else _details(outcome)
            click.echo(f"{self._verb(outcome)} {safe(str(outcome.source))}{details}")
            for path in outcome.companions:
                click.echo(f"  {safe(path.name)}")

    def _verb(self, outcome: AnnotateOutcome) -> str:
        if not outcome.changed:
            return "unchanged"
        past = "stripped" if self.request.strip else "annotated"
        return past if self.request.write else f"would be {past}:"

    def warn(self) -> None:
        for line in self.warnings.lines() if not self.quiet else ():
            click.echo(line, err=True)

    def end(self) -> int:
        total = sum(self.files.values())
        if self.skipped and self.skipped == total - self.files["failed"]:
            has = f"; the file has {', '.join(self.unselected[:20])}" if total == 1 else ""
            raise UsageError(safe(f"no chart matches {self.request.selection.options}{has}"))
        words = {} if self.request.write else {"changed": "would change"}
        parts = ", ".join(f"{n} {words.get(name, name)}" for name, n in sorted(self.files.items()) if n)
        if self.folders:
            parts += f"{'; ' * bool(parts)}no file to read in {plural(self.folders, 'folder')}"
        if not self.quiet:
            click.echo(f"{plural(total, 'file')}: {parts}", err=self.request.diff)
        if self.files["failed"] or self.folders:
            return 2
        return 1 if self.check and self.lacking else 0


def _leftover_message(outcome: AnnotateOutcome) -> str:
    """Return the message about markers that --strip has not removed."""
    pinned = dict(outcome.counts).get("pinned", 0)
    if not pinned:
        return ""
    measures, them = ("measures", "them") if pinned > 1 else ("measure", "it")
    return f": {pinned} pinned {measures} left alone; --force removes {them}"


def _details(outcome: AnnotateOutcome) -> str:
    counts = Counter(dict(outcome.counts))
    words = (("missing", "new"), ("different", "other feet"), ("stale", "stale"), ("pinned", "pinned, left alone"))
    measures = sum(counts[name] for name in ("missing", "different", "stale", "pinned", "current"))
    if not measures:
        return ""
    parts = [f"{counts[name]} {word}" for name, word in words if counts[name]]
    return f": {measures} measure{'s' if measures > 1 else ''}" + (f" ({', '.join(parts)})" if parts else "")
