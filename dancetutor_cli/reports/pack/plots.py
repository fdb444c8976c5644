"""Pictures of a pack as inline SVG: bars of meters, dots over meters, shares of facing. Hover tells which chart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape

WIDTH, HEIGHT = 560, 240
_LEFT, _BOTTOM, _TOP, _RIGHT = 44, 34, 14, 12
COLOURS = {
    "Beginner": "#4aa3df", "Easy": "#3fae6a", "Medium": "#e0a52c", "Hard": "#d9534f", "Challenge": "#8e5bd0",
    "Edit": "#8a8f98",
}  # fmt: skip
FACES = ("#2f6fb5", "#7fb2e5", "#e8c15a", "#e0863a", "#c0392b")  # from facing the screen to back to it


@dataclass(frozen=True, slots=True)
class Dot:
    """A chart: where it stands, which difficulty, what hovering says."""

    x: float
    y: float
    difficulty: str
    name: str


def _begin(title: str, x_name: str, y_name: str) -> list[str]:
    return [
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{escape(title)}">',
        f'<text x="{(WIDTH + _LEFT) / 2:.0f}" y="{HEIGHT - 4}" text-anchor="middle">{escape(x_name)}</text>',
        f'<text x="12" y="{HEIGHT / 2:.0f}" transform="rotate(-90 12 {HEIGHT / 2:.0f})" text-anchor="middle">'
        f"{escape(y_name)}</text>",
        f'<path class="axis" d="M{_LEFT} {_TOP}V{HEIGHT - _BOTTOM}H{WIDTH - _RIGHT}"/>',
    ]


def _x(value: float, first: float, last: float) -> float:
    return _LEFT + (value - first) / max(last - first, 1e-9) * (WIDTH - _LEFT - _RIGHT)


def _y(value: float, most: float) -> float:
    return HEIGHT - _BOTTOM - value / max(most, 1e-9) * (HEIGHT - _BOTTOM - _TOP)


def _grid(most: float) -> list[str]:
    """Lines and numbers of the upward axis, about four."""
    step = _round_step(most / 4)
    out = []
    for n in range(1, int(most / step) + 1):
        y = _y(n * step, most)
        out.append(f'<path class="grid" d="M{_LEFT} {y:.1f}H{WIDTH - _RIGHT}"/>')
        out.append(f'<text x="{_LEFT - 4}" y="{y + 4:.1f}" text-anchor="end">{n * step:g}</text>')
    return out


def _round_step(rough: float) -> float:
    """1, 2 or 5 times a power of ten, not below `rough`."""
    step = 0.01
    while step < rough:
        for times in (2.0, 2.5, 2.0):
            step *= times
            if step >= rough:
                return round(step, 6)
    return step


def bars(counts: Mapping[int, Mapping[str, int]], plays: Mapping[int, int]) -> str:
    """Charts by meter, parted by difficulty; a line for how many play like that meter."""
    meters = range(min([*counts, *plays]), max([*counts, *plays]) + 1)
    most = max([sum(of.values()) for of in counts.values()] + list(plays.values()))
    out = [*_begin("charts by meter", "meter", "charts"), *_grid(most)]
    wide = (WIDTH - _LEFT - _RIGHT) / len(meters)
    for n, meter in enumerate(meters):
        x, below = _LEFT + n * wide, 0
        for difficulty, colour in COLOURS.items():
            count = counts.get(meter, {}).get(difficulty, 0)
            if count:
                top, bottom = _y(below + count, most), _y(below, most)
                out.append(
                    f'<rect x="{x + wide * 0.12:.1f}" y="{top:.1f}" width="{wide * 0.76:.1f}" '
                    f'height="{bottom - top:.1f}" fill="{colour}"><title>{count} {difficulty} {meter}</title></rect>'
                )
                below += count
        out.append(f'<text x="{x + wide / 2:.1f}" y="{HEIGHT - 18}" text-anchor="middle">{meter}</text>')
    line = " ".join(f"{_LEFT + (n + 0.5) * wide:.1f},{_y(plays.get(m, 0), most):.1f}" for n, m in enumerate(meters))
    out.append(f'<polyline class="plays" points="{line}"/>')
    return "".join((*out, "</svg>"))


def dots(found: Sequence[Dot], title: str, y_name: str, *, diagonal: bool = False) -> str:
    """Charts over their meters; several of one meter stand side by side."""
    last = max([one.x for one in found] + [1.0]) + 1
    most = max([one.y for one in found] + [last if diagonal else 0.0, 0.1]) * 1.05
    out = [*_begin(title, "meter", y_name), *_grid(most)]
    step = 1 if last <= 24 else 5
    for meter in range(0, int(last) + 1, step):
        out.append(f'<text x="{_x(meter, 0, last):.1f}" y="{HEIGHT - 18}" text-anchor="middle">{meter}</text>')
    if diagonal:
        out.append(f'<path class="axis" d="M{_LEFT} {_y(0, most):.1f}L{_x(last, 0, last):.1f} {_y(last, most):.1f}"/>')
    placed: dict[float, int] = {}
    for one in found:
        aside = placed[one.x] = placed.get(one.x, -1) + 1
        x = _x(one.x + ((aside * 0.618) % 1 - 0.5) * 0.6, 0, last)
        colour = COLOURS.get(one.difficulty, COLOURS["Edit"])
        out.append(
            f'<circle cx="{x:.1f}" cy="{_y(one.y, most):.1f}" r="3" fill="{colour}">'
            f"<title>{escape(one.name)}</title></circle>"
        )
    return "".join((*out, "</svg>"))


def facing(shares: Mapping[int, Sequence[int]]) -> str:
    """By meter, how many of the rows she faces where: the screen at the bottom, back to it at the top."""
    meters = sorted(shares)
    out = _begin("where she faces", "meter", "rows, per cent") + _grid(100)
    wide = (WIDTH - _LEFT - _RIGHT) / max(len(meters), 1)
    for n, meter in enumerate(meters):
        rows, below = shares[meter], 0.0
        for colour, count in zip(FACES, rows, strict=True):
            share = 100 * count / max(sum(rows), 1)
            if share:
                top, bottom = _y(below + share, 100), _y(below, 100)
                x = _LEFT + (n + 0.12) * wide
                out.append(
                    f'<rect x="{x:.1f}" y="{top:.1f}" width="{wide * 0.76:.1f}" height="{bottom - top:.1f}" '
                    f'fill="{colour}"><title>meter {meter}: {share:.0f} %</title></rect>'
                )
                below += share
        out.append(f'<text x="{_LEFT + (n + 0.5) * wide:.1f}" y="{HEIGHT - 18}" text-anchor="middle">{meter}</text>')
    return "".join((*out, "</svg>"))
