"""Where the shaders are, and how one for desktop OpenGL is read by WebGL 2: they differ in their first lines only."""

from __future__ import annotations

from pathlib import Path

SHADERS = Path(__file__).resolve().parent / "shaders"
_DESKTOP = "#version 330 core"
_WEB = """#version 300 es
precision highp float;
precision highp int;
precision highp sampler2DShadow;"""


def web_source(text: str) -> str:
    """A shader's text for WebGL 2. ValueError for one that does not begin as those here do."""
    if not text.startswith(_DESKTOP):
        raise ValueError(f"a shader begins with '{_DESKTOP}'")
    return _WEB + text[len(_DESKTOP) :]
