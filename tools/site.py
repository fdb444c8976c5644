"""The source of the site, for `make site`: README, CHANGELOG, CONTRIBUTING, docs/ and pages made by commands.

    python tools/site.py [FOLDER]     # default: build/site-source, which mkdocs.yml names

A page for whoever reads it on the web is the same file as in the repository; only links between folders are changed.
The pages of options and rules are made here of `--help` and `--explain`; the gallery is that of `make gallery`.
"""

from __future__ import annotations

import importlib
import re
import shutil
import sys
from pathlib import Path

import click

from dancetutor_cli.commands import COMMANDS
from dancetutor_cli.lint.rule import all_rules
from dancetutor_cli.reports.rule_pages import explain

ROOT = Path(__file__).resolve().parent.parent
TOP = {"README.md": "index.md", "CHANGELOG.md": "CHANGELOG.md", "CONTRIBUTING.md": "CONTRIBUTING.md"}
GALLERY = ROOT / "build" / "gallery"
_LINK = re.compile(r"(\]\()([^)#\s]+)")
CSS = """\
.md-typeset table:not([class]) { display: table; font-size: .68rem; }
.md-typeset img { border-radius: 4px; }
.md-typeset table:not([class]) th, .md-typeset table:not([class]) td { padding: .5em .9em; }
.md-typeset .language-sh pre > code { white-space: pre-wrap; }
.md-grid { max-width: 68rem; }
"""
WIDE = "---\nhide:\n  - navigation\n---\n\n"  # the first page has nothing beside it
COLUMNS = 90  # of help


def on_site(text: str, folder: str) -> str:
    """A page of the repository with its links as the site has them. folder : of the page, "" or "docs" """

    def place(found: re.Match[str]) -> str:
        target = found[2]
        if "://" in target:
            return found[0]
        inside = (Path(folder) / target).as_posix().removeprefix("docs/")
        return found[1] + TOP.get(inside, inside.removeprefix(".github/"))

    return _LINK.sub(place, text)


def options_page() -> str:
    """The help of every command, as `--help` prints it in a terminal of COLUMNS."""
    parts = ["# Options of all commands\n", "What `dancetutor COMMAND --help` prints.\n"]
    for name, (module, _) in COMMANDS.items():
        command = importlib.import_module(f"dancetutor_cli.commands.{module}").command
        context = click.Context(
            command, info_name=f"dancetutor {name}", max_content_width=COLUMNS, terminal_width=COLUMNS
        )
        parts.append(f"## `{name}`\n\n```text\n{command.get_help(context)}\n```\n")
    return "\n".join(parts)


def rules_page() -> str:
    """Every rule as `analyze --explain` prints it, in order of their codes."""
    parts = ["# Rules of the linter\n", "The text that `dancetutor analyze --explain RULE` prints, for every rule.\n"]
    for code, rule in sorted(all_rules().items()):
        head, _, text = explain(rule).partition("\n")
        kind = head[head.index("(") + 1 : -1]
        parts.append(f"## {code} {rule.name}\n\n*{kind}*\n\n{_as_markdown(text)}\n")
    return "\n".join(parts)


def _as_markdown(text: str) -> str:
    """Explanations as Markdown: lists after a blank line, each option in one, rows and tables as code."""
    out: list[str] = []
    block = ""
    for line in text.splitlines():
        kind = "item" if line.startswith("- ") else {"`": "option", " ": "code"}.get(line[:1], "")
        if not line:
            block = ""
        elif kind == "code" and block not in ("item", "option"):
            if block != "code":
                out.append("")
            block, line = "code", line if line.startswith("    ") else "  " + line
        elif kind in ("item", "option"):
            if block != kind:
                out.extend(("", "The options mean:", "") if kind == "option" else ("",))
            block, line = kind, _escaped(line if kind == "item" else "- " + line)
        else:
            line = ("  " if block in ("item", "option") else "") + _escaped(line.strip())
        out.append(line)
    return "\n".join(out)


def _escaped(line: str) -> str:
    """A line of text whose signs mean nothing in Markdown, except for code between backticks."""
    parts = line.split("`")
    parts[::2] = [re.sub(r"([*_<\[\]]|^#)", r"\\\1", part) for part in parts[::2]]
    return "`".join(parts)


def gallery_page(folder: Path) -> str:
    """The gallery's page, with its pictures and films below `folder`; without a gallery how to make one."""
    page = GALLERY / "gallery.md"
    if not page.exists():
        return "# Gallery\n\nThis site was built without a gallery: `make gallery`, then `make site`.\n"
    shutil.copytree(
        GALLERY,
        folder / "gallery",
        ignore=shutil.ignore_patterns("gallery.md", "index.html", ".*", "*.npz", "*.bvh", "*.sm"),
    )
    return page.read_text("utf-8")


def prepare(folder: Path) -> None:
    """Lay the site's source into a folder, which is emptied first."""
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(ROOT / "docs", folder, ignore=shutil.ignore_patterns("*.md"))
    for path in sorted((ROOT / "docs").glob("*.md")):
        (folder / path.name).write_text(on_site(path.read_text("utf-8"), "docs"), "utf-8")
    for name, target in TOP.items():
        head = WIDE if target == "index.md" else ""
        (folder / target).write_text(head + on_site((ROOT / name).read_text("utf-8"), ""), "utf-8")
    shutil.copy(ROOT / ".github" / "frame.png", folder)
    (folder / "options.md").write_text(options_page(), "utf-8")
    (folder / "rules.md").write_text(rules_page(), "utf-8")
    (folder / "gallery.md").write_text(gallery_page(folder), "utf-8")
    (folder / "site.css").write_text(CSS, "utf-8")


if __name__ == "__main__":
    prepare(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build" / "site-source")
