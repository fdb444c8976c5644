"""One HTML file out of the template, the style, the ES modules and the data; nothing in it is loaded from elsewhere."""

from __future__ import annotations

import base64
import hashlib
import html
import json
import re
import struct
import zlib
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from dancetutor_cli.page.blob import Blob
from dancetutor_cli.page.bundle import bundle
from dancetutor_cli.video.scene.gl.sources import SHADERS, web_source

HERE = Path(__file__).resolve().parent
LANGUAGES = ("en", "de")  # the first one holds where a label is missing in another
_PLACE = re.compile(r"\{\{(\w+)\}\}")


def document(doc: Mapping[str, Any], blob: Blob, music: bytes | None = None) -> bytes:
    """The whole page. `doc` : see `content.pack_content`; music : the song's file, to be put into the page."""
    full = {**doc, "languages": languages(), "shaders": shaders()}
    head = json.dumps(full, separators=(",", ":"), ensure_ascii=False, allow_nan=False).encode("utf-8")
    data = base64.b64encode(zlib.compress(struct.pack("<I", len(head)) + head + blob.whole(), 9)).decode("ascii")
    script, style = bundle(HERE / "js", "main"), (HERE / "page.css").read_text("utf-8")
    title = " - ".join(part for part in (doc["words"]["title"], doc["words"]["badge"], "dancetutor") if part)
    music_text = "" if music is None else base64.b64encode(music).decode("ascii")
    body = _fill("page.html", {"data": data, "music": music_text, "script": script})
    return whole(policy(script, style), title, style, body)


def whole(policy: str, title: str, style: str, body: str) -> bytes:
    """An HTML file with this Content-Security-Policy; body : markup, title : text."""
    parts = {"policy": policy, "title": html.escape(title), "style": style, "body": body}
    return _fill("shell.html", parts).encode("utf-8")


def listed(title: str, items: str, style: str) -> bytes:
    """A page without script: a heading and markup below it."""
    rules = f"default-src 'none'; style-src '{hash_of(style)}'; img-src data:; base-uri 'none'; form-action 'none'"
    return whole(rules, title, style, _fill("index.html", {"title": html.escape(title), "songs": items}))


def _fill(template: str, values: Mapping[str, str]) -> str:
    """A template of this room with each {{name}} replaced, once: what is filled in is not looked at again."""
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
    return {name: json.loads((HERE / "words" / f"{name}.json").read_text("utf-8")) for name in LANGUAGES}


@cache
def shaders() -> dict[str, str]:
    """The dancer's shaders of the films as WebGL reads them, and the page's own for the stage."""
    films = {name: web_source((SHADERS / name).read_text("utf-8")) for name in ("skinned.vert", "dancer.frag")}
    own = {path.name: path.read_text("utf-8") for path in sorted((HERE / "shaders").iterdir())}
    return {**films, **own}
