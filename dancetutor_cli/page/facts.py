"""The facts of a page about a song and a chart: words, places of notes, the cost of the other foot, tags."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice
from typing import TYPE_CHECKING, Any

import numpy as np

from dancetutor_cli.chart.density import bpm_text
from dancetutor_cli.chart.model import Chart, Song
from dancetutor_cli.chart.names import TICKS_PER_BEAT
from dancetutor_cli.feet.limbs import Limb, Part
from dancetutor_cli.feet.overrides import Overrides
from dancetutor_cli.feet.play import Play, StepKind
from dancetutor_cli.feet.solver.solve import solve_rows
from dancetutor_cli.film.notes import note_track
from dancetutor_cli.film.overlay.text import clean
from dancetutor_cli.film.scroll import parse_segments

if TYPE_CHECKING:
    from dancetutor_cli.feet.pads import Pad
    from dancetutor_cli.feet.passages import Passage
    from dancetutor_cli.feet.preset import Preset


# The words of a song and a chart, the places of notes, and the seconds of beats.

BEATS_AFTER = 16  # number of beats in the page after the last note
_LONGEST = 300  # maximum letters of a title, an artist, a credit


def words_of(song: Song, chart: Chart, preset: str) -> dict[str, str]:
    """Return all words written by people that the page shows, as plain text; preset : the preset's name."""
    return {
        "title": _cut(clean(" ".join(part for part in (song.title or song.path.stem, song.subtitle) if part))),
        "artist": _cut(clean(song.artist)),
        "badge": clean(f"{chart.difficulty} {chart.meter}"),
        "difficulty": chart.difficulty,
        "steps": chart.steps_type,
        "bpm": bpm_text(song, chart),
        "credit": _cut(clean(chart.tags.get("CREDIT", "") or song.tags.get("CREDIT", ""))),
        "file": clean(song.path.name),
        "music": clean(song.music),
        "preset": preset,
        "index": str(chart.index),
        "meter": str(chart.meter),
    }


def _cut(text: str) -> str:
    return text if len(text) <= _LONGEST else text[: _LONGEST - 1] + "…"


def ticks_of(chart: Chart) -> list[int]:
    """Return the ticks of the notes in the order of `film.notes.note_track`."""
    return [int(tick) for tick in note_track(chart, None, parse_segments("")).tick]


def beats_of(chart: Chart) -> list[float]:
    """Return the second of each beat from 0 to `BEATS_AFTER` beats after the last note."""
    last = chart.notes.last_tick // TICKS_PER_BEAT
    ticks = np.arange(last + BEATS_AFTER, dtype=np.int64) * TICKS_PER_BEAT
    return [float(second) for second in chart.timing.seconds(ticks)]


# The cost of the other foot: each row with its feet exchanged, and all steps that the solver then changes.

MOST_WORK = 4_000_000  # rows times rows: each flip solves the whole chart; 2000 rows take about half a minute
_FEET = (Limb.LEFT_FOOT, Limb.RIGHT_FOOT)


def flips_of(play: Play, pad: Pad, preset: Preset, overrides: Overrides) -> list[dict[str, Any]]:
    """Return for each row with feet its number, the extra cost of exchanged feet, and the changed cells.

    `extra` is exact: the least cost of a play of the whole chart with these feet, minus the least cost of any play. It
    is -1 if nobody can step the row with these feet. For a very long chart, which would take minutes, only the first
    rows are returned. All other feet that the author has set (`overrides`) stay.
    """
    most, total = MOST_WORK // max(len(play.rows), 1), play.total
    return [_flip(play, row, total, (pad, preset, overrides)) for row in islice(_rows(play), most)]


def _rows(play: Play) -> Iterator[int]:
    steps = play.rows.steps
    seen = ((steps != StepKind.NONE) & (steps != StepKind.ROLL_TAP)).any(axis=1)
    feet = np.isin(play.limb, _FEET).any(axis=1)
    yield from np.flatnonzero(seen & feet).tolist()


def _flip(play: Play, row: int, total: int, given: tuple[Pad, Preset, Overrides]) -> dict[str, Any]:
    pad, preset, overrides = given
    tick = int(play.rows.tick[row])
    cells = overrides.cells()
    asked = {}
    for column, limb in enumerate(play.limb[row].tolist()):
        if limb in _FEET:
            asked[column] = 1 - limb
            cells[tick, column] = (1 - limb, int(Part.WHOLE))
    other = solve_rows(play.rows, pad, preset, Overrides.of(cells), margins=False)
    kept = all(int(other.limb[row, column]) == limb for column, limb in asked.items())
    changed = np.argwhere(other.limb != play.limb)
    return {
        "row": row,
        "extra": other.total - total if kept else -1,
        "changes": [[int(r), int(c), int(other.limb[r, c])] for r, c in changed] if kept else [],
    }


# Tags for the moves of a passage, for which the page has words in its reader's language.

_TURNED = 90.0  # smallest turn that is reported, degrees


def tags(passage: Passage) -> list[tuple[str, int]]:
    """Return the names of the moves with their counts (degrees for `turn`): first the steps, then by importance."""
    counted = (
        ("spin", passage.spins),
        ("crossover", sum(passage.crossovers)),
        ("bracket", passage.brackets),
        ("footswitch", passage.footswitches),
        ("doublestep", passage.doublesteps),
        ("jump", passage.jumps),
        ("hand", passage.hands),
        ("jack", passage.jacks),
        ("turn", round(passage.turn) if passage.turn >= _TURNED and not passage.spins else 0),
        ("close", passage.unsure),
    )
    first = ("stream", passage.stream) if passage.stream else ("fast", passage.steps)
    return [first, *((name, count) for name, count in counted if count)]


_PLAIN = 3.0  # steps a second below which a passage of mere steps is not listed


def passage_object(passage: Passage, player: int = 0) -> dict[str, Any]:
    """Return the object of a passage for the page; player : its player in a chart for two, from 1."""
    return {
        "from": passage.first,
        "to": passage.last,
        "start": round(passage.start, 6),
        "end": round(passage.end, 6),
        "rate": round(passage.rate, 2),
        "plain": passage.rate < _PLAIN and len(tags(passage)) == 1 and not passage.stream,
        "tags": [list(tag) for tag in tags(passage)],
        "player": player,
    }


def without_repeats(passages: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the passages that the page lists, the hardest first.

    `number` is the place among the hardest, as in `render --section hardest:3`. Passages with the same tags are one
    entry, with the measures of the others in `again`. A passage of a few slow steps is left out.
    """
    out: dict[str, dict[str, Any]] = {}
    for number, one in enumerate(passages, 1):
        if one["plain"]:
            continue
        kept = out.setdefault(str((one["player"], one["tags"])), {**one, "number": number, "again": []})
        if kept["number"] != number:
            kept["again"].append([one["from"], one["to"]])
    return list(out.values())
