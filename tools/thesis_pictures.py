"""Small curves of several settings over the same time, as one SVG: grey first, then in colours that print apart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from xml.sax.saxutils import escape

WIDTH, HEIGHT, LEFT, TOP, LINE = 640, 170, 44, 24, 15  # pixels
COLOURS = ("#999999", "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
MOST = 8  # curves; more cannot be told apart


def picture(title: str, seconds: float, curves: Mapping[str, Sequence[float]]) -> str:
    """The curves by name over so many seconds, with the title above and the names below."""
    shown = dict(list(curves.items())[:MOST])
    values = [x for curve in shown.values() for x in curve]
    low, high = min(values), max(values)
    high = high if high > low else low + 1.0
    below = TOP + HEIGHT + 22
    total = below + LINE * ((len(shown) + 1) // 2) + 6
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{total}" font-family="sans-serif" '
        'font-size="11" fill="#222222">',
        '<rect width="100%" height="100%" fill="white"/>',
        f'<text x="{LEFT}" y="16">{escape(title)}</text>',
        f'<rect x="{LEFT}" y="{TOP}" width="{WIDTH - LEFT - 8}" height="{HEIGHT}" fill="none" stroke="#cccccc"/>',
        f'<text x="{LEFT - 4}" y="{TOP + 10}" text-anchor="end">{high:.3g}</text>',
        f'<text x="{LEFT - 4}" y="{TOP + HEIGHT}" text-anchor="end">{low:.3g}</text>',
        f'<text x="{LEFT}" y="{TOP + HEIGHT + 14}">0 s</text>',
        f'<text x="{WIDTH - 8}" y="{TOP + HEIGHT + 14}" text-anchor="end">{seconds:g} s</text>',
    ]
    for k, (name, curve) in enumerate(shown.items()):
        across = (WIDTH - LEFT - 8) / max(len(curve) - 1, 1)
        points = " ".join(
            f"{LEFT + n * across:.0f},{TOP + HEIGHT * (high - x) / (high - low):.1f}" for n, x in enumerate(curve)
        )
        out.append(f'<polyline points="{points}" fill="none" stroke="{COLOURS[k]}" stroke-width="1.3"/>')
        x, y = LEFT + (k % 2) * (WIDTH - LEFT) // 2, below + LINE * (k // 2)
        out.append(f'<rect x="{x}" y="{y}" width="14" height="3" fill="{COLOURS[k]}"/>')
        out.append(f'<text x="{x + 20}" y="{y + 6}">{escape(name)}</text>')
    return "\n".join([*out, "</svg>", ""])
