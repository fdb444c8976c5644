"""Files of strangers: pipes, devices, circles of links, huge content; YAML and JSON made to break a reader."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from dancetutor_cli.feet.preset import load_preset
from dancetutor_cli.film.layout import load_layout
from dancetutor_cli.lint.baseline import load_baseline
from dancetutor_cli.lint.configuration import load_configuration
from dancetutor_cli.run import reading
from dancetutor_cli.run.errors import DancetutorError, FileError, MissingFileError
from dancetutor_cli.run.yaml_files import parse_value, read

BOMB = "a: &a [x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{chr(98 + n)}: &{chr(98 + n)} [{','.join(['*' + chr(97 + n)] * 9)}]\n" for n in range(9)
)
YAML = {
    "alias bomb": (BOMB, "aliases"),
    "recursive alias": ("rules: &a {x: *a}\n", "aliases"),
    "merged": ("a: &a {x: 1}\nrules:\n  <<: *a\n", "aliases"),
    "brackets": ("[" * 100_000, "nested deeper"),
    "braces": ("{a: " * 100_000, "nested deeper"),
    "deep blocks": ("".join(" " * n + "a:\n" for n in range(1000)), "nested deeper"),
    "huge": ("# " + "x" * 2_000_000, "larger than 1 MB"),
    "base 60": ("stream-rows: " + "1:" * 200_000 + "1\n", "characters"),
    "many digits": ("stream-rows: " + "1" * 9000 + "\n", "too many digits"),
    "long key": ("? " + "x" * 20_000 + "\n: 1\n", "characters"),
    "twice": ("preset: itg\npreset: thesis\n", "twice"),
    "twice, otherwise written": ("a: {16: L, 16.0: R}\n", "twice"),
    "nan": ("stream-rows: .nan\n", "finite"),
    "infinite": ("stream-rows: -.inf\n", "finite"),
    "infinite by its exponent": ("stream-rows: 1.0e+999\n", "finite"),
    "tag": ("rules: !!python/object/apply:os.system [x]\n", "has a tag"),
    "list as key": ("? [a]\n: 1\n", "unhashable"),
    "no date": ("a: 2001-99-99\n", "month"),
    "no text": ("a: \x00\n", "YAML"),
    "a list": ("- a\n", "must be a mapping"),
}
JSON = {
    "brackets": ("[" * 100_000, "nested deeper"),
    "objects": ('{"a":' * 500 + "1" + "}" * 500, "nested deeper"),
    "twice": ('{"schema": 1, "schema": 1, "entries": []}', "twice"),
    "nan": ('{"schema": NaN}', "infinite or not a number"),
    "infinite": ('{"schema": 1e999}', "infinite or not a number"),
    "many digits": ('{"schema": ' + "1" * 9000 + "}", "too many digits"),
    "cut off": ('{"schema": 1, "entr', "is not JSON"),
    "latin": ('{"schema": "\xe9"}', "UTF-8"),
}


@pytest.mark.parametrize("name", YAML)
def test_yaml_of_a_stranger_is_one_line_and_soon(name: str, tmp_path: Path) -> None:
    text, said = YAML[name]
    path = tmp_path / "x.yaml"
    path.write_bytes(text.encode("latin-1"))
    for load in (read, load_configuration, load_preset, lambda p: load_layout(str(p))):
        begin = time.monotonic()
        with pytest.raises(DancetutorError, match=said) as caught:
            load(path)
        assert "\n" not in str(caught.value) and len(str(caught.value)) < 500
        assert time.monotonic() - begin < 2


@pytest.mark.parametrize("name", JSON)
def test_json_of_a_stranger_is_one_line(name: str, tmp_path: Path) -> None:
    text, said = JSON[name]
    path = tmp_path / "x.json"
    path.write_bytes(text.encode("latin-1"))
    with pytest.raises(FileError, match=said):
        reading.read_json(path)
    with pytest.raises(FileError, match=said):
        load_baseline(path)


def test_ordinary_documents_are_read(tmp_path: Path) -> None:
    path = tmp_path / "x"
    path.write_text("a: {b: [1, 2.5, {c: off}]}\n")
    assert read(path).data == {"a": {"b": [1, 2.5, {"c": False}]}}
    assert read(path).lines[("a", "b", 2, "c")] == 1
    path.write_bytes(b'\xef\xbb\xbf{"a": [1, 2.5, null, "x"]}')
    assert reading.read_json(path) == {"a": [1, 2.5, None, "x"]}
    assert parse_value("0.4", "--set") == 0.4
    with pytest.raises(FileError, match="--set"):
        parse_value("[" * 100_000, "--set")


def test_a_size_limit_and_what_is_not_there(tmp_path: Path) -> None:
    path = tmp_path / "x"
    path.write_bytes(b"x" * 1000)
    assert reading.read_bytes(path, 1000) == b"x" * 1000
    with pytest.raises(FileError, match="larger than"):
        reading.read_bytes(path, 999)
    with pytest.raises(MissingFileError):
        reading.read_bytes(tmp_path / "none", 999)
    with pytest.raises(FileError, match="folder"):
        reading.read_bytes(tmp_path, 999)
    with pytest.raises(FileError, match="cannot be read"):
        reading.read_bytes(tmp_path / "a\0b", 999)


@pytest.mark.skipif(os.name == "nt", reason="Windows has no such files")
def test_special_files_are_not_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for name, to, said in (
        ("self", "self", "cannot be read"), ("zero", "/dev/zero", "device"), ("gone", "nowhere", "not there"),
        ("grows", "/proc/self/pagemap", "larger than|cannot be read|not there"), ("pipe2", "pipe", "named pipe"),
    ):  # fmt: skip
        (tmp_path / name).symlink_to(to)
        with pytest.raises(FileError, match=said):
            reading.read_bytes(tmp_path / name, 10_000)
        assert not reading.is_regular(tmp_path / name) or name == "grows"
    with pytest.raises(FileError, match="named pipe"):
        reading.read_bytes(tmp_path / "pipe", 10_000)


SECRET = "root:*:20228:0:99999:7::\n"


@pytest.fixture
def pack(tmp_path: Path) -> Path:
    """A folder with a dancetutor.yaml to be written, beside a file that is none of its business."""
    (tmp_path / "secret").write_text("root: x\n" + SECRET)
    (tmp_path / "secret.yaml").write_text(f'"{SECRET.strip()}": 1\n')
    (tmp_path / "pack").mkdir()
    return tmp_path / "pack"


@pytest.mark.parametrize(
    "text",
    [
        "extends: ../secret",
        "extends: [../secret.yaml]",
        "extends: {path}/secret.yaml",
        "extends: link.yaml",
        "extends: sub/../../secret.yaml",
        "preset: ../secret.yaml",
        "preset: link.yaml",
        "baseline: ../secret",
        "baseline: {path}/secret",
    ],
)
def test_a_configuration_stays_in_its_folder_and_quotes_no_other_file(text: str, pack: Path) -> None:
    if os.name != "nt":
        (pack / "link.yaml").symlink_to(pack.parent / "secret.yaml")
    (pack / "dancetutor.yaml").write_text(text.replace("{path}", pack.parent.as_posix()) + "\n")
    with pytest.raises(DancetutorError) as caught:
        load_configuration(pack / "dancetutor.yaml", found=True)
    assert "root:" not in str(caught.value) and "dancetutor.yaml:1" in str(caught.value)


@pytest.mark.skipif(os.name == "nt", reason="links need a right there")
def test_a_configuration_that_is_a_link_to_elsewhere_is_not_read(pack: Path) -> None:
    (pack / "dancetutor.yaml").symlink_to(pack.parent / "secret.yaml")
    with pytest.raises(FileError, match="outside its folder") as caught:
        load_configuration(pack / "dancetutor.yaml", found=True)
    assert "root:" not in str(caught.value)


def test_what_is_beside_or_has_a_name_is_extended(pack: Path) -> None:
    (pack / "sub").mkdir()
    (pack / "sub" / "more.yaml").write_text("fail-on: never\n")
    (pack / "dancetutor.yaml").write_text("extends: [beginner, sub/more.yaml]\nbaseline: known.json\n")
    found = load_configuration(pack / "dancetutor.yaml", found=True)
    assert found.fail_on == "never" and found.baseline == pack / "known.json"
    (pack / "sub" / "more.yaml").write_text("extends: ../dancetutor.yaml\n")
    with pytest.raises(FileError, match="outside"):
        load_configuration(pack / "dancetutor.yaml", found=True)
    (pack / "sub" / "more.yaml").write_text("extends: more.yaml\n")
    with pytest.raises(FileError, match="extends itself"):
        load_configuration(pack / "dancetutor.yaml", found=True)


@pytest.mark.parametrize("value", [".nan", "-3", "-0.5", ".inf", "true", "'3'", "[3]"])
def test_numbers_of_rules_are_checked(value: str, pack: Path) -> None:
    (pack / "dancetutor.yaml").write_text(f"rules: {{DT205: {{max_rows: {value}}}}}\n")
    with pytest.raises(FileError):
        load_configuration(pack / "dancetutor.yaml", found=True)


def test_bytes_that_are_no_text_are_reported_with_reason_and_line(tmp_path: Path) -> None:
    (tmp_path / "x.yaml").write_bytes(b"a: 1\nb: \xff\xfe\n")
    with pytest.raises(FileError, match=r"x\.yaml:2: not YAML: invalid"):
        read(tmp_path / "x.yaml")
