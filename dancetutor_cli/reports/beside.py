"""Our technique counts beside the game's, as a table in Markdown; and chart by chart where they differ."""

from __future__ import annotations

from collections.abc import Iterator

from dancetutor_cli.jobs.beside import TEN, Beside, Compared
from dancetutor_cli.reports.safe import safe, safe_path

_PLACES = 12  # measures of a chart that are named


def table_lines(found: Beside) -> Iterator[str]:
    """The table: for each technique how often each counts it, how often both do in the same chart, charts alike."""
    rows = [["technique", "charts", "ours", "theirs", "both", "charts alike"]]
    for name in TEN:
        pairs = [(len(one.ours[name]), one.theirs[name]) for one in found.charts if name in one.theirs]
        if pairs:
            ours, theirs = (sum(pair[side] for pair in pairs) for side in (0, 1))
            both, alike = sum(map(min, pairs)), sum(a == b for a, b in pairs)
            share = f"{alike} ({100 * alike / len(pairs):.0f} %)"
            rows.append([name, *map(str, (len(pairs), ours, theirs, both)), share])
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for number, row in enumerate(rows):
        first, *others = zip(row, widths, strict=True)
        yield " | ".join([f"| {first[0]:<{first[1]}}", *(f"{cell:>{width}}" for cell, width in others)]) + " |"
        if number == 0:
            yield f"|{'-' * (widths[0] + 2)}|" + "".join(f"{'-' * (width + 1)}:|" for width in widths[1:])
    yield ""
    count = f"{len(found.charts)} chart{'' if len(found.charts) == 1 else 's'}"
    yield f"{count} of both; only ours: {found.only_ours}; only theirs: {found.only_theirs}"


def chart_lines(found: Beside) -> Iterator[str]:
    """Every chart whose counts differ, a technique a line, with the measures of ours: each can be looked at."""
    for one in found.charts:
        for name in TEN:
            if name in one.theirs and len(one.ours[name]) != one.theirs[name]:
                yield f"{safe_path(one.file)} [{safe(one.label)}] {name}: {_told(one, name)}"


def _told(one: Compared, name: str) -> str:
    measures = list(dict.fromkeys(one.ours[name]))
    places = " ".join(map(str, measures[:_PLACES])) + (" ..." if len(measures) > _PLACES else "")
    where = f" (measures {places})" if measures else ""
    return f"ours {len(one.ours[name])}{where}, theirs {one.theirs[name]}"
