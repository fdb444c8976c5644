"""The page of a chart for two: both players' notes and feet, and both dancers on the pad of both."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from dancetutor_cli.errors import UsageError
from dancetutor_cli.jobs.bake import BakeTask, ask, bake_asked
from dancetutor_cli.jobs.two import pad_of_both, place_on, sides_of

if TYPE_CHECKING:
    from dancetutor_cli.jobs.bake import Asked
    from dancetutor_cli.lint.finding import Finding
    from dancetutor_cli.motion.baked import Motion


@dataclass(frozen=True, slots=True)
class Pair:
    """Both who dance. both : the chart as it is written, with what both play of it on the pad of both

    alone : each player's part; tasks : how each is baked
    """

    both: Asked
    alone: tuple[Asked, ...]
    tasks: Sequence[BakeTask]

    def motions(self) -> list[Motion]:
        """Bake both, each on her place."""
        from dancetutor_cli.motion.baked import shifted

        sides = sides_of([one.chart for one in self.alone])
        return [
            shifted(bake_asked(one, task, side), *place_on(self.both.pad, one.chart, one.pad))
            for one, task, side in zip(self.alone, self.tasks, sides, strict=True)
        ]


def pair_of(tasks: Sequence[BakeTask]) -> Pair:
    """Read and solve both. tasks : one for each player"""
    from dancetutor_cli.jobs.danced import together
    from dancetutor_cli.play.let_go import without_unplayable

    if tasks[0].bar:
        raise UsageError(f"{tasks[0].path}: --bar is for one dancer, and the chart is for two: choose with --player")
    alone = tuple(ask(task) for task in tasks)
    song = alone[0].song
    chart = song.charts[alone[0].chart.index]
    pad = pad_of_both(chart.steps_type)
    play = together(chart, [without_unplayable(one.play, one.pad)[0] for one in alone], pad)
    return Pair(replace(alone[0], chart=chart, play=play, pad=pad), alone, tasks)


def findings_of_two(pair: Pair) -> Iterator[Finding]:
    """What the linter finds in either part, told with whose it is."""
    from dancetutor_cli.feet import overrides_for
    from dancetutor_cli.lint.check import findings_of
    from dancetutor_cli.lint.subject import ChartSubject

    for one in pair.alone:
        chart = one.chart
        overrides, ignores, problems = overrides_for(one.song, chart)
        subject = ChartSubject(one.song, chart, one.play, one.pad, overrides, ignores, problems)
        for found in findings_of(subject):
            column = None if found.note_column is None else found.note_column + chart.first_column
            yield replace(found, message=f"P{chart.player}: {found.message}", note_column=column)


def passages_of_two(pair: Pair) -> list[dict[str, Any]]:
    """The hardest passages of either, the hardest first, told with whose they are."""
    from dancetutor_cli.lint.passages import hardest
    from dancetutor_cli.page.sentences import told

    found = [(passage, one.chart) for one in pair.alone for passage in hardest(one.play, one.chart.timing)]
    out = []
    for passage, chart in sorted(found, key=lambda one: -one[0].score):
        data = told(passage)
        out.append({**data, "sentence": {name: f"P{chart.player}: {text}" for name, text in data["sentence"].items()}})
    return out
