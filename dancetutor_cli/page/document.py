"""One HTML file of template, style, ES modules and data, which loads nothing from elsewhere; and an index of pages."""

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
from dancetutor_cli.run import markup
from dancetutor_cli.run.languages import Language, load_language
from dancetutor_cli.run.reading import config_names

# The numbers of a page: arrays in one compressed block, in a form that compresses well and is fast to read.

_DTYPES = {"u1": np.uint8, "i1": np.int8, "u2": np.uint16, "i2": np.int16, "u4": np.uint32, "i4": np.int32,
           "f4": np.float32, "f8": np.float64}  # fmt: skip


class Blob:
    """A block of named arrays, which `js/blob.js` reads."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self._size = 0
        self.index: dict[str, list[Any]] = {}  # name -> [type, count, row length, rounds of differences, offset]

    def add(self, name: str, values: NDArray[Any], kind: str, differences: int = 0) -> None:
        """Add an array as little-endian numbers of a kind ("i2", "f4", ...).

        Numbers of more than a byte are stored byte by byte: first all low bytes, which vary, then the bytes that
        repeat.

        differences : 0, 1 or 2, the number of times that each row (the last axis) of whole numbers is replaced by its
            differences. Differences have the sign as their lowest bit, so that small numbers have empty high bytes
        """
        array = np.ascontiguousarray(values, dtype=np.dtype(_DTYPES[kind]).newbyteorder("<"))
        row = array.shape[-1] if array.ndim else 1
        for _ in range(differences):
            first = np.zeros((*array.shape[:-1], 1), dtype=array.dtype)
            array = np.diff(array, axis=-1, prepend=first)  # an overflow wraps round, and so does the sum
        if differences:
            signed = array.view(np.dtype(f"<i{array.dtype.itemsize}"))
            array = (signed << 1) ^ (signed >> (8 * array.dtype.itemsize - 1))
        planes = np.frombuffer(array.tobytes(), dtype=np.uint8).reshape(-1, array.dtype.itemsize).T
        data = np.ascontiguousarray(planes).tobytes()
        self.index[name] = [kind, int(array.size), int(row), differences, self._size]
        self._parts.append(data)
        self._size += len(data)

    def add_bytes(self, name: str, data: bytes) -> None:
        """Add bytes without a change, for example an image."""
        self.add(name, np.frombuffer(data, dtype=np.uint8), "u1")

    def sizes(self) -> dict[str, int]:
        """Return the number of compressed bytes of each array alone, for reports."""
        return {name: len(zlib.compress(data, 1)) for name, data in zip(self.index, self._parts, strict=True)}

    def to_bytes(self) -> bytes:
        """Return the whole block, uncompressed."""
        return b"".join(self._parts)


# A bundle of ES modules in one script, without Node: each module becomes a function that returns its exports.
#
# Modules of this package may use `import { a, b as c } from "./x.js";` at the start of a line, and `export` before a
# function, class or const. Default exports and circles are not allowed.

_IMPORT = re.compile(r'^import\s*\{([^}]*)\}\s*from\s*"\./([\w-]+)\.js";\n?', re.MULTILINE)
_EXPORT = re.compile(r"^export\s+((?:async\s+)?(?:function\*?|class|const)\s+(\w+))", re.MULTILINE)
_LEFT = re.compile(r"^\s*(?:import\s+[^(\s]|export\s+\S)", re.MULTILINE)


def bundle(folder: Path, main: str) -> str:
    """Return the script of module `main` and all modules that it imports, each once and before its users.

    Raises ValueError for another form of import or export than the forms above, and for a circle.
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


# The HTML file of the template, the style, the ES modules and the data.

HERE = Path(__file__).resolve().parent
_PLACE = re.compile(r"\{\{(\w+)\}\}")


