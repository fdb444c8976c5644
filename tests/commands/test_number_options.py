"""Options with numbers: their range in words, and one line for a value that does not fit."""

import click
import pytest
from click.testing import CliRunner

from dancetutor_cli.commands import COMMANDS, cli
from dancetutor_cli.run.errors import UsageError

SONG = "charts/two_left_feet/two_left_feet.ssc"


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["analyze", SONG, "--alternatives", "200"], "--alternatives 200: write a whole number from 0 to 100"),
        (["analyze", SONG, "--index", "x"], "--index x: write a whole number, 0 or more"),
        (["analyze", SONG, "--index", "1.5"], "--index 1.5: write a whole number, 0 or more"),
        (["animate", SONG, "--rate", "nan"], "--rate nan: write a number from 0.25 to 2"),
        (["animate", SONG, "--trip", "nan"], "--trip nan: write seconds, such as 12.5"),
        (["render", SONG, "--sync-offset", "inf"], "--sync-offset inf: write a number from -60000 to 60000"),
        (["annotate", SONG, "--jobs", "0"], "--jobs 0: write a whole number, 1 or more"),
    ],
)
def test_a_number_that_does_not_fit_is_one_line(arguments: list[str], line: str) -> None:
    failure = CliRunner().invoke(cli, arguments).exception
    assert isinstance(failure, UsageError) and str(failure) == line


@pytest.mark.parametrize("name", COMMANDS)
def test_help_has_ranges_in_words(name: str) -> None:
    shown = CliRunner().invoke(cli, [name, "--help"]).output
    assert "Usage:" in shown and "<=" not in shown and ">=" not in shown
    command = cli.get_command(click.Context(cli), name)
    assert command is not None
    for option in command.params:
        assert type(option.type) not in (click.IntRange, click.FloatRange), f"{option.name} has another way for a range"
