"""`--tech-counts`: our technique counts beside the game's, as a table in Markdown; and chart by chart."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from dancetutor_cli.chart.names import TICKS_PER_BEAT, TICKS_PER_MEASURE
from dancetutor_cli.lint.techniques import TEN, ComparedChart, TechniqueComparison
from dancetutor_cli.reports.terminal import safe, safe_path
from dancetutor_cli.run.errors import plural


def table_lines(found: TechniqueComparison) -> Iterator[str]:
    """Yield the table: for each technique the counts of both programs, their common count, and the charts alike."""
    rows = [["technique", "charts", "ours", "theirs", "both", "charts alike"]]
    for name in TEN:
        charts = [one for one in found.charts if name in one.theirs]
        if charts:
            ours, theirs = sum(len(one.ours[name]) for one in charts), sum(_count(one, name) for one in charts)
            both, alike = sum(one.shared(name) for one in charts), sum(not one.differs(name) for one in charts)
            share = f"{alike} ({100 * alike / len(charts):.0f} %)"
            rows.append([name, *map(str, (len(charts), ours, theirs, both)), share])
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for number, row in enumerate(rows):
        first, *others = zip(row, widths, strict=True)
        yield " | ".join([f"| {first[0]:<{first[1]}}", *(f"{cell:>{width}}" for cell, width in others)]) + " |"
        if number == 0:
            yield f"|{'-' * (widths[0] + 2)}|" + "".join(f"{'-' * (width + 1)}:|" for width in widths[1:])
    yield ""
    count = plural(len(found.charts), "chart")
    yield f"{count} of both; only ours: {found.only_ours}; only theirs: {found.only_theirs}"


def chart_lines(found: TechniqueComparison) -> Iterator[str]:
    """Yield a line for each technique in which a chart differs: measures of ours, or rows that only one side has."""
    for one in found.charts:
        for name in TEN:
            if name in one.theirs and one.differs(name):
                yield f"{safe_path(one.file)} [{safe(one.label)}] {name}: {_technique_line(one, name)}"


def _count(one: ComparedChart, name: str) -> int:
    theirs = one.theirs[name]
    return theirs if isinstance(theirs, int) else len(theirs)


def _technique_line(one: ComparedChart, name: str) -> str:
    ours, theirs = one.ours[name], one.theirs[name]
    if isinstance(theirs, int):
        where = _places("measures", [tick // TICKS_PER_MEASURE for tick in dict.fromkeys(ours)])
        return f"ours {len(ours)}{where}, theirs {theirs}"
    return f"{_side('ours', ours, theirs)}, {_side('theirs', theirs, ours)}"


def _side(whose: str, times: Sequence[int], others: Sequence[int]) -> str:
    only = sorted((Counter(times) - Counter(others)).elements())
    return f"{whose} {len(times)}{_places(f'only {whose}: beats', [tick / TICKS_PER_BEAT for tick in only])}"


def _places(what: str, places: Sequence[float]) -> str:
    named = list(dict.fromkeys(places))
    if not named:
        return ""
    words = " ".join(f"{place:.3f}".rstrip("0").rstrip(".") for place in named)
    return f" ({what} {words})"
