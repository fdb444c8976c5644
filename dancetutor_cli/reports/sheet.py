"""The whole sheet: heading, density strip, systems, list of findings; one SVG, or an HTML page that prints well."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from html import escape
from unicodedata import east_asian_width

import numpy as np

from dancetutor_cli.chart.model import Kind
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.feet.limbs import LABELS
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.subject import ChartSubject
from dancetutor_cli.reports.analyze_formats import clock, moment
from dancetutor_cli.reports.sheet_drawing import HOLD_OPACITY, Sheet, badge, definitions, mark, system, unsure_rows
from dancetutor_cli.reports.sheet_places import SheetStyle, lay_out, sheet_style
from dancetutor_cli.run import markup
from dancetutor_cli.run.foreign_text import safe
from dancetutor_cli.run.languages import ENGLISH

_LEFT = 12.0
_FACTS, _FACT = 66.0, 14.0  # y of the first line of facts, and the spacing of these lines
_GAP = 22.0
_LIMBS = (*LABELS, "none")  # labels of a language
_LONG_LIST = 24  # more findings than these are listed in two columns
_FONT = "system-ui, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"


def make_sheet(subject: ChartSubject, findings: Sequence[Finding], language: str = ENGLISH) -> Sheet:
    """Return a chart ready to be drawn; without a pad, it has no feet. language : a name in configs/languages"""
    style, chart, limbs = sheet_style(), subject.chart, {}
    if subject.play is not None:
        play = subject.play
        for row, column in np.argwhere(play.rows.steps > 0).tolist():
            limbs[int(play.rows.tick[row]), column] = int(play.limb[row, column]), int(play.part[row, column])
    lanes = max(chart.columns, 1)
    arrows: list[float | None] = [None] * lanes
    if subject.pad is not None:
        arrows = [math.degrees(math.atan2(x, y)) if x or y else None for x, y in subject.pad.arrows.tolist()]
    layout = lay_out(chart.notes.tick, lanes, style, int(chart.notes.end.max(initial=0)))
    return Sheet(subject, findings, layout, limbs, arrows, language)


def svg_sheet(sheet: Sheet, facts: Sequence[str]) -> str:
    """Return the sheet as one picture. `facts` : lines about the chart, printed under its name."""
    style, layout = sheet.style, sheet.layout
    y = _heading_height(sheet, facts)
    parts = [_heading(sheet, facts)]
    for which in range(layout.systems):
        parts.append(markup.tag("g", system(sheet, which), transform=f"translate(0 {y:g})"))
        y += layout.system_height(which) + _GAP
    return _svg(style, "\n".join(parts), y, outer=True)


def sheets_html(sheets: Sequence[tuple[Sheet, Sequence[str]]]) -> str:
    """Return all sheets as one self-contained page: each system is a picture that is not cut when printing."""
    style = sheets[0][0].style
    song = sheets[0][0].subject.song
    name = safe(song.title) or song.path.name
    body = "\n".join(_article(sheet, facts) for sheet, facts in sheets)
    main = f"<main>\n<h1>{escape(name)}</h1>\n{body}\n</main>\n"
    return markup.page(markup.NO_SCRIPT, name, f"\n{_page_css(style)}", main, language=sheets[0][0].language)


def _article(sheet: Sheet, facts: Sequence[str]) -> str:
    style, layout = sheet.style, sheet.layout
    pictures = [_svg(style, _heading(sheet, facts), _heading_height(sheet, facts))]
    pictures += [_svg(style, system(sheet, n), layout.system_height(n)) for n in range(layout.systems)]
    figures = "\n".join(f"<figure>{picture}</figure>" for picture in pictures)
    return f"<article>\n{figures}\n{_list(sheet)}</article>"


def _heading_height(sheet: Sheet, facts: Sequence[str]) -> float:
    return _FACTS + _FACT * len(facts) + 24 + sheet.style.density + 10


def _heading(sheet: Sheet, facts: Sequence[str]) -> str:
    """Return the title, the facts, the legend and the density strip."""
    song, chart = sheet.subject.song, sheet.subject.chart
    by = " · ".join(part for part in (song.artist, chart.label, chart.description) if part.strip())
    parts = [markup.text(song.title or song.path.name, _LEFT, 30, "title"), markup.text(by, _LEFT, 50, "subtitle")]
    parts += [markup.text(line, _LEFT, _FACTS + _FACT * n, "fact") for n, line in enumerate(facts)]
    y = _FACTS + _FACT * len(facts)
    parts.append(markup.tag("g", _legend(sheet), transform=f"translate({_LEFT:g} {y - 4:g})"))
    parts.append(markup.tag("g", _density(sheet), transform=f"translate(0 {y + 24:g})"))
    return "".join(parts)


def _density(sheet: Sheet) -> str:
    """Return a bar for each measure, as high as its number of rows, with the findings as ticks above."""
    style, layout, play = sheet.style, sheet.layout, sheet.subject.play
    width = style.page_width
    ticks = np.unique(sheet.subject.chart.notes.tick) if play is None else play.rows.tick
    counts = np.bincount(np.maximum(ticks, 0) // (4 * TICKS_PER_BEAT), minlength=layout.measures)
    step = (width - 2 * _LEFT) / layout.measures
    tallest = max(int(counts.max()), 1)
    parts = []
    for measure, count in enumerate(counts.tolist()):
        height = count / tallest * (style.density - 10)
        bar = markup.title(sheet.say("measure", measure=measure, rows=count))
        size = {"width": max(step - 0.6, 0.5), "height": height}
        place = {"x": _LEFT + measure * step, "y": style.density - height}
        parts.append(markup.tag("rect", bar, **place, **size, fill=style.colours["density"]))
    for finding in sheet.findings:
        if finding.beat is not None:
            x = _LEFT + finding.beat / 4 * step
            parts.append(markup.tag("rect", x=x, y=0, width=1.4, height=6, fill=style.colours[finding.severity]))
    parts.append(markup.tag("path", d=f"M{_LEFT:g},{style.density:g} H{width - _LEFT:g}", class_="axis"))
    return "".join(parts)


def _legend(sheet: Sheet) -> str:
    """Return the colours of the grids that the chart has, and the limbs as they are marked on the arrows."""
    style, chart = sheet.style, sheet.subject.chart
    used = {style.note_colour(tick) for tick in np.unique(chart.notes.tick).tolist()}
    parts, x = [], 0.0
    for grid, colour in sorted(style.quantisation.items()):
        if colour in used:
            shape = f"translate({x + 8:g} 8) scale(15)"
            parts.append(markup.tag("use", href="#arrow", transform=shape, fill=colour, class_="sample"))
            label = "grid-nd" if grid % 10 == 2 and grid != 12 else "grid-th"  # 32nd, 16th
            parts.append(markup.text(sheet.say(label, grid=grid), x + 19, 11.5, "fact"))
            x += 54
    limbs = {limb for limb, _ in sheet.limbs.values()}
    for limb, label in zip((0, 1, 2, 3, -1), _LIMBS, strict=True):
        if limb in limbs or limb in (0, 1):
            name = sheet.words.limbs[label]
            parts.append(mark(style, x + 16, 8, limb, 0) + markup.text(name, x + 27, 11.5, "fact"))
            x += 40 + 5.4 * _letters(name)
    if unsure_rows(sheet):
        name = sheet.say("unsure-below", percent=f"{style.unsure:g}")
        parts.append(badge(style, x + 16, 8, 62) + markup.text(name, x + 27, 11.5, "fact"))
        x += 40 + 5.0 * _letters(name)
    for name, kind, corner in (("hold", Kind.HOLD, 3), ("roll", Kind.ROLL, 3), ("mine", Kind.MINE, 6)):
        if (chart.notes.kind == kind).any():
            opacity = 1.0 if kind == Kind.MINE else HOLD_OPACITY
            parts.append(markup.tag("rect", x=x + 8, y=2, width=12, height=12, rx=corner, fill=style.colours[name],
                             fill_opacity=opacity, class_="key"))  # fmt: skip
            parts.append(markup.text(sheet.say(name), x + 25, 11.5, "fact"))
            x += 36 + 5.4 * _letters(sheet.say(name))
    return "".join(parts)


def _letters(name: str) -> int:
    """Return the width of a text in Latin letters; Chinese, Japanese and Korean letters are twice as wide."""
    return sum(2 if east_asian_width(letter) in "WF" else 1 for letter in name)


def _list(sheet: Sheet) -> str:
    findings = sheet.findings
    if not findings:
        return f"<p>{escape(sheet.say('no-findings'))}</p>\n"
    rows = "".join(
        f'<tr class="{finding.severity}"><td>{finding.rule}</td><td>{escape(sheet.message(finding))}</td>'
        f"<td>{escape(_place(sheet, finding))}</td><td>{escape(sheet.say('line', line=finding.line or ''))}</td></tr>\n"
        for finding in findings
    )
    layout = "two" if len(findings) > _LONG_LIST else "one"
    return f'<h2>{escape(sheet.say("findings"))}</h2>\n<div class="{layout}"><table>\n{rows}</table></div>\n'


def _place(sheet: Sheet, finding: Finding) -> str:
    if finding.measure is None or finding.beat is None or finding.second is None:
        return moment(finding).strip()
    beat, time = f"{round(finding.beat, 3):g}", clock(finding.second)
    return sheet.say("place", measure=finding.measure, beat=beat, time=time)


def _svg(style: SheetStyle, inside: str, height: float, *, outer: bool = False) -> str:
    width = style.page_width
    colours = style.colours
    css = (
        f"text{{font-family:{_FONT};fill:{colours['ink']}}}.title{{font-size:22px;font-weight:700}}"
        f".subtitle{{font-size:13px}}.fact{{font-size:10.5px;fill:{colours['faint']}}}"
        f".number{{font-size:10.5px;font-weight:600}}.time{{font-size:8px;fill:{colours['faint']}}}"
        f".sure{{font-size:8.5px;font-weight:700;fill:{colours['paper']}}}"
        f".mark{{font-size:9px;font-weight:700}}.code{{font-size:7.5px;font-weight:600}}"
        f".sample{{stroke:{colours['ink']};stroke-width:.06}}"
        f".cross{{stroke:{colours['paper']};stroke-width:1.4;fill:none}}"
        f".panel{{fill:{colours['shade']};stroke:{colours['faint']};stroke-width:.4}}"
        f".sole{{stroke:{colours['ink']};stroke-width:.4}}.flag{{stroke-width:1;fill:none;stroke-opacity:.75}}"
        f".axis{{stroke:{colours['measure_line']};stroke-width:.8}}"
    )
    paper = markup.tag("rect", width=width, height=height, fill=colours["paper"]) if outer else ""
    body = f"<style>{css}</style>{definitions(style)}{paper}\n{inside}\n"
    box = f"0 0 {width:g} {height:g}"
    return markup.tag("svg", body, xmlns="http://www.w3.org/2000/svg", viewBox=box, width=width, height=height)


def _page_css(style: SheetStyle) -> str:
    colours = style.colours
    severities = "".join(f"tr.{name} td:first-child {{ color: {colours[name]}; }}\n"
                         for name in ("error", "warning", "info"))  # fmt: skip
    return (
        f"body {{ margin: 16px auto; padding: 0 16px; max-width: 1500px; background: {colours['paper']}; "
        f"color: {colours['ink']}; font-family: {_FONT}; }}\n"
        "h1 { position: absolute; width: 1px; height: 1px; margin: 0; overflow: hidden; clip-path: inset(50%); }\n"
        "figure { margin: 0 0 6px; break-inside: avoid; }\nsvg { width: 100%; height: auto; display: block; }\n"
        "article + article { break-before: page; }\n"
        "h2 { font-size: 15px; margin: 14px 12px 4px; break-after: avoid; }\n"
        "table { border-collapse: collapse; font-size: 12px; margin: 4px 12px 32px; }\ntr { break-inside: avoid; }\n"
        f"td {{ padding: 2px 14px 2px 0; border-bottom: 1px solid {colours['line']}; vertical-align: top; }}\n"
        "div.two { columns: 2; column-gap: 24px; }\ndiv.two table { font-size: 10px; }\n"
        "td + td + td { white-space: nowrap; }\n"
        f"td:first-child {{ font-weight: 600; }}\n{severities}"
        "@page { size: A4 landscape; margin: 8mm; }\n"
        "@media print { body { margin: 0; padding: 0; max-width: none; -webkit-print-color-adjust: exact; "
        "print-color-adjust: exact; } figure { margin: 0; } }\n"
    )


def facts_of(counts: Sequence[tuple[str, int]], numbers: Sequence[str]) -> list[str]:
    """Return the lines under the name of a chart: its numbers, and the number of each move."""
    moves = " · ".join(_move_words(counts))
    return [" · ".join(numbers), moves] if moves else [" · ".join(numbers)]


_KIND = re.compile("-(up|down|left|right|half|full)$")  # suffix of a move that its count leaves out
_SIDES = {"crossover-back": "behind", "crossover-front": "in front"}


def _move_words(counts: Sequence[tuple[str, int]]) -> Iterator[str]:
    """Yield the number of each move: "6 crossovers (4 behind, 2 in front)", "1 bracket"."""
    sums: dict[str, int] = {}
    for name, count in counts:
        if name not in _SIDES:
            base = _KIND.sub("", name)
            sums[base] = sums.get(base, 0) + count
    sides = ", ".join(f"{count} {_SIDES[name]}" for name, count in counts if name in _SIDES and count)
    for name, count in sums.items():
        noun = {"hand": "hand press"}.get(name, name.replace("-", " "))
        ending = "" if count == 1 else "es" if noun.endswith(("ch", "ss")) else "s"
        if count:
            yield f"{count} {noun}{ending}" + (f" ({sides})" if name == "crossover" and sides else "")
