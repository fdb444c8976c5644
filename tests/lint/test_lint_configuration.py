"""dancetutor.yaml: layers, conditions, and errors that name the line and what exists."""

from __future__ import annotations

from pathlib import Path

import pytest

from dancetutor_cli.chart.pack_files import find_settings_file
from dancetutor_cli.feet.conditions import Condition
from dancetutor_cli.feet.preset import preset_names
from dancetutor_cli.lint.configuration import (
    Configuration,
    load_configuration,
    with_assignments,
    with_selection,
)
from dancetutor_cli.lint.rule import FAMILIES, all_rules
from dancetutor_cli.lint.rule_settings import default_rules
from dancetutor_cli.run.errors import FileError, UsageError


def configured(text: str, folder: Path) -> Configuration:
    path = folder / "dancetutor.yaml"
    path.write_text(text, encoding="utf-8")
    return load_configuration(path)


def severity(configuration: Configuration, code: str, path: Path, *, difficulty: str = "Hard", meter: int = 9) -> str:
    rules = configuration.settings.for_chart(path, "dance-single", difficulty, meter)
    return str(rules[code]["severity"]) if code in rules else "off"


def test_every_rule_has_defaults_and_every_default_a_rule() -> None:
    assert sorted(default_rules()) == sorted(all_rules())


def test_a_rule_without_a_line_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    more = {**all_rules(), "DT299": all_rules()["DT202"]}
    monkeypatch.setattr("dancetutor_cli.lint.rule_settings.all_rules", lambda: more)
    with pytest.raises(FileError, match=r"default\.yaml: rule DT299 has no line under 'rules'"):
        default_rules.__wrapped__()


def test_codes_and_names_are_unique_and_well_formed() -> None:
    names = [rule.name for rule in all_rules().values()]
    assert len(set(names)) == len(names)
    assert all(code == f"DT{int(code[2:])}" and int(code[2]) in FAMILIES for code in all_rules())


def test_the_defaults_depend_on_the_difficulty(tmp_path: Path) -> None:
    plain = load_configuration(None)
    assert severity(plain, "DT204", tmp_path / "x.sm", difficulty="Easy", meter=4) == "warning"
    assert severity(plain, "DT204", tmp_path / "x.sm", difficulty="Easy", meter=9) == "off"
    assert severity(plain, "DT204", tmp_path / "x.sm", difficulty="Hard") == "off"


def test_a_file_changes_single_entries(tmp_path: Path) -> None:
    given = configured("rules:\n  doublestep: error\n  DT205: {max_rows: 3}\n", tmp_path)
    assert severity(given, "DT201", tmp_path / "x.sm") == "error"
    rules = given.settings.for_chart(tmp_path / "x.sm", "dance-single", "Hard", 9)
    assert rules["DT205"] == {"severity": "warning", "max_rows": 3, "max_seconds": 0.3}


