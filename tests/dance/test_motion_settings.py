"""The motion file: every number explained, wrong names and values refused with what exists."""

from __future__ import annotations

import re
from dataclasses import fields, replace
from pathlib import Path
from typing import Annotated, get_args, get_origin, get_type_hints

import pytest

from dancetutor_cli.dance import units
from dancetutor_cli.dance.gait import Gait, load_gait
from dancetutor_cli.dance.plan import LEAST_FLIGHT
from dancetutor_cli.dance.settings import MotionSettings, default_settings, load_settings
from dancetutor_cli.run.errors import FileError, UsageError
from dancetutor_cli.run.reading import config_names, config_path


def test_every_number_has_a_sentence() -> None:
    for line in config_path("motion.yaml").read_text(encoding="utf-8").splitlines():
        if line.startswith("  "):
            value, _, sentence = line.partition("#")
            assert ":" in value and len(sentence.strip()) > 10, line


def test_default_file_is_read() -> None:
    assert 0.2 < default_settings().step.longest <= 1.0


@pytest.mark.parametrize("path", sorted(config_path("gaits").glob("*.yaml")), ids=lambda path: path.stem)
def test_every_number_of_a_gait_has_a_sentence(path: Path) -> None:
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if line.startswith("  ")]
    assert len(lines) == 2 * len(fields(Gait))
    for line in lines:
        value, _, sentence = line.partition("#")
        assert ":" in value and len(sentence.strip()) > 8, line


def test_a_file_changes_only_what_it_names(tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text("jump: {apex_far: 0.07}\nlook:\n  height: 2.0\n", encoding="utf-8")
    base, mine = default_settings(), load_settings(path)
    assert mine.jump.apex_far == 0.07 != base.jump.apex_far and mine.look.height == 2.0
    assert replace(mine.jump, apex_far=base.jump.apex_far) == base.jump
    assert replace(mine, jump=base.jump, look=base.look) == base
    assert load_settings() == base


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("step:\n  speed: 1", ":2: unknown key 'speed' in 'step'; choose longest"),
        ("jump:\n  tuck: 0\n  far: wide", ":3: jump.far must be a number from 0 to 20 metres, not 'wide'"),
        ("jump: {far: -1}", ":1: jump.far must be a number from 0 to 20 metres, not -1"),
        ("jump: {far: .nan}", ":1: "),
        ("face: {fades: 0}", ":1: face.fades must be a number from 0.001 to 1000 seconds, not 0"),
        ("face: {ease: 0}", ":1: face.ease must be a number from 0.001 to 1000 seconds, not 0"),
        ("face: {smile_time: 0}", ":1: face.smile_time must be a number from 0.001 to 1000 seconds, not 0"),
        ("groove: {phrase_ease: 0}", ":1: groove.phrase_ease must be a number from 0.001 to 1000 seconds, not 0"),
        ("step: {fast: 0.2}\nlegs: {}", ":2: unknown key 'legs' (did you mean layers?)"),
        ("step: 3", ":1: step must be a mapping"),
        ("step: [1, 2", ":"),
    ],
)
def test_wrong_files_are_refused_with_the_line(text: str, said: str, tmp_path: Path) -> None:
    path = tmp_path / "motion.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(FileError) as error:
        load_settings(path)
    assert str(error.value).startswith(f"{path}{said}") and "\n" not in str(error.value)


def test_a_file_that_is_not_there_is_reported(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="no such file or folder"):
        load_settings(tmp_path / "none.yaml")


def test_a_new_gait_is_one_file(tmp_path: Path) -> None:
    assert config_names("gaits") == ["flat", "heels"]
    path = tmp_path / "strut.yaml"
    path.write_text(config_path("gaits/flat.yaml").read_text("utf-8").replace("arms: 0.11", "arms: 0.30"), "utf-8")
    slow, quick = load_gait(str(path))
    assert slow == replace(load_gait("flat")[0], arms=0.30) and quick == load_gait("flat")[1]
    path.write_text("slow: {period: 1.0}\nquick: {}\n", encoding="utf-8")
    load_gait.cache_clear()
    with pytest.raises(FileError, match=r"strut.yaml:1: slow.stride is missing"):
        load_gait(str(path))
    with pytest.raises(UsageError, match=r"no gait 'heel' \(did you mean heels\?\); choose flat, heels"):
        load_gait("heel")


def test_the_least_flight_is_no_more_than_a_frame() -> None:
    """So long a flight that nobody is told of is never seen: at 60 pictures per second it is one at most."""
    assert 0.0 < LEAST_FLIGHT <= 1 / 60


def test_every_number_of_the_motion_and_of_gaits_has_a_unit() -> None:
    """A field without one of `dance/units.py` would be read without bounds, and nobody would know what it means."""
    there = [kind for kind in vars(units).values() if get_origin(kind) is Annotated]
    for section, kind in get_type_hints(MotionSettings).items():
        for name, hint in get_type_hints(kind, include_extras=True).items():
            assert hint in there, f"{section}.{name}"
    for name, hint in get_type_hints(Gait, include_extras=True).items():
        assert hint in there, name


def test_angles_are_degrees() -> None:
    """Independent of the units that somebody wrote: what the code turns into radians is an angle."""
    fields = {name: {*get_type_hints(kind)} for name, kind in get_type_hints(MotionSettings).items()}
    degrees = {
        (section, name)
        for section, kind in get_type_hints(MotionSettings).items()
        for name, hint in get_type_hints(kind, include_extras=True).items()
        if get_args(hint)[1].unit.startswith("degrees")
    }
    count = 0
    for path in Path(units.__file__).parent.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        for section, name in re.findall(r"radians\((?:\w+\.)*?(\w+)\.(\w+)\)", text):
            if name in fields.get(section, ()):
                assert (section, name) in degrees, f"{path.name}: {section}.{name}"
                count += 1
    assert count > 20
