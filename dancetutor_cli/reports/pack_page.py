"""A pack as one HTML file with inline SVG pictures: no script, no network; untrusted texts are escaped."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from html import escape

import dancetutor_cli
from dancetutor_cli.reports.pack import TECHNIQUES, Pack, PackChart
from dancetutor_cli.run import markup
from dancetutor_cli.run.errors import plural
from dancetutor_cli.run.foreign_text import safe, safe_path

# Pictures of a pack as inline SVG: bars of meters, dots over meters, shares of facing. Tooltips name the chart.

WIDTH, HEIGHT = 560, 240
_LEFT, _BOTTOM, _TOP, _RIGHT = 44, 34, 14, 12
COLOURS = {
    "Beginner": "#4aa3df", "Easy": "#3fae6a", "Medium": "#e0a52c", "Hard": "#d9534f", "Challenge": "#8e5bd0",
    "Edit": "#8a8f98",
}  # fmt: skip
FACES = ("#2f6fb5", "#7fb2e5", "#e8c15a", "#e0863a", "#c0392b")  # from facing the screen to back to it


@dataclass(frozen=True, slots=True)
class Dot:
    """A chart as a dot. x, y : values on the axes; name : its tooltip"""

    x: float
    y: float
    difficulty: str
    name: str


def _svg(title: str, y_name: str, *parts: str) -> str:
    """Return a picture with its axes and their names."""
    middle = f"{HEIGHT / 2:.0f}"
    axes = (
        _label(f"{(WIDTH + _LEFT) / 2:.0f}", HEIGHT - 4, "meter"),
        markup.tag("text", y_name, x=12, y=middle, transform=f"rotate(-90 12 {middle})", text_anchor="middle"),
        _path("axis", f"M{_LEFT} {_TOP}V{HEIGHT - _BOTTOM}H{WIDTH - _RIGHT}"),
    )
    return markup.tag("svg", "".join((*axes, *parts)), viewBox=f"0 0 {WIDTH} {HEIGHT}", role="img", aria_label=title)


def _path(class_: str, d: str) -> str:
    return markup.tag("path", class_=class_, d=d)


def _label(x: str, y: int, text: str) -> str:
    return markup.tag("text", text, x=x, y=y, text_anchor="middle")


def _bar(x: float, top: float, bottom: float, width: float, about: tuple[str, str]) -> str:
    """Return a part of a bar. about : its colour and its tooltip"""
    colour, words = about
    size = {"y": f"{top:.1f}", "width": f"{width:.1f}", "height": f"{bottom - top:.1f}"}
    return markup.tag("rect", markup.tag("title", words), x=f"{x:.1f}", **size, fill=colour)


def _x(value: float, first: float, last: float) -> float:
    return _LEFT + (value - first) / max(last - first, 1e-9) * (WIDTH - _LEFT - _RIGHT)


def _y(value: float, most: float) -> float:
    return HEIGHT - _BOTTOM - value / max(most, 1e-9) * (HEIGHT - _BOTTOM - _TOP)


def _grid(most: float) -> list[str]:
    """Return the lines and numbers of the upward axis, about four."""
    step = _round_step(most / 4)
    out = []
    for n in range(1, int(most / step) + 1):
        y = _y(n * step, most)
        out.append(_path("grid", f"M{_LEFT} {y:.1f}H{WIDTH - _RIGHT}"))
        out.append(markup.tag("text", f"{n * step:g}", x=_LEFT - 4, y=f"{y + 4:.1f}", text_anchor="end"))
    return out


def _round_step(rough: float) -> float:
    """Return 1, 2 or 5 times a power of ten, not below `rough`."""
    step = 0.01
    while step < rough:
        for times in (2.0, 2.5, 2.0):
            step *= times
            if step >= rough:
                return round(step, 6)
    return step


def bars(counts: Mapping[int, Mapping[str, int]], plays: Mapping[int, int]) -> str:
    """Return the bars of charts by meter and difficulty; a line shows how many charts play like each meter."""
    meters = range(min([*counts, *plays]), max([*counts, *plays]) + 1)
    most = max([sum(of.values()) for of in counts.values()] + list(plays.values()))
    out = _grid(most)
    wide = (WIDTH - _LEFT - _RIGHT) / len(meters)
    for n, meter in enumerate(meters):
        x, below = _LEFT + n * wide, 0
        for difficulty, colour in COLOURS.items():
            count = counts.get(meter, {}).get(difficulty, 0)
            if count:
                top, bottom = _y(below + count, most), _y(below, most)
                out.append(_bar(x + wide * 0.12, top, bottom, wide * 0.76, (colour, f"{count} {difficulty} {meter}")))
                below += count
        out.append(_label(f"{x + wide / 2:.1f}", HEIGHT - 18, str(meter)))
    line = " ".join(f"{_LEFT + (n + 0.5) * wide:.1f},{_y(plays.get(m, 0), most):.1f}" for n, m in enumerate(meters))
    out.append(markup.tag("polyline", class_="plays", points=line))
    return _svg("charts by meter", "charts", *out)


def dots(found: Sequence[Dot], title: str, y_name: str, *, diagonal: bool = False) -> str:
    """Return the dots of charts over their meters; dots of the same meter are side by side."""
    last = max([one.x for one in found] + [1.0]) + 1
    most = max([one.y for one in found] + [last if diagonal else 0.0, 0.1]) * 1.05
    out = _grid(most)
    step = 1 if last <= 24 else 5
    for meter in range(0, int(last) + 1, step):
        out.append(_label(f"{_x(meter, 0, last):.1f}", HEIGHT - 18, str(meter)))
    if diagonal:
        out.append(_path("axis", f"M{_LEFT} {_y(0, most):.1f}L{_x(last, 0, last):.1f} {_y(last, most):.1f}"))
    placed: dict[float, int] = {}
    for one in found:
        aside = placed[one.x] = placed.get(one.x, -1) + 1
        x = _x(one.x + ((aside * 0.618) % 1 - 0.5) * 0.6, 0, last)
        colour = COLOURS.get(one.difficulty, COLOURS["Edit"])
        tooltip = markup.tag("title", escape(one.name))
        out.append(markup.tag("circle", tooltip, cx=f"{x:.1f}", cy=f"{_y(one.y, most):.1f}", r=3, fill=colour))
    return _svg(title, y_name, *out)


def facing(shares: Mapping[int, Sequence[int]]) -> str:
    """Return the share of rows for each facing, by meter: to the screen at the bottom, back to it at the top."""
    meters = sorted(shares)
    out = _grid(100)
    wide = (WIDTH - _LEFT - _RIGHT) / max(len(meters), 1)
    for n, meter in enumerate(meters):
        rows, below = shares[meter], 0.0
        for colour, count in zip(FACES, rows, strict=True):
            share = 100 * count / max(sum(rows), 1)
            if share:
                top, bottom = _y(below + share, 100), _y(below, 100)
                x = _LEFT + (n + 0.12) * wide
                out.append(_bar(x, top, bottom, wide * 0.76, (colour, f"meter {meter}: {share:.0f} %")))
                below += share
        out.append(_label(f"{_LEFT + (n + 0.5) * wide:.1f}", HEIGHT - 18, str(meter)))
    return _svg("where the dancer faces", "% of rows", *out)


# The page around the pictures.

_STYLE = """
:root{color-scheme:light;font:15px/1.45 system-ui,sans-serif}
body{margin:0 auto;max-width:1200px;padding:1.5rem;color:#1d2430;background:#fff}
h1{margin:0;overflow-wrap:anywhere}h2{margin:2rem 0 .5rem;border-bottom:1px solid #d5dbe3}.lead{color:#556070}
.plots{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,480px),1fr));gap:1rem}
figure{margin:0;border:1px solid #e2e7ee;border-radius:8px;padding:.6rem}
figcaption{font-weight:600;margin-bottom:.3rem}svg{width:100%;height:auto;font:12px sans-serif;fill:#1d2430}
.axis{stroke:#8a94a3;fill:none}.grid{stroke:#e8ecf1}circle{fill-opacity:.75}
.plays{fill:none;stroke:#1d2430;stroke-width:1.5;stroke-dasharray:4 3}
.key span{display:inline-block;margin-right:.9rem}
.key i{display:inline-block;width:.8em;height:.8em;border-radius:2px;margin-right:.3em}
.wide{overflow-x:auto}table{border-collapse:collapse;width:100%;font-variant-numeric:tabular-nums}
th,td{padding:.2rem .5rem;text-align:right;border-bottom:1px solid #eef1f5}th{background:#f6f8fa}
td{white-space:nowrap}td.t,th.t{text-align:left;white-space:normal;overflow-wrap:anywhere;min-width:7em}td.off{background:#fdeceb}
ul{margin:.3rem 0}li{overflow-wrap:anywhere}
"""
_MINUTE = 60.0
_OFF = 2.0  # meters between label and estimate from which a cell is marked


def pack_html(pack: Pack, changes: Sequence[str] = ()) -> str:
    """Return the page. changes : lines about the changes since another version of the pack"""
    charts = pack.charts()
    name = safe_path(pack.folder.rsplit("/", 1)[-1])
    counts = f"{plural(pack.songs, 'song')}, {plural(len(charts), 'chart')}"
    body = [f'<h1>{escape(name)}</h1><p class="lead">{counts}</p>']
    body += [_needs(pack), _list("What is missing or wrong", pack.missing_lines())]
    if changes:
        body.append(_list("What has changed", changes))
    body.append(_list("What stands out", pack.outliers()))
    for steps_type, _ in Counter(one.result.steps_type for one in charts).most_common():
        of_type = [one for one in charts if one.result.steps_type == steps_type]
        body.append(f"<h2>{escape(safe(steps_type))}</h2>{_key(COLOURS)}")
        body.append(f'<div class="plots">{"".join(_figures(of_type))}</div>')
        body.append(_techniques(of_type))
    body.append(_table(charts))
    made = f'<meta name="generator" content="dancetutor {escape(dancetutor_cli.__version__)}">\n'
    return markup.page(markup.NO_SCRIPT, name, _STYLE, "".join(body), head=made)


def _figures(charts: Sequence[PackChart]) -> Iterable[str]:
    """Yield the pictures of one steps type."""
    labels: dict[int, Counter[str]] = defaultdict(Counter)
    for one in charts:
        named = one.result.difficulty if one.result.difficulty in COLOURS else "Edit"
        labels[min(one.result.meter, 30)][named] += 1
    pairs = [(one, one.result.estimate) for one in charts]
    plays = Counter(min(round(estimate.meter), 30) for _, estimate in pairs if estimate)
    yield _figure("Charts by meter; dashed: charts that play like this meter", bars(labels, plays))
    estimated = [_dot(one, estimate.meter) for one, estimate in pairs if estimate]
    if estimated:
        yield _figure("What the charts play like, by meter", dots(estimated, "plays like", "plays like", diagonal=True))
    measured = [(one, one.result.figures) for one in charts if one.result.figures is not None]
    dense = [_dot(one, figures.nps_mean) for one, figures in measured]
    yield _figure("Density, rows per second", dots(dense, "density", "rows per second"))
    crossing = [
        _dot(one, _MINUTE * figures.tech.get("Crossovers", 0) / figures.seconds)
        for one, figures in measured
        if figures.seconds > 1
    ]
    yield _figure("Crossovers per minute", dots(crossing, "crossovers per minute", "crossovers per minute"))
    faces: dict[int, list[int]] = defaultdict(lambda: [0] * len(FACES))
    for one, figures in measured:
        for n, count in enumerate(figures.facing):
            faces[min(one.result.meter, 30)][n] += count
    if faces:
        names = ("to the screen", "45°", "sideways", "135°", "back to it")
        yield _figure("Where the dancer faces", facing(faces) + _key(dict(zip(names, FACES, strict=True))))


def _dot(one: PackChart, y: float) -> Dot:
    return Dot(float(min(one.result.meter, 30)), y, one.result.difficulty, f"{one.name}: {y:.1f}")


def _figure(caption: str, picture: str) -> str:
    return f"<figure><figcaption>{escape(caption)}</figcaption>{picture}</figure>"


def _key(colours: dict[str, str]) -> str:
    spans = (f'<span><i style="background:{colour}"></i>{escape(name)}</span>' for name, colour in colours.items())
    return f'<p class="key">{"".join(spans)}</p>'


def _techniques(charts: Sequence[PackChart]) -> str:
    """Return a table of charts and rows with each technique, by bands of three meters."""
    bands = sorted({(max(one.result.meter, 1) - 1) // 3 for one in charts})
    head = "".join(f"<th>{3 * band + 1} to {3 * band + 3}</th>" for band in bands)
    rows = []
    for technique in TECHNIQUES:
        cells = []
        for band in bands:
            counts = [one.rows_of(technique) for one in charts if (max(one.result.meter, 1) - 1) // 3 == band]
            cells.append(f"<td>{sum(map(bool, counts))} of {len(counts)} ({sum(counts)})</td>")
        rows.append(f'<tr><td class="t">{technique}</td>{"".join(cells)}</tr>')
    caption = '<p class="lead">Charts with a technique (and rows that have it), by meter</p>'
    return f'{caption}<div class="wide"><table><tr><th class="t"></th>{head}</tr>{"".join(rows)}</table></div>'


def _list(title: str, lines: Iterable[str]) -> str:
    items = "".join(f"<li>{escape(line)}</li>" for line in lines)
    return f"<h2>{title}</h2>" + (f"<ul>{items}</ul>" if items else '<p class="lead">Nothing.</p>')


def _needs(pack: Pack) -> str:
    """Return a table of files with errors and warnings, the worst first."""
    rows = [
        f'<tr><td class="t">{escape(one.file)}</td><td{" class=off" if one.errors else ""}>{one.errors or ""}</td>'
        f'<td>{one.warnings or ""}</td><td class="t">{"<br>".join(map(escape, one.what))}</td></tr>'
        for one in pack.needs()
    ]
    if not rows:
        return _list("What needs action", ())
    head = '<th class="t">file</th><th>errors</th><th>warnings</th><th class="t">what</th>'
    return f'<h2>What needs action</h2><div class="wide"><table><tr>{head}</tr>{"".join(rows)}</table></div>'


def _table(charts: Iterable[PackChart]) -> str:
    names = ("meter", "plays like", "to score on (DDR scale)", "rows", "rows/s", *TECHNIQUES)
    head = '<th class="t">song</th><th class="t">chart</th>' + "".join(f"<th>{name}</th>" for name in names)
    rows = []
    for one in charts:
        chart, figures, estimate = one.result, one.result.figures, one.result.estimate
        off = estimate is not None and estimate.is_scale_known and abs(estimate.meter - chart.meter) >= _OFF
        plays = f"<td{' class=off' if off else ''}>{estimate.meter:.1f}</td>" if estimate else "<td></td>"
        scores = f"<td>{chart.score.meter:.2f}</td>" if chart.score else "<td></td>"
        cells = [str(chart.row_count), f"{figures.nps_mean:.1f}" if figures else ""]
        cells += [str(one.rows_of(technique) or "") for technique in TECHNIQUES]
        rows.append(
            f'<tr><td class="t" title="{escape(one.file)}">{escape(one.song)}</td>'
            f'<td class="t">{escape(safe(chart.steps_type))} {escape(safe(chart.difficulty))}</td>'
            f"<td>{chart.meter}</td>{plays}{scores}{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>"
        )
    return f'<h2>All charts</h2><div class="wide"><table><tr>{head}</tr>{"".join(rows)}</table></div>'
