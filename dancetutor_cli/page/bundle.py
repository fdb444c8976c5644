"""ES modules put together into one script, without Node: each becomes a function that gives what it exports.

What modules here may do: `import { a, b as c } from "./x.js";` at the start of a line, and `export` before a function,
class or const. No default exports, no circles.
"""

from __future__ import annotations

import re
from pathlib import Path

_IMPORT = re.compile(r'^import\s*\{([^}]*)\}\s*from\s*"\./([\w-]+)\.js";\n?', re.MULTILINE)
_EXPORT = re.compile(r"^export\s+((?:async\s+)?(?:function\*?|class|const)\s+(\w+))", re.MULTILINE)
_LEFT = re.compile(r"^\s*(?:import\s+[^(\s]|export\s+\S)", re.MULTILINE)


def bundle(folder: Path, main: str) -> str:
    """The script of module `main` and all that it imports, each module once, before whoever needs it.

    Raises ValueError for a form of import or export that is none of those above, and for a circle.
    """
    done: list[str] = []
    out: list[str] = []
    _add(folder, main, [], done, out)
    text = '"use strict";\n' + "\n".join(out)
    if "</script" in text.lower() or "<!--" in text:
        raise ValueError("a module holds what would end the page's script element")
    return text


def _add(folder: Path, name: str, above: list[str], done: list[str], out: list[str]) -> None:
    if name in done:
        return
    if name in above:
        raise ValueError(f"modules import each other in a circle: {' -> '.join([*above, name])}")
    text = (folder / f"{name}.js").read_text("utf-8")
    lines = []
    for names, other in _IMPORT.findall(text):
        _add(folder, other, [*above, name], done, out)
        taken = ", ".join(re.sub(r"\s+as\s+", ": ", part.strip()) for part in names.split(",") if part.strip())
        lines.append(f"const {{ {taken} }} = {_variable(other)};")
    text = _IMPORT.sub("", text)
    exported = [found[1] for found in _EXPORT.findall(text)]
    text = _EXPORT.sub(r"\1", text)
    if left := _LEFT.search(text):
        raise ValueError(f"{name}.js: cannot bundle {left[0].strip()!r}")
    body = "\n".join([*lines, text.strip(), f"return {{ {', '.join(exported)} }};"])
    out.append(f"const {_variable(name)} = (() => {{\n{body}\n}})();")
    done.append(name)


def _variable(name: str) -> str:
    return "$" + name.replace("-", "_")
