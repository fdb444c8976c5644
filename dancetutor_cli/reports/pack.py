"""A pack as data and as a few lines of text: its charts, what is missing, what stands out; its technique counts."""

from __future__ import annotations

import os
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from dancetutor_cli.chart.names import TICKS_PER_BEAT, TICKS_PER_MEASURE
from dancetutor_cli.chart.pack_files import pack_folder, read_pack_ini
from dancetutor_cli.chart.selection import is_preferred
from dancetutor_cli.lint.findings import RANKS, Finding
from dancetutor_cli.lint.results import ChartResult, FileResult
from dancetutor_cli.lint.techniques import TEN, ComparedChart, TechniqueComparison
from dancetutor_cli.reports.analyze_formats import measures_text
from dancetutor_cli.reports.terminal import cut
from dancetutor_cli.run.errors import plural
from dancetutor_cli.run.foreign_text import safe, safe_path

# The techniques that are counted in a pack's charts: name -> moves.
TECHNIQUES = {
    "crossovers": ("crossover-half", "crossover-full"),
    "footswitches": ("footswitch", "footswitch-up", "footswitch-down", "sideswitch-left", "sideswitch-right"),
    "brackets": ("bracket",),
    "doublesteps": ("doublestep",),
    "jacks": ("jack",),
    "spins": ("spin",),
    "hand presses": ("hand",),
}
_SHORT = {"crossovers": "XO", "footswitches": "FS", "doublesteps": "DS"}  # players' abbreviations
_ORDER = ("Beginner", "Easy", "Medium", "Hard", "Challenge")
_MUSIC, _PAIR = "DT107", "DT109"
_MOST_HAVE = 0.8  # share of the songs with a difficulty, from which it counts as missing in the others
_FEWEST_SONGS = 5
_FEW = 2.0  # levels between label and estimate, from which a chart stands out
_LEAST_ROWS = 8  # rows with a technique that a chart needs to stand out
_NAMES = 3  # limit of the names in a line
_TIMES = 4.0  # a chart stands out with this many times the technique of the pack's charts near its meter


@dataclass(frozen=True, slots=True)
class PackChart:
    """A chart of the pack. song : title for people; file : its path below the pack's folder"""

    song: str
    file: str
    result: ChartResult

    @property
    def name(self) -> str:
        """The chart's name for people: "Max 300, Hard 9"."""
        return f"{self.song}, {safe(self.result.difficulty)} {self.result.meter}"

    def rows_of(self, technique: str) -> int:
        """Return the number of rows with a technique."""
        return sum(self.result.counts.get(move, 0) for move in TECHNIQUES[technique])


@dataclass(frozen=True, slots=True)
class FileNeed:
    """The findings of a file that need action. what : a line for each rule in each chart, errors first"""

    file: str
    errors: int
    warnings: int
    what: tuple[str, ...]

    @staticmethod
    def of(result: FileResult) -> FileNeed:
        found = [(one, chart) for one, chart in result.all_findings() if one.severity != "info"]
        found.sort(key=lambda pair: -RANKS[pair[0].severity])
        kinds: dict[tuple[str, str], list[Finding]] = {}
        for one, chart in found:
            kinds.setdefault(("" if chart is None else chart.label, one.rule), []).append(one)
        errors = sum(one.severity == "error" for one, _ in found)
        what = tuple(_need(label, of_kind) for (label, _), of_kind in kinds.items())
        return FileNeed(result.path, errors, len(found) - errors, what)


def _need(label: str, found: Sequence[Finding]) -> str:
    times = f" {len(found)} times" if len(found) > 1 else ""
    message = f": {safe(found[0].message)}" if len(found) == 1 else ""
    chart = f"{safe(label)}: " if label else ""
    return f"{chart}{found[0].rule} {found[0].name}{times}{measures_text(found)}{message}"


