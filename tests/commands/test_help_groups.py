"""Help prints each option once, in a group; options have one name over all commands, and old names work."""

from __future__ import annotations

import re
from itertools import chain
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from dancetutor_cli.commands import COMMANDS, cli
from dancetutor_cli.commands.option_groups import GROUPS, RENAMED


def command_named(name: str) -> click.Command:
    command = cli.get_command(click.Context(cli), name)
    assert command is not None
    return command


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_is_in_one_group_and_is_printed_once(name: str) -> None:
    context = click.Context(command_named(name), info_name=name)
    options = [one for one in context.command.get_params(context) if isinstance(one, click.Option) and not one.hidden]
    grouped = list(chain(*GROUPS.values()))
    assert len(grouped) == len(set(grouped))
    assert [one.opts for one in options if not set(one.opts) & set(grouped)] == []
    rows = [re.match(r"  (?:-\w, )?(--[\w-]+)", line) for line in context.get_help().splitlines()]
    starts = [row[1] for row in rows if row]
    for option in options:
        assert starts.count(max(option.opts, key=len)) == 1, option.opts


def test_no_name_of_an_option_has_two_meanings() -> None:
    """A name that several commands have takes the same kind of value in each: files and numbers are not mixed."""
    kinds: dict[str, set[bool]] = {}
    for name in COMMANDS:
        for option in command_named(name).params:
            if isinstance(option, click.Option):
                kinds.setdefault(max(option.opts, key=len), set()).add(option.is_flag)
    assert [name for name, flags in kinds.items() if len(flags) > 1] == []
    assert not {old for old, _ in RENAMED} & {new for _, new in RENAMED}


def options_by_name() -> dict[str, list[click.Option]]:
    """Long name -> the option of that name in each command that has one."""
    found: dict[str, list[click.Option]] = {}
    for name in COMMANDS:
        for option in command_named(name).params:
            if isinstance(option, click.Option):
                found.setdefault(max(option.opts, key=len), []).append(option)
    return found


def meaning(option: click.Option) -> str:
    """The first sentence of an option's help, up to a full stop, a colon or its default."""
    return re.split(r"[.:](?:\s|$)|\s\s\[", option.help or "")[0].rstrip(".")


def test_an_option_that_several_commands_have_means_the_same_in_each() -> None:
    shared = {
        name: {meaning(one) for one in options} for name, options in options_by_name().items() if len(options) > 1
    }
    assert len(shared) >= 25
    assert {name: said for name, said in shared.items() if len(said) > 1} == {}


def test_a_letter_stands_for_one_option() -> None:
    letters: dict[str, set[str]] = {}
    for options in options_by_name().values():
        for option in options:
            for letter in (one for one in option.opts if not one.startswith("--")):
                letters.setdefault(letter, set()).add(meaning(option))
    assert {letter: said for letter, said in letters.items() if len(said) > 1} == {}


def test_help_is_an_imperative_or_a_name_and_ends_in_a_full_stop_or_its_default() -> None:
    for name, options in options_by_name().items():
        for option in options:
            said = option.help or ""
            assert re.search(r"(\.|\]|\.\))$", said), (name, said)
            assert said[:1].isupper(), (name, said)
            assert not re.search(r"\bs?he\b|\bher\b", said, re.I), (name, said)


def test_the_names_of_before_work(tmp_path: Path) -> None:
    song = next((Path(__file__).parents[2] / "charts").rglob("*.ssc"))
    for call in (["annotate", "--style", "rows"], ["annotate", "--style=rows"], ["annotate", "--markers", "rows"]):
        result = CliRunner().invoke(cli, [*call, str(song), "--output", str(tmp_path / call[-1]), "--quiet"])
        assert result.exit_code == 0, result.output
    assert len({next((tmp_path / name).rglob("*.ssc")).read_bytes() for name in ("rows", "--style=rows")}) == 1
