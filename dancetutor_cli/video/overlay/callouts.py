"""What the picture calls out beside the notes: the moves a learner has to know, and what the linter found."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from dancetutor_cli.chart.model import TICKS_PER_BEAT
from dancetutor_cli.lint.check import findings_of
from dancetutor_cli.video.notes import Callout

if TYPE_CHECKING:
    from collections.abc import Mapping

    from dancetutor_cli.lint.subject import ChartSubject
    from dancetutor_cli.video.scroll import ScrollSegments

_FOR_AUTHORS = ("unsure-feet",)  # nothing that a dancer does
_ORDER = ("move", "info", "warning", "error")


def callouts_of(subject: ChartSubject, words: Mapping[str, str], scrolls: ScrollSegments) -> tuple[Callout, ...]:
    """Everything to call out, one entry per moment, in order of time.

    words : name of a move -> what is called; moves that are not in it are not. A move that goes on over several rows is
    called once, where it begins.
    """
    found: dict[int, tuple[set[str], int]] = {}
    for tick, text, weight in (*_moves(subject, words), *_findings(subject)):
        texts, most = found.setdefault(tick, (set(), 0))
        texts.add(text)
        found[tick] = (texts, max(most, weight))
    ticks = np.array(sorted(found), dtype=np.int64)
    seconds = subject.chart.timing.seconds(ticks)
    beats = scrolls.shown(ticks / TICKS_PER_BEAT)
    return tuple(
        Callout(float(second), float(beat), ", ".join(sorted(found[int(tick)][0])), _ORDER[found[int(tick)][1]])
        for tick, second, beat in zip(ticks, seconds, beats, strict=True)
    )


def _moves(subject: ChartSubject, words: Mapping[str, str]) -> list[tuple[int, str, int]]:
    out = []
    before: set[str] = set()
    play = subject.play
    for tick, names in zip(play.rows.tick.tolist(), play.moves, strict=True) if play else ():
        now = {words[name] for name in names if name in words}
        out += [(tick, word, 0) for word in sorted(now - before)]
        before = now
    return out


def _findings(subject: ChartSubject) -> list[tuple[int, str, int]]:
    return [
        (round(finding.beat * TICKS_PER_BEAT), finding.name.replace("-", " "), _ORDER.index(finding.severity))
        for finding in findings_of(subject)
        if finding.beat is not None
        and finding.note_column is not None
        and finding.severity in _ORDER
        and finding.name not in _FOR_AUTHORS
    ]
