#!/usr/bin/env python3
"""How well the sync of songs is measured: files shifted by known times, with another tempo, and with other songs'
music.

usage: tools/sync_shifts.py FOLDER [--seed N]     a folder of songs with music; prints a table in Markdown

A shift is an error by how far the bias moves otherwise; what was not sure (below 0.8) is a dash. Nothing is written.
"""

from __future__ import annotations

import argparse
import random
import time
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

import numpy as np

from dancetutor_cli.chart.model import Song
from dancetutor_cli.chart.music import music_file
from dancetutor_cli.chart.reader import load
from dancetutor_cli.chart.selection import find_files
from dancetutor_cli.lint.findings import Sync
from dancetutor_cli.lint.song_sync import hear
from dancetutor_cli.lint.sync import Judgement, Onsets, judge

SHIFTS = (9, -9, 25, -60)  # ms
TEMPO = Fraction("1.0005")
TOLERANCE = 1.5  # ms
STRANGERS = 3  # other songs whose music each song is tried with


class Heard(NamedTuple):
    """A song with its onsets and how many seconds of this process they took."""

    song: Song
    onsets: Onsets
    seconds: float


def heard_songs(folder: Path) -> dict[str, Heard]:
    """Every song of a folder with music, once: as .ssc where there are both."""
    files = {path.with_suffix(""): path for path in sorted(find_files([folder]))}
    out = {}
    for path in files.values():
        song = load(path)
        start = time.process_time()
        out[path.parent.name] = Heard(song, hear(music_file(song)).onsets, time.process_time() - start)
    return out


def sync(song: Song, onsets: Onsets, shift: float = 0.0, tempo: Fraction = Fraction(1)) -> Sync:
    """The sync of the song's own timing, its #OFFSET raised by milliseconds, its BPMs multiplied."""
    timing = song.timing
    charts = [chart for chart in song.charts if chart.timing == timing]
    bpms = tuple((tick, bpm * tempo) for tick, bpm in timing.bpms)
    changed = replace(timing, bpms=bpms, offset=timing.offset + Fraction(round(shift * 1000), 1_000_000))
    found = judge(changed, charts, onsets)
    return found.sync if isinstance(found, Judgement) else found


def drift_of_tempo(song: Song) -> float:
    """By how many ms the drift grows with the tempo, for two thirds of the time from the first to the last note."""
    ticks = np.concatenate([chart.notes.tick for chart in song.charts if chart.timing == song.timing])
    return float(1 - 1 / TEMPO) * 2 / 3 * float(np.ptp(song.timing.seconds(ticks))) * 1000


def shown(before: float | None, found: Sync, moved: float) -> tuple[str, float | None]:
    """How far from what it should be, for the table and as a number; nothing where it is not sure."""
    if not found.is_sure or found.bias_ms is None or before is None:
        return "-", None
    error = abs(found.bias_ms - before - moved)
    return f"{error:.1f}", error


def main() -> None:
    """Print the table, and below it what it comes to."""
    parser = argparse.ArgumentParser(description="How well the sync of songs is told.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    songs, dice = heard_songs(arguments.folder), random.Random(arguments.seed)
    print(f"| song | bias | confidence | kind | {' | '.join(f'{shift:+}' for shift in SHIFTS)} | drift | s |")
    print("| --- | ---: | ---: | --- |" + " ---: |" * (len(SHIFTS) + 2))
    errors: list[float] = []
    sure = strange = fooled = 0
    for name, one in songs.items():
        start = time.process_time()
        first = sync(one.song, one.onsets)
        seconds = one.seconds + time.process_time() - start
        cells = []
        for shift in SHIFTS:
            text, error = shown(first.bias_ms, sync(one.song, one.onsets, shift), shift)
            cells.append(text)
            errors += [] if error is None else [error]
        drifted = sync(one.song, one.onsets, tempo=TEMPO)
        told = drifted.is_sure and drifted.drift_ms is not None and first.drift_ms is not None
        cells.append(f"{abs(drifted.drift_ms - first.drift_ms - drift_of_tempo(one.song)):.1f}" if told else "-")
        bias = "-" if first.bias_ms is None else f"{first.bias_ms:.1f}"
        line = (name, bias, f"{first.confidence:.2f}", first.kind, *cells, f"{seconds:.2f}")
        print(f"| {' | '.join(line)} |")
        sure += first.is_sure
        others = [other for other in songs if other != name]
        for other in dice.sample(others, min(STRANGERS, len(others))):
            strange += 1
            fooled += sync(one.song, songs[other].onsets, dice.uniform(-250, 250)).is_sure
    wrong = sum(error > TOLERANCE for error in errors)
    print(
        f"\n{sure} of {len(songs)} songs are sure; of {len(errors)} sure shifts {wrong} are {TOLERANCE} ms off or more,"
    )
    print(f"the worst {max(errors, default=0.0):.1f} ms; of {strange} songs with other music {fooled} are sure")


if __name__ == "__main__":
    main()
