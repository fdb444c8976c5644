"""Modules put together without Node."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from dancetutor_cli.page.document import HERE, bundle


def _modules(folder: Path, **texts: str) -> Path:
    for name, text in texts.items():
        (folder / f"{name}.js").write_text(text)
    return folder


def test_each_module_comes_once_and_before_who_needs_it(tmp_path: Path) -> None:
    folder = _modules(
        tmp_path,
        main='import { two as b } from "./two.js";\nimport {\n  one,\n} from "./one.js";\nwindow.x = one + b;\n',
        two='import { one } from "./one.js";\nexport const two = one + 1;\n',
        one="export const one = 1;\nexport async function f() {}\nconst hidden = 3;\n",
    )
    text = bundle(folder, "main")
    assert text.count("const $one =") == text.count("const $two =") == 1
    assert text.index("const $one =") < text.index("const $two =") < text.index("const $main =")
    assert "return { one, f };" in text and "const { two: b } = $two;" in text
    assert "import" not in text and "export" not in text


@pytest.mark.parametrize(
    ("texts", "message"),
    [
        ({"main": 'import x from "./a.js";\n'}, "cannot bundle"),
        ({"main": "export default 1;\n"}, "cannot bundle"),
        ({"main": 'import { a } from "./b.js";\n', "b": 'import { m } from "./main.js";\n'}, "circle"),
        ({"main": 'const x = "</script>";\n'}, "end the page's script"),
    ],
)
def test_what_cannot_be_bundled_is_said(tmp_path: Path, texts: dict[str, str], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        bundle(_modules(tmp_path, **texts), "main")


def test_every_module_of_the_page_is_in_it() -> None:
    text = bundle(HERE / "js", "main") + bundle(HERE / "js", "capture")
    for path in (HERE / "js").glob("*.js"):
        assert f"const ${path.stem.replace('-', '_')} =" in text, f"{path.name} is imported by nobody"


def test_the_table_of_modules_names_each_once() -> None:
    table = (HERE / "js/README.md").read_text(encoding="utf-8").partition("| --- |")[2]
    named = [
        name for line in table.splitlines() for name in re.findall(r"`(\w+)`", line.partition("|")[2].partition("|")[0])
    ]
    assert sorted(named) == sorted(path.stem for path in (HERE / "js").glob("*.js"))
