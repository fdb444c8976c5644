"""`render` for a whole folder: a film of every chart in it."""

from __future__ import annotations

import json
import sys
from collections import Counter
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

import click

from dancetutor_cli.commands.arguments import LONG, note
from dancetutor_cli.commands.film_options import RenderOptions, film_request
from dancetutor_cli.commands.folder_run import FolderRun, JoinedWarnings
from dancetutor_cli.reports.progress import FilmProgress
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.files import check_file, check_folder, encode_json
from dancetutor_cli.run.foreign_text import json_without_commands, safe

if TYPE_CHECKING:
    from dancetutor_cli.chart.selection import Selection
    from dancetutor_cli.commands.shared_options import DanceOptions
    from dancetutor_cli.film.choices import RendererKind
    from dancetutor_cli.film.work.batch import BatchRequest
    from dancetutor_cli.film.work.jobs import FilmOutcome
    from dancetutor_cli.run.pool import Workers


def render_batch(path: Path, selection: Selection, dance: DanceOptions, options: RenderOptions) -> None:
    """Make a film of every matching chart below `path`. Exits with 2 if a film failed."""
    from dancetutor_cli.film.work.batch import Batch, film_list
    from dancetutor_cli.film.work.segments import find_records
    from dancetutor_cli.run.pool import default_jobs

    if options.scheduler:  # its workers have other working folders
        path = path.absolute()
    batch = _batch(path, selection, dance, options)
    check_folder(batch.folder)
    if options.results is not None and str(options.results) != "-":
        check_file(options.results, (".jsonl", ".json"), or_device=True)
    films, unreadable, without = film_list(batch)
    run = FolderRun(len(films), unreadable, JoinedWarnings(every=options.verbose))
    run.begin(path, batch.folder, f"{path}: no chart matches{_filters(selection, options)}")
    records, fault = find_records((path, batch.folder))
    if fault and not options.quiet:
        note(f"a second run will make all films again: {fault}")
    outcomes: list[FilmOutcome] = []
    jobs = options.jobs or default_jobs()
    with ExitStack() as stack:
        results = _open_results(options.results, stack)
        for bad in unreadable:
            _write(results, {"path": str(bad.path), "chart": None, "status": "failed", "error": bad.error})
        progress = stack.enter_context(FilmProgress(f"{len(films)} films", options.quiet))
        progress.begin(0, batch.request.fps)
        workers = _workers(options.scheduler, jobs, progress, batch.request.look.renderer)
        if not options.quiet:
            stack.callback(run.warn, progress.say)
        for outcome in Batch(films, workers, progress.add, records=records).run():
            outcomes.append(outcome)
            _write(results, outcome.as_json())
            _tell(outcome, progress, options.quiet, run.add(outcome.job.request.path, outcome.warnings))
    failed = [outcome for outcome in outcomes if outcome.status == "failed"]
    if not options.quiet:
        click.echo(_summary(outcomes, len(unreadable), len(without)), err=True)
    run.end([(str(one.job.request.path), one.job.label, str(one.error)) for one in failed])


def _batch(path: Path, selection: Selection, dance: DanceOptions, options: RenderOptions) -> BatchRequest:
    """Return the request of the charts below `path`, with the format and the output folder of the options."""
    from dancetutor_cli.film.media.encoder import FORMATS, PICTURES, Encoding, choose_encoder
    from dancetutor_cli.film.work.batch import DEFAULT_NAME, BatchRequest, parse_meters, parse_shard

    frames = options.frames
    kind = PICTURES if frames else "mp4"
    target = frames or options.output or Path("videos")
    request = film_request(path, selection, dance, options, FORMATS[kind])
    look = request.look
    encoder = choose_encoder(options.encoder) if frames is None else "x264"
    return BatchRequest(
        paths=(path,),
        request=request,
        encoding=Encoding(kind, look.size, request.fps, look.quality, encoder),
        folder=target.absolute() if options.scheduler else target,
        name=options.name or DEFAULT_NAME,
        meters=parse_meters(options.meter) if options.meter else None,
        shard=parse_shard(options.shard) if options.shard else (1, 1),
        longest=None if options.yes else LONG,
        exclude=options.exclude,
    )


def _workers(scheduler: str | None, jobs: int, progress: FilmProgress, kind: RendererKind) -> Workers:
    from dancetutor_cli.film.work.batch import film_workers
    from dancetutor_cli.film.work.segments import frames_of
    from dancetutor_cli.run.pool import ClusterWorkers

    if scheduler is None:
        return film_workers(jobs, progress.advance, kind)
    return ClusterWorkers(scheduler, lambda _key, count: progress.advance(count), frames_of)


def _open_results(path: Path | None, stack: ExitStack) -> TextIO | None:
    if path is None:
        return None
    if str(path) == "-":
        return sys.stdout
    try:
        return stack.enter_context(path.open("w", encoding="utf-8"))
    except OSError as error:
        raise FileError(path, f"cannot be written: {error.strerror}") from error


def _write(results: TextIO | None, line: dict[str, Any]) -> None:
    if results is not None:
        text = json_without_commands(json.dumps(line, ensure_ascii=False))
        results.write(encode_json(text + "\n").decode("utf-8"))
        results.flush()


def _tell(outcome: FilmOutcome, progress: FilmProgress, quiet: bool, number: str) -> None:
    name = outcome.job.output.name
    text = {"done": "done", "skipped": "already exists", "failed": f"FAILED: {outcome.error}"}[outcome.status]
    if not quiet or outcome.status == "failed":
        progress.say(safe(f"{number} {name} {text}"))


def _summary(outcomes: list[FilmOutcome], unreadable: int, without: int) -> str:
    counts = Counter(outcome.status for outcome in outcomes)
    parts = [f"{counts[name]} {name}" for name in ("done", "skipped", "failed") if counts[name]]
    parts += [f"{unreadable} unreadable"] if unreadable else []
    if without:
        parts.append(f"{without} {'songs have' if without > 1 else 'song has'} no such chart")
    return ", ".join(parts)


def _filters(selection: Selection, options: RenderOptions) -> str:
    """Return the options that select charts of a folder, as the user typed them, and what to do."""
    typed = [selection.options, *(f"--{n} {getattr(options, n)}" for n in ("meter", "shard") if getattr(options, n))]
    words = ", ".join(one for one in typed if one)
    return f" {words}; change or leave out one of these options" if words else ", so there is nothing to render"
