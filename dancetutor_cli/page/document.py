"""One HTML file out of template, style, ES modules and data; nothing in it is loaded from elsewhere. And an index."""

from __future__ import annotations

import base64
import hashlib
import html
import json
import re
import struct
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import groupby
from pathlib import Path
from typing import Any
from urllib.parse import quote

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.film.scene.gl.available import SHADERS, web_source
from dancetutor_cli.run.html import page
from dancetutor_cli.run.languages import Language, load_language
from dancetutor_cli.run.reading import config_names

# Numbers for the page: arrays in one compressed block, in a form that compresses well and is quick to read back.

_DTYPES = {"u1": np.uint8, "i1": np.int8, "u2": np.uint16, "i2": np.int16, "u4": np.uint32, "i4": np.int32,
           "f4": np.float32, "f8": np.float64}  # fmt: skip


class Blob:
    """Collects arrays under names; `js/blob.js` reads them."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self._size = 0
        self.index: dict[str, list[Any]] = {}  # name -> [type, count, row length, rounds of differences, offset]

    def add(self, name: str, values: NDArray[Any], kind: str, differences: int = 0) -> None:
        """Add an array as little-endian numbers of a kind ("i2", "f4", ...).

        differences : 0, 1 or 2: how often each row (the last axis) of whole numbers is replaced by its differences;
        these are stored with the sign as the lowest bit, so that small ones have empty high bytes.
        Numbers of more than a byte are stored byte by byte: first all low ones, which vary, then those that repeat.
        """
        array = np.ascontiguousarray(values, dtype=np.dtype(_DTYPES[kind]).newbyteorder("<"))
        row = array.shape[-1] if array.ndim else 1
        for _ in range(differences):
            first = np.zeros((*array.shape[:-1], 1), dtype=array.dtype)
            array = np.diff(array, axis=-1, prepend=first)  # wraps round, and so does adding up
        if differences:
            signed = array.view(np.dtype(f"<i{array.dtype.itemsize}"))
            array = (signed << 1) ^ (signed >> (8 * array.dtype.itemsize - 1))
        planes = np.frombuffer(array.tobytes(), dtype=np.uint8).reshape(-1, array.dtype.itemsize).T
        data = np.ascontiguousarray(planes).tobytes()
        self.index[name] = [kind, int(array.size), int(row), differences, self._size]
        self._parts.append(data)
        self._size += len(data)

    def add_bytes(self, name: str, data: bytes) -> None:
        """Add bytes as they are, for example an image."""
        self.add(name, np.frombuffer(data, dtype=np.uint8), "u1")

    def sizes(self) -> dict[str, int]:
        """Compressed bytes of each array alone, for reports."""
        return {name: len(zlib.compress(data, 1)) for name, data in zip(self.index, self._parts, strict=True)}

    def whole(self) -> bytes:
        """All of it, not compressed yet."""
        return b"".join(self._parts)


# ES modules put together into one script, without Node: each becomes a function that gives what it exports.
#
# What modules here may do: `import { a, b as c } from "./x.js";` at the start of a line, and `export` before a
# function, class or const. No default exports, no circles.

_IMPORT = re.compile(r'^import\s*\{([^}]*)\}\s*from\s*"\./([\w-]+)\.js";\n?', re.MULTILINE)
_EXPORT = re.compile(r"^export\s+((?:async\s+)?(?:function\*?|class|const)\s+(\w+))", re.MULTILINE)
_LEFT = re.compile(r"^\s*(?:import\s+[^(\s]|export\s+\S)", re.MULTILINE)


def bundle(folder: Path, main: str) -> str:
    """The script of module `main` and all that it imports, each module once, before anyone who needs it.

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


# One HTML file out of the template, the style, the ES modules and the data; nothing in it is loaded from elsewhere.

HERE = Path(__file__).resolve().parent
_PLACE = re.compile(r"\{\{(\w+)\}\}")


