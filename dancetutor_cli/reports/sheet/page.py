"""The whole sheet: heading, density strip, systems, list of findings; one SVG, or an HTML page that prints well."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape

import numpy as np

from dancetutor_cli.chart.model import TICKS_PER_BEAT
from dancetutor_cli.lint.model import Finding
from dancetutor_cli.lint.subject import ChartSubject
from dancetutor_cli.reports.safe import safe
from dancetutor_cli.reports.sheet.draw import Sheet, definitions, system
from dancetutor_cli.reports.sheet.layout import lay_out
from dancetutor_cli.reports.sheet.style import Style, sheet_style
from dancetutor_cli.reports.sheet.svg import tag, text, title
from dancetutor_cli.reports.text import clock, moment

_HEADING = 64.0
_GAP = 26.0
_FONT = "system-ui, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"


def make_sheet(subject: ChartSubject, findings: Sequence[Finding]) -> Sheet:
    """A chart ready to be drawn; one without a pad has notes without feet."""
    style, chart, limbs = sheet_style(), subject.chart, {}
    if subject.play is not None:
        play = subject.play
        for row, column in np.argwhere(play.rows.steps > 0).tolist():
            limbs[int(play.rows.tick[row]), column] = int(play.limb[row, column]), int(play.part[row, column])
    lanes = max(chart.columns, 1)
    arrows: list[float | None] = [None] * lanes
    if subject.pad is not None:
        arrows = [math.degrees(math.atan2(x, y)) if x or y else None for x, y in subject.pad.arrows.tolist()]
    return Sheet(
        subject, findings, lay_out(chart.notes.tick, lanes, style, int(chart.notes.end.max(initial=0))), limbs, arrows
    )


def svg_sheet(sheet: Sheet, facts: Sequence[str]) -> str:
    """The sheet as one picture. `facts` : lines about the chart, printed under its name."""
    style, layout = sheet.style, sheet.layout
    width = _width(sheet)
    y = _HEADING + 14 * len(facts)
    parts = [_heading(sheet, facts), tag("g", _density(sheet, width), transform=f"translate(0 {y:g})")]
    y += style.density + _GAP
    for which in range(layout.systems):
        parts.append(tag("g", system(sheet, which), transform=f"translate(12 {y:g})"))
        y += layout.system_height + _GAP
    parts.append(tag("g", _legend(style), transform=f"translate(12 {y:g})"))
    return _svg(style, "\n".join(parts), width, y + 26, outer=True)


def html_page(sheets: Sequence[tuple[Sheet, Sequence[str]]]) -> str:
    """All sheets as one self-contained page: each system is a picture that is not cut when printing."""
    style = sheets[0][0].style
    song = sheets[0][0].subject.song
    name = safe(song.title) or song.path.name
    body = "\n".join(_article(sheet, facts) for sheet, facts in sheets)
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>{escape(name)}</title>\n'
        f'<meta name="viewport" content="width=device-width">\n<style>\n{_page_css(style)}</style>\n</head>\n'
        f"<body>\n{body}\n</body>\n</html>\n"
    )


def _article(sheet: Sheet, facts: Sequence[str]) -> str:
    style, layout, width = sheet.style, sheet.layout, _width(sheet)
    top = _HEADING + 14 * len(facts)
    head = _heading(sheet, facts) + tag("g", _density(sheet, width), transform=f"translate(0 {top:g})")
    pictures = [_svg(style, head, width, top + style.density + 8)]
    for which in range(layout.systems):
        inside = tag("g", system(sheet, which), transform="translate(12 0)")
        pictures.append(_svg(style, inside, width, layout.system_height))
    pictures.append(_svg(style, tag("g", _legend(style), transform="translate(12 4)"), width, 26))
    figures = "\n".join(f"<figure>{picture}</figure>" for picture in pictures)
    return f"<article>\n{figures}\n{_list(sheet.findings)}</article>"


def _width(sheet: Sheet) -> float:
    columns = min(sheet.layout.columns, math.ceil(sheet.layout.measures / sheet.layout.per_column))
    return max(24 + columns * sheet.layout.column_width, 900.0)


def _heading(sheet: Sheet, facts: Sequence[str]) -> str:
    song, chart = sheet.subject.song, sheet.subject.chart
    by = " · ".join(part for part in (song.artist, chart.label, chart.description) if part.strip())
    parts = [text(song.title or song.path.name, 12, 30, "title"), text(by, 12, 50, "subtitle")]
    parts += [text(line, 12, 67 + 14 * n, "fact") for n, line in enumerate(facts)]
    return "".join(parts)


def _density(sheet: Sheet, width: float) -> str:
    """A bar for each measure, as high as it has rows, with the findings as ticks above."""
    style, layout, play = sheet.style, sheet.layout, sheet.subject.play
    ticks = np.unique(sheet.subject.chart.notes.tick) if play is None else play.rows.tick
    counts = np.bincount(np.maximum(ticks, 0) // (4 * TICKS_PER_BEAT), minlength=layout.measures)
    step = (width - 24) / layout.measures
    tallest = max(int(counts.max()), 1)
    parts = []
    for measure, count in enumerate(counts.tolist()):
        height = count / tallest * (style.density - 10)
        bar = title(f"measure {measure}: {count} rows")
        parts.append(tag("rect", bar, x=12 + measure * step, y=style.density - height, width=max(step - 0.6, 0.5),
                         height=height, fill=style.colours["density"]))  # fmt: skip
    for finding in sheet.findings:
        if finding.beat is not None:
            x = 12 + finding.beat / 4 * step
            parts.append(tag("rect", x=x, y=0, width=1.4, height=6, fill=style.colours[finding.severity]))
    parts.append(tag("path", d=f"M12,{style.density:g} H{width - 12:g}", class_="axis"))
    return "".join(parts)


def _legend(style: Style) -> str:
    parts, x = [], 0.0
    for grid, colour in sorted(style.quantisation.items()):
        shape = f"translate({x + 6:g} 6) scale({style.arrow:g})"
        parts.append(tag("use", href="#arrow", transform=shape, fill=colour, stroke_width="0.045", stroke="#1b1e2b"))
        ending = "nd" if grid % 10 == 2 and grid != 12 else "th"
        parts.append(text(f"{grid}{ending}", x + 17, 9.5, "fact"))
        x += 52
    names = ("L left foot (disc)", "R right foot (square)", "< left hand", "> right hand")
    for name, colour in zip(names, style.limbs, strict=True):
        parts.append(tag("rect", x=x, y=1, width=10, height=10, fill=colour, stroke="#1b1e2b", stroke_width=0.6))
        parts.append(text(name, x + 15, 9.5, "fact"))
        x += 24 + 5.6 * len(name)
    return "".join(parts)


def _list(findings: Sequence[Finding]) -> str:
    if not findings:
        return "<p>No findings.</p>\n"
    rows = "".join(
        f'<tr class="{finding.severity}"><td>{finding.rule}</td><td>{escape(safe(finding.message))}</td>'
        f"<td>{escape(moment(finding).strip())}</td><td>line {finding.line}</td></tr>\n"
        for finding in findings
    )
    return f"<table>\n{rows}</table>\n"


def _svg(style: Style, inside: str, width: float, height: float, *, outer: bool = False) -> str:
    colours = style.colours
    css = (
        f"text{{font-family:{_FONT};fill:{colours['ink']}}}.title{{font-size:22px;font-weight:700}}"
        f".subtitle{{font-size:13px}}.fact{{font-size:10px;fill:{colours['faint']}}}"
        f".number{{font-size:10px;font-weight:600}}.time{{font-size:7px;fill:{colours['faint']}}}"
        f".mark{{font-size:8px;font-weight:700}}.code{{font-size:7.5px;font-weight:600}}"
        f".cross{{stroke:{colours['paper']};stroke-width:1.4;fill:none}}"
        f".panel{{fill:{colours['shade']};stroke:{colours['faint']};stroke-width:.4}}"
        f".sole{{stroke:{colours['ink']};stroke-width:.4}}.flag{{stroke-width:1;fill:none;stroke-opacity:.75}}"
        f".axis{{stroke:{colours['measure_line']};stroke-width:.8}}"
    )
    paper = tag("rect", width=width, height=height, fill=colours["paper"]) if outer else ""
    body = f"<style>{css}</style>{definitions(style)}{paper}\n{inside}\n"
    box = f"0 0 {width:g} {height:g}"
    return tag("svg", body, xmlns="http://www.w3.org/2000/svg", viewBox=box, width=width, height=height)


def _page_css(style: Style) -> str:
    colours = style.colours
    severities = "".join(f"tr.{name} td:first-child {{ color: {colours[name]}; }}\n"
                         for name in ("error", "warning", "info"))  # fmt: skip
    return (
        f"body {{ margin: 16px; background: {colours['paper']}; color: {colours['ink']}; font-family: {_FONT}; }}\n"
        "figure { margin: 0 0 10px; break-inside: avoid; }\nsvg { max-width: 100%; height: auto; display: block; }\n"
        "article + article { break-before: page; }\n"
        "table { border-collapse: collapse; font-size: 12px; margin: 8px 12px 32px; }\n"
        f"td {{ padding: 2px 14px 2px 0; border-bottom: 1px solid {colours['line']}; }}\n"
        f"td:first-child {{ font-weight: 600; }}\n{severities}"
        "@page { size: A4 landscape; margin: 10mm; }\n"
        "@media print { body { margin: 0; -webkit-print-color-adjust: exact; print-color-adjust: exact; } }\n"
    )


def facts_of(counts: Sequence[tuple[str, int]], numbers: Sequence[str]) -> list[str]:
    """Lines under the name of a chart: its numbers, and how often each move happens."""
    told = " · ".join(f"{name} {count}" for name, count in counts if count)
    return [" · ".join(numbers), told] if told else [" · ".join(numbers)]


def length_of(subject: ChartSubject) -> str:
    """Time from the first to the last step, "1:42"."""
    return clock(subject.seconds_played())[:-4]
