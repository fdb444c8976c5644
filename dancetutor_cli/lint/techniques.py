"""Our technique counts beside the counts of ITGmania, from its song cache or from CSV tables with its names."""

from __future__ import annotations

import csv
import io
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from dancetutor_cli.chart.msd import Tag, plain, scan
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.chart.names import difficulty as named
from dancetutor_cli.lint.analysis import AnalyzeTask, load_song, solve_selected
from dancetutor_cli.lint.figures import tech_rows
from dancetutor_cli.run.errors import DancetutorError, FileError, UsageError
from dancetutor_cli.run.foreign_text import text_of
from dancetutor_cli.run.reading import CHART_LIMIT, read_bytes

# A file of the cache (`Cache/Songs` in the game's folder) is an .ssc without a suffix and without notes. Each chart has
# the game's counts (`#TECHCOUNTS`: with six decimals, the same numbers for each of two players) and, last, the path of
# its file (`#STEPFILENAME:/Songs/Pack/Song/song.ssc`). A player has ten numbers since ITGmania counts half and full
# crossovers apart. Before, a player had six numbers, and five before the game counted doublesteps. The game finds feet
# only for dance-single and dance-double; for other steps types it writes zeros without meaning.
#
# A cache has numbers but no rows, so the number of shared occurrences is at most the lesser number. A CSV with the beat
# of each occurrence shows which rows are the same.

TEN = (
    "Crossovers", "HalfCrossovers", "FullCrossovers", "Footswitches", "UpFootswitches", "DownFootswitches",
    "Sideswitches", "Jacks", "Brackets", "Doublesteps",
)  # fmt: skip
SIX = ("Crossovers", "Footswitches", "Sideswitches", "Jacks", "Brackets", "Doublesteps")
FIVE = SIX[:5]
COMPARED_STEPS_TYPES = ("dance-single", "dance-double")  # steps types that the game has a pad for
# Technique -> number of occurrences, or the tick of each occurrence, ascending.
GameCounts = Mapping[str, int] | Mapping[str, Sequence[int]]
_PLAYERS = 2  # the game writes the numbers of two players for every chart
_MOST = 1_000_000  # most occurrences in a chart


@dataclass(frozen=True, slots=True)
class Key:
    """The key of a chart: its song's folder and file, both in lower case; steps type, difficulty and description."""

    song: tuple[str, ...]
    steps_type: str
    difficulty: str
    description: str


@dataclass(frozen=True, slots=True)
class ComparedChart:
    """A chart that both programs know. ours : technique -> tick of each occurrence, ascending; theirs : `GameCounts`"""

    file: str
    label: str
    ours: Mapping[str, Sequence[int]]
    theirs: GameCounts

    def shared_count(self, name: str) -> int:
        """Return the number of occurrences in the same row; if only numbers are known, the most that this can be."""
        ours, theirs = self.ours[name], self.theirs[name]
        if isinstance(theirs, int):
            return min(len(ours), theirs)
        return (Counter(ours) & Counter(theirs)).total()

    def differs(self, name: str) -> bool:
        """Whether the numbers differ or, if rows are known, any row differs."""
        theirs = self.theirs[name]
        return len(self.ours[name]) != theirs if isinstance(theirs, int) else [*self.ours[name]] != [*theirs]


@dataclass
class TechniqueComparison:
    """All charts that both programs know, and how many charts only one of them has."""

    charts: list[ComparedChart] = field(default_factory=list)
    only_ours: int = 0
    only_theirs: int = 0


def read_game_counts(path: Path) -> Mapping[Key, GameCounts]:
    """Return the game's counts from a CSV file, a file of its cache, or a folder of cache files.

    UsageError if there are no counts.
    """
    found: Mapping[Key, GameCounts]
    if path.is_file() and path.suffix.lower() == ".csv":
        rows = list(_table_rows(path))
        found = (
            _technique_times(path, rows)
            if rows and {"technique", "beat"} <= rows[0][1].keys()
            else dict(_table(path, rows))
        )
    else:
        files = [path] if path.is_file() else sorted(one for one in path.rglob("*") if one.is_file())
        found = {key: counts for file in files for key, counts in _cached(file)}
    if not found:
        raise UsageError(f"{path}: has no #TECHCOUNTS; name ITGmania's Cache/Songs, or a CSV with its technique names")
    return found


def _cached(path: Path) -> Iterator[tuple[Key, dict[str, int]]]:
    try:
        data = read_bytes(path, CHART_LIMIT)
    except FileError:
        return
    values: dict[str, str] = {}
    for tag in [*scan(data), Tag("NOTEDATA", len(data), ())]:
        if tag.name != "NOTEDATA":
            values[tag.name] = _text(data, tag)
            continue
        counts = _counts(values.get("TECHCOUNTS", ""))
        if counts is not None and values.get("STEPSTYPE", "").lower() in COMPARED_STEPS_TYPES:
            # A chart in the cache names its file. Another .ssc with TECHCOUNTS has the counts of its own charts.
            name = values.get("STEPFILENAME") or path.as_posix()
            description = values.get("DESCRIPTION", "")
            yield _key(name, values.get("STEPSTYPE", ""), values.get("DIFFICULTY", ""), description), counts
        values = {}


