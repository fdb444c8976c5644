"""The result of `analyze` for a file, as plain data, and the cache of results, kept as JSON after a checksum."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, fields, replace
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dancetutor_cli.chart.pack_files import feet_fingerprint
from dancetutor_cli.lint.findings import (
    RANKS,
    AlternativeResult,
    Cause,
    DifferentRun,
    Estimate,
    ExcerptRow,
    Figures,
    Finding,
    ScoreEstimate,
    Sync,
)
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.files import CHART_SUFFIXES, SONG_SUFFIXES
from dancetutor_cli.run.reading import CHART_LIMIT, read_bytes
from dancetutor_cli.run.stored_files import DAY, StoredFiles, program_stamp
from dancetutor_cli.run.trust import results_folder

if TYPE_CHECKING:
    from dancetutor_cli.lint.analysis import AnalyzeTask

# This module imports neither numpy nor numba, so that results can be read back quickly.


@dataclass(frozen=True, slots=True)
class ChartResult:
    """The result for one chart.

    rows, figures, alternatives, causes, ambiguous : None if the task does not want them; `rows` is the JSON text of the
        chart's rows (docs/formats.md)
    counts : name of the move -> number of rows in which it happens
    playable : False if the steps type has no pad; the chart then has no rows and no cost
    arrows : a sign for each panel, to draw rows with
    ambiguous : beat of each row with ties, and "resolved" or "open", see `feet.play.Ambiguity`
    player : number of the player whose part of a chart for several this is, from 1, else 0
    hash : the identifier of the chart on leaderboards, see `chart.hash`; None if it has none
    sync : the sync of a chart with timing or music of its own, if the task wants it; else None
    estimate : how hard the chart plays; None for a pad without a meter model
    score : how hard the chart is to score on; None for a pad without a score model
    preset : name of the cost preset, None without a pad; mismatch : a message if it is for other pads, else None
    """

    index: int
    steps_type: str
    difficulty: str
    meter: int
    description: str
    playable: bool
    row_count: int
    cost: int
    counts: Mapping[str, int]
    findings: tuple[Finding, ...]
    rows: str | None = None
    arrows: str = ""
    figures: Figures | None = None
    alternatives: tuple[AlternativeResult, ...] | None = None
    causes: tuple[Cause, ...] | None = None
    ambiguous: tuple[tuple[float, str], ...] | None = None
    preset: str | None = None
    mismatch: str | None = None
    estimate: Estimate | None = None
    player: int = 0
    hash: str | None = None
    score: ScoreEstimate | None = None
    sync: Sync | None = None

    @property
    def label(self) -> str:
        """The name of the chart for people: "dance-single Hard 8"; a player's part is "dance-couple Hard 8 P2"."""
        return f"{self.steps_type} {self.difficulty} {self.meter}{self.player_suffix}"

    @property
    def player_suffix(self) -> str:
        """The player in the label: " P1", " P2" and so on in a chart for several players, else ""."""
        return f" P{self.player}" if self.player else ""


@dataclass(frozen=True, slots=True)
class FileResult:
    """The result for one file: either an error in one line, or its charts. sync : None if the task does not want it"""

    path: str
    title: str
    artist: str
    error: str | None
    warnings: tuple[str, ...]
    findings: tuple[Finding, ...]  # about the file, not about one chart
    charts: tuple[ChartResult, ...]
    unselected: tuple[str, ...] = ()  # index and label of the charts that are not selected
    sync: Sync | None = None

    def at_least(self, severity: str) -> FileResult:
        """Return the result without findings of less severity, and without charts that then have no finding."""
        charts = (replace(c, findings=_at_least(c.findings, severity)) for c in self.charts)
        return replace(self, findings=_at_least(self.findings, severity), charts=tuple(c for c in charts if c.findings))

    def all_findings(self) -> Iterator[tuple[Finding, ChartResult | None]]:
        """Yield every finding with its chart, None for a finding about the file."""
        for finding in self.findings:
            yield finding, None
        for chart in self.charts:
            for finding in chart.findings:
                yield finding, chart


def _at_least(findings: tuple[Finding, ...], severity: str) -> tuple[Finding, ...]:
    return tuple(finding for finding in findings if RANKS[finding.severity] >= RANKS[severity])


# A `FileResult` as bytes and back: JSON after a checksum, so that a damaged or foreign file is not a result.
#
# No data that is read can run as code: JSON has only numbers and texts, and only this module's classes are made from
# it. Values are in lists, in the order of the fields, because a pack has thousands of findings.

_HEAD = b"dancetutor result 5\n"  # the number changes whenever the format below changes
_DIGEST = 32  # bytes of SHA-256
_CLASSES = (
    FileResult, ChartResult, Finding, Figures, AlternativeResult, DifferentRun, Cause, Estimate, ScoreEstimate, Sync,
)  # fmt: skip
_VALUES = {kind: attrgetter(*(field.name for field in fields(kind))) for kind in _CLASSES}
_CHART_FIELDS = tuple(field.name for field in fields(ChartResult))
_EXCERPT = [field.name for field in fields(Finding)].index("excerpt")


def to_bytes(result: FileResult, key: str) -> bytes:
    """Return a result as the content of its file. The checksum includes `key`, the hash of the dependencies."""
    text = json.dumps(result, default=lambda one: _VALUES[type(one)](one), separators=(",", ":"))
    data = text.encode("ascii")
    return _HEAD + _digest(data, key) + data


