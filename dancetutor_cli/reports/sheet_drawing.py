"""The drawing of a system of measures: grid, holds, arrows with L and R, crossed feet, and findings beside them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from dancetutor_cli.chart.model import STEP_KINDS, Kind
from dancetutor_cli.chart.names import TICKS_PER_BEAT, TICKS_PER_MEASURE
from dancetutor_cli.feet.limbs import letter
from dancetutor_cli.lint.findings import Finding
from dancetutor_cli.lint.subject import ChartSubject
from dancetutor_cli.reports.analyze_formats import clock
from dancetutor_cli.reports.sheet_places import SheetLayout, SheetStyle
from dancetutor_cli.run import markup
from dancetutor_cli.run.foreign_text import safe
from dancetutor_cli.run.languages import ENGLISH, Language, load_language

_PLURAL = re.compile(r"\{(\w+)\|([^|}]*)\|([^}]*)\}")
HOLD_OPACITY = 0.55
_BAND_OPACITY = 0.2
_FEET_SPACING = 27.0  # pixels; diagrams of feet that are nearer would overlap


@dataclass(frozen=True)
class Sheet:
    """One chart to be drawn. `limbs` : (tick, column) -> limb and part of every step, `arrows` : angle per column.

    language : language of its words, a name in configs/languages
    """

    subject: ChartSubject
    findings: Sequence[Finding]
    layout: SheetLayout
    limbs: Mapping[tuple[int, int], tuple[int, int]]
    arrows: Sequence[float | None]
    language: str = ENGLISH

    @property
    def words(self) -> Language:
        """The words of the sheet in its language."""
        return load_language(self.language)

    def say(self, label: str, **values: object) -> str:
        """Return the words of a label with their {places} filled in, "row" or "rows" for {count|row|rows} by count."""
        words = _PLURAL.sub(lambda m: m[2] if values[m[1]] == 1 else m[3], self.words.sheet[label])
        return words.format_map(values)

    def message(self, finding: Finding) -> str:
        """Return the sentence of a finding in English, or the meaning of its rule in another language."""
        return safe(finding.sentence) if self.language == ENGLISH else self.words.findings[finding.rule]

    @property
    def style(self) -> SheetStyle:
        """The sizes and colours of the sheet."""
        return self.layout.style


def definitions(style: SheetStyle) -> str:
    """Return the definitions of repeated shapes: the arrow (pointing up), one unit high, and the middle panel."""
    arrow = "M0,-.5 L.48,-.02 L.34,.14 L.13,-.06 L.13,.5 L-.13,.5 L-.13,-.06 L-.34,.14 L-.48,-.02 Z"
    shapes = f'<path id="arrow" d="{arrow}"/><rect id="middle" x="-.4" y="-.4" width=".8" height=".8" rx=".15"/>'
    return markup.tag("defs", shapes)


def system(sheet: Sheet, which: int) -> str:
    """Return the contents of one system as SVG elements."""
    measures = sheet.layout.measures_of(which)
    ticks = range(measures.start * TICKS_PER_MEASURE, measures.stop * TICKS_PER_MEASURE)
    parts = [
        *(_measure(sheet, measure) for measure in measures),
        *_unsure_bands(sheet, ticks),
        *_holds(sheet, ticks),
        *_notes(sheet, ticks),
        *_unsure_marks(sheet, ticks),
        *_feet(sheet, ticks),
        *_finding_flags(sheet, ticks),
    ]
    return "\n".join(parts)


def _measure(sheet: Sheet, measure: int) -> str:
    """Return the shade, the lines and the number of a measure."""
    layout, style = sheet.layout, sheet.style
    left, top = layout.left(measure), layout.top(measure)
    width, height = layout.lanes * style.lane, layout.measure_height
    shade = style.colours["shade"] if measure % 2 else style.colours["paper"]
    parts = [markup.tag("rect", x=left, y=top, width=width, height=height, fill=shade)]
    for beat in range(1, 4):
        y = top + beat * layout.beat
        parts.append(_line(left, y, left + width, y, style.colours["line"], 0.5))
    for lane in range(layout.lanes + 1):
        x = left + lane * style.lane
        parts.append(_line(x, top, x, top + height, style.colours["line"], 0.5))
    ends = (top, top + height) if measure == layout.column_of(measure)[-1] else (top,)
    parts += [_line(left, y, left + width, y, style.colours["measure_line"], 1.2) for y in ends]
    second = float(sheet.subject.chart.timing.seconds(np.array([measure * TICKS_PER_MEASURE]))[0])
    parts.append(markup.text(str(measure), left - 5, top + 4, "number", text_anchor="end"))
    parts.append(markup.text(clock(second, milliseconds=False), left - 5, top + 13, "time", text_anchor="end"))
    return "".join(parts)


def _line(x1: float, y1: float, x2: float, y2: float, colour: str, width: float) -> str:
    return markup.tag("line", x1=x1, y1=y1, x2=x2, y2=y2, stroke=colour, stroke_width=width)


def _holds(sheet: Sheet, ticks: range) -> Iterator[str]:
    """Yield the bodies of holds and rolls, cut at the end of each column of measures."""
    layout, style, notes = sheet.layout, sheet.style, sheet.subject.chart.notes
    at = np.flatnonzero((notes.end > ticks.start) & (notes.tick < ticks.stop))
    for n in at.tolist():
        start, end, lane = int(notes.tick[n]), int(notes.end[n]), int(notes.column[n])
        colour = style.colours["roll" if notes.kind[n] == Kind.ROLL else "hold"]
        first = max(start, ticks.start)
        while first < min(end, ticks.stop):
            last = min(layout.column_of(first // TICKS_PER_MEASURE).stop * TICKS_PER_MEASURE, end, ticks.stop)
            x, y = layout.x(first, lane) - style.arrow * 0.27, layout.y(first)
            height = (last - first) / TICKS_PER_BEAT * layout.beat
            yield markup.tag(
                "rect", x=x, y=y, width=style.arrow * 0.54, height=height, rx=3, fill=colour, fill_opacity=HOLD_OPACITY
            )
            first = last


def _notes(sheet: Sheet, ticks: range) -> Iterator[str]:
    """Yield arrows and mines, and then the letters, so that no arrow hides the letter of another."""
    notes, marks = sheet.subject.chart.notes, []
    at = np.flatnonzero((notes.tick >= ticks.start) & (notes.tick < ticks.stop))
    for n in at.tolist():
        tick, lane, kind = int(notes.tick[n]), int(notes.column[n]), int(notes.kind[n])
        x, y = sheet.layout.x(tick, lane), sheet.layout.y(tick)
        if kind == Kind.MINE:
            yield _mine(sheet.style, x, y)
        elif kind == Kind.FAKE or (kind in STEP_KINDS and not notes.judged[n]):
            yield _arrow(sheet, lane, (x, y), sheet.style.colours["fake"], 0.45)
        elif kind in STEP_KINDS:
            yield _arrow(sheet, lane, (x, y), sheet.style.note_colour(tick), 0.4 if kind == Kind.LIFT else 1.0)
            if (tick, lane) in sheet.limbs:
                marks.append(mark(sheet.style, x, y, *sheet.limbs[tick, lane]))
    yield from marks


def _arrow(sheet: Sheet, lane: int, at: tuple[float, float], colour: str, opacity: float) -> str:
    angle = sheet.arrows[lane]
    move = f"translate({markup.number(at[0])} {markup.number(at[1])}) scale({markup.number(sheet.style.arrow)})"
    turn = f" rotate({markup.number(angle)})" if angle else ""
    return markup.tag(
        "use",
        href="#middle" if angle is None else "#arrow",
        transform=move + turn,
        fill=colour,
        fill_opacity=opacity,
        stroke=sheet.style.colours["ink"],
        stroke_width="0.045",
    )


def _mine(style: SheetStyle, x: float, y: float) -> str:
    r = style.arrow * 0.36
    cross = f"M{_point(x - r / 2, y - r / 2)} l{_point(r, r)} m{_point(0, -r)} l{_point(-r, r)}"
    disc = markup.tag("circle", cx=x, cy=y, r=r, fill=style.colours["mine"])
    return disc + markup.tag("path", d=cross, class_="cross")


def _point(x: float, y: float) -> str:
    return f"{markup.number(x)},{markup.number(y)}"


def mark(style: SheetStyle, x: float, y: float, limb: int, part: int) -> str:
    """Return the mark of a limb: L in a disc, R in a square, a hand in a lozenge, a toe with a small letter.

    The shapes can be distinguished without colours.
    """
    half, colour = style.mark / 2, style.limbs[limb] if limb >= 0 else style.colours["mine"]
    sign = letter(limb, part) if limb >= 0 else "?"
    ink = style.colours["ink"]
    if limb == 0:
        shape = markup.tag("circle", cx=x, cy=y, r=half, fill=colour, stroke=ink, stroke_width=0.6)
    elif limb == 1:
        shape = markup.tag(
            "rect",
            x=x - half + 0.4,
            y=y - half + 0.4,
            width=style.mark - 0.8,
            height=style.mark - 0.8,
            fill=colour,
            stroke=ink,
            stroke_width=0.6,
        )
    else:
        points = f"{_point(x, y - half - 1)} {_point(x + half + 1, y)} "
        points += f"{_point(x, y + half + 1)} {_point(x - half - 1, y)}"
        shape = markup.tag("polygon", points=points, fill=colour, stroke=ink, stroke_width=0.6)
    return shape + markup.text(sign, x, y + 3.1, "mark", text_anchor="middle")


def unsure_rows(sheet: Sheet) -> list[tuple[int, int, float]]:
    """Return row, tick and confidence in per cent of every row below `SheetStyle.unsure`; none if unknown."""
    play = sheet.subject.play
    if play is None or play.confidence is None:
        return []
    percent = 100 * play.confidence
    rows = np.flatnonzero((percent < sheet.style.unsure) & play.rows.steps.any(axis=1))
    return [(row, int(play.rows.tick[row]), float(percent[row])) for row in rows.tolist()]


def _unsure_bands(sheet: Sheet, ticks: range) -> Iterator[str]:
    """Yield a band across each unsure row, behind its notes."""
    for _, tick, percent in unsure_rows(sheet):
        if tick in ticks:
            left, width = sheet.layout.left(tick // TICKS_PER_MEASURE), sheet.layout.lanes * sheet.style.lane
            tooltip = markup.title(sheet.say("unsure", percent=f"{percent:.0f}"))
            yield markup.tag(
                "rect",
                tooltip,
                x=left,
                y=sheet.layout.y(tick) - 7,
                width=width,
                height=14,
                rx=4,
                fill=sheet.style.colours["unsure"],
                fill_opacity=_BAND_OPACITY,
            )


def _unsure_marks(sheet: Sheet, ticks: range) -> Iterator[str]:
    """Yield the confidence of each unsure row, in per cent, at the corner of its last note, above other arrows."""
    play = sheet.subject.play
    for row, tick, percent in unsure_rows(sheet):
        if play is not None and tick in ticks:
            lane = int(np.flatnonzero(play.rows.steps[row])[-1])
            corner, x, y = sheet.style.arrow / 2, sheet.layout.x(tick, lane), sheet.layout.y(tick)
            yield badge(sheet.style, x + corner - 1, y - corner + 3, percent)


def badge(style: SheetStyle, x: float, y: float, percent: float) -> str:
    """Return a confidence in per cent, white on a plate; x, y : its middle."""
    plate = markup.tag(
        "rect",
        x=x - 7,
        y=y - 5,
        width=14,
        height=10,
        rx=3,
        fill=style.colours["unsure"],
        stroke=style.colours["paper"],
        stroke_width=0.8,
    )
    return plate + markup.text(f"{percent:.0f}", x, y + 3, "sure", text_anchor="middle")


def _feet(sheet: Sheet, ticks: range) -> Iterator[str]:
    """Yield small diagrams of the pad for rows with crossed feet, as many as there is room for."""
    play, pad = sheet.subject.play, sheet.subject.pad
    if play is None or pad is None:
        return
    crossed = (np.abs(play.facing) > 90 + 1e-6) & play.rows.steps.any(axis=1) & (play.feet >= 0).all(axis=1)
    last = (-1.0, -math.inf)
    for row in np.flatnonzero(crossed).tolist():
        tick = int(play.rows.tick[row])
        if tick not in ticks:
            continue
        x = sheet.layout.left(tick // TICKS_PER_MEASURE) + sheet.layout.lanes * sheet.style.lane + 17
        y = sheet.layout.y(tick)
        if last[0] == x and y - last[1] < _FEET_SPACING:
            continue
        last = (x, y)
        yield _pose(sheet, x, y, play.feet[row].tolist(), float(play.facing[row]))


def _pose(sheet: Sheet, x: float, y: float, feet: Sequence[int], facing: float) -> str:
    """Return the panels around the feet from above, and two soles that point where the dancer faces."""
    pad, style = sheet.subject.pad, sheet.style
    assert pad is not None
    middle = pad.panels[list(feet)].mean(axis=0)
    near = [panel for panel in pad.panels if np.abs(panel - middle).max() <= 1.6]
    near += [pad.panels[column] for column in feet if np.abs(pad.panels[column] - middle).max() > 1.6]
    scale = 7.5
    parts = []
    for panel in near:
        px, py = x + (panel[0] - middle[0]) * scale, y - (panel[1] - middle[1]) * scale
        parts.append(markup.tag("rect", x=px - 3.4, y=py - 3.4, width=6.8, height=6.8, rx=1, class_="panel"))
    for limb, column in enumerate(feet):
        px, py = x + (pad.panels[column][0] - middle[0]) * scale, y - (pad.panels[column][1] - middle[1]) * scale
        turn = f"rotate({markup.number(-facing)} {markup.number(px)} {markup.number(py)})"
        parts.append(
            markup.tag("ellipse", cx=px, cy=py, rx=2.4, ry=4.6, fill=style.limbs[limb], class_="sole", transform=turn)
        )
    return markup.tag("g", markup.title(sheet.say("crossed", degrees=f"{facing:g}")) + "".join(parts))


def _finding_flags(sheet: Sheet, ticks: range) -> Iterator[str]:
    """Yield a line across the row of each finding, and the code of its rule beside it."""
    by_tick: dict[int, list[Finding]] = {}
    for finding in sheet.findings:
        if finding.beat is not None and (tick := round(finding.beat * TICKS_PER_BEAT)) in ticks:
            by_tick.setdefault(tick, []).append(finding)
    bottom = (-1.0, -math.inf)
    for tick, found in sorted(by_tick.items()):
        left = sheet.layout.left(tick // TICKS_PER_MEASURE)
        right, y = left + sheet.layout.lanes * sheet.style.lane, sheet.layout.y(tick)
        column = left
        for finding in sorted(found, key=lambda f: ("error", "warning", "info").index(f.severity)):
            colour = sheet.style.colours[finding.severity]
            label = y if bottom[0] != column else max(y, bottom[1] + 9)
            bottom = (column, label)
            line = markup.tag(
                "path",
                d=f"M{_point(left - 3, y)} H{markup.number(right + 2)}",
                stroke=colour,
                class_="flag",
            )
            lead = markup.tag(
                "path",
                d=f"M{_point(right + 31, y)} L{_point(right + 33, label)}",
                stroke=colour,
                class_="flag",
            )
            code = markup.text(finding.rule, right + 34, label + 2.5, "code", style=f"fill:{colour}")
            yield markup.tag("g", markup.title(f"{finding.rule} {sheet.message(finding)}") + line + lead + code)
