"""docs/analysis.schema.json describes what `analyze` writes: everything in it, and nothing that it does not name."""

from __future__ import annotations

import copy
import json
import re
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from dancetutor_cli.commands.analyze import command as analyze
from dancetutor_cli.run.reading import charts_path

jsonschema = pytest.importorskip("jsonschema", reason="jsonschema is not installed; it is in the extra dev")

ROOT = Path(__file__).resolve().parent.parent.parent
SCHEMA = json.loads((ROOT / "docs" / "analysis.schema.json").read_text(encoding="utf-8"))
DEMO = charts_path() / "two_left_feet" / "two_left_feet.ssc"


def closed(schema: Any) -> Any:
    """A schema that refuses keys it does not name: a reader must survive them, but none may come by accident."""
    if isinstance(schema, list):
        return [closed(one) for one in schema]
    if not isinstance(schema, dict):
        return schema
    out = {key: closed(value) for key, value in schema.items()}
    if isinstance(out.get("properties"), dict) and out.get("type") == "object":
        out.setdefault("additionalProperties", False)
    return out


def flaws(data: Any, schema: Any) -> list[str]:
    validator = jsonschema.Draft202012Validator(schema)
    return [f"{error.json_path}: {error.message[:200]}" for error in validator.iter_errors(data)]


def written(*arguments: str | Path) -> str:
    run = CliRunner().invoke(analyze, [*map(str, arguments), "--no-cache"])
    assert run.exit_code in (0, 1, 2), run.output
    return run.stdout


def charts_of(folder: Path, most: int, largest: int = 60_000) -> list[Path]:
    """Small chart files spread over a folder."""
    small = [path for path in sorted(folder.rglob("*.s[sm][cm]")) if path.stat().st_size < largest]
    return small[:: max(1, len(small) // most)][:most]


def test_the_schema_is_one() -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)


@pytest.mark.parametrize("options", [(), ("--suggest",), ("--alternatives", "2"), ("--preset", "thesis"), ("--sync",)])
def test_the_demo_song(options: tuple[str, ...]) -> None:
    data = json.loads(written(DEMO, "--format", "json", *options))
    assert flaws(data, closed(SCHEMA)) == []
    (file,) = data["files"]
    assert len(file["charts"]) == 6 and all(chart["rows"] for chart in file["charts"])
    assert ("sync" in file) == (options == ("--sync",))
    assert all(("alternatives" in chart) == (options[:1] == ("--alternatives",)) for chart in file["charts"])


def test_music_that_cannot_be_heard(tmp_path: Path) -> None:
    song = tmp_path / DEMO.name
    song.write_bytes(DEMO.read_bytes())
    data = json.loads(written(song, "--format", "json", "--sync"))
    assert flaws(data, closed(SCHEMA)) == []
    assert data["files"][0]["sync"]["bias_ms"] is None and "not there" in data["files"][0]["sync"]["reason"]


def test_real_charts(corpus: Path) -> None:
    paths = charts_of(corpus, 12)
    data = json.loads(written(*paths, "--format", "json"))
    assert len(data["files"]) == len(paths) == 12
    assert flaws(data, closed(SCHEMA)) == []


def test_hostile_files(hostile: Path) -> None:
    data = json.loads(written(hostile, "--format", "json"))
    assert any(file["error"] for file in data["files"])
    assert flaws(data, closed(SCHEMA)) == []


def test_lines() -> None:
    schema = {"$ref": "#/$defs/line", "$defs": SCHEMA["$defs"]}
    lines = [json.loads(line) for line in written(DEMO, "--format", "jsonl").splitlines()]
    assert lines and all(flaws(line, schema) == [] for line in lines)
    named = {key for part in SCHEMA["$defs"]["line"]["allOf"][1:] for key in part["properties"]}
    assert set(lines[0]) == named | set(SCHEMA["$defs"]["finding"]["properties"])


def test_other_things_are_refused() -> None:
    """The schema is no sieve without a bottom."""
    data = json.loads(written(DEMO, "--format", "json"))
    row = data["files"][0]["charts"][0]["rows"][0]
    for change in (
        {"margin": -1},
        {"line": 0},
        {"facing": "left"},
        {"steps": [{}]},
        {"feet": {"left": 1}},
        {"cost": {"a": 0.5}},
    ):
        wrong = copy.deepcopy(data)
        wrong["files"][0]["charts"][0]["rows"][0] = {**row, **change}
        assert flaws(wrong, SCHEMA), change
    assert flaws({**data, "schema": 2}, SCHEMA)
    data["files"][0]["charts"][0]["rows"][0]["news"] = 1
    assert flaws(data, closed(SCHEMA)) and not flaws(data, SCHEMA)


def test_the_page_on_formats_names_every_key() -> None:
    page = (ROOT / "docs" / "formats.md").read_text(encoding="utf-8")
    assert "(analysis.schema.json)" in page
    for part in ("file", "chart", "row", "finding", "doublestep", "alternative", "sync"):
        for key in SCHEMA["$defs"][part]["properties"]:
            assert re.search(rf'[`"]{key}[`"]', page), f"{part}: {key}"
