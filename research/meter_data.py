"""Charts from which meters are learned: their features and labels, and the labels that are not real meters."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from dancetutor_cli.chart.model import Song
from dancetutor_cli.chart.reader import load
from dancetutor_cli.chart.selection import find_files
from dancetutor_cli.lint.analysis import solve_selected
from dancetutor_cli.lint.meter.model import Feature, features_of
from dancetutor_cli.lint.meter.score import Oddities
from dancetutor_cli.lint.run import LintRequest, LintRun
from dancetutor_cli.run.errors import DancetutorError

HIGHEST = 30  # no pad's players count further without a joke
LEAST_ROWS, LEAST_SECONDS = 40, 30.0
SLOWEST = 0.5  # rows a second; a chart of meter 5 with fewer is a stub, or broken
DENSE_ONE = 2.0  # rows a second that no chart of meter 1 has


@dataclass(frozen=True)
class Labelled:
    """One chart with its meter. family : the same for all files of a song; values : of the features asked for

    oddities : what it is scored by, None on a pad without a model of meters; again : whether it equals one before in
    notes and meter
    """

    file: str
    tag: str
    family: str
    steps_type: str
    difficulty: str
    meter: int
    rows: int
    seconds: float
    values: tuple[float, ...]
    oddities: Oddities | None = None
    again: bool = False

    @property
    def density(self) -> float:
        """Rows a second."""
        return (self.rows - 1) / max(self.seconds, 1.0)


def labelled(folder: Path, wanted: Iterable[Feature]) -> list[Labelled]:
    """Every chart below a folder."""
    wanted, run = list(wanted), LintRun(LintRequest(config="default"))
    seen: set[tuple[str, int, bytes, bytes]] = set()
    families = Families()
    songs: list[tuple[Labelled, str]] = []
    for path in find_files([folder]):
        try:
            song = load(path)
        except DancetutorError:
            continue
        if is_modded(song):
            continue
        for subject in solve_selected(song, song.charts, run.task(path)):
            play, chart = subject.play, subject.chart
            if play is None or not subject.row_count or chart.player:  # a couple's meter is for both players
                continue
            key = (chart.steps_type, chart.meter, play.rows.steps.tobytes(), play.rows.second.round(2).tobytes())
            one = Labelled(
                str(path), song.tags.get("METERTYPE", ""), "", chart.steps_type, chart.difficulty, chart.meter,
                len(subject.step_rows), subject.seconds_played(), tuple(features_of([play], wanted)[0]),
                subject.oddities(), key in seen,
            )  # fmt: skip
            seen.add(key)
            songs.append((one, families.add(song.title, path)))
    return [replace(one, family=families.root(member)) for one, member in songs]


class Families:
    """Which files are the same song: by title, and by a number at the beginning of a file's name (g0037_...)."""

    def __init__(self) -> None:
        self._parent: dict[str, str] = {}

    def add(self, title: str, path: Path) -> str:
        """A member of the song's family."""
        name = "title " + re.sub(r"\W", "", title.lower())
        number = re.match(r"g\d+(?=_)", path.name)
        self._parent.setdefault(name, name)
        if number:
            self._parent.setdefault(number[0], number[0])
            self._parent[self.root(name)] = self.root(number[0])
        return name

    def root(self, member: str) -> str:
        """One name for a family."""
        while self._parent[member] != member:
            member = self._parent[member]
        return member


def is_modded(song: Song) -> bool:
    """Whether a song moves its arrows by a script: its meters count what is seen, too."""
    return "=" in song.tags.get("FGCHANGES", "")


def placeholder(one: Labelled, of_file: Iterable[Labelled]) -> str:
    """The reason why nothing can be learned from a chart's meter; "" if it is a real meter. of_file : the charts of its
    file and pad
    """
    others = list(of_file)
    if one.meter < 1 or one.meter > HIGHEST:
        return f"meter 0, or above {HIGHEST}"
    if one.rows < LEAST_ROWS or one.seconds < LEAST_SECONDS:
        return f"fewer than {LEAST_ROWS} rows or {LEAST_SECONDS:g} s"
    if len(others) >= 3 and len({other.meter for other in others}) == 1:
        return "three charts or more of one file, all of one meter"
    if one.meter == 1 and one.density > DENSE_ONE:
        return f"meter 1 with more than {DENSE_ONE:g} rows a second"
    if one.meter >= 5 and one.density < SLOWEST:
        return f"meter 5 or more with fewer than {SLOWEST:g} rows a second"
    return ""


def sorted_out(charts: Iterable[Labelled]) -> Iterator[tuple[Labelled, str]]:
    """Each chart with the reason to leave it out, or ""."""
    by_file: dict[tuple[str, str], list[Labelled]] = defaultdict(list)
    for one in charts:
        by_file[one.file, one.steps_type].append(one)
    for of_file in by_file.values():
        for one in of_file:
            yield one, placeholder(one, of_file)