def _text(data: bytes, tag: Tag) -> str:
    return plain(data[slice(*tag.spans[0])]).decode("utf-8", "replace").strip() if tag.spans else ""


def _counts(text: str) -> dict[str, int] | None:
    """Return the first player's numbers by name; None for a list of another length, or with -1 (not counted)."""
    try:
        numbers = [round(float(part)) for part in text.split(",")]
    except (ValueError, OverflowError):
        return None
    for names in (TEN, SIX, FIVE):
        if len(numbers) == _PLAYERS * len(names) and all(0 <= n <= _MOST for n in numbers):
            return dict(zip(names, numbers, strict=False))
    return None


def _table_rows(path: Path) -> Iterator[tuple[int, dict[str, str]]]:
    """Yield line number and cells of each row of a CSV file."""
    text = io.StringIO(read_bytes(path, CHART_LIMIT).decode("utf-8-sig", "replace"), newline="")
    for number, row in enumerate(csv.DictReader(text), 2):
        yield number, {name: text_of(value or "") for name, value in row.items() if name}


def _table(path: Path, rows: Iterable[tuple[int, dict[str, str]]]) -> Iterator[tuple[Key, dict[str, int]]]:
    """Yield the counts of a table with a chart in each row.

    Its columns are file, steps_type, difficulty, description and names of techniques.
    """
    for number, row in rows:
        try:
            counts = {name: round(float(row[name])) for name in TEN if row.get(name)}
        except (ValueError, OverflowError) as error:
            raise FileError(path, "a count is not a number", number) from error
        if counts:
            yield _key_of(row), counts


def _technique_times(path: Path, rows: Sequence[tuple[int, dict[str, str]]]) -> dict[Key, dict[str, list[int]]]:
    """Return the ticks of a table with an occurrence in each row.

    Its columns name the chart, the technique and the beat. A row without a technique only names a chart.
    """
    names = [name for name in TEN if any(row["technique"] == name for _, row in rows)]
    found: dict[Key, dict[str, list[int]]] = {}
    for number, row in rows:
        times = found.setdefault(_key_of(row), {name: [] for name in names})
        if row["technique"] in times:
            try:
                times[row["technique"]].append(round(float(row["beat"]) * TICKS_PER_BEAT))
            except (ValueError, OverflowError) as error:
                raise FileError(path, "a beat is not a number", number) from error
    for times in found.values():
        for ticks in times.values():
            ticks.sort()
    return found if names else {}


def _key_of(row: Mapping[str, str]) -> Key:
    return _key(*(row.get(name, "") for name in ("file", "steps_type", "difficulty", "description")))


def _key(file: str, steps_type: str, difficulty: str, description: str) -> Key:
    parts = PurePosixPath(file.replace("\\", "/").lower()).parts
    return Key(parts[-2:], steps_type.strip().lower(), named(difficulty, description, 0, True)[0], description.strip())


def compare_techniques(tasks: Iterable[AnalyzeTask], theirs: Mapping[Key, GameCounts]) -> TechniqueComparison:
    """Return our counts beside the game's for every chart that the game knows; unreadable files are left out."""
    found, seen = TechniqueComparison(), set[Key]()
    by_chart: dict[tuple[object, ...], list[Key]] = defaultdict(list)
    for key in theirs:
        by_chart[key.song, key.steps_type, key.difficulty].append(key)
    songs = {key.song for key in theirs}
    for task in tasks:
        if _key(task.path.absolute().as_posix(), "", "", "").song not in songs:
            continue
        try:
            song = load_song(task)
        except DancetutorError:
            continue
        for subject in solve_selected(song, task.selection.charts(song), task):
            chart, play = subject.chart, subject.play
            if play is None or chart.player:  # the game finds no feet in charts for two
                continue
            mine = _key(task.path.absolute().as_posix(), chart.steps_type, chart.difficulty, chart.description)
            near = by_chart[mine.song, mine.steps_type, mine.difficulty]
            same = mine if mine in theirs else near[0] if len(near) == 1 else None
            if same is None or same in seen:
                found.only_ours += 1
                continue
            seen.add(same)
            ours = {name: sorted(play.rows.tick[rows].tolist()) for name, rows in tech_rows(subject).items()}
            found.charts.append(ComparedChart(task.path.as_posix(), chart.label, ours, theirs[same]))
    found.only_theirs = len(theirs) - len(seen)
    return found
