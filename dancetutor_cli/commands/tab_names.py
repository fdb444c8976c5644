"""The names with which the Tab key completes an option; they are read only while a shell completes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial

import click
from click.shell_completion import CompletionItem

from dancetutor_cli.chart.names import COLUMNS, DIFFICULTIES
from dancetutor_cli.run.reading import config_names

_Completer = Callable[[click.Context, click.Parameter, str], list[CompletionItem]]


def named(names: Callable[[], Iterable[str]], files: bool = True) -> _Completer:
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