def document(doc: Mapping[str, Any], blob: Blob, music: bytes | None = None, kind: str = "page") -> bytes:
    """The whole page.

    doc : see `content.pack_content` and `capture.capture_page`; music : the song's file, to be put into the page
    kind : "page" of a chart, or "capture": which module begins it, and its style
    """
    full = {**doc, "languages": languages(), "shaders": shaders()}
    head = json.dumps(full, separators=(",", ":"), ensure_ascii=False, allow_nan=False).encode("utf-8")
    data = base64.b64encode(zlib.compress(struct.pack("<I", len(head)) + head + blob.whole(), 9)).decode("ascii")
    script = bundle(HERE / "js", {"page": "main"}.get(kind, kind))
    style = (HERE / f"{kind}.css").read_text("utf-8")
    title = " - ".join(part for part in (doc["words"]["title"], doc["words"]["badge"], "dancetutor") if part)
    music_text = "" if music is None else base64.b64encode(music).decode("ascii")
    body = _fill("page.html", {"data": data, "music": music_text, "script": script})
    return whole(policy(script, style), title, style, body)


def whole(policy: str, title: str, style: str, body: str) -> bytes:
    """An HTML file with this Content-Security-Policy; body : markup, title : text."""
    icon = '<link rel="icon" href="data:,">\n'  # else browsers ask for one
    return page(policy, title, style, body, head=icon).encode("utf-8")


def listed(title: str, items: str, style: str) -> bytes:
    """A page without script: a heading and markup below it."""
    rules = f"default-src 'none'; style-src '{hash_of(style)}'; img-src data:; base-uri 'none'; form-action 'none'"
    return whole(rules, title, style, _fill("index.html", {"title": html.escape(title), "songs": items}))


def _fill(template: str, values: Mapping[str, str]) -> str:
    """A template of this package with each {{name}} replaced, once: what is filled in is not looked at again."""
    return _PLACE.sub(lambda found: values[found[1]], (HERE / template).read_text("utf-8"))


def policy(script: str, style: str) -> str:
    """Content-Security-Policy: this script and this style, pictures and sound made in the page, and no network."""
    return (
        f"default-src 'none'; script-src '{hash_of(script)}'; style-src '{hash_of(style)}'; "
        "img-src blob: data:; media-src blob:; base-uri 'none'; form-action 'none'"
    )


def hash_of(text: str) -> str:
    """How a policy names a script or a style that stands in the page."""
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode("utf-8")).digest()).decode("ascii")


@cache
def languages() -> dict[str, dict[str, str]]:
    """The page's labels, by language and name."""
    return {name: _labels(load_language(name)) for name in config_names("languages")}


def _labels(words: Language) -> dict[str, str]:
    panels = {f"panel-{name}": text for name, text in words.panels.items()}
    findings = {f"finding-{rule}": text for rule, text in words.findings.items()}
    return {"language": words.language, **words.page, **panels, **findings}


@cache
def shaders() -> dict[str, str]:
    """The dancer's shaders of the films as WebGL reads them, and the page's own for the stage."""
    films = {name: web_source((SHADERS / name).read_text("utf-8")) for name in ("skinned.vert", "dancer.frag")}
    own = {path.name: path.read_text("utf-8") for path in sorted((HERE / "shaders").iterdir())}
    return {**films, **own}


# The index of a folder of practice pages: plain links, grouped by song; no script.


@dataclass(frozen=True, slots=True)
class IndexEntry:
    """One page. file : its name in the folder; title, artist : of the song; label : of the chart"""

    file: str
    title: str
    artist: str
    label: str


def index_page(entries: Sequence[IndexEntry], title: str) -> bytes:
    """The page that leads to the others; songs in the order given, names never as markup."""
    style = (HERE / "index.css").read_text("utf-8")
    songs = []
    for (name, artist), group in groupby(entries, key=lambda one: (one.title, one.artist)):
        by = f" <small>{html.escape(artist)}</small>" if artist else ""
        links = "".join(f'<li><a href="{quote(one.file)}">{html.escape(one.label)}</a></li>' for one in group)
        songs.append(f"<h2>{html.escape(name)}{by}</h2>\n<ul>{links}</ul>")
    return listed(title, "\n".join(songs), style)
