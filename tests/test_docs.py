"""The documents keep up with the program: every command and option is documented, every example parses."""

from __future__ import annotations

import importlib
import re
import shlex
from pathlib import Path

import click
import pytest

from dancetutor_cli.commands import COMMANDS

README = (Path(__file__).resolve().parent.parent / "README.md").read_text(encoding="utf-8")
EXAMPLES = [
    line.split("#")[0].removeprefix("$ ").strip()
    for block in re.findall(r"```(?:sh|console)\n(.*?)```", README, re.S)
    for line in block.splitlines()
    if line.removeprefix("$ ").startswith("dancetutor ")
]


def command_named(name: str) -> click.Command:
    command = importlib.import_module(f"dancetutor_cli.commands.{COMMANDS[name][0]}").command
    assert isinstance(command, click.Command)
    return command


@pytest.mark.parametrize("name", sorted(COMMANDS))
def test_every_command_has_a_section_and_an_example(name: str) -> None:
    assert re.search(rf"^### .*`?{name}`?", README, re.M), f"the README has no section on {name}"
    assert any(shlex.split(example)[1] == name for example in EXAMPLES), f"the README has no example of {name}"


@pytest.mark.parametrize("name", sorted(COMMANDS))
def test_every_option_says_what_it_does(name: str) -> None:
    command = command_named(name)
    assert command.help
    silent = [p.name for p in command.params if isinstance(p, click.Option) and not p.help and not p.hidden]
    assert silent == []


@pytest.mark.parametrize("example", EXAMPLES)
def test_the_examples_use_options_that_exist(example: str) -> None:
    _, name, *arguments = shlex.split(example)
    command = command_named(name)
    known = {flag for p in command.params if isinstance(p, click.Option) for flag in (*p.opts, *p.secondary_opts)}
    used = {a.split("=")[0] for a in arguments if a.startswith("-") and a != "-"}
    assert used <= known | {"--help", "-h"}


def test_short_help_in_the_list_matches_the_command() -> None:
    for name, (_, text) in COMMANDS.items():
        assert command_named(name).get_short_help_str(200).split()[0] == text.split()[0], name
