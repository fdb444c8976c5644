"""`analyze --sync --plot FILE.svg`: the delay of the music's attacks after the beats, over the song."""

from __future__ import annotations

import base64

import numpy as np
from numpy.typing import NDArray

from dancetutor_cli.lint.findings import ITG, NULL
from dancetutor_cli.lint.sync import Judgement
from dancetutor_cli.reports.analyze_formats import clock
from dancetutor_cli.run import markup
from dancetutor_cli.run.pictures import picture_bytes

_WIDTH, _HEIGHT = 900, 420
_LEFT, _RIGHT, _TOP, _BOTTOM = 64, 16, 56, 48
_REACH = 40.0  # ms above and below the bias
_STEP = 10  # ms between lines
_DARK, _LIGHT = np.array([24, 48, 104]), np.array([255, 255, 255])  # colours of the highest and the lowest values
_INK, _GREY, _LINE, _BIAS = "#1d2430", "#6b7484", "#c9ced8", "#d9480f"
_STYLE = f".name{{font-size:16px;font-weight:600}}.note{{fill:{_GREY}}}text{{font-size:12px;fill:{_INK}}}"


def sync_plot(name: str, found: Judgement) -> str:
    """Return the picture as SVG: how well each part of the song fits each bias.

    Dots are at the best bias of each part; a line is at the bias of the song.
    """
    bias = found.sync.bias_ms or 0.0
    low, high = bias - _REACH, bias + _REACH
    parts = [
        markup.tag("style", _STYLE),
        markup.tag("rect", width=_WIDTH, height=_HEIGHT, fill="#fff"),
        markup.text(name, _LEFT, 24, "name"),
        markup.text(found.sync.description, _LEFT, 43, "note"),
        _heat(found, low, high),
        *_grid(found, low, high),
        *_dots(found, low, high),
        markup.tag("line", x1=_LEFT, x2=_WIDTH - _RIGHT, y1=_y(bias, low, high), y2=_y(bias, low, high), stroke=_BIAS),
    ]
    size = {"viewBox": f"0 0 {_WIDTH} {_HEIGHT}", "width": _WIDTH, "height": _HEIGHT}
    inside = "\n".join(["", *parts, ""])
    return markup.tag("svg", inside, xmlns="http://www.w3.org/2000/svg", **size, font_family="sans-serif") + "\n"


def _y(milliseconds: float, low: float, high: float) -> float:
    return _TOP + (_HEIGHT - _TOP - _BOTTOM) * (high - milliseconds) / (high - low)


def _x(share: float) -> float:
    return _LEFT + (_WIDTH - _LEFT - _RIGHT) * share


def _heat(found: Judgement, low: float, high: float) -> str:
    """Return the profiles of all parts as one picture, in which the highest values are dark."""
    wanted = np.linspace(high, low, 161) / 1000
    rows = np.array([np.interp(wanted, found.lags, part, left=0.0, right=0.0) for part in found.profile])
    strength: NDArray[np.float64] = np.clip(rows / np.maximum(rows.max(axis=1, keepdims=True), 1e-9), 0, 1)
    pixels = (_LIGHT + (_DARK - _LIGHT) * (strength.T**2)[..., None]).astype(np.uint8)
    data = base64.b64encode(picture_bytes(pixels)).decode("ascii")
    size = {"width": _WIDTH - _LEFT - _RIGHT, "height": _HEIGHT - _TOP - _BOTTOM}
    look = {"preserveAspectRatio": "none", "opacity": "0.75", "href": f"data:image/png;base64,{data}"}
    return markup.tag("image", x=_LEFT, y=_TOP, **size, **look)


def _grid(found: Judgement, low: float, high: float) -> list[str]:
    """Return lines of milliseconds, with names for null and ITG, and the time of the song below."""
    out = []
    lines = {float(one): f"{one} ms" for one in range(int(low // _STEP + 1) * _STEP, int(high) + 1, _STEP)}
    lines.update({one: name for one, name in ((NULL, "null"), (ITG, "ITG")) if low < one < high})
    for milliseconds, name in lines.items():
        y = _y(milliseconds, low, high)
        named = not name.endswith("ms")
        colour = _INK if named else _LINE
        out.append(markup.tag("line", x1=_LEFT, x2=_WIDTH - _RIGHT, y1=y, y2=y, stroke=colour, stroke_width=1))
        if named or all(abs(milliseconds - one) > 4 for one in (NULL, ITG)):
            out.append(markup.text(name, _LEFT - 6, y + 4, None, text_anchor="end"))
    for share in np.linspace(0, 1, 5):
        second = found.first + share * (found.last - found.first)
        label = clock(second, milliseconds=False)
        out.append(markup.text(label, _x(float(share)), _HEIGHT - 26, None, text_anchor="middle"))
    note = "dark: attacks of the music around the notes of a part; dots: best value of each part; line: of the song"
    out.append(markup.text(note, _LEFT, _HEIGHT - 8, "note"))
    return out


def _dots(found: Judgement, low: float, high: float) -> list[str]:
    count = len(found.biases)
    return [
        markup.tag("circle", cx=_x((place + 0.5) / count), cy=_y(float(seconds) * 1000, low, high), r=3.5, fill=_BIAS)
        for place, seconds in enumerate(found.biases)
        if low < seconds * 1000 < high
    ]