def document(doc: Mapping[str, Any], blob: Blob, music: bytes | None = None, kind: str = "page") -> bytes:
    """Return the whole page.

    doc : see `content.pack_content` and `capture.capture_page`; music : the song's file for the page
    kind : "page" for a chart, or "capture", which selects the main module and the style
    """
    full = {**doc, "languages": languages(), "shaders": shaders()}
    head = json.dumps(full, separators=(",", ":"), ensure_ascii=False, allow_nan=False).encode("utf-8")
    data = base64.b64encode(zlib.compress(struct.pack("<I", len(head)) + head + blob.to_bytes(), 9)).decode("ascii")
    script = bundle(HERE / "js", {"page": "main"}.get(kind, kind))
    style = (HERE / f"{kind}.css").read_text("utf-8")
    title = " - ".join(part for part in (doc["words"]["title"], doc["words"]["badge"], "dancetutor") if part)
    music_text = "" if music is None else base64.b64encode(music).decode("ascii")
    body = _fill("page.html", {"data": data, "music": music_text, "script": script})
    return html_file(content_policy(script, style), title, style, body)


def html_file(policy: str, title: str, style: str, body: str) -> bytes:
    """Return an HTML file with this Content-Security-Policy; body : markup; title : text."""
    icon = '<link rel="icon" href="data:,">\n'  # prevents a request of the browser for an icon
    return markup.page(policy, title, style, body, head=icon).encode("utf-8")


def list_page(title: str, items: str, style: str) -> bytes:
    """Return a page without script: a heading and markup below it."""
    rules = f"default-src 'none'; style-src '{hash_of(style)}'; img-src data:; base-uri 'none'; form-action 'none'"
    return html_file(rules, title, style, _fill("index.html", {"title": html.escape(title), "songs": items}))


def _fill(template: str, values: Mapping[str, str]) -> str:
    """Return a template of this package with each {{name}} replaced once; a value is not searched for names again."""
    return _PLACE.sub(lambda found: values[found[1]], (HERE / template).read_text("utf-8"))


def content_policy(script: str, style: str) -> str:
    """Return a Content-Security-Policy: only this script and style, pictures and sound of the page, and no network."""
    return (
        f"default-src 'none'; script-src '{hash_of(script)}'; style-src '{hash_of(style)}'; "
        "img-src blob: data:; media-src blob:; base-uri 'none'; form-action 'none'"
    )


def hash_of(text: str) -> str:
    """Return the hash by which a policy names a script or a style in the page."""
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode("utf-8")).digest()).decode("ascii")


@cache
def languages() -> dict[str, dict[str, str]]:
    """Return the page's labels, by language and name."""
    return {name: _labels(load_language(name)) for name in config_names("languages")}


def _labels(words: Language) -> dict[str, str]:
    panels = {f"panel-{name}": text for name, text in words.panels.items()}
    findings = {f"finding-{rule}": text for rule, text in words.findings.items()}
    return {"language": words.language, **words.page, **panels, **findings}


@cache
def shaders() -> dict[str, str]:
    """Return the films' shaders for the dancer in the form for WebGL, and the page's own shaders for the stage."""
    films = {name: web_source((SHADERS / name).read_text("utf-8")) for name in ("skinned.vert", "dancer.frag")}
    own = {path.name: path.read_text("utf-8") for path in sorted((HERE / "shaders").iterdir())}
    return {**films, **own}


# The index of a folder of practice pages: plain links, grouped by song; no script.


@dataclass(frozen=True, slots=True)
class IndexEntry:
    """A page in an index. file : its name in the folder; title, artist : of the song; label : the chart's label"""

    file: str
    title: str
    artist: str
    label: str


def index_page(entries: Sequence[IndexEntry], title: str) -> bytes:
    """Return the page that links to the others; songs keep their order, and names are never markup."""
    style = (HERE / "index.css").read_text("utf-8")
    songs = []
    for (name, artist), group in groupby(entries, key=lambda one: (one.title, one.artist)):
        by = f" <small>{html.escape(artist)}</small>" if artist else ""
        links = "".join(f'<li><a href="{quote(one.file)}">{html.escape(one.label)}</a></li>' for one in group)
        songs.append(f"<h2>{html.escape(name)}{by}</h2>\n<ul>{links}</ul>")
    return list_page(title, "\n".join(songs), style)
