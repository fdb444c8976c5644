"""What is known of a pack: its charts, each once, and what is missing or stands out."""

from __future__ import annotations

import os
from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from dancetutor_cli.jobs.result import ChartResult, FileResult
from dancetutor_cli.library.pack_ini import pack_folder, read_pack_ini
from dancetutor_cli.reports.safe import safe, safe_path

# What a pack's charts are sorted by: name -> the moves that it is.
TECHNIQUES = {
    "crossovers": ("crossover-half", "crossover-full"),
    "footswitches": ("footswitch", "footswitch-up", "footswitch-down", "sideswitch-left", "sideswitch-right"),
    "brackets": ("bracket",),
    "doublesteps": ("doublestep",),
    "jacks": ("jack",),
    "spins": ("spin",),
    "hands": ("hand",),
}
_ORDER = ("Beginner", "Easy", "Medium", "Hard", "Challenge")
_MUSIC, _PAIR, _BROKEN = "DT107", "DT109", "DT101"
_MOST_HAVE = 0.8  # a difficulty that so many of the songs have is missed in the others
_FEWEST_SONGS = 5
_FEW = 2.0  # meters between label and estimate, from which on a chart stands out
_LEAST_ROWS = 8  # with a technique that a chart stands out for
_TIMES = 4.0  # how many times as much of a technique as the pack's charts of its meter have


@dataclass(frozen=True, slots=True)
class PackChart:
    """A chart of the pack. song : title for people; file : its path below the pack's folder"""

    song: str
    file: str
    result: ChartResult

    @property
    def name(self) -> str:
        """For people: "Max 300 Hard 9"."""
        return f"{self.song} {safe(self.result.difficulty)} {self.result.meter}"

    def rows_of(self, technique: str) -> int:
        """Rows with a technique."""
        return sum(self.result.counts.get(move, 0) for move in TECHNIQUES[technique])


class Pack:
    """Takes results as they come. A song that lies there as .sm and .ssc counts once: as .ssc, which games prefer."""

    def __init__(self) -> None:
        self._results: dict[str, FileResult] = {}
        self._unreadable: list[str] = []
        self.problems: dict[str, list[str]] = {"music": [], "differ": []}

    def add(self, result: FileResult) -> None:
        """Take note of a file. What is heavy of it (rows, excerpts) is not kept."""
        path = Path(result.path)
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
        if key not in self._results or path.suffix.lower() == ".ssc":
            charts = tuple(replace(chart, findings=(), rows=None, causes=None) for chart in result.charts)
            self._results[key] = replace(result, findings=(), charts=charts)

    @property
    def songs(self) -> int:
        """How many there are."""
        return len(self._results)

    @property
    def folder(self) -> str:
        """The folder that all of it is in."""
        paths = [os.path.dirname(os.path.abspath(one.path)) for one in self._results.values()]  # noqa: PTH100, PTH120
        return os.path.commonpath(paths) if paths else "."

    def _unread(self) -> Iterator[str]:
        """Files that could not be read, by their paths below the folder of everything that was looked at."""
        paths = [os.path.abspath(path) for path in (*self._unreadable, self.folder)]  # noqa: PTH100
        above = os.path.commonpath([os.path.dirname(path) for path in paths[:-1]] + paths[-1:])  # noqa: PTH120
        return (safe_path(os.path.relpath(path, above)) for path in paths[:-1])

    def charts(self) -> list[PackChart]:
        """Every chart that is danced, by song."""
        below, out = self.folder, []
        for result in self._results.values():
            name = safe_path(os.path.relpath(os.path.abspath(result.path), below))  # noqa: PTH100
            title = safe(result.title) or safe_path(Path(result.path).stem)
            out += [PackChart(title, name, chart) for chart in result.charts if chart.playable and chart.row_count]
        return out

    def missing(self) -> Iterator[str]:
        """What the pack lacks, a line each."""
        yield from self._missing_difficulties()
        for kind, said in (("music", "no music"), ("differ", ".sm and .ssc differ")):
            songs = list(dict.fromkeys(self.problems[kind]))
            if songs:
                yield f"{said}: {_some(songs)}"
        if self._unreadable:
            yield f"cannot be read: {_some(list(self._unread()))}"
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
                    yield f"no {safe(steps_type)} {name}: {_some(titles)}"

    def _sync(self) -> Iterator[str]:
        """What is wrong with the Pack.ini of each pack that files of these lie in."""
        folders = {pack_folder(Path(result.path).absolute()) for result in self._results.values()}
        beside = {Path(result.path).absolute().parent for result in self._results.values()}
        found = [ini for folder in sorted(folders | beside) if (ini := read_pack_ini(folder)) is not None]
        for ini in found:
            if ini.problem is not None:
                yield f"{safe_path(os.fspath(ini.path.parent.name))}/{safe(ini.path.name)}: {safe(ini.problem)}"
        if not found:
            yield "no Pack.ini, which tells ITGmania whether the sync is NULL or ITG"

    def outliers(self) -> Iterator[str]:
        """Charts that stand out, a line each, the farthest first."""
        charts = self.charts()
        off = [
            (abs(told.meter - one.result.meter), one, told.meter)
            for one in charts
            if (told := one.result.estimate) is not None and told.known and one.result.meter > 0
        ]
        for how_far, one, meter in sorted(off, key=lambda x: -x[0]):
            if how_far >= _FEW:
                yield f"{one.name} plays like {meter:.1f}"
        yield from (said for _, said in sorted(_much_of(charts), reverse=True))


def _much_of(charts: list[PackChart]) -> Iterator[tuple[float, str]]:
    """Charts with far more of a technique than others of about their meter: how many times, and a line."""
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
                rows = f"{one.rows_of(technique)} rows with {technique}, {share:.0%} of all"
                said = f"{one.name}: {rows} (others {usual:.0%})"
                yield share / usual, said


def _some(names: list[str], most: int = 3) -> str:
    """The first names and how many more there are."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return ", ".join(names[:most]) + more