def from_bytes(content: bytes, key: str) -> FileResult | None:
    """Return the result in a file's content; None unless `to_bytes` made the content for this key."""
    data = content[len(_HEAD) + _DIGEST :]
    if content[: len(_HEAD)] != _HEAD or content[len(_HEAD) : len(_HEAD) + _DIGEST] != _digest(data, key):
        return None
    try:
        return _file(json.loads(data))
    except (ValueError, TypeError, KeyError, IndexError, RecursionError):
        return None  # another program made it, with a correct checksum


def _digest(data: bytes, key: str) -> bytes:
    return hashlib.sha256(key.encode() + b"\0" + data).digest()


def _file(values: list[Any]) -> FileResult:
    path, title, artist, error, warnings, findings, charts, unselected, sync = values
    return FileResult(
        path,
        title,
        artist,
        error,
        tuple(warnings),
        _read_findings(findings),
        tuple(map(_chart, charts)),
        tuple(unselected),
        _sync(sync),
    )


def _read_findings(listed: Iterable[list[Any]]) -> tuple[Finding, ...]:
    for values in listed:
        values[_EXCERPT] = tuple(ExcerptRow(*row) for row in values[_EXCERPT])
    return tuple(Finding(*values) for values in listed)


def _chart(values: list[Any]) -> ChartResult:
    given = dict(zip(_CHART_FIELDS, values, strict=True))
    given["findings"] = _read_findings(given["findings"])
    if given["figures"] is not None:
        mean, peak, breakdown, stream, tech, seconds, facing, hands = given["figures"]
        given["figures"] = Figures(mean, peak, breakdown, stream, tech, seconds, tuple(facing), hands)
    if given["alternatives"] is not None:
        given["alternatives"] = tuple(map(_alternative, given["alternatives"]))
    if given["causes"] is not None:
        given["causes"] = tuple(Cause(*cause) for cause in given["causes"])
    if given["ambiguous"] is not None:
        given["ambiguous"] = tuple(map(tuple, given["ambiguous"]))
    if given["estimate"] is not None:
        meter, low, high, scale, known, terms, rate = given["estimate"]
        given["estimate"] = Estimate(meter, low, high, scale, known, tuple(map(tuple, terms)), rate)
    if given["score"] is not None:
        meter, low, high, terms = given["score"]
        given["score"] = ScoreEstimate(meter, low, high, tuple(map(tuple, terms)))
    given["sync"] = _sync(given["sync"])
    return ChartResult(**given)


def _sync(values: list[Any] | None) -> Sync | None:
    return None if values is None else Sync(*values)


def _alternative(values: list[Any]) -> AlternativeResult:
    extra, terms, runs = values
    return AlternativeResult(extra, tuple(map(tuple, terms)), tuple(DifferentRun(*run) for run in runs))


# The cache: each result is a small file, named by the hash of everything that the result depends on.

_LARGEST = CHART_LIMIT  # bytes of a kept result
_LONGEST = 30 * DAY  # a result that is not used for so long is removed


class ResultCache:
    """A folder of results in files named by `key`. A file that cannot be read or written is never an error."""

    def __init__(self, folder: Path) -> None:
        self._files = StoredFiles(folder, longest=_LONGEST)
        self._listings: dict[Path, str] = {}

    def key(self, task: AnalyzeTask) -> str | None:
        """Return the hash of everything that the task's result depends on, or None if the result cannot be kept."""
        if task.want_rows or task.data is not None:
            return None
        try:
            data = read_bytes(task.path, CHART_LIMIT)
        except FileError:
            return None
        digest = hashlib.sha256(data)
        wanted = f"{task.path}|{task.path.absolute()}|{(task.presets, task.selection, task.options())}"
        for part in (program_stamp(), wanted, task.settings.fingerprint(), *self._dependencies(task.path)):
            digest.update(b"\0" + part.encode("utf-8", "surrogateescape"))
        return digest.hexdigest()

    def get(self, key: str) -> FileResult | None:
        """Return the result kept under a key, or None."""
        content = self._files.read(_name(key), _LARGEST)
        return None if content is None else from_bytes(content, key)

    def put(self, key: str, result: FileResult) -> None:
        """Keep a result under a key."""
        self._files.write(_name(key), to_bytes(result, key))

    def prune(self) -> None:
        """Remove results that have not been used for a long time."""
        self._files.prune()

    def _dependencies(self, path: Path) -> Iterator[str]:
        """Yield the other dependencies of a result: music and pictures by size and time, feet, the other format."""
        if path.parent not in self._listings:
            self._listings[path.parent] = _listing(path.parent)
        yield self._listings[path.parent]
        yield feet_fingerprint(path)
        for suffix in SONG_SUFFIXES:
            other = path.with_suffix(suffix)
            if other != path:
                with suppress(FileError):
                    yield hashlib.sha256(read_bytes(other, CHART_LIMIT)).hexdigest()


def _name(key: str) -> str:
    return f"{key[:2]}/{key[2:]}"


def default_folder() -> Path | None:
    """Return the folder for results in the user's cache, or in DANCETUTOR_CACHE; None if results cannot be kept."""
    folder, _ = results_folder()
    return None if folder is None else folder / "analyze"


def _listing(folder: Path) -> str:
    lines = []
    for entry in sorted(os.scandir(folder), key=lambda e: e.name):
        with suppress(OSError):  # a circle of links
            if entry.is_file() and not entry.name.lower().endswith(CHART_SUFFIXES):
                stat = entry.stat()
                lines.append(f"{entry.name} {stat.st_size} {stat.st_mtime_ns}")
    return "\n".join(lines)
