"""Paths, numbers, charts and completed names on the command line, the output of results, messages and questions."""

from __future__ import annotations

import io
import os
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import click
from click.shell_completion import CompletionItem

from dancetutor_cli.chart.names import COLUMNS, DIFFICULTIES
from dancetutor_cli.chart.selection import find_files, split_links_out
from dancetutor_cli.run.errors import UsageError, did_you_mean
from dancetutor_cli.run.files import UCS_SUFFIX, plain_name, write_atomic
from dancetutor_cli.run.foreign_text import safe
from dancetutor_cli.run.reading import config_names
from dancetutor_cli.run.trust import exclude

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song


class GivenPath(click.Path):
    """A path from the user, as a `Path`.

    An empty path, as from a shell variable that is not set, is refused. It would mean the current folder, and
    `annotate ""` would write into every file below it.
    """

    def __init__(self, *, untrusted: bool = False, **options: Any) -> None:
        """untrusted : whether files of strangers are read there, so that no code may be loaded from there."""
        super().__init__(path_type=Path, **options)
        self._untrusted = untrusted

    def convert(
        self, value: str | os.PathLike[str], param: click.Parameter | None, ctx: click.Context | None
    ) -> str | bytes | os.PathLike[str]:
        if value == "":
            self.fail("the name is empty; write . for the folder you are in", param, ctx)
        path = super().convert(value, param, ctx)
        if self._untrusted and value != "-":
            exclude(Path(os.fsdecode(path)))
        return path


class _Range:
    """The common part of number types: the words for a range, and a one-line error for a value outside it."""

    min: Any  # float or None, of click
    max: Any
    what = "a number"

    def _describe_range(self) -> str:
        if self.min is None:
            return ""
        return f"{self.min:g} or more" if self.max is None else f"{self.min:g} to {self.max:g}"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the number. Raises UsageError if the text is not a number, or the number is nan or out of range."""
        try:
            converted = super().convert(value, param, ctx)  # type: ignore[misc]
            if converted == converted:  # nan is within every range
                return converted
        except click.BadParameter:
            pass
        name = max(param.opts, key=len) if param is not None else "number"
        limits = self._describe_range()
        between = ", " if self.max is None else " from "
        raise UsageError(f"{name} {value}: write {self.what}{between * bool(limits)}{limits}")


class WholeNumber(_Range, click.IntRange):
    """A whole number within limits, both included, in the option's unit; None stands for no limit."""

    what = "a whole number"


class Number(_Range, click.FloatRange):
    """A number within limits, both included, in the option's unit; None stands for no limit."""


class Second(Number):
    """A second of the song, any number."""

    what = "seconds, such as 12.5"


def within_folders(paths: Sequence[Path], files: Sequence[Path]) -> list[Path]:
    """Return the files of a search that may be written; print a warning for each link out of the searched folders."""
    kept, links = split_links_out(paths, files)
    where = "outside the folder that is searched; it is not changed; name it to change it"
    warn(f"{link}: is a link to {os.path.realpath(link)}, {where}" for link in links)
    return kept


# The charts on the command line of `analyze`: files, folders that are searched, or one chart on standard input.

Source = tuple[Path, bytes | None]  # a chart file, and its bytes if they come from standard input


def _suffix_of(data: bytes) -> str:
    """Return the suffix of a chart without a file name, from its contents."""
    if data.lstrip(b"\xef\xbb\xbf \t\r\n")[:1] == b":":
        return UCS_SUFFIX
    return ".ssc" if b"#NOTEDATA" in data.upper() else ".sm"


def sources(paths: tuple[Path, ...], stdin_filename: Path | None, exclude: Sequence[str] = ()) -> list[Source]:
    """Return the chart files that paths stand for, without excluded ones; standard input comes with its bytes."""
    if any(str(path) == "-" for path in paths):
        if len(paths) > 1:
            raise UsageError("standard input (-) cannot be combined with other paths")
        if sys.stdin is None:
            raise UsageError("standard input (-) is closed; send a chart to it, or name a file")
        data = sys.stdin.buffer.read()
        if stdin_filename is None and not data.strip():
            raise UsageError("standard input: nothing was read; send a chart to it")
        name = f"stdin{_suffix_of(data)}"
        return [(stdin_filename or Path(name), data)]
    if stdin_filename is not None:
        raise UsageError("--stdin-filename belongs to standard input: give - as PATH")
    return [(path, None) for path in find_files(paths, exclude)]


# The output of results: standard output, or a file that is written when all results are known.


@contextmanager
def open_output(path: Path | None) -> Iterator[IO[str]]:
    """Yield a stream of text with a `buffer` of bytes; its contents reach the file in one step, or not at all."""
    if path is None:
        yield sys.stdout
        return

    content = io.BytesIO()
    stream = io.TextIOWrapper(content, encoding="utf-8", errors="replace", newline="\n")
    yield stream
    stream.flush()
    write_atomic(path, content.getvalue())


