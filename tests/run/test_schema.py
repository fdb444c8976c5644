"""The schema of YAML: what fits becomes dataclasses; what does not is one line with the place and what it must be."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.schema import (
    NOT_IN_FILES,
    RGB,
    THREE,
    Bounds,
    Box,
    Entries,
    Meaning,
    Names,
    Share,
    Text,
    Texts,
    convert,
)
from dancetutor_cli.run.yaml_files import load, read


@dataclass(frozen=True)
class Inner:
    seconds: Annotated[float, Bounds(0, 10, "seconds", above=True)]
    count: Annotated[int, Bounds(1)] = 1


@dataclass(frozen=True)
class Outer:
    HYPHENS: ClassVar[bool] = True
    inner: Inner
    by_name: dict[Annotated[str, Names(("left", "right"))], Share] = field(default_factory=dict)
    knots: Annotated[dict[Annotated[int, Bounds(0, 9)], int], Entries(1, 3)] = field(default_factory=dict)
    way: Literal["up", "down"] = "up"
    many: tuple[Inner, ...] = ()
    pair: tuple[int, str] | None = None
    names: Texts = ()
    name: Text | None = None
    three: Annotated[tuple[float, float, float], THREE] = (0.0, 0.0, 0.0)
    colour: RGB = (0, 0, 0)
    box: Box = (0.0, 0.0, 1.0, 1.0)
    place: Annotated[tuple[int, int], Meaning("a place, [x, y]")] = (0, 0)
    flag: bool = False
    anything: Any = None
    ours: Annotated[int, NOT_IN_FILES] = 7


def write(folder: Path, text: str) -> Path:
    path = folder / "x.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_what_fits_is_read(tmp_path: Path) -> None:
    path = write(
        tmp_path,
        "inner: {seconds: 2}\nby-name: {left: 1}\nknots: {3: 4}\nway: down\n"
        "many: [{seconds: 1, count: 2}]\npair: [1, a]\n"
        "names: 2024\nname: 7\nthree: 5\ncolour: '#ff8000'\n"
        "box: [0, 0.5, 1, 1]\nplace: [1, 2]\nflag: true\nanything: {a: [1]}\n",
    )
    assert load(path, Outer) == Outer(
        inner=Inner(2.0), by_name={"left": 1.0}, knots={3: 4}, way="down", many=(Inner(1.0, 2),), pair=(1, "a"),
        names=("2024",), name="7", three=(5.0, 5.0, 5.0), colour=(255, 128, 0), box=(0, 0.5, 1, 1), place=(1, 2),
        flag=True, anything={"a": [1]},
    )  # fmt: skip
    assert isinstance(load(path, Outer).inner.seconds, float)


def test_a_base_gives_what_is_left_out(tmp_path: Path) -> None:
    base = Outer(Inner(3.0, 4), {"left": 0.5}, way="down", ours=8)
    changed = load(write(tmp_path, "inner: {count: 5}\nby-name: {right: 1}\nmany:\n"), Outer, base)
    assert changed == Outer(Inner(3.0, 5), {"left": 0.5, "right": 1.0}, way="down", ours=8)
    with pytest.raises(FileError, match=r":1: inner.seconds is missing; it must be a number above 0"):
        load(write(tmp_path, "inner: {count: 5}\n"), Outer)


def test_a_part_of_a_file_is_read_with_its_lines(tmp_path: Path) -> None:
    source = read(write(tmp_path, "a:\n  b:\n  - seconds: 1\n  - seconds: 11\n"))
    with pytest.raises(FileError, match=r":4: a.b\[1\].seconds must be a number above 0, at most 10 seconds, not 11"):
        convert(source, tuple[Inner, ...], ("a", "b"))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("inner:\n  seconds: 0", ":2: inner.seconds must be a number above 0, at most 10 seconds, not 0"),
        ("inner:\n  seconds: true", ":2: inner.seconds must be a number above 0, at most 10 seconds, not True"),
        ("inner: {seconds: 1,\n  count: 0}", ":2: inner.count must be a whole number of 1 or more, not 0"),
        ("inner: {seconds: 1,\n  count: 1.0}", ":2: inner.count must be a whole number of 1 or more, not 1.0"),
        ("inner: 3", ":1: inner must be a mapping of seconds, count, not 3"),
        ("iner: 3", ":1: unknown key 'iner' (did you mean inner?)"),
        ("ours: 3", ":1: unknown key 'ours'"),
        ("by-name:\n  left: 1\n  up: 1", ":3: unknown key 'up' in 'by-name'; choose left, right"),
        ("by-name:\n  left: 1.5", ":2: by-name.left must be a number from 0 to 1, not 1.5"),
        ("knots: {}", ":1: knots must be a mapping of 1 to 3 names to values, each a whole number, not {}"),
        ("knots:\n  10: 1", ":2: knots.10 must be a whole number from 0 to 9, not 10"),
        ("way: upp", ":1: way: there is no 'upp' (did you mean up?); choose up, down"),
        ("way: [up]", ":1: way: there is no ['up']; choose up, down"),
        ("many: [{seconds: 1},\n  {seconds: -1}]", ":2: many[1].seconds must be"),
        ("many: {seconds: 1}", ":1: many must be a list of values, each a mapping of seconds, count, not"),
        ("pair: [1]", ":1: pair must be a list [a whole number, text], not [1]"),
        ("names: {a: 1}", ":1: names[0] must be text, not {'a': 1}"),
        ("name: [a]", ":1: name must be text, not ['a']"),
        ("three: [1, 2]", ":1: three must be one number or three, not [1, 2]"),
        ("colour: red", """:1: colour must be a colour, written as "#rrggbb", not 'red'"""),
        ("colour: '#ff 801'", """:1: colour must be a colour, written as "#rrggbb", not"""),
        (
            "box: [0, 0, 0, 1]",
            ":1: box must be left, top, right, bottom: shares 0 to 1 in rising order, not [",
        ),
        ("place: 1", ":1: place must be a place, [x, y], not 1"),
        ("flag: 1", ":1: flag must be true or false, not 1"),
        ('way: "\\e[2Jx"', ":1: way: there is no '\\x1b[2Jx'"),
        ("way: " + "x" * 200, ":1: way: there is no '" + "x" * 39 + "...; choose up, down"),
    ],
)
def test_what_does_not_fit_is_one_line_with_its_place(text: str, said: str, tmp_path: Path) -> None:
    path = write(tmp_path, text + "\n" if text.startswith("inner") else "inner: {seconds: 1}\n" + text + "\n")
    if not text.startswith("inner"):
        line, rest = said[1:].split(":", 1)
        said = f":{int(line) + 1}:{rest}"
    with pytest.raises(FileError) as error:
        load(path, Outer)
    assert str(error.value).startswith(f"{path}{said}") and "\n" not in str(error.value)


VALUES = st.recursive(
    st.none() | st.booleans() | st.integers(-20, 20) | st.floats(-20, 20) | st.text("ab#\n", max_size=8),
    lambda inside: (
        st.lists(inside, max_size=4)
        | st.dictionaries(st.sampled_from(("seconds", "count", "left", "a")) | st.integers(-2, 12), inside, max_size=4)
    ),
    max_leaves=8,
)
KEYS = st.sampled_from(("inner", "by-name", "knots", "way", "many", "pair", "names", "three", "colour", "box", "place"))


@given(st.dictionaries(KEYS, VALUES, max_size=5))
def test_any_value_is_read_or_refused_in_one_line_at_a_key_of_the_file(
    tmp_path_factory: pytest.TempPathFactory, data: dict[str, Any]
) -> None:
    path = tmp_path_factory.getbasetemp() / "any.yaml"
    path.write_text(yaml.safe_dump({"inner": {"seconds": 1}, **data}), encoding="utf-8")
    try:
        read_back = load(path, Outer)
    except FileError as error:
        line = error.line
        assert line and line <= len(path.read_text().splitlines())
        assert "\n" not in str(error) and len(error.message) < 600
    else:
        assert 0 < read_back.inner.seconds <= 10 and all(0 <= share <= 1 for share in read_back.by_name.values())
        assert read_back.way in ("up", "down") and len(read_back.three) == 3
