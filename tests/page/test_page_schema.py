"""docs/page.schema.json describes the page's document, all of it and nothing else; the types are made of it."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from test_page_document import unpacked

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.dance.request import DanceRequest
from dancetutor_cli.page.work import Page, PageRequest, make_page

jsonschema = pytest.importorskip("jsonschema", reason="jsonschema is not installed; it is in the extra dev")

ROOT = Path(__file__).resolve().parents[2]
SCHEMA = json.loads((ROOT / "docs" / "page.schema.json").read_text("utf-8"))
JS = ROOT / "dancetutor_cli" / "page" / "js"


def test_a_page_is_as_the_schema_says(page: Page) -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    jsonschema.validate(unpacked(page.html), SCHEMA)


def test_one_with_bar_and_music_is_too(tmp_path: Path) -> None:
    song = tmp_path / "song.sm"
    song.write_text("#MUSIC:x.ogg;\n#BPMS:0=120;\n#NOTES:pump-single::Hard:9::\n10000\n00100\n00001\n00010\n;\n")
    (tmp_path / "x.ogg").write_bytes(b"OggS")
    doc = unpacked(make_page(PageRequest(DanceRequest(song, Selection(), bar=True, fps=30.0), music=True)).html)
    assert doc["music"] == {"type": "audio/ogg", "bytes": 4}
    jsonschema.validate(doc, SCHEMA)


@pytest.mark.parametrize("spoil", ["motions", "beats", "words"])
def test_what_is_left_out_or_added_is_seen(page: Page, spoil: str) -> None:
    doc = unpacked(page.html)
    del doc[spoil]
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(doc, SCHEMA)
    doc = unpacked(page.html)
    doc["body"]["more"] = 1
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(doc, SCHEMA)


def test_every_object_of_it_says_what_it_is() -> None:
    def objects(one: Any) -> list[dict[str, Any]]:
        inner = [x for part in (one.values() if isinstance(one, dict) else one) if isinstance(part, dict | list)
                 for x in objects(part)]  # fmt: skip
        return [*([one] if isinstance(one, dict) and one.get("type") == "object" else []), *inner]

    every = objects(SCHEMA)
    assert len(every) > 20
    assert [one for one in every if "properties" in one and not one.get("description")] == []


def test_the_types_are_made_of_it_and_none_is_any() -> None:
    tool = ROOT / "tools" / "page_types.py"
    done = subprocess.run([sys.executable, str(tool), "--check"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    for path in sorted(JS.glob("*.js")):
        found = re.findall(r"(?:@\w+\s*\{[^}]*|[<(|:\s])\bany\b(?:\[\]|[}>|)])", path.read_text("utf-8"))
        assert not found, f"{path.name}: {found}"