def default_name(song: Song, chart: Chart, suffix: str) -> Path:
    """Return the default name of a result, SONG-difficulty, in characters that every file system accepts."""
    name = f"{song.title or song.path.stem}-{chart.difficulty or 'chart'}"
    return Path(plain_name(name) + suffix)


# Warnings beside the result of a command.


def warn(warnings: Iterable[str]) -> None:
    """Print each warning as a line on standard error."""
    for warning in warnings:
        click.echo(f"warning: {safe(warning)}", err=True)


def note(text: str) -> None:
    """Write a line to standard error about something that is no fault."""
    click.echo(f"note: {safe(text)}", err=True)


def report_error(error: Exception | str) -> None:
    """Write an error after which the command goes on, in the form of errors that end a command."""
    click.echo(f"dancetutor: {safe(str(error))}", err=True)


# The question before hours of work, for films and dances that are longer than anyone intends.

LONG = 20 * 60.0  # seconds of film or motion; longer ones need a confirmation


def _choices_text(choices: Sequence[str]) -> str:
    """Return "choose auto, cpu or gl", "" if there is no choice."""
    return f"choose {', '.join(choices[:-1])} or {choices[-1]}" if choices else ""


def usage_message(error: click.ClickException) -> str:
    """Return what click found wrong in one line: which option or argument, what to do, and where the help is."""
    context = getattr(error, "ctx", None)
    name = getattr(error, "option_name", "")
    if isinstance(error, click.NoSuchOption):
        text = f"there is no option {name}{did_you_mean(name, error.possibilities or ())}"
    elif isinstance(error, click.BadOptionUsage):
        text = f"{name} needs a value" if "requires" in error.message else f"{name} takes no value"
    elif isinstance(error, click.BadParameter) and error.param is not None:
        hint = error.param.get_error_hint(context).replace("'", "").removesuffix("...")
        if wrong := re.match(r"(?:\w+ )?'(.*)' (?:is not one of|does not exist)", error.message):
            name = hint if isinstance(error.param, click.Option) else error.param.name
            choices = error.param.type.choices if isinstance(error.param.type, click.Choice) else ()
            return f"{name} {wrong[1]}: " + (_choices_text(choices) or "no such file or folder")
        text = f"{hint} is missing" if isinstance(error, click.MissingParameter) else f"{hint}: {error.message}"
    else:
        text = error.format_message()
        text = text[:1].lower() + text[1:]
    text = text.rstrip(".")
    return text if context is None or ";" in text else f"{text}; see {context.command_path} --help"


def confirm_long(what: str, verb: str) -> None:
    """Ask the user to confirm; without a terminal, refuse, because nobody can answer. verb : "Render", "Bake" """
    if sys.stdin is not None and sys.stdin.isatty() and sys.stderr.isatty():
        click.confirm(f"{what}. {verb} it?", abort=True, err=True)
    else:
        raise UsageError(f"{what}; choose a part with --section, or add --yes")


# The names with which the Tab key completes an option; they are read only while a shell completes.

_Completer = Callable[[click.Context, click.Parameter, str], list[CompletionItem]]


def completer_of(names: Callable[[], Iterable[str]], files: bool = True) -> _Completer:
    """Return a completer of an option from `names`; if no name fits and `files` is set, the shell completes files."""

    def complete(_context: click.Context, _option: click.Parameter, begun: str) -> list[CompletionItem]:
        found = [CompletionItem(name) for name in sorted(names()) if name.lower().startswith(begun.lower())]
        return found or ([CompletionItem(begun, type="file")] if files else [])

    return complete


def rules() -> Iterable[str]:
    """Return the codes and names of the rules."""
    from dancetutor_cli.lint.rule import all_rules

    return [word for code, rule in all_rules().items() for word in (code, rule.name)]


def fixes() -> Iterable[str]:
    """Return the values that --fix accepts."""
    from dancetutor_cli.lint.fix import FIXABLE

    return ["safe", *FIXABLE]


def folder(name: str) -> Callable[[], Iterable[str]]:
    """Return a function that lists the files in a folder of configs, without their suffix."""
    return partial(config_names, name)


def steps_types() -> Iterable[str]:
    """Return the names of all steps types."""
    return COLUMNS


def difficulties() -> Iterable[str]:
    """Return the games' names of difficulties, in lower case."""
    return [name.lower() for name in DIFFICULTIES]


def characters() -> Iterable[str]:
    """Return the names of the built-in characters."""
    from dancetutor_cli.character.characters import BUILT_IN

    return BUILT_IN
