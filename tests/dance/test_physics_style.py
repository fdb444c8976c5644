"""Style files: what is read, and what is said of wrong ones."""

from pathlib import Path

import pytest

from dancetutor_cli.dance.physics.style import PARTS, Follower, Spring, load_style
from dancetutor_cli.run.errors import DancetutorError, FileError, UsageError
from dancetutor_cli.run.reading import config_names


def written(folder: Path, text: str) -> str:
    path = folder / "mine.yaml"
    path.write_text(text)
    return str(path)


@pytest.mark.parametrize("name", config_names("styles"))
def test_styles_that_come_with_the_program_load(name: str) -> None:
    style = load_style(name)
    assert style.name == name and set(style.springs) == set(PARTS) == set(style.density) == set(style.force)


def test_a_file_changes_only_what_it_names(tmp_path: Path) -> None:
    text = (
        "springs: {arms: {frequency: [1, 2, 3], damping: 0.2}}\nbody: {gravity: -2}\nforce: {chest: [0, 5, 6]}\n"
        "follower: {head: {frequency: 2, damping: 0.5, response: -1}}\nplacement: hybrid\nlimits: false\n"
        "disabled: [skull_tip]\n"
    )
    style, neutral = load_style(written(tmp_path, text)), load_style("neutral")
    assert style.springs["arms"] == Spring((1.0, 2.0, 3.0), (0.2, 0.2, 0.2))
    assert style.springs["hands"] == neutral.springs["hands"]
    assert (style.body.gravity, style.body.friction) == (-2.0, neutral.body.friction)
    assert style.force["chest"] == (0.0, 5.0, 6.0) and style.force["arms"] == (0.0, 0.0, 0.0)
    assert style.follower == {"head": Follower(2.0, 0.5, -1.0)}
    assert (style.placement, style.limits, style.extra_points) == ("hybrid", False, True)
    assert style.disabled == ("skull_tip",)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "placment: end\n",
            r"mine\.yaml:1: unknown key 'placment' \(did you mean placement\?\)",
        ),
        ("limits: true\nplacement: top\n", r":2: placement: there is no 'top'; choose end, center, hybrid"),
        ("limits: 1\n", r":1: limits must be true or false, not 1"),
        ("body: {gravity: 99}\n", r":1: body\.gravity must be a number from -50 to 50 m/s², not 99"),
        ("body: {mass: 9}\n", r":1: unknown key 'mass' in 'body'; choose gravity"),
        ("springs: {arms: 5}\n", r":1: springs\.arms must be a mapping of frequency, damping, not 5"),
        ("springs: {arms: {frequency: [1, 2], damping: 1}}\n", r"frequency must be one number or three, not \[1, 2\]"),
        (
            "springs: {all: {frequency: 99, damping: 1}}\n",
            r":1: springs\.all\.frequency\[0\] must be a number from 0 to 60 hertz, not 99",
        ),
        ("density: {legs: 5}\n", r":1: unknown key 'legs' in 'density'; choose all, pelvis"),
        ("force: {chest: [1, .nan, 2]}\n", r":1: a number must be finite"),
        ("disabled: skull\n", r":1: disabled must be a list of values, each text, not"),
        (
            "follower: {head: {frequency: 1}}\n",
            r":1: follower\.head\.damping is missing; it must be a number from 0\.1 to 5",
        ),
    ],
)
def test_a_wrong_file_is_reported_with_its_line(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(FileError, match=said) as error:
        load_style(written(tmp_path, text))
    assert "\n" not in str(error.value)


def test_an_unknown_name_lists_those_that_there_are() -> None:
    with pytest.raises(UsageError, match=r"there is no style 'neutrl' \(did you mean neutral\?\); choose .*neutral"):
        load_style("neutrl")
    with pytest.raises(DancetutorError, match=r"gone\.yaml"):
        load_style("gone.yaml")
