"""Charts that are looked at together, so that what rules ask of one is answered for all of them at once."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple

from dancetutor_cli.lint.candidates import Candidates

if TYPE_CHECKING:
    from dancetutor_cli.lint.subject import ChartSubject


class Shared(NamedTuple):
    """Plays that are looked at together, and which of them is meant."""

    candidates: Candidates
    number: int


def look_at_together(subjects: Iterable[ChartSubject]) -> None:
    """Let charts share their work: what is asked of one is answered for those on the same pad at once."""
    of_pads: dict[str, list[ChartSubject]] = defaultdict(list)
    for subject in subjects:
        if subject.play is not None and subject.pad is not None:
            of_pads[subject.pad.steps_type].append(subject)
    for alike in of_pads.values():
        assert alike[0].pad is not None
        candidates = Candidates([subject.play for subject in alike if subject.play is not None], alike[0].pad)
        for number, subject in enumerate(alike):
            vars(subject)["shared"] = Shared(candidates, number)