class Pack:
    """The results of a pack. A song with a .sm and a .ssc file counts once: as .ssc, which the games prefer."""

    def __init__(self) -> None:
        self._results: dict[str, FileResult] = {}
        self._unreadable: list[str] = []
        self.problems: dict[str, list[str]] = {"music": [], "differ": []}
        self._needs: dict[str, FileNeed] = {}

    def add(self, result: FileResult) -> None:
        """Add a file. Its large parts (rows, excerpts) are not kept."""
        path = Path(result.path)
        if path.is_dir() and result.error is None:  # findings about the pack itself
            return
        title = safe(result.title) or safe_path(path.stem)
        if result.error is not None:
            self._unreadable.append(result.path)
            return
        rules = {finding.rule for finding in result.findings}
        if _MUSIC in rules:
            self.problems["music"].append(title)
        if _PAIR in rules:
            self.problems["differ"].append(title)
        key = os.fspath(path.with_suffix(""))
        if key not in self._needs or is_preferred(path):
            self._needs[key] = FileNeed.of(result)
        if key not in self._results or is_preferred(path):
            charts = tuple(replace(chart, findings=(), rows=None, causes=None) for chart in result.charts)
            self._results[key] = replace(result, findings=(), charts=charts)

    def needs(self) -> Iterator[FileNeed]:
        """Yield the files with errors and warnings, the worst first, with paths below the pack's folder."""
        found = [one for one in self._needs.values() if one.errors or one.warnings]
        for one in sorted(found, key=lambda need: (-need.errors, -need.warnings, need.file)):
            yield replace(one, file=safe_path(os.path.relpath(os.path.abspath(one.file), self.folder)))  # noqa: PTH100

    @property
    def songs(self) -> int:
        """The number of songs."""
        return len(self._results)

    @property
    def folder(self) -> str:
        """The folder that contains all songs."""
        paths = [os.path.dirname(os.path.abspath(one.path)) for one in self._results.values()]  # noqa: PTH100, PTH120
        return os.path.commonpath(paths) if paths else "."

    def _unread(self) -> Iterator[str]:
        """Return the files that could not be read, by their paths below the folder that contains all files."""
        paths = [os.path.abspath(path) for path in (*self._unreadable, self.folder)]  # noqa: PTH100
        above = os.path.commonpath([os.path.dirname(path) for path in paths[:-1]] + paths[-1:])  # noqa: PTH120
        return (_below(path, above) for path in paths[:-1])

    def charts(self) -> list[PackChart]:
        """Return every playable chart with steps, song by song."""
        below, out = self.folder, []
        for result in self._results.values():
            name = _below(result.path, below)
            title = safe(result.title) or safe_path(Path(result.path).stem)
            out += [PackChart(title, name, chart) for chart in result.charts if chart.playable and chart.row_count]
        return out

    def missing_lines(self) -> Iterator[str]:
        """Yield a line for each thing that is missing or wrong in the pack."""
        yield from self._missing_difficulties()
        for kind, words in (("music", "missing: music of"), ("differ", "wrong: .sm and .ssc differ:")):
            songs = list(dict.fromkeys(self.problems[kind]))
            if songs:
                yield f"{words} {_some(songs)}"
        if self._unreadable:
            yield f"wrong: cannot be read: {_some(list(self._unread()), 'files')}"
        yield from self._sync()

    def _missing_difficulties(self) -> Iterator[str]:
        by_type: dict[str, dict[str, set[str]]] = defaultdict(dict)
        for path, result in self._results.items():
            for chart in result.charts:
                by_type[chart.steps_type].setdefault(path, set()).add(chart.difficulty)
        for steps_type, songs in sorted(by_type.items()):
            counted = Counter(name for has in songs.values() for name in has if name in _ORDER)
            for name in _ORDER:
                lacking = [path for path, has in songs.items() if name not in has]
                if lacking and len(songs) >= _FEWEST_SONGS and counted[name] >= _MOST_HAVE * len(songs):
                    titles = [safe(self._results[path].title) or safe_path(Path(path).name) for path in lacking]
                    yield f"missing: {safe(steps_type)} {name} of {_some(titles)}"

    def _sync(self) -> Iterator[str]:
        """Yield a line for each problem of a Pack.ini, or one if no pack of these files has a Pack.ini."""
        folders = {pack_folder(Path(result.path).absolute()) for result in self._results.values()}
        beside = {Path(result.path).absolute().parent for result in self._results.values()}
        found = [ini for folder in sorted(folders | beside) if (ini := read_pack_ini(folder)) is not None]
        for ini in found:
            if ini.problem is not None:
                yield f"wrong: {safe_path(os.fspath(ini.path.parent.name))}/{safe(ini.path.name)}: {safe(ini.problem)}"
        if not found:
            yield "missing: Pack.ini (its SyncOffset says whether the songs use null or ITG sync)"

    def outliers(self) -> Iterator[str]:
        """Yield a line for each chart that stands out, the farthest first."""
        charts = self.charts()
        off = [
            (abs(estimate.meter - one.result.meter), one, estimate.meter, estimate.scale_name)
            for one in charts
            if (estimate := one.result.estimate) is not None and estimate.is_scale_known and one.result.meter > 0
        ]
        for how_far, one, meter, scale_name in sorted(off, key=lambda x: -x[0]):
            if how_far >= _FEW:
                beside = "above" if meter > one.result.meter else "below"
                yield f"{one.name}: plays like {scale_name} {meter:.1f}, {how_far:.1f} levels {beside} its meter"
        yield from (words for _, words in sorted(_much_of(charts), reverse=True))


def _below(path: str, folder: str) -> str:
    """Return a file's path below a folder, for people; links are not followed."""
    return safe_path(os.path.relpath(os.path.abspath(path), folder))  # noqa: PTH100


