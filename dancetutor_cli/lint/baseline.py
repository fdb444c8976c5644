"""The baseline: accepted findings that are not reported again, identified by chart, beat and rule."""

from __future__ import annotations

import json
import os
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.run.errors import FileError, MissingFileError
from dancetutor_cli.run.files import encode_json, write_atomic
from dancetutor_cli.run.reading import read_json

if TYPE_CHECKING:
    from dancetutor_cli.lint.findings import Finding

SCHEMA = 1
NO_BEAT = -(2**31)  # the place of a finding about a whole chart
# path of the chart file relative to the baseline's folder, chart, rule, beat in 1/48 (the line, for a file's finding)
Key = tuple[str, str, str, int]


@dataclass
class Baseline:
    """Accepted findings and how often each may occur. Each match lowers the count that remains."""

    path: Path
    allowed: Counter[Key] = field(default_factory=Counter)
    _remaining: Counter[Key] = field(default_factory=Counter)
    _ran: dict[tuple[str, str], set[str]] = field(default_factory=dict)
    _whole: dict[str, set[str]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._remaining = Counter(self.allowed)

    def key(self, file: str, chart: str, finding: Finding) -> Key:
        """Return the key that identifies a finding: file, chart, rule and beat."""
        if finding.beat is None:
            place = NO_BEAT if chart else finding.line or 0
        else:
            place = round(finding.beat * TICKS_PER_BEAT)
        return self._relative(file), chart, finding.rule, place

    def absorbs(self, key: Key) -> bool:
        """Whether the baseline accepts a finding. Each call uses up one occurrence of the entry."""
        if self._remaining[key] <= 0:
            return False
        self._remaining[key] -= 1
        return True

    def mark_seen(self, file: str, chart: str, rules: Iterable[str]) -> None:
        """Remember which rules ran on a chart, or with chart "" on the file: only their entries can be unused."""
        self._ran.setdefault((self._relative(file), chart), set()).update(rules)

    def mark_all_seen(self, file: str) -> None:
        """Remember that every chart of a file was analysed: entries with any other chart are of a removed chart."""
        name = self._relative(file)
        self._whole[name] = set().union(*(rules for (of, _), rules in self._ran.items() if of == name))

    def unused_keys(self) -> list[Key]:
        """Return the entries that no finding matched although their rule ran. They are no longer needed."""
        return sorted(key for key, count in self._remaining.items() if count > 0 and self._could_match(key))

    def replaced(self, keys: Iterable[Key]) -> Baseline:
        """Return a baseline with these findings, and with the old entries of charts and rules that did not run."""
        kept = Counter({key: count for key, count in self.allowed.items() if not self._could_match(key)})
        return Baseline(self.path, kept + Counter(keys))

    def _could_match(self, key: Key) -> bool:
        file, chart, rule, _ = key
        ran = self._ran.get((file, chart))
        return rule in (self._whole.get(file, set()) if ran is None else ran)

    def write(self) -> None:
        """Write the file with sorted entries, one on each line."""
        entries = [json.dumps(_entry(key, count), ensure_ascii=False) for key, count in sorted(self.allowed.items())]
        body = ",\n  ".join(entries)
        text = f'{{"schema": {SCHEMA}, "entries": [\n  {body}\n]}}\n'
        write_atomic(self.path, encode_json(text))

    def _relative(self, file: str) -> str:
        return Path(os.path.relpath(Path(file).absolute(), self.path.absolute().parent)).as_posix()


def _entry(key: Key, count: int) -> dict[str, Any]:
    file, chart, rule, place = key
    beat = None if place == NO_BEAT else round(place / TICKS_PER_BEAT, 6)
    where = {"beat": beat} if chart else {"line": place}
    return {"file": file, "chart": chart, "rule": rule, **where, **({"count": count} if count > 1 else {})}


def load_baseline(path: Path) -> Baseline:
    """Read a baseline; FileError says which entry or key is wrong."""
    try:
        data = read_json(path, writer="--update-baseline")
    except MissingFileError:
        raise FileError(path, "there is no such baseline; add --update-baseline to make it") from None
    if not isinstance(data, Mapping) or data.get("schema") != SCHEMA or not isinstance(data.get("entries"), list):
        raise FileError(path, f'is not a baseline: it needs "schema": {SCHEMA} and "entries"')
    known: Counter[Key] = Counter()
    for number, entry in enumerate(data["entries"]):
        try:
            beat = entry["beat"] if entry["chart"] else int(entry["line"]) / TICKS_PER_BEAT
            place = NO_BEAT if beat is None else round(float(beat) * TICKS_PER_BEAT)
            known[str(entry["file"]), str(entry["chart"]), str(entry["rule"]), place] += int(entry.get("count", 1))
        except (KeyError, TypeError, ValueError, AttributeError, OverflowError):
            raise FileError(path, f"entry {number} is not a finding with file, chart, rule and beat") from None
    return Baseline(path, known)
