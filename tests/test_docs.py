"""The documents keep up with the program: every command and option is documented, every example parses."""

from __future__ import annotations

import importlib
import json
import re
import shlex
from pathlib import Path

import click
import pytest
import yaml
from click.testing import CliRunner

from dancetutor_cli.commands import COMMANDS, cli

ROOT = Path(__file__).resolve().parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
PAGES = {
    page.relative_to(ROOT).as_posix(): page.read_text(encoding="utf-8")
    for page in (ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md", *sorted(ROOT.glob("docs/*.md")))
}


def examples_of(text: str) -> list[str]:
    """Every call of the command in a block of shell input."""
    return [
        line.split("#")[0].removeprefix("$ ").strip()
        for block in re.findall(r"```(?:sh|console)\n(.*?)```", text, re.S)
        for line in block.splitlines()
        if line.removeprefix("$ ").startswith("dancetutor ")
    ]


EXAMPLES = examples_of(README)
ALL_EXAMPLES = sorted({example for text in PAGES.values() for example in examples_of(text)})


def command_named(name: str) -> click.Command:
    command = importlib.import_module(f"dancetutor_cli.commands.{COMMANDS[name][0]}").command
    assert isinstance(command, click.Command)
    return command


@pytest.mark.parametrize("name", sorted(COMMANDS))
def test_every_command_has_a_section_and_an_example(name: str) -> None:
    assert re.search(rf"^### .*`?{name}`?", README, re.M), f"the README has no section on {name}"
    assert any(shlex.split(example)[1] == name for example in EXAMPLES), f"the README has no example of {name}"


@pytest.mark.parametrize("name", sorted(COMMANDS))
def test_every_option_says_what_it_does(name: str) -> None:
    command = command_named(name)
    assert command.help
    silent = [p.name for p in command.params if isinstance(p, click.Option) and not p.help and not p.hidden]
    assert silent == []


@pytest.mark.parametrize("example", ALL_EXAMPLES)
def test_the_examples_use_options_that_exist(example: str) -> None:
    _, name, *arguments = shlex.split(example)
    command = command_named(name)
    known = {flag for p in command.params if isinstance(p, click.Option) for flag in (*p.opts, *p.secondary_opts)}
    used = {a.split("=")[0] for a in arguments if a.startswith("-") and a != "-"}
    assert used <= known | {"--help", "-h"}


@pytest.mark.parametrize("name", sorted(PAGES))
def test_snippets_are_what_they_say(name: str) -> None:
    """Blocks of YAML, JSON and Python are that."""
    for kind, block in re.findall(r"```(yaml|json|python)\n(.*?)```", PAGES[name], re.S):
        if kind == "yaml":
            assert yaml.safe_load(block) is not None, f"{name}: {block}"
        elif kind == "json":
            json.loads(block)
        else:
            compile(block, name, "exec")


def test_there_are_snippets_to_check() -> None:
    assert len([kind for text in PAGES.values() for kind in re.findall(r"```(yaml|json|python)\n", text)]) >= 5


@pytest.mark.parametrize("name", ["README.md", "docs/guide.md"])
def test_the_shown_output_of_analyze_is_what_it_prints(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    (block,) = (
        found
        for found in re.findall(r"```console\n\$ dancetutor (analyze charts/.*?)```", PAGES[name], re.S)
        if "--steps-type" in found
    )
    call, *shown = block.splitlines()
    monkeypatch.chdir(ROOT)
    printed = CliRunner().invoke(cli, [*shlex.split(call), "--no-cache"]).stdout
    lines = [line.rstrip() for line in printed.splitlines()]
    assert len(shown) > 10
    assert [line for line in shown if line not in ("", "...") and line not in lines] == []


def test_short_help_in_the_list_matches_the_command() -> None:
    for name, (_, text) in COMMANDS.items():
        assert command_named(name).get_short_help_str(200).split()[0] == text.split()[0], name


def test_the_readme_is_for_a_user_in_a_hurry() -> None:
    assert len(README.splitlines()) <= 150
    assert "make demo" in README and "make test" in README


@pytest.mark.parametrize("name", sorted(PAGES))
def test_links_between_pages_lead_somewhere(name: str) -> None:
    for target in re.findall(r"\]\(([^)\s]+)\)", PAGES[name]):
        if "://" not in target and not target.startswith("#"):
            there = (ROOT / name).parent / target.split("#")[0]
            assert there.exists(), f"{name} links to {target}, which is not there"


CITED = re.compile(r"\bdocs/([\w-]+\.(?:md|json|svg))")
CITING = [
    path
    for part in ("dancetutor_cli", "configs", "tests", "tools", "research")
    for path in sorted((ROOT / part).rglob("*.[py][ya]*"))
]


def test_pages_that_code_and_settings_cite_are_there() -> None:
    found = {
        (path, page) for path in CITING for page in CITED.findall(path.read_text(encoding="utf-8", errors="replace"))
    }
    assert len(found) > 10
    assert [(path.name, page) for path, page in sorted(found) if not (ROOT / "docs" / page).exists()] == []


def test_every_picture_of_the_docs_is_there_small_and_shown() -> None:
    docs = ROOT / "docs"
    shown = {path.name: re.findall(r"!\[[^\]]+\]\(([\w.-]+)\)", path.read_text("utf-8")) for path in docs.glob("*.md")}
    named = {name for names in shown.values() for name in names}
    pictures = {path.name for path in docs.iterdir() if path.suffix in (".svg", ".png", ".jpg")}
    assert named == pictures
    assert all((docs / name).stat().st_size < 100_000 for name in pictures)
    features = ("meter.md", "guide.md", "theme.md", "pack.md", "films.md", "peers.md", "page.md")
    assert all(shown[name] for name in features)


PACKAGE = ROOT / "dancetutor_cli"
MODULES = {
    ".".join(path.relative_to(PACKAGE).with_suffix("").parts).removesuffix(".__init__")
    for path in PACKAGE.rglob("*.py")
}
CODE_PAGES = sorted(name for name in PAGES if name != "CHANGELOG.md")


def exists(name: str) -> bool:
    """Whether a dotted name, with the room it is in or from its module on, is a module or what one defines."""
    parts = name.split(".")
    for k in range(len(parts), 0, -1):
        head = ".".join(parts[:k])
        for module in sorted(m for m in MODULES if m == head or m.endswith(f".{head}")):
            target: object = importlib.import_module(f"dancetutor_cli.{module}")
            for part in parts[k:]:
                target = getattr(target, part, None)
            if target is not None:
                return True
    return False


@pytest.mark.parametrize("name", CODE_PAGES)
def test_modules_and_functions_that_the_pages_name_exist(name: str) -> None:
    words = re.findall(r"`([^`\n]+)`", re.sub(r"```.*?```", "", PAGES[name], flags=re.S))
    paths = [word for word in words if re.fullmatch(r"[\w/]+\.py", word)]
    files = [
        path for folder in ("dancetutor_cli", "tests", "tools", "research") for path in (ROOT / folder).rglob("*.py")
    ]
    there = {
        path.relative_to(base).as_posix() for base in (ROOT, PACKAGE) for path in files if path.is_relative_to(base)
    }
    there |= {path.rpartition("/")[2] for path in there}
    assert [path for path in paths if path not in there] == []
    rooms = {module.partition(".")[0] for module in MODULES} | {module.rpartition(".")[2] for module in MODULES}
    dotted = [word.removesuffix("()") for word in words if re.fullmatch(r"[a-z_]\w*(\.\w+)+(\(\))?", word)]
    code = [
        word
        for word in dotted
        if (word.count(".") > 1 or word.partition(".")[0] in rooms)
        and word.rpartition(".")[2] not in ("py", "yaml", "json", "md")
    ]
    keys = (ROOT / "configs" / "motion.yaml").read_text(encoding="utf-8")  # `body.height_smooth` is a setting
    settings = [word for word in code if re.search(rf"^ +{word.rpartition('.')[2]}:", keys, re.M)]
    assert [word for word in code if word not in settings and not exists(word)] == []
