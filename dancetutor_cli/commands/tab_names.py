"""The names that the Tab key completes an option to; they are looked up only while a shell completes."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import click
from click.shell_completion import CompletionItem

from dancetutor_cli.chart.names import COLUMNS
from dancetutor_cli.run.reading import config_path

_Completer = Callable[[click.Context, click.Parameter, str], list[CompletionItem]]


def named(names: Callable[[], Iterable[str]], files: bool = True) -> _Completer:
    """Completes an option from `names`; where none fits and `files` may be given, the shell completes those."""

    def complete(_context: click.Context, _option: click.Parameter, begun: str) -> list[CompletionItem]:
        found = [CompletionItem(name) for name in sorted(names()) if name.lower().startswith(begun.lower())]
        return found or ([CompletionItem(begun, type="file")] if files else [])

    return complete


def rules() -> Iterable[str]:
    """Codes and names of the rules."""
    from dancetutor_cli.lint.rule import all_rules

    return [word for code, rule in all_rules().items() for word in (code, rule.name)]


def fixes() -> Iterable[str]:
    """What --fix takes."""
    from dancetutor_cli.lint.fix import FIXABLE

    return ["safe", *FIXABLE]


def folder(name: str) -> Callable[[], Iterable[str]]:
    """The files of a folder of configs, without their suffix."""

    def names() -> Iterable[str]:
        return [path.stem for path in config_path(name).glob("*.yaml")]

    return names


def steps_types() -> Iterable[str]:
    """Those that have a name."""
    return COLUMNS


def difficulties() -> Iterable[str]:
    """As the games name them."""
    return ["beginner", "easy", "medium", "hard", "challenge", "edit"]


def characters() -> Iterable[str]:
    """Who is built in."""
    from dancetutor_cli.character.characters import BUILT_IN

    return BUILT_IN
