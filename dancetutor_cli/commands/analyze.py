"""`dancetutor analyze`: find the feet of charts and lint them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import chain
from pathlib import Path
from typing import IO, TYPE_CHECKING

import click

from dancetutor_cli.chart.selection import Selection, find_files, note_bytes
from dancetutor_cli.commands.analyze_options import AnalyzeOptions
from dancetutor_cli.commands.arguments import (
    GivenPath,
    Source,
    WholeNumber,
    completer_of,
    fixes,
    folder,
    note,
    open_output,
    report_error,
    rules,
    sources,
)
from dancetutor_cli.commands.drawings import check_sheet, check_sync_plot, write_sheet, write_sync_plot
from dancetutor_cli.commands.first_run import announce_compiling
from dancetutor_cli.commands.option_groups import GroupedCommand
from dancetutor_cli.commands.pack import (
    PackReport,
    check_comparison,
    pack_options,
    report_changes,
    report_tech_counts,
)
from dancetutor_cli.commands.shared_options import (
    exclude_option,
    into,
    language_option,
    preset_option,
    quiet_option,
    same_fields,
    selection_options,
)
from dancetutor_cli.reports.analyze_formats import FORMATS, Output, Tally, open_report
from dancetutor_cli.run.errors import DancetutorError, UsageError
from dancetutor_cli.run.files import check_file
from dancetutor_cli.run.trust import results_folder

if TYPE_CHECKING:
    from dancetutor_cli.lint.analysis import AnalyzeTask
    from dancetutor_cli.lint.results import FileResult, ResultCache
    from dancetutor_cli.lint.run import LintRequest, LintRun


def _explain(context: click.Context, _: click.Parameter, value: str | None) -> None:
    """Print the documentation of a rule and exit; no PATH is needed."""
    if value is None or context.resilient_parsing:
        return
    from dancetutor_cli.lint.rule import rule_named
    from dancetutor_cli.reports.rule_pages import explain, explain_all

    click.echo(explain_all() if value.lower() == "all" else explain(rule_named(value)), nl=False)
    context.exit()


@click.command(cls=GroupedCommand)
@click.argument("paths", nargs=-1, required=True, type=GivenPath(allow_dash=True, untrusted=True), metavar="PATH...")
@selection_options
@preset_option
@click.option(
    "--format",
    "format_name",
    type=click.Choice(tuple(FORMATS)),
    default="text",
    show_default=True,
    help="Format of the result.",
)
@click.option(
    "-o",
    "--output-file",
    type=GivenPath(dir_okay=False),
    metavar="FILE",
    help="Name of the output: a file.  [default: standard output]",
)
@click.option(
    "--fail-on",
    type=click.Choice(["error", "warning", "never"]),
    help="Exit with 1 for findings of this severity or worse.  [default: warning]",
)
@click.option("--exit-zero", is_flag=True, help="Exit with 0 despite findings; unreadable files still exit with 2.")
@click.option(
    "--select",
    shell_complete=completer_of(rules, files=False),
    multiple=True,
    metavar="RULES",
    help="Run only these rules, even if they are off: codes (DT201), names (spin) or families (DT2).",
)
@click.option(
    "--ignore",
    shell_complete=completer_of(rules, files=False),
    multiple=True,
    metavar="RULES",
    help="Do not run these rules.",
)
@click.option(
    "--config",
    shell_complete=completer_of(folder("lint")),
    metavar="FILE|NAME",
    help="Use this configuration, not the dancetutor.yaml beside or above PATH.",
)
@click.option(
    "--set",
    "assignments",
    multiple=True,
    metavar="KEY=VALUE",
    help="Change one value of the configuration, such as DT205.max_rows=4.",
)
@click.option("--show-settings", is_flag=True, help="Print the settings for PATH as a dancetutor.yaml, and exit.")
@click.option(
    "--baseline", type=GivenPath(dir_okay=False), metavar="FILE", help="Do not report the findings in this file."
)
@click.option("--update-baseline", is_flag=True, help="Write the findings of this run into the baseline.")
@quiet_option
@exclude_option
@click.option(
    "--full/--brief",
    default=None,
    help="Full: print a table for each chart and the rows around each finding. Brief: print at most one screen for "
    "a song and 60 lines for a pack.  [default: brief at a terminal, otherwise one line per finding]",
)
@click.option(
    "--statistics",
    is_flag=True,
    help="Print only the number of findings of each rule. With --full, print the findings first. In formats other than "
    "text, the numbers go to standard error.",
)
@click.option(
    "--sheet",
    type=GivenPath(dir_okay=False),
    metavar="FILE.html|.svg",
    help="Draw the charts of one file as a sheet of measures.",
)
@language_option("Language of the words.  [default: en; needs --sheet]")
@click.option(
    "--sync",
    is_flag=True,
    help="Measure the sync: how far the music is from the beats. Runs the rules about it (DT6).",
)
@click.option(
    "--plot",
    type=GivenPath(dir_okay=False),
    metavar="FILE.svg",
    help="Draw a diagram over time: the sync of one file. Needs --sync.",
)
@click.option(
    "--suggest",
    is_flag=True,
    help="Print what causes a doublestep, and a small edit of the notes that would remove a finding.",
)
@click.option(
    "--alternatives",
    type=WholeNumber(0, 100),
    default=0,
    metavar="N",
    help="Print the N next best feet of a chart: which rows differ, and which costs decide.  [formats text and json]",
)
@click.option(
    "--fix",
    shell_complete=completer_of(fixes, files=False),
    multiple=True,
    metavar="RULE[:N]|safe",
    help="Write the edits of --suggest into the file: for all findings of a rule, or for its N-th; safe: only edits "
    "that no player notices.",
)
@click.option("--diff", is_flag=True, help="Write nothing; print what would change. Needs --fix.")
@click.option("--backup", is_flag=True, help="Keep the old file as NAME.bak. Needs --fix.")
@pack_options
@click.option("--watch", is_flag=True, help="Run again whenever a file is saved, until Ctrl-C.")
@click.option("--jobs", type=WholeNumber(1), metavar="N", help="Number of processes.  [default: one per core]")
@click.option("--no-cache", is_flag=True, help="Do not use or store results of earlier runs.")
@click.option(
    "--stdin-filename",
    type=GivenPath(),
    metavar="FILE",
    help="File name of the chart on standard input (PATH -).",
)
@click.option(
    "--explain",
    shell_complete=completer_of(rules, files=False),
    callback=_explain,
    expose_value=False,
    is_eager=True,
    metavar="RULE|all",
    help="Print the documentation of a rule and exit.",
)
@into("selection", Selection)
@into("options", AnalyzeOptions)
def command(selection: Selection, options: AnalyzeOptions) -> int:
    """Find which foot steps each note, and check the chart.

    PATH is a .sm, .ssc or .ucs file, a folder with such files, or - for standard input.

    Exit status: 0 no errors or warnings, 1 errors or warnings (see --fail-on), 2 a file cannot be read or an option is
    wrong.
    """
    from dancetutor_cli.lint.run import LintRequest, LintRun

    request = LintRequest(
        selection=selection,
        **same_fields(options, LintRequest),
        want_rows=options.format_name == "json",
        want_figures=options.format_name == "csv" or options.report_html is not None,
        want_excerpts=options.format_name == "text",
    )
    options.check()
    if options.watch and not options.fix:
        return _watch(request, options)
    files = sources(options.paths, options.stdin_filename, options.exclude)
    if options.show_settings:
        from dancetutor_cli.commands.analyze_options import show_settings

        return show_settings(LintRun(request), files)
    return _run(LintRun(request), files, options)


def _watch(request: LintRequest, options: AnalyzeOptions) -> int:
    """Analyze all files, then each file that is saved, until Ctrl-C."""
    from dancetutor_cli.lint.run import LintRun, changes

    if any(str(path) == "-" for path in options.paths):
        raise UsageError("--watch needs files or folders, not standard input")
    run = LintRun(request)  # a new run each time: configurations may have changed

    def needs(path: Path) -> Iterable[Path]:
        return run.needs(path)

    for _, changed in changes(lambda: find_files(options.paths, options.exclude), needs):
        run = LintRun(request)
        if changed:
            click.clear()  # does nothing without a terminal
            _report_errors(partial(_run, run, [(file, None) for file in changed], options))
            click.echo("waiting for changes; Ctrl-C ends", err=True)
    return 0


def _report_errors(work: Callable[[], object]) -> None:
    """Do the work, and report an error, such as a wrong configuration, which the next save may correct."""
    try:
        work()
    except DancetutorError as error:
        report_error(error)


def _run(run: LintRun, files: list[Source], options: AnalyzeOptions) -> int:
    if options.sheet is not None:
        check_sheet(options.sheet, len(files))
    if options.plot is not None:
        check_sync_plot(options.plot, len(files))
    if options.update_baseline and options.baseline is not None:
        check_file(options.baseline)
    if options.output_file is not None:
        check_file(options.output_file, or_device=True)
    first = files[0][0]
    if options.fix:
        from dancetutor_cli.commands.fix_option import fix_all

        run.open_baseline(first)
        return fix_all(run, run.tasks(files), options)
    with open_output(options.output_file) as output:
        if options.tech_counts is not None:
            return report_tech_counts(run.tasks(files), options, output)
        if options.compare is not None:
            check_comparison(options)
            if options.report_html is None:
                return report_changes(options, output)
        return _lint(run, files, options, output)


def _lint(run: LintRun, files: list[Source], options: AnalyzeOptions, output: IO[str]) -> int:
    """Analyze all files and write the report. Returns the exit status."""
    from dancetutor_cli.lint.run import analyze_all

    first = files[0][0]
    view = options.view(output)
    silent = options.quiet or (view == "none" and not options.statistics)
    run.open_baseline(first)
    tasks = run.tasks(files)
    tally = Tally(run.fail_on(first), options.exit_zero, quiet=silent)
    pack = PackReport(options, run.has_baseline, len(files), view)
    _check_ffmpeg(tasks)
    preset = next(tasks[0].presets.candidates()).name
    report = open_report(view, Output(output, preset=preset, files=len(tasks)))
    report.begin()
    is_for_several = False
    cache = _open_cache(options)
    for raw in run.with_packs(analyze_all(tasks, options.jobs, cache, _before_work)):
        result = run.without_baseline(raw)
        tally.add(result)
        is_for_several |= any(chart.player for chart in raw.charts)
        pack.add(raw)
        if (reported := _reported_part(result, run, options, tally)) is not None:
            report.add(reported)
    player = run.request.selection.player
    none_matches = not tally.charts and not tally.unreadable and bool(tally.unselected or player)
    tally.quiet |= none_matches  # the error is enough
    tally.page += pack.lines()
    if options.statistics and options.format_name == "text":
        tally.page += tally.statistics()
    report.end(tally)
    for line in chain(pack.summary_lines(tally), _drawn(tasks, options) if not tally.unreadable else ()):
        if not options.quiet:
            click.echo(line, err=True)
    if cache is not None and not options.watch:
        _keep(files)
    _finish(run, tally, options)
    if none_matches:
        has = f"; the file has {', '.join(tally.unselected[:20])}" if len(files) == 1 and tally.unselected else ""
        raise UsageError(f"no chart matches {run.request.selection.options}{has}")
    if player is not None and not is_for_several and not options.quiet:
        note(f"--player {player} has no effect: every chart here is for one player")
    return tally.exit_status


def _open_cache(options: AnalyzeOptions) -> ResultCache | None:
    """Return the store of results; None with --no-cache, or where nothing can be stored, which is a note."""
    from dancetutor_cli.lint.results import ResultCache, default_folder

    kept = None if options.no_cache else default_folder()
    if not options.no_cache and not options.quiet and (fault := results_folder()[1]):
        note(f"{fault}: results are not stored")
    return None if kept is None else ResultCache(kept)


def _check_ffmpeg(tasks: list[AnalyzeTask]) -> None:
    """Raise an error before the work if --sync needs ffmpeg, which reads the music, and there is none."""
    if any(task.settings.sync for task in tasks):
        from dancetutor_cli.run.ffmpeg import executable

        executable()


def _reported_part(result: FileResult, run: LintRun, options: AnalyzeOptions, tally: Tally) -> FileResult | None:
    """Return the part of a result that is reported: with -q only what makes the run fail; None for nothing."""
    if not options.quiet and not (run.has_baseline and options.format_name == "text"):
        return result
    failing = "warning" if tally.fail_on == "never" else tally.fail_on
    part = result.at_least(failing if options.quiet else "info")
    return part if part.error or part.findings or part.charts else None


def _drawn(tasks: list[AnalyzeTask], options: AnalyzeOptions) -> Iterator[str]:
    """Write --sheet and --plot, and yield a line about each."""
    if options.sheet is not None:
        yield write_sheet(options.sheet, tasks, options.language)
    if options.plot is not None:
        yield write_sync_plot(options.plot, tasks[0])


def _keep(files: list[Source]) -> None:
    """Store the charts as they are now, for --compare last."""
    from dancetutor_cli.lint.snapshots import open_store

    store = open_store()
    if store is not None:
        store.prune()
        for path, data in files:
            if data is None:
                store.keep(path)


def _before_work(tasks: Sequence[AnalyzeTask]) -> None:
    """Decide whether kernels must be compiled for these files, and print a note if so."""
    solves_often = any(task.suggest or task.alternatives for task in tasks)

    def size() -> int:
        return sum(note_bytes(task.path, task.selection, task.data) for task in tasks)

    announce_compiling(tasks[0].presets, None if solves_often else size)


def _finish(run: LintRun, tally: Tally, options: AnalyzeOptions) -> None:
    """Print the messages after the results, to standard error, so that the results stay one document."""
    message = run.close_baseline()
    for line in tally.statistics() if options.statistics and options.format_name != "text" else ():
        click.echo(line, err=True)
    if options.suggest and not options.quiet:
        click.echo(tally.suggestions(), err=True)
    for line in message if not options.quiet else ():
        click.echo(line, err=True)
