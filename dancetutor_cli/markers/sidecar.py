"""Feet in files beside the chart: `SONG.dancetutor.json`, `SONG.feet.txt` of a .ucs, and SMEditor's `data.sme`."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.feet.limbs import Limb, Part
from dancetutor_cli.feet.sme import FEET, OURS, overrides_of, place_in_type, tick_of
from dancetutor_cli.markers.comments import ChartFeet, limbs_of
from dancetutor_cli.run.errors import FileError
from dancetutor_cli.run.files import encoded
from dancetutor_cli.run.reading import parse_json

# The style `sidecar`: `SONG.dancetutor.json` beside the file; the form that no editor throws away when it saves.

SUFFIX = ".dancetutor.json"
_SCHEMA = 1


def sidecar_path(song: Path) -> Path:
    """The sidecar of a chart file; the .sm and the .ssc of one song share theirs."""
    return song.with_name(song.stem + SUFFIX)


def write_sidecar(path: Path, old: bytes | None, song: Song, feet: Sequence[ChartFeet]) -> bytes:
    """The new content of a sidecar; what it says about other files and other charts stays."""
    files = _files(path, old)
    before = files.get(song.path.name, {}).get("charts", [])
    indices = {one.chart.index for one in feet}
    kept = [entry for entry in before if entry.get("index") not in indices and _still_there(entry, song)]
    charts = sorted([*kept, *(_entry(one) for one in feet)], key=lambda entry: int(entry["index"]))
    files[song.path.name] = {"charts": charts}
    return _dump(files)


def strip_sidecar(path: Path, old: bytes | None, song: Song, charts: Sequence[Chart]) -> bytes | None:
    """The sidecar without what it says about some charts of a file; None if nothing is left of it."""
    if old is None:
        return None
    files = _files(path, old)
    gone = {chart.index for chart in charts}
    before = files.pop(song.path.name, {}).get("charts", [])
    if kept := [entry for entry in before if entry.get("index") not in gone]:
        files[song.path.name] = {"charts": kept}
    return _dump(files) if files else None


def lack(path: Path, old: bytes | None, song: Song, chart: Chart, new: bytes) -> str | None:
    """Why a chart's entry is not what it should be, for `--check`; None if it is."""
    entry, wanted = (_find(_files(path, data), song, chart) for data in (old, new))
    if entry == wanted:
        return None
    if entry is None:
        return f"{chart.label}: {path.name} has no feet for it"
    if entry.get("notes_sha256") != notes_hash(chart):
        return f"{chart.label}: its notes have changed since {path.name} was written"
    return f"{chart.label}: {path.name} has other feet than the solver finds"


def notes_hash(chart: Chart) -> str:
    """SHA-256 of the notes: a line "tick,column,kind,end" for each, ticks of 1/48 beat, `kind` as in `chart.model`."""
    notes = chart.notes
    rows = zip(notes.tick.tolist(), notes.column.tolist(), notes.kind.tolist(), notes.end.tolist(), strict=True)
    text = "".join(f"{tick},{column},{kind},{end}\n" for tick, column, kind, end in rows)
    return hashlib.sha256(text.encode("ascii")).hexdigest()


def _still_there(entry: Any, song: Song) -> bool:
    index = entry.get("index")
    return isinstance(index, int) and 0 <= index < len(song.charts)


def _entry(one: ChartFeet) -> dict[str, Any]:
    chart = one.chart
    return {
        "index": chart.index,
        "steps_type": chart.steps_type,
        "difficulty": chart.difficulty,
        "meter": chart.meter,
        "description": chart.description,
        "preset": one.play.preset,
        "notes_sha256": notes_hash(chart),
        "steps": list(_steps(one)),
    }


def _steps(one: ChartFeet) -> list[list[Any]]:
    """[beat, column, limb] of each step, and which part of the foot in a bracket; limb null: nobody is left for it."""
    limb, part = limbs_of(one.chart, one.rows, one.play)
    row, column = one.rows.steps.nonzero()
    ticks = one.chart.rows.tick[one.rows.row[row]].tolist()
    steps = []
    cells = zip(ticks, column.tolist(), limb[row, column].tolist(), part[row, column].tolist(), strict=True)
    for tick, at, who, which in cells:
        step: list[Any] = [round(tick / TICKS_PER_BEAT, 6), at, None if who < 0 else Limb(who).name.lower()]
        steps.append([*step, Part(which).name.lower()] if which else step)
    return steps


def _files(path: Path, old: bytes | None) -> dict[str, Any]:
    if old is None:
        return {}
    try:
        data = parse_json(encoded(old.decode("utf-8", "surrogateescape")), path)
        files = data["files"]
        if data["program"] == "dancetutor" and all(isinstance(f["charts"], list) for f in files.values()):
            return dict(files)
    except (FileError, KeyError, TypeError, AttributeError):
        pass
    raise FileError(path, "is not a sidecar file of dancetutor; move it away or choose another style")


def _find(files: dict[str, Any], song: Song, chart: Chart) -> Any:
    charts = files.get(song.path.name, {}).get("charts", [])
    return next((entry for entry in charts if entry.get("index") == chart.index), None)


def _dump(files: dict[str, Any]) -> bytes:
    """One line for each chart, so that version control shows which have changed."""
    blocks = []
    for name in sorted(files):
        lines = ",\n".join("   " + json.dumps(entry, ensure_ascii=False) for entry in files[name]["charts"])
        blocks.append(f'  {json.dumps(name, ensure_ascii=False)}: {{"charts": [\n{lines}]}}')
    head = f'{{"schema": {_SCHEMA}, "program": "dancetutor", "files": {{\n'
    return encoded(head + ",\n".join(blocks) + "}}\n")