@pytest.mark.parametrize(
    ("option", "words"),
    [
        ("DT508: {kinds: [mine, spikes]}", "there is no kind 'spikes'; choose mine, roll, hold"),
        ("DT401: {grid: []}", "divisors of 192"),
        ("DT401: {grid: [0]}", "divisors of 192"),
        ("DT401: {grid: [4, 7]}", "divisors of 192"),
        ("DT401: {grid: [a]}", "by default it is [4, 8"),
        ("DT504: {sizes: [418x]}", "'418x' is not a size; write it as 418x164"),
        ("DT505: {sizes: [10x0]}", "'10x0' is not a size"),
    ],
)
def test_values_that_no_rule_can_use_are_refused(option: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(FileError) as caught:
        configured(f"rules:\n  {option}\n", tmp_path)
    assert str(caught.value).startswith(f"{tmp_path / 'dancetutor.yaml'}:2") and words in str(caught.value)


def test_every_kind_of_note_can_be_forbidden() -> None:
    from dancetutor_cli.chart.reader import parse
    from dancetutor_cli.lint.note_facts import NoteFacts
    from dancetutor_cli.lint.rules.notes import KINDS

    rows = "1MK0\n2L40\n303F\n1110\n1001\n"
    song = parse(f"#TITLE:T;\n#BPMS:0=120;\n#NOTES:dance-single::Hard:9::\n{rows};\n".encode(), Path("x.sm"))
    notes = NoteFacts(song.charts[0])
    assert {kind: len(notes.of_kind(kind)) > 0 for kind in KINDS} == dict.fromkeys(KINDS, True)


def test_yaml_off_needs_no_quotes(tmp_path: Path) -> None:
    assert severity(configured("rules: {spin: off}", tmp_path), "DT202", tmp_path / "x.sm") == "off"


def test_a_rule_that_is_off_runs_when_it_is_named_singly(tmp_path: Path) -> None:
    plain, path = load_configuration(None), tmp_path / "x.sm"
    assert severity(plain, "DT204", path) == "off"
    for selectors in (["crossover"], ["spin,DT204"]):
        assert severity(with_selection(plain, selectors, []), "DT204", path) == "warning"
    assert severity(with_selection(plain, ["DT2"], []), "DT204", path) == "off"
    assert severity(with_selection(plain, ["spin"], []), "DT202", path) == "warning"
    strict = with_assignments(plain, ["DT204.severity=error"])
    assert severity(with_selection(strict, ["crossover"], []), "DT204", path) == "error"
    assert severity(configured("select: [crossover]", tmp_path), "DT204", path) == "warning"


def test_select_and_ignore_take_families_and_names(tmp_path: Path) -> None:
    given = configured("select: [DT2, DT301]\nignore: spin\n", tmp_path)
    rules = given.settings.for_chart(tmp_path / "x.sm", "dance-single", "Hard", 9)
    assert "DT201" in rules and "DT301" in rules
    assert "DT202" not in rules and "DT401" not in rules


def test_the_command_line_selects_over_the_file(tmp_path: Path) -> None:
    given = with_selection(configured("ignore: spin\n", tmp_path), ["spin,DT201"], [])
    assert sorted(given.settings.for_chart(tmp_path / "x.sm", "dance-single", "Hard", 9)) == ["DT201", "DT202"]


@pytest.mark.parametrize(
    ("when", "path", "difficulty", "meter", "holds"),
    [
        ("{path: tech}", "tech/x.sm", "Hard", 9, True),
        ("{path: tech}", "other/x.sm", "Hard", 9, False),
        ("{path: 'tech/*.ssc'}", "tech/x.sm", "Hard", 9, False),
        ("{path: 'tech/*.sm'}", "tech/x.sm", "Hard", 9, True),
        ("{difficulty: [easy, HARD]}", "x.sm", "Hard", 9, True),
        ("{difficulty: easy}", "x.sm", "Hard", 9, False),
        ("{meter: 9}", "x.sm", "Hard", 9, True),
        ("{meter: 1-8}", "x.sm", "Hard", 9, False),
        ("{meter: 9-}", "x.sm", "Hard", 14, True),
        ('{meter: "-8"}', "x.sm", "Hard", 14, False),
        ("{meter: 9-, difficulty: easy}", "x.sm", "Hard", 14, False),
        ("{steps-type: dance-double}", "x.sm", "Hard", 9, False),
    ],
)
def test_overrides(when: str, path: str, difficulty: str, meter: int, holds: bool, tmp_path: Path) -> None:
    given = configured(f"overrides:\n  - when: {when}\n    rules: {{DT201: error}}\n", tmp_path)
    found = severity(given, "DT201", tmp_path / path, difficulty=difficulty, meter=meter)
    assert found == ("error" if holds else "warning")


def test_extends_a_file_beside_it(tmp_path: Path) -> None:
    (tmp_path / "base.yaml").write_text("rules: {spin: error, doublestep: error}\n")
    given = configured("extends: base.yaml\nrules: {doublestep: info}\n", tmp_path)
    assert severity(given, "DT202", tmp_path / "x.sm") == "error"
    assert severity(given, "DT201", tmp_path / "x.sm") == "info"


def test_a_circle_is_refused(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="extends itself"):
        configured("extends: dancetutor.yaml\n", tmp_path)


def test_paths_in_the_file_are_relative_to_it(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text("extends: thesis\n")
    given = configured("baseline: known.json\npreset: mine.yaml\n", tmp_path)
    assert given.baseline == tmp_path / "known.json"
    assert given.preset == str(tmp_path / "mine.yaml")
    assert configured("preset: stamina\n", tmp_path).preset == "stamina"


def test_what_it_says_about_presets_is_in_order(tmp_path: Path) -> None:
    given = configured("preset: itg\noverrides:\n  - {when: {difficulty: [Oni, heavy]}, preset: ddr}\n", tmp_path)
    (always, first), (when, second) = given.presets
    assert (always, first, second) == (Condition(), "itg", "ddr")
    assert when.holds(tmp_path, "dance-single", "Hard", 9) and when.holds(tmp_path, "pump-single", "Challenge", 9)
    assert not when.holds(tmp_path, "dance-single", "Easy", 9)


def test_a_steps_type_may_be_a_pattern(tmp_path: Path) -> None:
    text = "overrides:\n  - when: {steps-type: ['PUMP-*', dance-double]}\n    rules: {DT201: error}\n"
    found = configured(text, tmp_path).settings
    kinds = ("pump-halfdouble", "dance-double", "dance-single", "lights-cabinet")
    severities = [found.for_chart(tmp_path / "x.sm", kind, "Hard", 9)["DT201"]["severity"] for kind in kinds]
    assert severities == ["error", "error", "warning", "warning"]


def test_a_link_out_of_the_folder_is_no_preset(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text("extends: itg\n")
    (tmp_path / "pack").mkdir()
    (tmp_path / "pack" / "mine.yaml").symlink_to(tmp_path / "mine.yaml")
    with pytest.raises(FileError, match="outside this file's folder"):
        configured("preset: mine.yaml\n", tmp_path / "pack")


def test_the_command_line_may_name_any_preset(tmp_path: Path) -> None:
    given = with_assignments(load_configuration("stamina"), [f"preset={tmp_path / 'mine.yaml'}"])
    assert given.presets == ((Condition(), str(tmp_path / "mine.yaml")),)


def test_it_is_found_up_the_tree(tmp_path: Path) -> None:
    (tmp_path / "dancetutor.yaml").write_text("{}")
    deep = tmp_path / "a" / "b"
    deep.mkdir(parents=True)
    assert find_settings_file(deep) == tmp_path / "dancetutor.yaml"


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("rules:\n  DT2O1: error\n", 2, ["DT2O1", "did you mean DT201?", "--explain all"]),
        ("rules:\n  DT201:\n    colour: red\n", 3, ["colour", "severity"]),
        ("rules:\n  DT205: {max_rows: many}\n", 2, ["max_rows", "8"]),
        ("rules:\n  DT201: fatal\n", 2, ["fatal", "error, warning, info, off"]),
        ("rule: {}\n", 1, ["rule", "rules"]),
        ("\nfail-on: never\nselect: DT9\n", 3, ["DT9", "--explain all"]),
        ("fail-on: sometimes\n", 1, ["error, warning, never"]),
        ("overrides:\n  - rules: {}\n", 2, ["when"]),
        ("overrides:\n  - when: {metre: 3}\n", 2, ["metre", "meter"]),
        ("overrides:\n  - when:\n      meter: hard\n", 3, ["hard", "1-7"]),
        (
            "overrides:\n  - when: {difficulty: [Easy, Herd]}\n",
            2,
            ["did you mean Hard", "Beginner, Easy, Medium"],
        ),
        ("overrides:\n  - when:\n      steps-type: danse-*\n", 3, ["danse-*", "dance-*", "pump-*"]),
        ("preset: gpt\n", 1, ["gpt", ", ".join(preset_names())]),
        ("overrides:\n  - when: {meter: 3}\n    preset: begginer\n", 3, ["did you mean beginner", "thesis"]),
        ("preset: ../mine.yaml\n", 1, ["'preset' names a file outside this file's folder"]),
        ("overrides:\n  - when: {meter: 3}\n    preset: /etc/mine.yaml\n", 3, ["outside this file's folder"]),
        ("feet:\n  - when: {difficulty: Herd}\n    steps: {16: L}\n", 2, ["Herd", "Beginner, Easy"]),
        ("rules: [\n", 2, ["expected"]),
        ("- a\n", 1, ["mapping"]),
    ],
)
def test_what_is_wrong_is_named_with_its_line(text: str, line: int, words: list[str], tmp_path: Path) -> None:
    with pytest.raises(FileError) as raised:
        configured(text, tmp_path)
    assert raised.value.line == line, str(raised.value)
    for word in words:
        assert word in raised.value.message


@pytest.mark.parametrize(
    ("assignment", "code", "expected"),
    [("DT201.severity=error", "DT201", "error"), ("spin.severity=off", "DT202", "off")],
)
def test_set_on_the_command_line(assignment: str, code: str, expected: str, tmp_path: Path) -> None:
    given = with_assignments(load_configuration(None), [assignment])
    assert severity(given, code, tmp_path / "x.sm") == expected


def test_set_takes_top_keys_too() -> None:
    given = with_assignments(load_configuration(None), ["fail-on=error", "preset=stamina"])
    assert (given.fail_on, given.preset) == ("error", "stamina")


@pytest.mark.parametrize(
    "assignment", ["nonsense", "DT999.severity=error", "DT201.colour=1", "what=1", "DT201.severity=x"]
)
def test_a_wrong_set_is_refused(assignment: str) -> None:
    with pytest.raises(UsageError, match="--set"):
        with_assignments(load_configuration(None), [assignment])


def test_an_unknown_named_configuration_lists_what_exists() -> None:
    with pytest.raises(UsageError, match="default"):
        load_configuration("nonsense")
