"""What the formats for other programs share: one entry per finding, with its file, its chart and a fingerprint."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePath

from dancetutor_cli.jobs.result import ChartResult, FileResult
from dancetutor_cli.lint.finding import Finding
from dancetutor_cli.reports.safe import safe, safe_path


@dataclass(frozen=True, slots=True)
class Entry:
    """A finding with where it is; texts are safe to print. `path` is relative to the working folder where it can be."""

    path: str
    finding: Finding
    chart: ChartResult | None
    fingerprint: str

    @property
    def message(self) -> str:
        """The finding's message with the edit that would mend it and the chart it is about."""
        better = self.finding.suggestion
        text = safe(self.finding.message) + (f"; better: {safe(better)}" if better else "")
        return f"{text} [{safe(self.chart.label)}]{self.moment}" if self.chart else text

    @property
    def moment(self) -> str:
        """ " measure 4 beat 16", or nothing."""
        beat, measure = self.finding.beat, self.finding.measure
        return "" if beat is None else f" measure {measure} beat {round(beat, 3):g}"

    @property
    def place(self) -> str:
        """Where in the chart, as a path: "dance-single Hard 8/measure 4/beat 16"; "" for the file itself."""
        if self.chart is None:
            return ""
        steps = [safe(self.chart.label)]
        if self.finding.beat is not None:
            steps += [f"measure {self.finding.measure}", f"beat {round(self.finding.beat, 3):g}"]
        return "/".join(steps)


def entries(result: FileResult) -> Iterator[Entry]:
    """Every finding of a file. The fingerprint is made of chart, beat and rule, so that it survives edits elsewhere."""
    path = relative(result.path)
    seen: dict[str, int] = {}
    for finding, chart in result.all_findings():
        place = "" if chart is None else f"{chart.steps_type}|{chart.difficulty}|{chart.description}{chart.whose}"
        beat = finding.line if finding.beat is None else round(finding.beat * 48)
        identity = f"{path}|{place}|{beat}|{finding.rule}"
        seen[identity] = seen.get(identity, 0) + 1
        text = f"{identity}|{seen[identity]}" if seen[identity] > 1 else identity
        yield Entry(path, finding, chart, hashlib.sha256(text.encode("utf-8", "replace")).hexdigest()[:32])


def relative(path: str) -> str:
    """`path` with forward slashes, relative to the working folder if it lies inside."""
    pure = PurePath(path)
    if pure.is_absolute() and pure.is_relative_to(Path.cwd()):
        pure = pure.relative_to(Path.cwd())
    return safe_path(pure.as_posix())
