"""Help prints each option once, in a group; options have one name over all commands, and old names work."""

from __future__ import annotations

import re
from itertools import chain
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from dancetutor_cli.commands import COMMANDS, cli
from dancetutor_cli.commands.help_groups import GROUPS, RENAMED


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


def test_the_names_of_before_work(tmp_path: Path) -> None:
    song = next((Path(__file__).parents[2] / "charts").rglob("*.ssc"))
    for call in (["annotate", "--style", "rows"], ["annotate", "--style=rows"], ["annotate", "--markers", "rows"]):
        result = CliRunner().invoke(cli, [*call, str(song), "--output", str(tmp_path / call[-1]), "--quiet"])
        assert result.exit_code == 0, result.output
    assert len({next((tmp_path / name).rglob("*.ssc")).read_bytes() for name in ("rows", "--style=rows")}) == 1
