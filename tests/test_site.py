"""The site: every document is in its navigation once, links reach their headings, and it needs no other server."""

from __future__ import annotations

import importlib.util
import re
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
import yaml

ROOT = Path(__file__).resolve().parent.parent
MADE = {"options.md", "rules.md", "gallery.md"}  # by tools/site.py


def tool(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, ROOT / "tools" / f"{name}.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site") / "source"
    tool("site").prepare(folder)
    return folder


def settings() -> dict[str, Any]:
    data: dict[str, Any] = yaml.safe_load((ROOT / "mkdocs.yml").read_text("utf-8"))
    return data


def pages(entry: Any) -> list[str]:
    """All files of a navigation."""
    if isinstance(entry, str):
        return [entry]
    parts = entry.values() if isinstance(entry, dict) else entry
    return [page for part in parts for page in pages(part)]


def anchors(text: str) -> set[str]:
    """Names of the headings, as Markdown's table of contents makes them."""
    bare = re.sub(r"```.*?```", "", text, flags=re.S)
    heads = (re.sub(r"[^\w\s-]", "", re.sub(r"[`*]", "", one)) for one in re.findall(r"^#+ (.*)$", bare, re.M))
    return {re.sub(r"[-\s]+", "-", head.strip().lower()) for head in heads}


def test_every_document_is_in_the_navigation_once(source: Path) -> None:
    named = pages(settings()["nav"])
    assert sorted(named) == sorted(path.name for path in source.glob("*.md"))
    assert {path.name for path in (ROOT / "docs").glob("*.md")} < set(named)
    assert set(named) >= MADE


def test_the_navigation_has_the_four_kinds_of_documents() -> None:
    titles = [next(iter(part)) for part in settings()["nav"]]
    assert titles == ["Home", "Tutorial", "How-to", "Reference", "Explanation", "Contribute"]


def test_links_of_the_site_reach_files_and_headings(source: Path) -> None:
    texts = {path.name: path.read_text("utf-8") for path in source.glob("*.md")}
    assert len(texts) > 25
    for name, text in texts.items():
        for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"```.*?```", "", text, flags=re.S)):
            if "://" not in target:
                file, _, anchor = target.partition("#")
                assert (source / (file or name)).exists(), f"{name}: {target}"
                assert not anchor or anchor in anchors(texts[file or name]), f"{name}: {target}"


def test_the_options_are_those_of_the_help(source: Path) -> None:
    text = (source / "options.md").read_text("utf-8")
    assert "## `render`" in text and "--language" in text and "Charts:" in text


def test_the_site_loads_nothing_from_elsewhere() -> None:
    site = settings()
    assert site["theme"]["font"] is False and site["plugins"] == ["search"]
    assert "Content-Security-Policy" in (ROOT / site["theme"]["custom_dir"] / "main.html").read_text("utf-8")
    assert not any("://" in str(one) for one in (*site.get("extra_css", ()), *site.get("extra_javascript", ())))