# The style of a .ucs for people: `SONG.feet.txt`, the file line by line with the feet behind its rows, "..M.X  ..L.R".
#
# Nothing but rows may stand in a .ucs, so nothing is written into it. Lines have the same numbers in both files.

TEXT_SUFFIX = ".feet.txt"
_OURS = b"feet by dancetutor, preset "  # begins its last line


def text_path(song: Path) -> Path:
    """The text with the feet of a .ucs."""
    return song.with_name(song.stem + TEXT_SUFFIX)


def write_feet_text(path: Path, old: bytes | None, song: Song, feet: Sequence[ChartFeet]) -> bytes:
    """The content of the text; FileError if what lies there is not ours."""
    check_text(path, old)
    lines = [line.rstrip(b"\r\n") for line in song.data.splitlines(keepends=True)]
    newline = b"\r\n" if b"\r\n" in song.data else b"\n"
    for one in feet:
        columns = one.chart.columns
        for row, steps, letters in zip(one.rows.row.tolist(), one.rows.steps, one.letters, strict=True):
            letter = iter(letters.encode("ascii"))
            cells = bytes(next(letter) if step else ord(".") for step in steps[:columns].tolist())
            at = int(one.chart.rows.line[row]) - 1
            lines[at] = lines[at].rstrip() + b"  " + cells
    preset = ", ".join(dict.fromkeys(one.play.preset for one in feet)).encode()
    return newline.join([*lines, _OURS + preset, b""])


def check_text(path: Path, old: bytes | None) -> None:
    """FileError if a file that lies where the text goes is not ours."""
    if old is not None and not old.rstrip().rpartition(b"\n")[2].startswith(_OURS):
        raise FileError(path, "was not written by dancetutor; move it away or choose --markers sidecar")


# The style `smeditor`: feet as overrides in `data.sme`, which SMEditor reads and shows.
#
# What a person has set there is never touched. What we add is listed once more under a key of our own, so that it can
# be distinguished from theirs and removed again; SMEditor drops that key when it saves, and then all feet are theirs.

_Key = tuple[str, int]  # steps type, place among the charts of that type
_VALUES: dict[tuple[int, int], str | int] = {(limb, part): value for value, (limb, part) in FEET.items()}


def write_editor_data(path: Path, old: bytes | None, song: Song, feet: Sequence[ChartFeet]) -> bytes | None:
    """The new content of `data.sme` with the feet of these charts; those of other charts that we wrote stay."""
    new = {(one.chart.steps_type, place_in_type(song, one.chart)): overrides(one) for one in feet}
    return _rewrite(path, old, new)


def strip_editor_data(path: Path, old: bytes | None, song: Song, charts: Sequence[Chart]) -> bytes | None:
    """`data.sme` without the feet that we wrote for these charts; None if nothing is left of a file of our own."""
    if old is None:
        return None
    return _rewrite(path, old, {(chart.steps_type, place_in_type(song, chart)): [] for chart in charts})


def overrides(one: ChartFeet) -> list[list[Any]]:
    """The steps of a chart as SMEditor writes them: beat, column, foot. Hands have no word there and are left out."""
    limb, part = limbs_of(one.chart, one.rows, one.play)
    row, column = one.rows.steps.nonzero()
    ticks = one.chart.rows.tick[one.rows.row[row]].tolist()
    cells = zip(ticks, column.tolist(), limb[row, column].tolist(), part[row, column].tolist(), strict=True)
    return [[_beat(tick), at, _VALUES[who, which]] for tick, at, who, which in cells if (who, which) in _VALUES]


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
        # Behind theirs: SMEditor looks notes up and does not mind the order.
        entry["overrides"] = [*entry["overrides"], *added]
        listed = written.setdefault(steps_type, [])
        listed.extend({"overrides": []} for _ in range(place + 1 - len(listed)))
        listed[place] = {"overrides": added}
    if before is not None and not any(entry["overrides"] for entries in written.values() for entry in entries):
        return before.encode("utf-8")  # every foot is theirs already
    data[OURS] = {"parity": written} if before is None else {"parity": written, "before": before}
    return _compact(data).encode("utf-8")


def _split_own_entries(path: Path, old: bytes | None) -> tuple[str | None, dict[_Key, list[list[Any]]]]:
    """The file as it was without us (None: not there), and what we had written into it."""
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
    """Take our overrides out of a chart's entry; one that a person has changed since is theirs and stays."""
    try:
        entry = data["parity"][steps_type][place]
        mine = {tuple(item) for item in ours}
        entry["overrides"] = [item for item in entry["overrides"] if _hashable(item) not in mine]
    except (KeyError, IndexError, TypeError):
        return


def _hashable(item: Any) -> Any:
    """An override as a tuple; anything else, which is not ours, as None."""
    flat = isinstance(item, list) and all(isinstance(value, str | int | float) for value in item)
    return tuple(item) if flat else None


def _pruned(data: Any) -> Any:
    """Without the empty entries that only keep the place of a chart."""
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
    """The entry of a chart in the parsed file, made if it is not there."""
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
    """JSON the way SMEditor writes it."""
    return json.dumps(data, separators=(",", ":"), ensure_ascii=False)
