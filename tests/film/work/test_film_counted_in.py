"""While a film counts to its first step nothing else is danced or shown: what is counted and what she does agree."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from dance_requests import film_request

from dancetutor_cli.chart.selection import Selection
from dancetutor_cli.film.clock import Practice
from dancetutor_cli.film.layout import FilmLook, load_layout
from dancetutor_cli.film.work.film_dance import quiet_times, shown_notes
from dancetutor_cli.film.work.planning import PreparedFilm, prepare
from dancetutor_cli.film.work.request import look_up

STREAM = "1000\n0100\n0010\n0001\n0100\n1000\n0010\n0001\n"


@pytest.fixture(scope="module", params=[1, 2])
def prepared(tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest) -> PreparedFilm:
    """Four steps a second for 16 seconds, of which 8 to 10 are practised, by one or by two."""
    path = tmp_path_factory.mktemp("counted") / "stream.sm"
    steps, notes = "dance-single", ",\n".join([STREAM] * 8)
    if request.param == 2:
        steps, notes = "dance-couple", "\n".join(2 * line if len(line) == 4 else line for line in notes.split("\n"))
    path.write_text(f"#TITLE:x;\n#OFFSET:0;\n#BPMS:0=120;\n#NOTES:\n {steps}:\n :\n Hard:\n 8:\n :\n{notes};\n")
    look = FilmLook(load_layout("practice"), (320, 180), "draft", "cpu")
    how = {"rates": (0.5, 1.0), "practice": Practice(count_in=4)}
    wanted = film_request(path, Selection(), look, fps=30, section="8:10", mute=True, **how)
    return prepare(wanted, look_up(wanted))


def test_nothing_is_stepped_or_shown_while_it_counts(prepared: PreparedFilm) -> None:
    plan = prepared.plan
    one = plan.clock.passes[0]
    assert (one.start, one.sound_from) == (6.0, 8.0)
    assert plan.rows is not None
    for seconds in (plan.notes.second, plan.presses.start, plan.rows.second):
        assert not ((seconds >= one.start) & (seconds < one.sound_from)).any()
        assert (seconds == 8.0).any(), "the first step that it counts to"
    for rate, motions in plan.motions.items():
        for motion in motions:
            starts = np.array([contact.start for contact in motion.contacts]) * rate
            assert not ((starts >= one.start) & (starts < one.sound_from - 1e-3)).any()
            assert (np.abs(starts - 8.0) < 0.02).any()


def test_the_strip_still_shows_the_whole_song(prepared: PreparedFilm) -> None:
    steps = prepared.plan.song.steps
    assert ((steps >= 6.0) & (steps < 8.0)).sum() == 8


def test_without_a_count_in_all_is_danced(prepared: PreparedFilm) -> None:
    plan = prepared.plan
    passes = (replace(plan.clock.passes[0], count=0, rest=0.0),)
    assert quiet_times(passes) == [] and shown_notes(plan.notes, passes) is plan.notes
