"""Where `analyze` writes and what it leaves out: --output-file, --exclude, --color, --show-settings, own results."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
import yaml
from click.testing import CliRunner, Result

from dancetutor_cli.chart.selection import find_files, is_excluded
from dancetutor_cli.commands import cli
from dancetutor_cli.run.errors import FileError

HEAD = "#TITLE:T;\n#ARTIST:A;\n#CREDIT:C;\n#BPMS:0=120;\n"
HANDS = f"{HEAD}#NOTES:dance-single:C:Easy:3::\n1110\n0000\n0001\n0000\n,\n0111\n0000\n1000\n0000\n;\n"
HARD = HANDS.replace(":Easy:3:", ":Hard:12:")


def run(*words: object) -> Result:
    return CliRunner().invoke(cli, list(map(str, words)), standalone_mode=False)


@pytest.fixture
def pack(tmp_path: Path) -> Path:
    for name in ("a/a.sm", "b/b.sm", "Old/c.sm"):
        (tmp_path / "pack" / name).parent.mkdir(parents=True)
        (tmp_path / "pack" / name).write_text(HANDS, encoding="utf-8")
    return tmp_path / "pack"


@pytest.mark.parametrize("name", ["text", "json", "jsonl", "csv", "sarif", "github", "gitlab", "junit"])
def test_a_file_has_what_standard_output_would(pack: Path, tmp_path: Path, name: str) -> None:
    there = run("analyze", pack, "--format", name)
    file = run("analyze", pack, "--format", name, "--output-file", tmp_path / "out")
    assert file.stdout == "" and file.return_value == there.return_value == 1
    assert (tmp_path / "out").read_bytes() == there.stdout_bytes


def test_a_chart_is_no_output_file(pack: Path) -> None:
    result = run("analyze", pack, "-o", pack / "a" / "a.sm")
    assert isinstance(result.exception, FileError)
    assert (pack / "a" / "a.sm").read_text("utf-8") == HANDS


@pytest.mark.parametrize("pattern", ["Old", "old/", "OLD/*", "c.sm", "O?d/c.*", "[o]ld"])
def test_what_is_excluded_is_not_searched(pack: Path, pattern: str) -> None:
    found = {file.relative_to(pack).as_posix() for file in find_files([pack], [pattern])}
    assert found == {"a/a.sm", "b/b.sm"}
    assert run("analyze", pack, "--exclude", pattern).stdout.splitlines()[-1].startswith("2 files, ")
    assert find_files([pack / "Old" / "c.sm"], [pattern]) == [pack / "Old" / "c.sm"]  # who names it means it


def test_a_pattern_is_no_part_of_a_name() -> None:
    assert not is_excluded("Older/c.sm", ["Old", "c", "*.ssc"]) and not is_excluded("Older/c.sm", [])


def test_exclude_means_the_same_everywhere(pack: Path, tmp_path: Path) -> None:
    before = (pack / "Old" / "c.sm").read_bytes()
    assert run("annotate", pack, "--exclude", "Old").exception is None
    assert (pack / "Old" / "c.sm").read_bytes() == before != (pack / "a" / "a.sm").read_bytes()
    said = run("analyze", pack, "--compare", pack / "a", "--exclude", "Old").stdout
    assert "b/b.sm: is new" in said and "Old" not in said


def test_quiet_means_the_same_everywhere(pack: Path) -> None:
    done = run("annotate", pack, "-q")
    assert (done.stdout, done.stderr, done.return_value) == ("", "", 0)
    (pack / "a" / "a.sm").write_text(HANDS, encoding="utf-8")
    assert "a.sm" in run("annotate", pack, "-q", "--check").stdout  # that fails the run


def test_colours(pack: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.delenv("NO_COLOR", raising=False)
    assert "\x1b[" in run("analyze", pack, "--color", "always").stdout
    assert "\x1b[" not in run("analyze", pack).stdout
    monkeypatch.setenv("FORCE_COLOR", "1")
    assert "\x1b[" in run("analyze", pack).stdout
    assert "\x1b[" not in run("analyze", pack, "--color", "never").stdout
    assert os.environ["FORCE_COLOR"] == "1" and "NO_COLOR" not in os.environ  # as before the run


def test_a_page_is_the_only_result(pack: Path, tmp_path: Path) -> None:
    result = run("analyze", pack, "--report-html", tmp_path / "p.html")
    assert result.stdout == ""
    (line,) = result.stderr.splitlines()
    assert line.startswith(f"{tmp_path / 'p.html'}: 3 songs; 3 files, 3 charts: ")
    page = (tmp_path / "p.html").read_text("utf-8")
    places = [page.index(f"<h2>{title}") for title in ("What needs action", "What is missing", "What stands out")]
    assert places == sorted(places) and places[-1] < page.index("<svg") < page.index("<h2>All charts")
    assert "dance-single Easy 3: DT302 hand, measure 0: three panels at once" in page


def test_only_what_is_new_against_a_baseline_is_reported(pack: Path, tmp_path: Path) -> None:
    known = tmp_path / "known.json"
    run("analyze", pack, "--baseline", known, "--update-baseline")
    assert run("analyze", pack, "--baseline", known).stdout == "3 files, 3 charts: no findings\n"
    (pack / "b" / "b.sm").write_text(
        HANDS.replace("0000\n0001", "1100\n0001") + HARD.replace(":Hard:12:", ":Medium:5:").removeprefix(HEAD),
        encoding="utf-8",
    )
    for words in ((), ("--full",)):
        said = run("analyze", pack, "--baseline", known, *words).stdout
        assert "b.sm" in said and "a.sm" not in said and "c.sm" not in said
    *lines, summary = run("analyze", pack, "--baseline", known).stdout.splitlines()
    assert summary == "3 files, 4 charts: 1 warning, 2 infos" and len(lines) == 3


def test_settings_are_a_configuration_that_says_the_same(pack: Path, tmp_path: Path) -> None:
    (pack / "a" / "a.sm").write_text(HANDS + HARD.removeprefix(HEAD), encoding="utf-8")
    (pack / "dancetutor.yaml").write_text(
        "extends: contest\nfail-on: error\nignore: [DT5]\nrules: {spin: error, DT213: off}\n"
        "overrides:\n- when: {difficulty: Hard}\n  rules: {hand: info}\n"
    )
    words = ("--set", "DT302.least_meter=20")
    shown = run("analyze", pack / "a" / "a.sm", "--show-settings", *words).stdout
    data = yaml.safe_load(shown)
    assert data["fail-on"] == "error" and data["rules"]["DT202"]["severity"] == "error"
    assert data["rules"]["DT502"] == {"severity": "off"}
    (tmp_path / "same.yaml").write_text(shown, encoding="utf-8")
    (tmp_path / "same").mkdir()
    results = [
        run("analyze", pack / "a" / "a.sm", "--format", "json", *more)
        for more in (words, ("--config", tmp_path / "same.yaml"))
    ]
    assert json.loads(results[0].stdout) == json.loads(results[1].stdout)
    assert results[0].return_value == results[1].return_value
