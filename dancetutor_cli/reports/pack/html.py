"""A pack as one HTML file with its pictures inside: no script, no network; what people wrote is text."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from html import escape

import dancetutor_cli
from dancetutor_cli.reports.pack import plots
from dancetutor_cli.reports.pack.facts import TECHNIQUES, Pack, PackChart
from dancetutor_cli.reports.safe import safe, safe_path

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
_OFF = 2.0  # meters from label to estimate that a cell is marked for


def html_page(pack: Pack, changes: Sequence[str] = ()) -> str:
    """The page. changes : lines of what is new against another version of the pack"""
    charts = pack.charts()
    name = escape(safe_path(pack.folder.rsplit("/", 1)[-1]))
    body = [f'<h1>{name}</h1><p class="lead">{pack.songs} songs, {len(charts)} charts</p>']
    for steps_type, _ in Counter(one.result.steps_type for one in charts).most_common():
        of_type = [one for one in charts if one.result.steps_type == steps_type]
        body.append(f"<h2>{escape(safe(steps_type))}</h2>{_key(plots.COLOURS)}")
        body.append(f'<div class="plots">{"".join(_figures(of_type))}</div>')
        body.append(_techniques(of_type))
    body += [_list("What stands out", pack.outliers()), _list("What is missing", pack.missing())]
    if changes:
        body.append(_list("What has changed", changes))
    body.append(_table(charts))
    made = f"dancetutor {dancetutor_cli.__version__}"
    policy = "default-src 'none'; style-src 'unsafe-inline'"
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{name}</title>'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">'
        f'<meta name="generator" content="{escape(made)}"><meta name="viewport" content="width=device-width">'
        f"<style>{_STYLE}</style></head>"
        f"<body>{''.join(body)}</body></html>\n"
    )


def _figures(charts: Sequence[PackChart]) -> Iterable[str]:
    """The pictures of one steps type."""
    labels: dict[int, Counter[str]] = defaultdict(Counter)
    for one in charts:
        named = one.result.difficulty if one.result.difficulty in plots.COLOURS else "Edit"
        labels[min(one.result.meter, 30)][named] += 1
    told = [(one, one.result.estimate) for one in charts]
    plays = Counter(min(round(estimate.meter), 30) for _, estimate in told if estimate)
    yield _figure("Charts by meter; dashed: by how they play", plots.bars(labels, plays))
    estimated = [_dot(one, estimate.meter) for one, estimate in told if estimate]
    if estimated:
        yield _figure(
            "How they play against their meters", plots.dots(estimated, "plays like", "plays like", diagonal=True)
        )
    measured = [(one, one.result.figures) for one in charts if one.result.figures is not None]
    dense = [_dot(one, figures.nps_mean) for one, figures in measured]
    yield _figure("Density: rows a second", plots.dots(dense, "density", "rows a second"))
    crossing = [
        _dot(one, _MINUTE * figures.tech.get("Crossovers", 0) / figures.seconds)
        for one, figures in measured
        if figures.seconds > 1
    ]
    yield _figure("Crossovers a minute", plots.dots(crossing, "crossovers a minute", "crossovers a minute"))
    faces: dict[int, list[int]] = defaultdict(lambda: [0] * len(plots.FACES))
    for one, figures in measured:
        for n, count in enumerate(figures.facing):
            faces[min(one.result.meter, 30)][n] += count
    if faces:
        names = ("to the screen", "45°", "sideways", "135°", "back to it")
        yield _figure("Where she faces", plots.facing(faces) + _key(dict(zip(names, plots.FACES, strict=True))))


def _dot(one: PackChart, y: float) -> plots.Dot:
    return plots.Dot(float(min(one.result.meter, 30)), y, one.result.difficulty, f"{one.name}: {y:.1f}")


def _figure(caption: str, picture: str) -> str:
    return f"<figure><figcaption>{escape(caption)}</figcaption>{picture}</figure>"


def _key(colours: dict[str, str]) -> str:
    spans = (f'<span><i style="background:{colour}"></i>{escape(name)}</span>' for name, colour in colours.items())
    return f'<p class="key">{"".join(spans)}</p>'


def _techniques(charts: Sequence[PackChart]) -> str:
    """Charts and rows with each technique, by bands of three meters."""
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


def _list(title: str, said: Iterable[str]) -> str:
    items = "".join(f"<li>{escape(line)}</li>" for line in said)
    return f"<h2>{title}</h2>" + (f"<ul>{items}</ul>" if items else '<p class="lead">Nothing.</p>')


def _table(charts: Iterable[PackChart]) -> str:
    names = ("meter", "plays like", "rows", "rows/s", *TECHNIQUES)
    head = '<th class="t">song</th><th class="t">chart</th>' + "".join(f"<th>{name}</th>" for name in names)
    rows = []
    for one in charts:
        chart, figures, told = one.result, one.result.figures, one.result.estimate
        off = told is not None and told.known and abs(told.meter - chart.meter) >= _OFF
        plays = f"<td{' class=off' if off else ''}>{told.meter:.1f}</td>" if told else "<td></td>"
        cells = [str(chart.row_count), f"{figures.nps_mean:.1f}" if figures else ""]
        cells += [str(one.rows_of(technique) or "") for technique in TECHNIQUES]
        rows.append(
            f'<tr><td class="t" title="{escape(one.file)}">{escape(one.song)}</td>'
            f'<td class="t">{escape(safe(chart.steps_type))} {escape(safe(chart.difficulty))}</td>'
            f"<td>{chart.meter}</td>{plays}{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>"
        )
    return f'<h2>All charts</h2><div class="wide"><table><tr>{head}</tr>{"".join(rows)}</table></div>'
