"""The style `smeditor`: feet as overrides in `data.sme`, which SMEditor reads and shows.

Feet that a person has set are never changed. The feet that this program adds are also listed under a separate key, so
that they can be recognised and removed. SMEditor drops that key when it saves; then all feet count as the person's.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.chart.pack_files import song_stems
from dancetutor_cli.feet.song_feet import FEET, FILE_NAME, OURS, overrides_of, place_in_type, tick_of
from dancetutor_cli.markers.model import ChartFeet, FileChange, change_of, limbs_of_steps, old_content, removal_of
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.reading import parse_json

_Key = tuple[str, int]  # steps type, place among the charts of that type
_VALUES: dict[tuple[int, int], str | int] = {(limb, part): value for value, (limb, part) in FEET.items()}


def write(song: Song, folder: Path, feet: Sequence[ChartFeet]) -> Iterator[FileChange]:
    """Yield the `data.sme` of a folder; it identifies charts only by their place, so it can hold only one song."""
    path = folder / FILE_NAME
    if len(stems := song_stems(song.path.parent)) > 1:
        raise FileError(path, f"its folder has {len(stems)} songs, but data.sme can hold only one; it is not written")
    old = old_content(path, song)
    new = {(one.chart.steps_type, place_in_type(song, one.chart)): overrides(one) for one in feet}
    yield change_of(path, old, _rewrite(path, old, new), "does not have the feet that the solver finds")


def strip(song: Song, charts: Sequence[Chart]) -> Iterator[FileChange]:
    """Yield the `data.sme` without the feet that this program wrote; a file that would be empty is removed."""
    path = song.path.with_name(FILE_NAME)
    old = old_content(path, song)
    gone: dict[_Key, list[list[Any]]]
    gone = {(chart.steps_type, place_in_type(song, chart)): [] for chart in charts}
    yield removal_of(path, old, None if old is None else _rewrite(path, old, gone))


def overrides(one: ChartFeet) -> list[list[Any]]:
    """Return the steps of a chart in SMEditor's form: beat, column, foot.

    SMEditor has no hands, so they are left out.
    """
    return [
        [_beat(tick), at, _VALUES[who, which]]
        for tick, at, who, which in limbs_of_steps(one)
        if (who, which) in _VALUES
    ]


def _beat(tick: int) -> int | float:
    """A beat with three digits, as SMEditor rounds it; whole beats without a point."""
    beat = round(tick / TICKS_PER_BEAT, 3)
    return int(beat) if beat == int(beat) else beat


def _rewrite(path: Path, old: bytes | None, new: dict[_Key, list[list[Any]]]) -> bytes | None:
    before, ours = _split_own_entries(path, old)
    ours = {key: value for key, value in {**ours, **new}.items() if value}
    if not ours:
        return None if before is None else before.encode("utf-8")
    data = _parsed(path, before) if before is not None else {"version": 1, "parity": {}}
    written: dict[str, Any] = {}
    for (steps_type, place), wanted in sorted(ours.items()):
        entry = _chart_entry(path, data, steps_type, place)
        theirs = {(tick_of(beat), column) for beat, column, _ in overrides_of(entry)}
        added = [item for item in wanted if (tick_of(item[0]), item[1]) not in theirs]
        # The order of overrides does not matter to SMEditor.
        entry["overrides"] = [*entry["overrides"], *added]
        listed = written.setdefault(steps_type, [])
        listed.extend({"overrides": []} for _ in range(place + 1 - len(listed)))
        listed[place] = {"overrides": added}
    if before is not None and not any(entry["overrides"] for entries in written.values() for entry in entries):
        return before.encode("utf-8")  # a person has already set every foot
    data[OURS] = {"parity": written} if before is None else {"parity": written, "before": before}
    return _compact(data).encode("utf-8")


def _split_own_entries(path: Path, old: bytes | None) -> tuple[str | None, dict[_Key, list[list[Any]]]]:
    """Return the file without this program's feet (None: there was no file), and these feet."""
    if old is None:
        return None, {}
    try:
        text = old.decode("utf-8")
    except UnicodeDecodeError as error:
        raise FileError(path, "is not UTF-8; SMEditor did not write it") from error
    data = _parsed(path, text)
    mine = data.pop(OURS, None)
    if not isinstance(mine, dict):
        return text, {}
    ours: dict[_Key, list[list[Any]]] = {}
    for steps_type, entries in mine.get("parity", {}).items():
        for place, entry in enumerate(entries):
            ours[steps_type, place] = entry["overrides"]
            _remove(data, steps_type, place, entry["overrides"])
    before = mine.get("before")
    if isinstance(before, str) and _pruned(_parsed(path, before)) == _pruned(data):
        return before, ours
    if set(data) <= {"version", "parity"} and not _pruned(data).get("parity"):
        return None, ours
    return _compact(_pruned(data)), ours


def _remove(data: Any, steps_type: str, place: int, ours: list[list[Any]]) -> None:
    """Remove this program's overrides from a chart's entry; overrides that a person has changed stay."""
    try:
        entry = data["parity"][steps_type][place]
        mine = {tuple(item) for item in ours}
        entry["overrides"] = [item for item in entry["overrides"] if _hashable(item) not in mine]
    except (KeyError, IndexError, TypeError):
        return


def _hashable(item: Any) -> Any:
    """Return an override as a tuple, and None for anything else."""
    flat = isinstance(item, list) and all(isinstance(value, str | int | float) for value in item)
    return tuple(item) if flat else None


def _pruned(data: Any) -> Any:
    """Return the data without the empty entries that only keep the places of charts."""
    parity = data.get("parity")
    if not isinstance(parity, dict):
        return data
    kept: dict[str, Any] = {}
    for steps_type, entries in parity.items():
        short = list(entries) if isinstance(entries, list) else entries
        while isinstance(short, list) and short and short[-1] == {"overrides": [], "ignores": {}}:
            short.pop()
        if short:
            kept[steps_type] = short
    return {**data, "parity": kept}


def _chart_entry(path: Path, data: Any, steps_type: str, place: int) -> Any:
    """Return the entry of a chart in the parsed file, made if it does not exist."""
    parity = data.setdefault("parity", {})
    entries = parity.setdefault(steps_type, []) if isinstance(parity, dict) else None
    if not isinstance(entries, list):
        raise FileError(path, f"has an unexpected form at parity/{steps_type}; it is left alone")
    entries.extend({"overrides": [], "ignores": {}} for _ in range(place + 1 - len(entries)))
    entry = entries[place]
    if not isinstance(entry, dict) or not isinstance(entry.setdefault("overrides", []), list):
        raise FileError(path, f"has an unexpected form at parity/{steps_type}/{place}; it is left alone")
    entry.setdefault("ignores", {})
    return entry


def _parsed(path: Path, text: str) -> dict[str, Any]:
    try:
        data = parse_json(text.encode("utf-8"), path)
    except FileError as error:
        raise FileError(path, f"{error.message}; it is left alone", error.line, error.column) from error
    if not isinstance(data, dict):
        raise FileError(path, "is not what SMEditor writes; it is left alone")
    return data


def _compact(data: Any) -> str:
    """Return JSON in SMEditor's form."""
    return json.dumps(data, separators=(",", ":"), ensure_ascii=False)