def _much_of(charts: list[PackChart]) -> Iterator[tuple[float, str]]:
    """Yield a ratio and a line for each chart with far more of a technique than others near its meter."""
    for technique in TECHNIQUES:
        shares: dict[tuple[str, int], list[float]] = defaultdict(list)
        for one in charts:
            for meter in range(one.result.meter - 1, one.result.meter + 2):
                shares[one.result.steps_type, meter].append(one.rows_of(technique) / one.result.row_count)
        for one in charts:
            others = shares[one.result.steps_type, one.result.meter]
            usual = max(sum(others) / len(others), 0.01)
            share = one.rows_of(technique) / one.result.row_count
            enough = one.rows_of(technique) >= _LEAST_ROWS and len(others) >= _FEWEST_SONGS
            if enough and share >= _TIMES * usual:
                beside = f"{100 * share:.0f} % of rows (this meter: {100 * usual:.0f} %)"
                words = f"{one.name}: {_SHORT.get(technique, technique)} in {beside}"
                yield share / usual, words


def _some(names: list[str], what: str = "songs") -> str:
    """Return the names; of many names, their number and the first ones."""
    return f"{len(names)} {what}: {', '.join(names[:_NAMES])}, ..." if len(names) > _NAMES else ", ".join(names)


# A pack in a few lines of text, at the end of a run over many songs.

LINES = 11  # limit of lines, few enough to paste into a chat
_TYPES, _OUTLIERS, _MISSING = 2, 3, 3


def pack_lines(pack: Pack, width: int) -> list[str]:
    """Return at most `LINES` lines about a pack, none wider than `width`."""
    charts = pack.charts()
    if not charts:
        return []
    counts = f"{plural(pack.songs, 'song')}, {plural(len(charts), 'chart')}"
    lines = [f"pack {safe_path(pack.folder.rsplit('/', 1)[-1])}: {counts}"]
    types = Counter(one.result.steps_type for one in charts)
    for steps_type, _ in types.most_common(_TYPES):
        lines.append(_meters_line(steps_type, [one for one in charts if one.result.steps_type == steps_type]))
    lines.append(_by_technique(charts))
    lines += _listed("", pack.missing_lines(), _MISSING)
    lines += _listed("stands out: ", pack.outliers(), _OUTLIERS)
    return [cut(line, width) for line in lines[:LINES]]


def _meters_line(steps_type: str, charts: list[PackChart]) -> str:
    """Return the number of charts, the middle half of their meters, and that of estimates on the commonest scale."""
    estimates = [one.result.estimate for one in charts if one.result.estimate]
    scales = Counter(one.scale_name for one in estimates).most_common(1)
    like = ""
    for scale, number in scales:
        plays = _middle([round(one.meter) for one in estimates if one.scale_name == scale])
        like = f", playing like {scale} {plays}" if number == len(charts) else f"; {number} play like {scale} {plays}"
    half = "middle half " if len(charts) > 1 else ""
    rated = f"{half}rated {_middle([one.result.meter for one in charts])}"
    return f"  {safe(steps_type)}: {plural(len(charts), 'chart')}, {rated}{like}"


def _middle(meters: list[int]) -> str:
    """Return the quartiles, "4 to 10", or one number if they are equal."""
    ordered = sorted(meters)
    low, high = ordered[len(ordered) // 4], ordered[-1 - len(ordered) // 4]
    return f"{low} to {high}" if low != high else f"{low}"


def _by_technique(charts: list[PackChart]) -> str:
    """Return a line with the number of charts that have each technique."""
    counts = {technique: sum(one.rows_of(technique) > 0 for one in charts) for technique in TECHNIQUES}
    first, *others = [(_SHORT.get(name, name), count) for name, count in counts.items() if count] or [("steps", 0)]
    return f"  {first[0]} in {plural(first[1], 'chart')}" + "".join(f", {name} {count}" for name, count in others)


def _listed(what: str, words: Iterable[str], most: int) -> Iterator[str]:
    lines = list(words)
    for line in lines[:most]:
        yield f"  {what}{line}"
    if len(lines) > most:
        yield f"  ... and {len(lines) - most} more such lines; --report-html FILE lists them"


# `--tech-counts`: our technique counts beside the game's, as a table in Markdown; and chart by chart.


def table_lines(found: TechniqueComparison) -> Iterator[str]:
    """Yield the table: for each technique the counts of both programs, their common count, and the charts alike."""
    rows = [["technique", "charts", "ours", "theirs", "both", "charts alike"]]
    for name in TEN:
        charts = [one for one in found.charts if name in one.theirs]
        if charts:
            ours, theirs = sum(len(one.ours[name]) for one in charts), sum(_count(one, name) for one in charts)
            both, alike = sum(one.shared_count(name) for one in charts), sum(not one.differs(name) for one in charts)
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
