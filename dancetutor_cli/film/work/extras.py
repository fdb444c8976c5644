"""The files besides a film: a picture for each row, a poster, subtitles."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.chart.names import TICKS_PER_BEAT, TICKS_PER_MEASURE
from dancetutor_cli.film.clock import Moments
from dancetutor_cli.run.errors import DancetutorError
from dancetutor_cli.run.files import encoded, write_atomic
from dancetutor_cli.run.pictures import picture_bytes

if TYPE_CHECKING:
    from dancetutor_cli.chart.model import Chart, Song
    from dancetutor_cli.film.film import Film
    from dancetutor_cli.film.plan import FilmPlan

INDEX = "poses.json"


def pose_plan(plan: FilmPlan, label: str) -> FilmPlan:
    """Return a plan with one frame for each row with a step, which an editor can show while its user scrolls."""
    start, end = plan.clock.passes[0].start, plan.clock.passes[0].end
    rows = plan.rows
    times = () if rows is None else tuple(float(t) for t in rows.second if start <= t <= end)
    if not times:
        raise DancetutorError(f"{label}: there is no step here, so there is no pose to draw")
    clock = Moments(plan.clock.passes[:1], plan.clock.fps, times)
    beats = np.interp(times, plan.lines.second, plan.lines.beat) if len(plan.lines.second) else np.zeros(len(times))
    return replace(plan, clock=clock, beats=beats)


def write_pose_index(folder: Path, song: Song, chart: Chart, plan: FilmPlan) -> None:
    """Write the index of pictures and rows: an object with one entry for each picture."""
    assert isinstance(plan.clock, Moments)
    notes = chart.notes
    seconds = chart.timing.seconds(notes.tick)
    entries = []
    for number, time in enumerate(plan.clock.times):
        note = int(np.argmin(np.abs(seconds - time)))
        tick = int(notes.tick[note])
        entries.append(
            {
                "picture": f"frame_{number:06d}.png",
                "beat": tick / TICKS_PER_BEAT,
                "measure": tick // TICKS_PER_MEASURE,
                "second": round(time, 6),
                "line": int(notes.line[note]),
            }
        )
    data = {"schema": 1, "path": song.path.name, "chart": chart.label, "poses": entries}
    write_atomic(folder / INDEX, encoded(json.dumps(data, ensure_ascii=False, indent=1) + "\n"))


def write_poster(path: Path, film: Film) -> None:
    """Write a picture for a title page: the first called-out move, or a note a third into the film."""
    plan = film.plan
    one = plan.clock.passes[-1]
    first = max(one.start, one.sound_from) + 1.0
    calls = [call.second for call in plan.callouts if first <= call.second <= one.end]
    steps = plan.presses.start
    aim = one.start + (one.end - one.start) / 3
    moment = calls[0] if calls else float(steps[np.argmin(np.abs(steps - aim))]) if len(steps) else aim
    before = sum(other.seconds for other in plan.clock.passes[:-1])
    number = round((before + one.film_seconds(moment)) * plan.clock.fps + 0.5)
    write_atomic(path, picture_bytes(film.frame(min(number, plan.clock.frames - 1))))


def write_subtitles(path: Path, plan: FilmPlan) -> list[str]:
    """Write subtitles that name the moves, beside the film; without moves, write no file and return a warning."""
    from dancetutor_cli.film.media.subtitles import subtitle_style, subtitles

    text = subtitles(plan.cues, plan.clock, subtitle_style())
    if not text:
        path.unlink(missing_ok=True)  # the subtitles of an earlier film would be wrong
        return [
            f"no move of this film has a name, so there is no {path.name}; configs/subtitles.yaml says what is named"
        ]
    write_atomic(path, text.encode())
    return []
